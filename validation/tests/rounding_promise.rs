//! The promise of ten roundings per event, on runs that the test draws itself: each event of the
//! solver beside the same run in 106 bits.
//!
//! `cargo test --test harness rounding_promise:: -- --nocapture` prints what is reached.

use percuss::{Entry, Exit, GrowthRecorder, Instant, Start, TwoWord};
use percuss_validation::case::{Given, Problem};
use percuss_validation::engine::place;
use percuss_validation::truth::{Truth, TruthRow};

/// Runs that are drawn.
const RUNS: usize = 2000;
/// Runs that begin far away.
const FAR_STARTS: u32 = 4000;
/// Forcing periods of a run.
const PERIODS: u64 = 40;
/// The promise, in roundings per event beside the largest state so far. These draws reach 2.3, and
/// others 7.0, by slow forcing, whose flights are 1e4 high. METHODOLOGY.md states both.
const PROMISED_ROUNDINGS: f64 = 10.0;
/// Where errors have grown to this share of the state so far, they no longer grow as the linear
/// theory of the growth says.
const MAX_LINEAR_SHARE: f64 = 1e-6;

/// SplitMix64: the same runs every time.
struct Draw(u64);

impl Draw {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 0.5_f64.powi(53)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn decades(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Parameters and a start of any regime; half of the starts have a displacement or a velocity
    /// of up to 1000, and slow forcing takes the mass as far.
    fn problem(&mut self) -> Given {
        let mut given = Given::default();
        let it = &mut given.parameters;
        it.a = self.between(0.0, 2.0);
        it.b = self.between(0.02, 0.95);
        it.xi = self.decades(1e-3, 10.0);
        it.omega = self.decades(0.005, 10.0);
        it.g = self.between(0.0, 0.3);
        it.phi = self.between(0.0, std::f64::consts::TAU);
        let [mut p, mut y] = [self.between(-2.0, 0.5), self.between(-1.0, 1.0)];
        let mut q = self.between(0.0, 0.5).max(p);
        let far = self.decades(1.0, 1e3);
        match (self.share() * 8.0) as u32 {
            0 => p = -far,
            1 => y = far,
            2 => y = -far,
            3 => q = far,
            _ => {}
        }
        given.start = Start { p, y, q: Some(q), ..Start::default() };
        given
    }
}

/// The largest errors of a run's events, in roundings per event times the growth of errors.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    /// Beside 1 + the largest of the states, and of an event's time that too, so far.
    beside_largest: f64,
    /// Beside 1 + |value| of the row.
    beside_value: f64,
    events: usize,
}

impl Errors {
    fn take(&mut self, error: f64, [largest, value]: [f64; 2]) {
        let units = |beside: f64| error / (f64::EPSILON * (1.0 + beside));
        // Not a maximum, which would drop a NaN.
        for (worst, units) in
            [(&mut self.beside_largest, units(largest)), (&mut self.beside_value, units(value))]
        {
            if units > *worst || units.is_nan() {
                *worst = units;
            }
        }
    }
}

fn values(row: &TruthRow) -> [TwoWord; 5] {
    let [p, y, q, v] = row.state[..] else { panic!("four states") };
    [row.elapsed, p, y, q, v]
}

fn found(entry: &Entry, start: &Instant, omega: f64) -> [f64; 5] {
    let [p, y, q] = entry.point();
    [entry.instant.since(start, omega).value(), p, y, q, entry.v()]
}

/// The errors of one run's events up to where they are large; none where 106 bits do not decide
/// the run, or the solver says that rounding hides a touch.
fn errors(given: &Given) -> Option<Errors> {
    let Problem { model, entry, .. } = given.check().ok()?;
    let horizon = entry.instant.after_periods(PERIODS, 1);
    let truth = Truth::replayed(&given.parameters, &entry, horizon, (0, 1)).ok()?;
    let mut run = model.trajectory(entry).until(horizon);
    let (mut errors, mut growth) = (Errors::default(), GrowthRecorder::new());
    let mut largest = values(&truth.start).map(|it| it.value().abs())[1..].to_vec();
    for row in &truth.events {
        let segment = run.next()?;
        if run.counters().undecidable > 0 {
            return None;
        }
        let Exit::Switch(next) = segment.exit() else { panic!("{given:?}: an event is missed") };
        let grown = growth.pass(&segment).expect("an event");
        let [p, y, q] = grown.state;
        let grown = [grown.tau, p, y, q, grown.v];
        errors.events += 1;
        let exact = values(row).map(TwoWord::value);
        for (state, value) in largest.iter_mut().zip(&exact[1..]) {
            *state = state.max(value.abs());
        }
        let far = largest.iter().copied().fold(0.0, f64::max);
        let count = errors.events as f64;
        if grown.iter().any(|it| it * f64::EPSILON * (1.0 + far) * count > MAX_LINEAR_SHARE) {
            break;
        }
        assert_eq!(place(next.phase()), row.mode, "{given:?}");
        let found = found(next, &entry.instant, given.parameters.omega);
        for (i, (found, proved)) in found.iter().zip(values(row)).enumerate() {
            let error = TwoWord::new(*found).minus(proved).value().abs() / (grown[i] * count);
            errors.take(error, [far.max(exact[i].abs()), exact[i].abs()]);
        }
    }
    Some(errors)
}

#[test]
fn drawn_runs_keep_the_promise_beside_the_largest_state_so_far() {
    let mut draw = Draw(41);
    let mut all: Vec<Errors> = Vec::new();
    let mut undecided = 0;
    while all.len() < RUNS {
        match errors(&draw.problem()) {
            Some(errors) => all.push(errors),
            None => undecided += 1,
        }
    }
    let largest = all.iter().map(|it| it.beside_largest).fold(0.0, f64::max);
    let events: usize = all.iter().map(|it| it.events).sum();
    println!(
        "{events} events of {RUNS} runs ({undecided} left out): {largest:.2} roundings beside the \
         largest state"
    );
    assert!(events > 20 * RUNS && undecided < RUNS / 20, "{events} {undecided}");
    assert!(all.iter().all(|it| it.beside_largest <= PROMISED_ROUNDINGS), "{largest}");
}

/// Beside |value| alone it would be no promise: of these fixed starts far away many have an event
/// at small values that has more roundings than that, those of the state from which it was reached.
/// Slow forcing alone does not show it: of 3000 runs with omega from 0.005 to 0.1 none passed 5.
#[test]
fn beside_small_values_after_far_starts_there_is_no_promise() {
    let far = |n: u32| {
        let mut given = Given::default();
        let it = &mut given.parameters;
        (it.a, it.b, it.xi, it.omega, it.g, it.phi) = (0.93, 0.535, 0.17, 0.286, 0.064, 5.9);
        let y = 40.0 + 0.25 * f64::from(n);
        given.start = Start { p: -1.9, y, q: Some(0.175), ..Start::default() };
        given
    };
    let all: Vec<_> = (0..FAR_STARTS).filter_map(|n| errors(&far(n))).collect();
    let exceed = all.iter().filter(|it| it.beside_value > PROMISED_ROUNDINGS).count();
    println!(
        "{exceed} of {} runs from far away have above {PROMISED_ROUNDINGS} beside the value",
        all.len()
    );
    assert!(all.len() > FAR_STARTS as usize * 9 / 10, "{}", all.len());
    assert!(all.iter().all(|it| it.beside_largest <= PROMISED_ROUNDINGS));
    assert!(exceed >= 20, "{exceed}");
}
