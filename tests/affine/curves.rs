//! Curves of bifurcations in two parameters, held against closed forms, and against branches in one
//! parameter at the other's value.

use percuss::affine::{Place, SectionMap, Solver, System, SystemError};
use percuss::dynamics::continuation::BifurcationKind;
use percuss::system::{
    BifurcationCurve, CurveEnding, ReturnBranch, ReturnFamily, ReturnPlane, Section, SystemFile,
};
use std::f64::consts::TAU;

macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../validation/systems/", $name, ".system.toml"))
    };
}

/// A system with two parameters that vary, and others set.
struct Varied {
    file: SystemFile,
    names: [&'static str; 2],
    section: Section,
}

impl Varied {
    fn new(text: &str, section: Section, names: [&'static str; 2], set: &[(&str, f64)]) -> Self {
        let mut file = SystemFile::read("test.system.toml", text).unwrap();
        for (name, value) in set {
            file.set(name, *value, "here").unwrap();
        }
        Self { file, names, section }
    }

    fn at(&self, values: [f64; 2]) -> Result<System, SystemError> {
        let mut file = self.file.clone();
        for (name, value) in self.names.iter().zip(values) {
            file.set(name, value, "here")?;
        }
        file.system()
    }

    /// The return after so many others, from the start with these states.
    fn settled(&self, values: [f64; 2], state: Option<&[f64]>, transient: usize) -> Place<f64> {
        let system = self.at(values).unwrap();
        let solver = Solver::new(&system).unwrap();
        let map = SectionMap::new(&solver, &self.section).unwrap();
        let mut returns = map.returns(system.start().unwrap()).unwrap();
        returns.by_ref().take(transient + 1).for_each(|it| drop(it.unwrap()));
        let place = returns.place().unwrap();
        match state {
            Some(state) => place.moved_to(place.time, state.to_vec()),
            None => place,
        }
    }

    /// The branch in the first parameter, at a value of the second.
    fn branch(&self, guess: &Place<f64>, period: u32, ends: [f64; 2], second: f64) -> ReturnBranch {
        let at = |value: f64| self.at([value, second]);
        let family = ReturnFamily::new(self.section.clone(), None, &at);
        ReturnBranch::follow(&family, guess, period, ends, &mut |_| {}).unwrap()
    }

    /// The curves of all its bifurcations.
    fn curves(
        &self,
        branch: &ReturnBranch,
        window: [[f64; 2]; 2],
        second: f64,
    ) -> Vec<BifurcationCurve> {
        let at = |values: [f64; 2]| self.at(values);
        let plane = ReturnPlane::new(self.section.clone(), None, window, &at);
        BifurcationCurve::all(&plane, branch, second, &mut |_| {})
    }
}

fn show(curves: &[BifurcationCurve]) {
    for it in curves {
        let [a, b] = [&it.points[0], &it.points[it.points.len() - 1]];
        let worst = it.points.iter().map(|it| it.error).fold(0.0, f64::max);
        eprintln!(
            "{} {:?} {} points {:?} to {:?} {:?} worst {worst:e}",
            it.kind,
            it.event,
            it.points.len(),
            a.values,
            b.values,
            it.endings
        );
    }
}

/// The orbits of the rigid impact oscillator that impact once in several forcing periods, in closed
/// form (Shaw and Holmes, J. Sound Vib. 90 (1983) 129): between impacts the motion is the forced
/// one and a free one, of which both ends are known.
///
/// With v the speed before the impact, the forced motion has there the value d - `a` v and the rate
/// `b` v, and these make the square of its amplitude, a quadratic in v.
struct OneImpact {
    frequency: f64,
    a: f64,
    b: f64,
    /// The free motion's trace, and its upper right entry, over one period of the orbit.
    trace: f64,
    entry: f64,
    det: f64,
    /// The amplitude of the forced motion for a force of 1.
    response: f64,
}

const ZETA: f64 = 0.05;
const STOP: f64 = 0.125;
const BACK: f64 = 0.75;

impl OneImpact {
    fn new(frequency: f64, periods: f64) -> Self {
        let time = TAU * periods / frequency;
        let own = (1.0 - ZETA * ZETA).sqrt();
        let (decay, (sin, cos)) = ((-ZETA * time).exp(), (own * time).sin_cos());
        let free = [
            [decay * (cos + ZETA / own * sin), decay * sin / own],
            [-decay * sin / own, decay * (cos - ZETA / own * sin)],
        ];
        let first = (1.0 - free[0][0]) / free[0][1];
        let last = free[1][0] + first * free[1][1];
        let a = (1.0 + BACK) / (last - first);
        Self {
            frequency,
            a,
            b: -BACK - first * a,
            trace: free[0][0] + free[1][1],
            entry: free[0][1],
            det: BACK * BACK * (-2.0 * ZETA * time).exp(),
            response: 1.0 / (1.0 - frequency * frequency).hypot(2.0 * ZETA * frequency),
        }
    }

    /// The force with which the orbit impacts at a speed.
    fn force(&self, speed: f64) -> f64 {
        let [value, rate] = [STOP - self.a * speed, self.b * speed];
        value.hypot(rate / self.frequency) / self.response
    }

    /// The force at the fold, where both speeds are one.
    fn fold(&self) -> f64 {
        let rate = self.b / self.frequency;
        self.force(STOP * self.a / (self.a * self.a + rate * rate))
    }

    /// The force at the flip: 1 + trace + determinant of the map vanishes, whose trace has what
    /// the impact makes of a small change of its place, (1 + r) (force there - d)/v.
    fn flip(&self) -> f64 {
        let squared = self.frequency * self.frequency;
        let lasting = 2.0 * ZETA * self.b - (1.0 - squared) * self.a;
        let kick = -(1.0 - BACK * self.trace + self.det) / (self.entry * (1.0 + BACK));
        self.force(-squared * STOP / (kick - lasting))
    }
}

#[test]
fn explore() {
    let varied = Varied::new(
        system!("rigid-impact-oscillator"),
        Section::strobe(0.0),
        ["A", "frequency"],
        &[],
    );
    let guess = varied.settled([0.3, 2.75], Some(&[-0.2978346517671801, -0.010812597735035047]), 0);
    for to in [0.6, 0.12] {
        let branch = varied.branch(&guess, 2, [0.3, to], 2.75);
        let time = std::time::Instant::now();
        let curves = varied.curves(&branch, [[0.3, to], [2.1, 3.5]], 2.75);
        show(&curves);
        eprintln!("{:?}", time.elapsed());
        for it in &curves {
            for p in &it.points {
                let exact = OneImpact::new(p.values[1], 2.0);
                let exact =
                    if it.kind == BifurcationKind::Fold { exact.fold() } else { exact.flip() };
                let off = (exact - p.values[0]).abs();
                if off > p.error || p.error > 1e-9 {
                    eprintln!("{:?} off {off:e} error {:e}", p.values, p.error);
                }
            }
        }
    }
}
