//! Accepted inputs of every size at random: no panic, no hang, legal phases, finite numbers.

use percuss::{Exit, Model, Parameters, Phase, Segment, Start};
use std::sync::mpsc;
use std::time::Duration;

/// The longest time that any phase of any accepted input may take to solve.
const MAX_SEGMENT_TIME: Duration = Duration::from_secs(1);
const CASES: u64 = 20_000;
const SEGMENTS: usize = 300;

/// a, b, xi, omega, g, phi; p, y, q: what earlier attacks have found, tried first.
const KNOWN_CASES: [[f64; 9]; 7] = [
    // Rest at f = 0 with every derivative zero: steps of 1e-7 for ever.
    [0.0, 0.0, 0.0016, 2781.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 6.4e-5, 0.0, 0.0, 0.0, 0.0, 0.0],
    // 2 xi F + y cancels: no contact to no contact in 1e-161, for ever.
    [0.03, -1e9, 0.5, 0.5, 0.775, 5.16, -1e9 + 0.775, 1e9, -1e9],
    // Fast forcing under a slow relaxation: a step a forcing period.
    [0.02, 1.2, 2.94, 495_615.8, 1e9, 0.0, 1e9, 0.18476, 1e9],
    [0.68, -0.44, 16.4, 486_138.1, 0.0, 1.57, 2813.27, 0.84, 2813.27],
    // Next to the other threshold: 1.8e5 steps that begin at 5e-20.
    [0.0, 1e9, 1e-8, 0.0038, 0.0, 0.0, 0.0, -0.967_983_422_3, 1.935_967_844_6e-8],
    // A million divisions, a forcing period each.
    [1.222, 0.250_29, 1.0, 855_764.8, 1.2036, 2.198, 1.2036, -1.0, 0.0],
];

/// splitmix64
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn log(&mut self, low: f64, high: f64) -> f64 {
        (low.ln() + (high / low).ln() * self.unit()).exp().clamp(low, high)
    }

    fn pick(&mut self, values: &[f64]) -> f64 {
        values[self.below(values.len() as u64) as usize]
    }

    fn signed(&mut self, size: f64) -> f64 {
        if self.below(2) == 0 { size } else { -size }
    }

    fn size(&mut self, wild: bool) -> f64 {
        let tame = self.log(1e-12, 10.0);
        let huge = [self.log(1e-300, 1e9), self.log(1e-20, 1e9), 1e9];
        match self.below(8) {
            0 => 0.0,
            1 => self.pick(&[1.0, -1.0, 0.5, 0.02, -0.02, 2.0]),
            2..=4 => self.between(-1.5, 1.5),
            k if wild => self.signed(huge[k as usize - 5]),
            _ => self.signed(tame),
        }
    }

    fn parameters(&mut self, wild: bool) -> Parameters {
        let xi = match self.below(6) {
            0 if wild => self.log(1e-8, 1e4),
            0 | 1 => self.log(1e-4, 1e2),
            2 => self.pick(&[1.0, 1.0 + 1e-15, 1.0 - 1e-9, 0.5, 0.01, 0.1, 1.2, 0.7]),
            3 if wild => self.pick(&[1e-8, 1e4, 1e-7, 1e3]),
            _ => self.log(1e-3, 3.0),
        };
        let omega = match self.below(6) {
            0 if wild => self.log(1e-6, 1e6),
            0 | 1 => self.log(1e-2, 50.0),
            2 => self.pick(&[1.0, 1.0 + 1e-7, 1.0 - 1e-12, 2.0, 0.5, 1.4, 0.1]),
            3 if wild => self.pick(&[1e-6, 1e6, 1e3, 1e-3]),
            _ => self.log(0.1, 5.0),
        };
        let phi = match self.below(4) {
            0 => 0.0,
            1 => self.between(-1e15, 1e15),
            _ => self.between(0.0, 7.0),
        };
        let [a, b, g] = [self.size(wild).abs(), self.size(wild), self.size(wild).abs()];
        Parameters { a, b, xi, omega, g, phi }
    }

    fn case(seed: u64) -> (Parameters, Start) {
        if let Some([a, b, xi, omega, g, phi, p, y, q]) = KNOWN_CASES.get(seed as usize).copied() {
            let start = Start { p, y, q: Some(q), ..Start::default() };
            return (Parameters { a, b, xi, omega, g, phi }, start);
        }
        let mut chance = Self(seed.wrapping_mul(0x1234_5678_9abc_def1));
        let wild = chance.below(2) == 0;
        let parameters = chance.parameters(wild);
        let two_xi = 2.0 * parameters.xi;
        let mut y = chance.size(wild);
        let mut q = match chance.below(3) {
            0 => chance.size(wild),
            1 => chance.unit(),
            _ => -two_xi * y,
        };
        let f = chance.pick(&[0.0, 1.0, 0.5, 1.0 + 1e-13, 1e-13, 2.0, -0.5, -1e-14]);
        let on_the_surface = chance.below(2) == 0;
        match chance.below(3) {
            0 if on_the_surface => q = f - two_xi * y,
            1 if on_the_surface => y = (f - q) / two_xi,
            _ => {}
        }
        (q, y) = (q.clamp(-1e9, 1e9), y.clamp(-1e9, 1e9));
        let depth = if on_the_surface { 0.0 } else { chance.size(wild).abs() };
        let p = (q + parameters.g - depth).clamp(-1e9, 1e9);
        let tau = if chance.below(3) == 0 { chance.between(-1e15, 1e15) } else { 0.0 };
        let cycle = if chance.below(3) == 0 { (chance.next() >> 11) as i64 } else { 0 };
        (parameters, Start { tau, cycle, p, y, q: Some(q), v: chance.size(wild), phase: None })
    }
}

