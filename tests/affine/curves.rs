//! Curves of bifurcations in two parameters, held against closed forms, and against branches in one
//! parameter at the other's value.

use super::branches::BILINEAR;
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
    fn settled_return(
        &self,
        values: [f64; 2],
        state: Option<&[f64]>,
        transient: usize,
    ) -> Place<f64> {
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

/// An orbit with one impact in two forcing periods, near enough for Newton's method.
const TWO_PERIODS: [f64; 2] = [-0.2978, -0.0108];

/// Every place is on the curve within its error, with the roundings of the value it is held to, and
/// no error is larger than `most`.
fn assert_on(curve: &BifurcationCurve, most: f64, exact: impl Fn([f64; 2]) -> f64) {
    for it in &curve.points {
        let (off, [value, _]) = ((exact(it.values) - it.values[0]).abs(), it.values);
        let within = it.error + 64.0 * f64::EPSILON * value.abs();
        assert!(off <= within && it.error <= most, "{:?}: {off} {}", it.values, it.error);
    }
}

/// The ends of a curve.
fn ends(curve: &BifurcationCurve) -> [[f64; 2]; 2] {
    [curve.points[0].values, curve.points[curve.points.len() - 1].values]
}

fn range(curve: &BifurcationCurve, axis: usize) -> [f64; 2] {
    let values = curve.points.iter().map(|it| it.values[axis]);
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], it| [a.min(it), b.max(it)])
}

/// The least force at the fold is at a frequency of 2.42, where the curve turns back in it.
#[test]
fn folds_of_an_impact_oscillator_are_those_of_its_closed_form() {
    let text = system!("rigid-impact-oscillator");
    let varied = Varied::new(text, Section::strobe(0.0), ["A", "frequency"], &[]);
    let guess = varied.settled_return([0.3, 2.75], Some(&TWO_PERIODS), 0);
    let branch = varied.branch(&guess, 2, [0.3, 0.1], 2.75);
    let curves = varied.curves(&branch, [[0.3, 0.1], [2.2, 3.5]], 2.75);
    let [fold] = &curves[..] else { panic!("{curves:?}") };
    assert_eq!((fold.kind, fold.endings), (BifurcationKind::Fold, [CurveEnding::Left; 2]));
    assert_on(fold, 1e-12, |[_, frequency]| OneImpact::new(frequency, 2.0).fold());
    let [least, _] = range(fold, 0);
    assert!(least < 0.109, "{least}");
    let mut ends = ends(fold);
    ends.sort_by(|a, b| a[1].total_cmp(&b[1]));
    assert_eq!((ends[0][1], ends[1][0]), (2.2, 0.3));
}

/// The curve turns back in the second parameter, the force, at a frequency of 2.28.
#[test]
fn flips_of_an_impact_oscillator_are_those_of_its_closed_form() {
    let text = system!("rigid-impact-oscillator");
    let varied = Varied::new(text, Section::strobe(0.0), ["frequency", "A"], &[]);
    let guess = varied.settled_return([2.75, 0.25], Some(&TWO_PERIODS), 0);
    let branch = varied.branch(&guess, 2, [2.75, 2.19], 0.25);
    let curves = varied.curves(&branch, [[2.75, 2.19], [0.2, 0.4]], 0.25);
    let own: Vec<_> = curves.iter().filter(|it| it.kind == BifurcationKind::Flip).collect();
    let [flip] = &own[..] else { panic!("{curves:?}") };
    assert_eq!(flip.endings, [CurveEnding::Left; 2]);
    let [least, most] = range(flip, 1);
    assert!(least < 0.2275 && most == 0.4, "{least} {most}");
    assert_eq!(range(flip, 0)[0], 2.19);
    for it in &flip.points {
        let [frequency, force] = it.values;
        let beside = [-1.0, 1.0]
            .map(|side| OneImpact::new(frequency + side * (it.error + 1e-14), 2.0).flip() - force);
        // Where the curve turns both are on one side, or it is between them.
        let is_turn = (force - least).abs() < 1e-9;
        assert!(beside[0] * beside[1] <= 0.0 || is_turn, "{:?} {beside:?}", it.values);
        assert!(it.error < 1e-11 || (force - least).abs() < 1e-4, "{:?} {}", it.values, it.error);
    }
}

/// A mass that meets a spring whose distance grows with two parameters in every direction.
const ROUND: &str = r#"
schema = 1
name = "round"
states = ["x", "v"]
forcing = { omega = "frequency", phi = 0 }
[parameters]
frequency = 0.8
zeta = 0.05
A = 0.6
gap = 1.4
c = 0.0
d = 0.0
[let]
distance = "gap + c*c + d*d"
[[mode]]
name = "free"
equations = ["x' = v", "v' = A*cos - 2*zeta*v - x"]
[[mode.until]]
name = "touch"
guard = "x > distance"
next = [{ mode = "contact" }]
[[mode]]
name = "contact"
equations = ["x' = v", "v' = A*cos - 2*zeta*v - x - 5*(x - distance)"]
[[mode.until]]
name = "leave"
guard = "x < distance"
next = [{ mode = "free" }]
[start]
mode = "free"
x = 0
v = 0
"#;

