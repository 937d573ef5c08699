//! The runs whose events are examined: the paper's cases, the corners around them, and near grazes.

use percuss::{Exit, Model, Parameters, Start};

/// A small generator, so that a run is the same everywhere (splitmix64).
pub struct Chance(u64);

impl Chance {
    /// A generator that begins with the given seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn log(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { 1.0 } else { -1.0 }
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.unit() * all.len() as f64) as usize % all.len()]
    }
}

/// The parameters and the start of a run.
pub type Run = (Parameters, Start);

/// A family of runs.
#[derive(Clone, Copy)]
pub struct Regime {
    /// The name of the regime.
    pub name: &'static str,
    /// The regime's share of the events.
    pub share: f64,
    /// Phases followed in one run.
    pub phases: usize,
    /// Runs to follow, one after the other.
    pub draw: fn(&mut Chance) -> Vec<Run>,
}

/// All regimes.
pub const REGIMES: [Regime; 17] = [
    regime("chaos, xi = 0.01", 0.15, 2000, |it| it.run(Parameters::default())),
    regime("omega and xi of Fig. 7", 0.10, 2000, |it| {
        let omega = it.one_of(&[1.4, 1.45, 1.56, 1.58, 1.6, 1.7]);
        it.run(Parameters { omega, xi: 0.1, ..Parameters::default() })
    }),
    regime("period two of Table 1", 0.06, 2000, |it| {
        it.run(Parameters { omega: 0.1, ..Parameters::default() })
    }),
    regime("no gap, late start", 0.04, 500, |it| {
        let cycle = (it.log(1.0, 1e12)) as i64;
        it.late_run(Parameters { g: 0.0, xi: 0.05, omega: 1.3, ..Parameters::default() }, cycle)
    }),
    regime("stiff, xi 1e-4 to 0.3", 0.08, 500, |it| {
        let (xi, omega) = (it.log(1e-4, 0.3), it.between(0.2, 2.0));
        it.run(Parameters { xi, omega, ..Parameters::default() })
    }),
    regime("over-damped, xi 1.2 to 100", 0.07, 500, |it| {
        let (xi, omega) = (it.log(1.2, 100.0), it.between(0.3, 3.0));
        it.run(Parameters { a: 0.6, xi, omega, ..Parameters::default() })
    }),
    regime("critical, xi = 1", 0.05, 500, |it| {
        let omega = it.between(0.3, 3.0);
        it.run(Parameters { xi: 1.0, omega, ..Parameters::default() })
    }),
    regime("near critical, 1e-15 to 0.1", 0.05, 500, |it| {
        let xi = 1.0 + it.sign() * it.log(1e-15, 0.1);
        let omega = it.between(0.3, 3.0);
        it.run(Parameters { xi, omega, ..Parameters::default() })
    }),
    regime("resonance in contact", 0.06, 500, |it| {
        let (xi, off) = (it.log(1e-4, 0.1), it.log(1e-9, 0.1));
        let (omega, a) = (1.0 + it.sign() * off, it.log(0.01, 0.5));
        it.run(Parameters { a, xi, omega, ..Parameters::default() })
    }),
    regime("fast forcing, omega 5 to 50", 0.06, 500, |it| {
        let (omega, strength) = (it.log(5.0, 50.0), it.between(0.2, 0.8));
        let (a, xi) = (strength * omega * omega, it.log(0.01, 1.0));
        it.run(Parameters { a, b: 0.3, xi, omega, ..Parameters::default() })
    }),
    regime("slow forcing, omega 0.003 to 0.1", 0.05, 500, |it| {
        let (omega, xi) = (it.log(0.003, 0.1), it.log(1e-3, 1.0));
        it.run(Parameters { omega, xi, ..Parameters::default() })
    }),
    regime("small b, 1e-12 to 0.01", 0.04, 300, |it| {
        let (b, xi) = (it.log(1e-12, 0.01), it.log(0.005, 0.5));
        it.run(Parameters { b, xi, ..Parameters::default() })
    }),
    regime("random parameters", 0.06, 30, |it| {
        let parameters = it.parameters();
        it.run(parameters)
    }),
    regime("impacts into progression", 0.05, 4, Chance::hard_impact),
    regime("near grazes without contact", 0.03, 3, |it| it.grazes(Kind::NoContact)),
    regime("near grazes in contact", 0.03, 3, |it| it.grazes(Kind::Contact)),
    regime("near grazes in progression", 0.02, 3, |it| it.grazes(Kind::Progression)),
];