fn is_legal(from: Phase, to: Phase) -> bool {
    match from {
        Phase::NoContact | Phase::Contact => to != from,
        Phase::Progression => to == Phase::Contact,
    }
}

fn complaint(segment: &Segment, last_v: f64) -> Option<String> {
    let d = segment.duration();
    if d.is_nan() || d < 0.0 {
        return Some(format!("duration {d}"));
    }
    let until = if d.is_finite() { d } else { 1.0 };
    for k in 0..=8 {
        let sample = segment.at(until * f64::from(k) / 8.0);
        let numbers = [sample.state.p, sample.state.y, sample.state.q, sample.v];
        if numbers.iter().any(|number| !number.is_finite()) {
            return Some(format!("{sample:?}"));
        }
    }
    let Exit::Switch(next) = segment.exit() else { return None };
    if !is_legal(segment.phase(), next.phase()) {
        return Some(format!("{} to {}", segment.phase(), next.phase()));
    }
    if d == 0.0 {
        return Some("no time passes".to_owned());
    }
    (next.v() < last_v).then(|| format!("drift falls from {last_v} to {}", next.v()))
}

/// Runs a case; the messages between segments tell the watch that it is alive.
fn attack(seed: u64, progress: &mpsc::Sender<u64>) -> Option<String> {
    let (parameters, start) = Chance::case(seed);
    let model = Model::new(parameters).ok()?;
    let entry = model.start(&start).ok()?;
    // Some natural units, or at most a few forcing periods.
    let most = if seed < KNOWN_CASES.len() as u64 || seed % 2 == 1 { 1e9 } else { 20.0 };
    let periods = (60.0 / model.period()).clamp(1e-3, most);
    let horizon = entry.instant.after_periods((periods * 1e3) as u64, 1000);
    let mut last_v = entry.v();
    for (n, segment) in model.trajectory(entry).until(horizon).take(SEGMENTS).enumerate() {
        let _ = progress.send(seed);
        if let Some(complaint) = complaint(&segment, last_v) {
            return Some(format!("segment {n}, {}: {complaint}", segment.phase()));
        }
        last_v = segment.entry().v();
    }
    None
}

#[test]
fn no_accepted_input_breaks_the_solver() {
    let mut complaints = Vec::new();
    let mut next = 0;
    while next < CASES && complaints.len() < 10 {
        let (progress, reports) = mpsc::channel();
        let (report, found) = mpsc::channel();
        let from = next;
        std::thread::spawn(move || {
            for seed in from..CASES {
                let _ = progress.send(seed);
                if let Some(complaint) = attack(seed, &progress) {
                    let _ = report.send((seed, complaint));
                }
            }
        });
        let mut last = from;
        let trouble = loop {
            match reports.recv_timeout(MAX_SEGMENT_TIME) {
                Ok(seed) => last = seed,
                Err(mpsc::RecvTimeoutError::Timeout) => break Some("hangs"),
                Err(mpsc::RecvTimeoutError::Disconnected) if last + 1 < CASES => {
                    break Some("panics");
                }
                Err(mpsc::RecvTimeoutError::Disconnected) => break None,
            }
        };
        complaints.extend(found.try_iter());
        if let Some(trouble) = trouble {
            complaints.push((last, trouble.to_owned()));
        }
        next = last + 1;
    }
    for (seed, complaint) in &complaints {
        println!("{seed}: {complaint}: {:?}", Chance::case(*seed));
    }
    assert!(complaints.is_empty(), "{} complaints", complaints.len());
}

#[test]
fn everything_zero_rests() {
    let nothing = Parameters { a: 0.0, b: 0.0, g: 0.0, ..Parameters::default() };
    let model = Model::new(nothing).unwrap();
    let entry = model.start(&Start::default()).unwrap();
    let mut trajectory = model.trajectory(entry).until(entry.instant.after_periods(1000, 1));
    let segment = trajectory.next().unwrap();
    assert!(!matches!(segment.exit(), Exit::Switch(_)), "{segment:?}");
    assert!(trajectory.counters().evaluations < 100, "{:?}", trajectory.counters());
}