/// The spring is touched on a circle: both touches of the branch are on one curve, which is closed
/// and turns in both parameters.
#[test]
fn a_closed_curve_of_grazings_is_followed_once_around() {
    let varied = Varied::new(ROUND, Section::strobe(0.0), ["c", "d"], &[]);
    let branch = varied.branch(&varied.settled_return([-1.8, 0.1], None, 300), 1, [-1.8, 1.8], 0.1);
    let kinds: Vec<_> = branch.bifurcations.iter().map(|it| it.kind).collect();
    let [grazing, flip] = [BifurcationKind::Grazing, BifurcationKind::Flip];
    assert_eq!(kinds, [grazing, flip, flip, grazing]);
    let curves = varied.curves(&branch, [[-1.8, 1.8], [-2.0, 2.0]], 0.1);
    let told: Vec<_> = curves.iter().map(|it| (it.kind, it.endings)).collect();
    assert_eq!(told, [grazing, flip].map(|it| (it, [CurveEnding::Closed; 2])));
    let squared = 0.6 / (0.36_f64).hypot(0.08) - 1.4;
    assert_circle(&curves[0], squared.sqrt());
    // The flip depends on the distance alone, too.
    assert_circle(&curves[1], branch.bifurcations[1].value.hypot(0.1));
}

fn assert_circle(circle: &BifurcationCurve, radius: f64) {
    for it in &circle.points {
        let [c, d] = it.values;
        // Inside and outside of the circle within the error, or beside its top.
        let error = it.error + 8.0 * f64::EPSILON;
        let off = [-1.0, 1.0].map(|side| (c + side * error).hypot(d) - radius);
        let is_top = (d.abs() - radius).abs() < 1e-9;
        assert!(off[0] * off[1] <= 0.0 || is_top, "{:?} {} {off:?}", it.values, it.error);
        assert!(it.error <= 1e-10 || c.abs() < 0.1 * radius, "{:?} {}", it.values, it.error);
    }
    // The cosine of the largest turn in a step: a place is as near to the top at least.
    let [low, high] = range(circle, 1);
    assert!(low < -0.95 * radius && high > 0.95 * radius, "{low} {high} {radius}");
}

/// Each of several places is found by a branch in the first parameter where the second has its
/// value, and both ends are where the window ends.
#[test]
fn a_curve_is_where_branches_in_one_parameter_have_the_bifurcation() {
    let text = system!("buck-converter");
    let varied = Varied::new(text, Section::event("clock"), ["Vin", "R"], &[]);
    let branch =
        varied.branch(&varied.settled_return([22.0, 22.0], None, 200), 1, [22.0, 26.0], 22.0);
    let curves = varied.curves(&branch, [[22.0, 26.0], [15.0, 30.0]], 22.0);
    let [flip] = &curves[..] else { panic!("{curves:?}") };
    let mut seconds = ends(flip).map(|it| it[1]);
    seconds.sort_by(f64::total_cmp);
    assert_eq!((seconds, flip.endings), ([15.0, 30.0], [CurveEnding::Left; 2]));
    for it in flip.points.iter().step_by(9) {
        let [value, second] = it.values;
        let guess = varied.settled_return([22.0, second], None, 200);
        let branch = varied.branch(&guess, 1, [22.0, 26.0], second);
        let [own] = &branch.bifurcations[..] else { panic!("{second}") };
        assert_eq!(own.kind, BifurcationKind::Flip);
        assert!((own.value - value).abs() <= own.error + it.error, "{value} {own:?}");
        assert!(it.error <= 1e-10 * value, "{}", it.error);
    }
}

/// A rigid stop is touched where the free motion is as large as the gap, whatever the frequency;
/// beyond the touch no orbit is found.
#[test]
fn a_rigid_stop_is_touched_along_the_response() {
    let text = system!("rigid-impact-oscillator");
    let varied = Varied::new(text, Section::strobe(0.0), ["A", "frequency"], &[]);
    let branch = varied.branch(&varied.settled_return([0.5, 2.75], None, 300), 1, [0.5, 0.9], 2.75);
    // The window begins at the system's own value: the curve goes one way alone.
    let curves = varied.curves(&branch, [[0.5, 0.9], [2.75, 3.5]], 2.75);
    let graze = curves.iter().find(|it| it.kind == BifurcationKind::Grazing).unwrap();
    assert_on(graze, 1e-10, |[_, frequency]| STOP / OneImpact::new(frequency, 1.0).response);
    let mut ends = ends(graze);
    ends.sort_by(|a, b| a[1].total_cmp(&b[1]));
    assert_eq!((ends[0][1], ends[1][0]), (2.75, 0.9));
    assert_eq!(graze.endings, [CurveEnding::Left; 2]);
    let places = graze.points.windows(2).map(|it| [it[0].values[1], it[1].values[1]]);
    assert!(places.into_iter().all(|[one, next]| one != next), "{:?}", graze.points);
}