const fn regime(
    name: &'static str,
    share: f64,
    phases: usize,
    draw: fn(&mut Chance) -> Vec<Run>,
) -> Regime {
    Regime { name, share, phases, draw }
}

/// In which phase a run begins.
#[derive(Clone, Copy)]
enum Kind {
    NoContact,
    Contact,
    Progression,
}

impl Chance {
    fn parameters(&mut self) -> Parameters {
        let (a, b) = (self.log(0.03, 10.0), self.between(-0.05, 0.9));
        let (xi, omega) = (self.log(1e-4, 1e2), self.log(0.01, 50.0));
        Parameters { a, b, xi, omega, g: self.between(0.0, 0.3), phi: self.between(0.0, 6.0) }
    }

    fn run(&mut self, parameters: Parameters) -> Vec<Run> {
        self.late_run(parameters, 0)
    }

    fn late_run(&mut self, parameters: Parameters, cycle: i64) -> Vec<Run> {
        let kind = self.one_of(&[Kind::NoContact, Kind::Contact, Kind::Progression]);
        let start = Start { cycle, ..self.start(&parameters, kind) };
        vec![(parameters, start)]
    }

    fn start(&mut self, parameters: &Parameters, kind: Kind) -> Start {
        let Parameters { g, xi, .. } = *parameters;
        let q = self.unit();
        let tau = self.between(0.0, 20.0);
        let (p, y) = match kind {
            Kind::NoContact => (q + g - self.log(1e-6, 1.0), self.between(-1.0, 1.0)),
            Kind::Contact => (q + g, (self.unit() - q) / (2.0 * xi)),
            Kind::Progression => (q + g, (1.0 - q) / (2.0 * xi) + self.log(1e-3, 1.0)),
        };
        Start { p, y, q: Some(q), tau, ..Start::default() }
    }

    /// A flight that ends with the slider nearly compressed, so that its impact may make it slip at
    /// once.
    fn hard_impact(&mut self) -> Vec<Run> {
        let parameters = Parameters { xi: self.log(1e-4, 1.0), ..self.parameters() };
        let q = 1.0 - self.log(1e-6, 0.5);
        let p = q + parameters.g - self.log(1e-6, 0.1);
        let (y, tau) = (self.log(0.01, 2.0), self.between(0.0, 20.0));
        vec![(parameters, Start { p, y, q: Some(q), tau, ..Start::default() })]
    }

    /// Runs that begin within 1e-17 to 1e-2 of where the end of their first phase jumps.
    fn grazes(&mut self, kind: Kind) -> Vec<Run> {
        const RUNS: usize = 24;
        let parameters = self.parameters();
        let start = self.start(&parameters, kind);
        let Some(edge) = self.edge(parameters, &start) else { return Vec::new() };
        let near = (0..RUNS).map(|_| {
            let off = self.sign() * self.log(1e-17, 1e-2);
            (parameters, Start { y: edge + off, ..start })
        });
        near.collect()
    }

    /// A velocity at which the first phase's length jumps over some value between two that occur.
    fn edge(&mut self, parameters: Parameters, start: &Start) -> Option<f64> {
        const MIN_LENGTH_RATIO: f64 = 1.3;
        const HALVINGS: usize = 60;
        let other = start.y + self.sign() * self.log(0.01, 1.0);
        let length = |y: f64| first_length(parameters, &Start { y, ..*start });
        let (mut one, mut two) = (start.y, other);
        let (first, second) = (length(one)?, length(two)?);
        if !(first > MIN_LENGTH_RATIO * second || second > MIN_LENGTH_RATIO * first) {
            return None;
        }
        let between = (first.min(1e6) * second.min(1e6)).sqrt();
        for _ in 0..HALVINGS {
            let middle = 0.5 * (one + two);
            if (length(middle)? > between) == (first > between) {
                one = middle
            } else {
                two = middle
            }
        }
        Some(one)
    }
}

/// The duration of the first phase.
fn first_length(parameters: Parameters, start: &Start) -> Option<f64> {
    let model = Model::new(parameters).ok()?;
    let entry = model.start(start).ok()?;
    let segment = model.trajectory(entry).until(entry.instant.after_periods(1000, 1)).next()?;
    Some(if matches!(segment.exit(), Exit::Switch(_)) { segment.duration() } else { 1e6 })
}
