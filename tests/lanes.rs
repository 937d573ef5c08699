//! Motions in lanes against the scalar solver: every phase and every strobe.
//!
//! A phase is begun by both from the same entry, so that errors do not add up: their results differ
//! by what both round in one phase, in units of eps (1 + |value|) x growth.

use crate::support::one_sided::{Effort, OneSidedEnd, one_sided_end};
use percuss::dynamics::ensemble::{Member, Tally, Watcher, follow_by};
use percuss::lanes::Instructions;
use percuss::{Endless, Entry, Exit, Growth, GrowthRecorder, Instant, Model, Parameters, Start};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::ops::ControlFlow;

/// Ten roundings each, as the restart test promises of a whole passage.
const MAX_ROUNDINGS: f64 = 20.0;

/// What a motion went through.
#[derive(Clone, Debug, Default, PartialEq)]
struct Diary {
    phases: Vec<Entry>,
    /// Strobes, and the number of phases begun before each.
    strobes: Vec<(usize, Entry)>,
    wanted: usize,
}

impl Watcher for Diary {
    fn see(&mut self, strobe: &Entry, _: Option<Endless>) -> ControlFlow<()> {
        self.strobes.push((self.phases.len(), *strobe));
        if self.strobes.len() >= self.wanted {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    fn enter(&mut self, phase: &Entry) {
        self.phases.push(*phase);
    }
}

fn diaries(by: Instructions, motions: &[(Model, Entry)], wanted: usize) -> (Vec<Diary>, Tally) {
    follow_by(by, motions.len(), |number| {
        let (model, entry) = &motions[number];
        let first = entry.instant.first_at_angle(1.0);
        let horizon = first.after_periods(wanted as u64, 1);
        let watcher = Diary { phases: vec![*entry], wanted, ..Diary::default() };
        Member { model, entry: *entry, first, horizon: Some(horizon), watcher }
    })
}

/// The largest error of a state in eps (1 + |value|) x growth.
fn units(found: &Entry, expected: &Entry, growth: &Growth) -> f64 {
    let [p, y, q] = found.point();
    let [p0, y0, q0] = expected.point();
    let drift = found.drift.minus(expected.drift).value();
    let [gp, gy, gq] = growth.state;
    [(p - p0, p0, gp), (y - y0, y0, gy), (q - q0, q0, gq), (drift, expected.v(), growth.v)]
        .into_iter()
        .map(|(off, value, growth)| off.abs() / (f64::EPSILON * (1.0 + value.abs()) * growth))
        .fold(0.0, f64::max)
}

/// Compares a diary with the scalar solver's phases from the same entries; the largest error.
fn largest_error(model: &Model, diary: &Diary) -> Result<f64, TestCaseError> {
    let omega = model.parameters().omega;
    let mut largest = 0.0_f64;
    for (k, entry) in diary.phases.iter().enumerate() {
        let until = entry.instant.after_periods(1 << 20, 1);
        let segment = model.trajectory(*entry).until(until).next().expect("a run has a phase");
        let mut recorder = GrowthRecorder::new();
        for (_, strobe) in diary.strobes.iter().filter(|(begun, _)| *begun == k + 1) {
            prop_assert!(!segment.ends_by(&strobe.instant), "{k}: {entry:?} {strobe:?}");
            let expected = segment.entry_at(&strobe.instant);
            prop_assert_eq!(strobe.phase(), expected.phase());
            let growth = recorder.at(&segment, segment.elapsed_at(&strobe.instant));
            largest = largest.max(units(strobe, &expected, &growth));
        }
        let Some(next) = diary.phases.get(k + 1) else { break };
        let Exit::Switch(expected) = segment.exit() else {
            return Err(TestCaseError::fail(format!("{k}: no switch after {entry:?}")));
        };
        let message = format!("{k}: {entry:?}\n{next:?}\n{expected:?} {:?}", model.parameters());
        prop_assert!(next.phase() == expected.phase(), "{}", message);
        let growth = recorder.pass(&segment).expect("it ends by a switch");
        let late = next.instant.since(&expected.instant, omega).value().abs();
        let time = late / (f64::EPSILON * (1.0 + segment.duration()) * growth.tau);
        let off = time.max(units(next, expected, &growth));
        prop_assert!(off <= MAX_ROUNDINGS, "{off} {}", message);
        largest = largest.max(off);
    }
    Ok(largest)
}

/// The same 256 cases every time, so that a failure is seen again wherever the test is run; set
/// `PROPTEST_CASES` for more of them.
fn config() -> Config {
    Config { failure_persistence: None, rng_seed: RngSeed::Fixed(2004), ..Config::default() }
}

fn sets() -> impl Iterator<Item = Instructions> {
    Instructions::available().into_iter().filter(|it| *it != Instructions::ONE)
}

fn parameters() -> impl Strategy<Value = Parameters> {
    let logarithmic = |low: f64, high: f64| (low.ln()..high.ln()).prop_map(f64::exp);
    (
        logarithmic(0.05, 20.0),
        logarithmic(1e-3, 50.0),
        0.02..1.0_f64,
        0.0..0.5_f64,
        0.0..0.1_f64,
        -7.0..7.0_f64,
    )
        .prop_map(|(omega, xi, a, b, g, phi)| Parameters { a, b, xi, omega, g, phi })
}

/// Where the forced oscillation is a divided difference, down to no more than a hundred-thousandth
/// of damping.
fn near_resonance() -> impl Strategy<Value = Parameters> {
    (parameters(), 0.75..1.2_f64, (1e-5_f64.ln()..0.2_f64.ln()).prop_map(f64::exp))
        .prop_map(|(others, omega, xi)| Parameters { omega, xi, ..others })
}

fn starts() -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec((-1.0..0.5_f64, -1.0..1.0_f64), 11)
}

fn motions(parameters: Parameters, starts: &[(f64, f64)]) -> Vec<(Model, Entry)> {
    let model = Model::new(parameters).expect("in range");
    let start = |(p, y): &(f64, f64)| Start { tau: 0.1, p: *p, y: *y, ..Start::default() };
    starts.iter().map(|it| (model, model.start(&start(it)).expect("a start"))).collect()
}

proptest! {
    #![proptest_config(config())]
    #[test]
    fn phases_and_strobes_are_those_of_the_scalar_solver(
        parameters in parameters(), starts in starts(),
    ) {
        let motions = motions(parameters, &starts);
        for set in sets() {
            for ((model, _), diary) in motions.iter().zip(diaries(set, &motions, 6).0) {
                prop_assert_eq!(diary.strobes.len(), 6);
                largest_error(model, &diary)?;
            }
        }
    }

    #[test]
    fn resonant_contacts_are_those_of_the_scalar_solver(
        parameters in near_resonance(), starts in starts(),
    ) {
        let motions = motions(parameters, &starts);
        for set in sets() {
            for ((model, _), diary) in motions.iter().zip(diaries(set, &motions, 6).0) {
                prop_assert_eq!(diary.strobes.len(), 6);
                largest_error(model, &diary)?;
            }
        }
    }

    /// Motions of different models share vectors, and all widths give the same bits.
    #[test]
    fn neighbours_and_widths_change_nothing(
        models in prop::collection::vec(parameters(), 7), starts in starts(),
    ) {
        let mixed: Vec<_> = models.into_iter().flat_map(|it| motions(it, &starts[..3])).collect();
        let mut before: Option<Vec<Diary>> = None;
        for set in sets() {
            let (together, _) = diaries(set, &mixed, 5);
            for (motion, diary) in mixed.iter().zip(&together) {
                let alone = diaries(set, std::slice::from_ref(motion), 5).0;
                prop_assert_eq!(&alone[0], diary);
            }
            if let Some(before) = &before {
                prop_assert_eq!(before, &together);
            }
            before = Some(together);
        }
    }
}

/// The paper's attractors: from the strobes of the motion from rest on.
fn on_attractor(omega: f64, xi: f64, count: u64) -> Vec<(Model, Entry)> {
    let model = Model::new(Parameters { omega, xi, ..Parameters::default() }).expect("in range");
    let rest = model.start(&Start::default()).expect("rest is a start");
    let strobes = percuss::dynamics::section::section(&model, rest, 0.0, 100, count);
    strobes.map(|strobe| (model, strobe)).collect()
}

const ATTRACTORS: [(f64, f64); 16] = [
    (1.4, 0.01),
    (0.1, 0.01),
    (1.6, 0.1),
    (1.58, 0.1),
    (1.4, 0.3),
    (1.2, 0.01),
    (1.2, 0.1),
    (0.9, 0.1),
    (1.4, 0.8),
    (1.4, 1.0),
    (0.9, 1.0),
    (1.4, 1.2),
    (1.4, 1.5),
    (0.7, 1.5),
    (1.4, 5.0),
    (0.4, 20.0),
];

/// What is left to the scalar solver on attractors: the starts away from the slider, and a share of
/// the phases.
#[test]
fn lanes_take_nearly_all_of_an_attractor() {
    for (omega, xi) in ATTRACTORS {
        let motions = on_attractor(omega, xi, 64);
        let apart =
            motions.iter().filter(|(_, it)| it.phase() == percuss::Phase::NoContact).count();
        for set in sets() {
            let (diaries, tally) = diaries(set, &motions, 200);
            let mut largest = 0.0_f64;
            for ((model, _), diary) in motions.iter().zip(&diaries) {
                largest = largest.max(largest_error(model, diary).unwrap());
            }
            let alone = tally.alone as f64 - apart as f64;
            let share = alone / (tally.alone + tally.in_lanes) as f64;
            println!("{omega} {xi} {}: alone {share:.4}, error {largest:.2}", set.as_str());
            assert!(share < 0.05, "{omega} {xi}: {tally:?}");
        }
    }
}

/// Where a motion's first so many phases change with a number of its start: a graze, a tie or a
/// touch lies between.
fn beside_changes(
    parameters: Parameters,
    number: f64,
    periods: u64,
    start: impl Fn(f64) -> Start,
) -> Option<[(Model, Entry); 2]> {
    let model = Model::new(parameters).expect("in range");
    let entry = |number: f64| model.start(&start(number)).expect("a start");
    let sequence = |number: f64| -> Vec<_> {
        let start = entry(number);
        let segments = model.trajectory(start).until(start.instant.after_periods(periods, 1));
        segments.map(|segment| segment.phase()).take(6).collect()
    };
    let (mut low, mut high) = (number, number + 0.2);
    let first = sequence(low);
    if first == sequence(high) {
        return None;
    }
    // To a share of 1e-11: nearer than 1e-5 to a graze, and decided.
    for _ in 0..34 {
        let middle = 0.5 * (low + high);
        if sequence(middle) == first { low = middle } else { high = middle }
    }
    Some([(model, entry(low)), (model, entry(high))])
}

proptest! {
    #![proptest_config(config())]
    #[test]
    fn near_grazes_are_decided_as_the_scalar_solver_does(
        (omega, decade) in (0.5..3.0_f64, -2.0..1.0_f64), y in -0.5..0.5_f64,
    ) {
        let xi = 10.0_f64.powf(decade);
        let parameters = Parameters { omega, xi, ..Parameters::default() };
        let start = |y| Start { p: -0.3, y, q: Some(0.0), ..Start::default() };
        let Some(motions) = beside_changes(parameters, y, 8, start) else { return Ok(()) };
        for set in sets() {
            for ((model, _), diary) in motions.iter().zip(diaries(set, &motions, 8).0) {
                largest_error(model, &diary)?;
            }
        }
    }
}

proptest! {
    #![proptest_config(config())]
    /// Contacts in which the quick exponential takes the force to a threshold and the slow one
    /// takes it back.
    #[test]
    fn dips_of_over_damped_contacts_are_decided_as_the_scalar_solver_does(
        (omega, decade) in (0.3..3.0_f64, 0.1..1.3_f64),
        (f, y, tau) in (0.02..0.9_f64, -1.0..0.0_f64, 0.0..2.0_f64),
    ) {
        let xi = 10.0_f64.powf(decade);
        let parameters = Parameters { omega, xi, ..Parameters::default() };
        let p = parameters.g + (f - 2.0 * xi * y);
        let start = |tau: f64| Start { tau: 5.0 * tau, p, y, ..Start::default() };
        let Some(motions) = beside_changes(parameters, tau, 8, start) else { return Ok(()) };
        for set in sets() {
            for ((model, _), diary) in motions.iter().zip(diaries(set, &motions, 8).0) {
                largest_error(model, &diary)?;
            }
        }
    }
}

proptest! {
    #![proptest_config(config())]
    /// Slow flights that last for several periods: the force pushes and pulls by turns, and the
    /// graze may come in any of the stretches in which it pulls.
    #[test]
    fn grazes_in_later_stretches_are_decided_as_the_scalar_solver_does(
        (omega, decade) in (0.7..2.0_f64, -2.0..1.0_f64),
        (a, depth, y) in (0.1..1.0_f64, 0.2..6.0_f64, 0.05..0.5_f64),
    ) {
        let xi = 10.0_f64.powf(decade);
        let parameters = Parameters { a, b: 1e-3, omega, xi, ..Parameters::default() };
        let start = |y| Start { p: -depth, y, q: Some(0.0), ..Start::default() };
        let Some(motions) = beside_changes(parameters, y, 30, start) else { return Ok(()) };
        for set in sets() {
            for ((model, _), diary) in motions.iter().zip(diaries(set, &motions, 30).0) {
                largest_error(model, &diary)?;
            }
        }
    }
}

/// Flights of 1e4 to 1e7 radians: beyond 1e5 the sine of lanes is not asked, and a run in lanes has
/// to give them to the scalar solver.
#[test]
fn long_flights_are_those_of_the_scalar_solver() {
    let parameters = Parameters { a: 0.3, b: 0.0, omega: 50.0, ..Parameters::default() };
    let model = Model::new(parameters).expect("in range");
    let start = |depth: f64| Start { p: -depth, y: 0.05, q: Some(0.0), ..Start::default() };
    let depths = (0..12).map(|k| 10.0 * 10.0_f64.powf(0.25 * f64::from(k)));
    let entries: Vec<_> = depths.map(|it| model.start(&start(it)).expect("a start")).collect();
    for set in sets() {
        let (diaries, _) = follow_by(set, entries.len(), |number| {
            let entry = entries[number];
            let flight = model.trajectory(entry).next().expect("a phase");
            let Exit::Switch(landing) = flight.exit() else { unreachable!("it lands") };
            let first = landing.instant.after_periods(3, 1);
            let watcher = Diary { phases: vec![entry], wanted: 1, ..Diary::default() };
            Member { model: &model, entry, first, horizon: Some(first), watcher }
        });
        for diary in diaries {
            assert!(diary.phases.len() > 1);
            largest_error(&model, &diary).unwrap();
        }
    }
}

/// No switch comes later than the judge finds one, who shares nothing with lanes: plain steps that
/// pass no crossing.
#[test]
fn switches_are_the_judges() {
    for (omega, xi) in ATTRACTORS {
        let motions = on_attractor(omega, xi, 40);
        for set in sets() {
            let (diaries, _) = diaries(set, &motions, 100);
            for ((model, _), diary) in motions.iter().zip(&diaries) {
                for pair in diary.phases.windows(2) {
                    let segment = model.trajectory(pair[0]).next().expect("a phase");
                    let found = pair[1].instant.since(&pair[0].instant, omega).value();
                    let effort = Effort {
                        horizon: 2.0 * found,
                        evaluations: 100_000,
                        unit: 0.5 * f64::EPSILON,
                    };
                    let end = one_sided_end::<f64>(model, &segment, &effort);
                    let OneSidedEnd::Crossing { elapsed: judged, .. } = end else {
                        panic!("{end:?}, {found}, {pair:?}");
                    };
                    assert!(
                        (judged - found).abs() <= 1e-7 * (1.0 + found),
                        "{judged} {found} {pair:?}"
                    );
                }
            }
        }
    }
}

/// A motion that nothing ends is followed as well.
#[test]
fn motions_without_end_are_seen_to_be_so() {
    struct Until(Option<Endless>, u32);
    impl Watcher for Until {
        fn see(&mut self, _: &Entry, endless: Option<Endless>) -> ControlFlow<()> {
            (self.0, self.1) = (endless, self.1 + 1);
            if self.1 < 50 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        }
    }
    let parameters = Parameters { a: 0.05, b: 0.5, xi: 0.1, omega: 0.7, ..Parameters::default() };
    let model = Model::new(Parameters { omega: 0.6, ..parameters }).expect("in range");
    for set in Instructions::available() {
        let (seen, _) = follow_by(set, 9, |number| {
            let start = Start { p: -0.1 * number as f64, ..Start::default() };
            let entry = model.start(&start).expect("a start");
            let first: Instant = entry.instant;
            Member { model: &model, entry, first, horizon: None, watcher: Until(None, 0) }
        });
        for Until(endless, strobes) in seen {
            assert_eq!((endless, strobes), (Some(Endless::RestsForEver), 50), "{}", set.as_str());
        }
    }
}

/// A processor without vectors takes every phase by the scalar solver, to the bit.
#[test]
fn without_vectors_motions_are_the_scalar_solvers() {
    let motions = on_attractor(1.4, 0.01, 12);
    let (diaries, tally) = diaries(Instructions::ONE, &motions, 30);
    assert_eq!(tally.in_lanes, 0);
    for ((model, entry), diary) in motions.iter().zip(&diaries) {
        let alone = percuss::dynamics::section::section(model, *entry, 1.0, 0, 30);
        assert!(alone.eq(diary.strobes.iter().map(|(_, strobe)| *strobe)));
    }
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same() {
    let motions = on_attractor(1.4, 0.01, 150);
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(|| diaries(Instructions::widest(), &motions, 60))
    };
    let one = by(1);
    for threads in [2, 3, 8] {
        assert!(by(threads) == one, "{threads} threads");
    }
}