/// A neuron whose spike becomes a touch, with no orbit beyond, and orbits on the way to it whose
/// multiplier grows without bound. Everything is in proportion to the threshold, so that the curve
/// is a straight line through the value that another program has for a threshold of 1.
#[test]
fn a_touch_that_orbits_do_not_reach_is_followed() {
    let text = "schema = 1\nname = \"neuron\"\nstates = [\"u\"]\n\
                forcing = { omega = 2.2, phi = 0 }\n[parameters]\nI = 1\nth = 1\n\
                [[mode]]\nname = \"rest\"\nequations = [\"u' = -u/2 + I + th*cos/2\"]\n\
                until = [{ name = \"spike\", guard = \"u > th\", reset = [\"u = 0\"] }]\n\
                [start]\nmode = \"rest\"\nu = 0.2\n";
    let neuron = Varied::new(text, Section::strobe(0.0), ["I", "th"], &[]);
    let branch = neuron.branch(&neuron.settled_return([1.0, 1.0], None, 300), 1, [1.0, 0.9], 1.0);
    for window in [[[0.96, 1.0], [0.5, 1.5]], [[0.9, 1.1], [0.98, 1.02]]] {
        let curves = neuron.curves(&branch, window, 1.0);
        let graze = curves.iter().find(|it| it.kind == BifurcationKind::Grazing).unwrap();
        assert_on(graze, 2e-9, |[_, threshold]| 0.975_507_101_985_535 * threshold);
        assert_eq!(graze.endings, [CurveEnding::Left; 2]);
        assert!(graze.points.len() > 20);
    }
}

/// On this curve of flips the orbit leaves the stop at the strobe where w is 0.79426: the curve
/// goes on, as that of a strobe far from it has it.
#[test]
fn a_curve_goes_on_past_an_event_at_the_strobe() {
    let names = ["A", "frequency"];
    let bilinear = |angle| Varied::new(BILINEAR, Section::strobe(angle), names, &[("k", 10.0)]);
    let (own, beside) = (bilinear(0.3), bilinear(1.3));
    let [ends, window] = [[0.185, 0.193], [0.792, 0.8]];
    let guess = own.settled_return([ends[0], 0.8], None, 300);
    let branch = own.branch(&guess, 1, ends, 0.8);
    let curves = own.curves(&branch, [ends, window], 0.8);
    let [curve] = &curves[..] else { panic!("{curves:?}") };
    assert_eq!(curve.kind, BifurcationKind::Flip);
    assert_eq!(curve.endings, [CurveEnding::Left; 2]);
    let seconds: Vec<f64> = curve.points.iter().map(|it| it.values[1]).collect();
    let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(least, window[0]);
    for point in curve.points.iter().filter(|it| it.values[1] < 0.7942).step_by(3) {
        let [force, frequency] = point.values;
        let guess = beside.settled_return([force - 1e-3, frequency], None, 300);
        let branch = beside.branch(&guess, 1, [force - 1e-3, force + 1e-3], frequency);
        let flips = branch.bifurcations.iter().filter(|it| it.kind == BifurcationKind::Flip);
        let [flip] = &flips.collect::<Vec<_>>()[..] else { panic!("no flip at {frequency}") };
        let apart = (flip.value - force).abs();
        assert!(apart <= flip.error + point.error, "{apart:e} at {frequency}");
    }
}

/// Beyond a fold the stability changes, and both points beside it may lie on one side of its value.
#[test]
fn a_fold_explains_the_change_of_stability_at_it() {
    let names = ["frequency", "A"];
    let bilinear = Varied::new(BILINEAR, Section::strobe(0.3), names, &[("k", 10.0)]);
    let guess = bilinear.settled_return([0.365, 1.0], None, 300);
    let branch = bilinear.branch(&guess, 1, [0.365, 0.376], 1.0);
    let folds: Vec<_> =
        branch.bifurcations.iter().filter(|it| it.kind == BifurcationKind::Fold).collect();
    assert!(!folds.is_empty());
    for fold in folds {
        let sides = [fold.points_before - 1, fold.points_before].map(|n| &branch.points[n]);
        assert_ne!(sides[0].1.is_stable(), sides[1].1.is_stable());
        assert!(sides.iter().all(|(value, _)| (value - fold.value).abs() < 1e-2));
    }
    assert_eq!(branch.unnamed_changes(), [0; 0]);
}
