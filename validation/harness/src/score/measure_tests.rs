use super::*;
use crate::case::{Case, Given, Horizon, Problem, Quantity, SAMPLES_PER_PERIOD};
use crate::engine::{Accuracy, Event, Numbers, OscillatorTask, SampleGrid, place};
use crate::system::Values;
use percuss::Ending;
use percuss::Phase::{self, Contact, NoContact, Progression};
use percuss::{Parameters, Start};

const UNIT: f64 = 1e-6;
/// Sums and quotients of a few numbers.
const ROUNDING: f64 = 1e-12;

fn problem() -> Problem {
    let given = Given { start: Start::default(), ..Given::default() };
    let Ok(problem) = given.check() else { unreachable!("the defaults are in range") };
    problem
}

fn row(elapsed: f64, phase: Phase, state: [f64; 4]) -> TruthRow {
    TruthRow {
        event: 0,
        mode: place(phase),
        elapsed: TwoWord::new(elapsed),
        state: state.map(TwoWord::new).to_vec(),
        growth_time: 1.0,
        growth: vec![1.0; 4],
        size: 0.0,
    }
}

/// Two forcing periods with three events, and growths that are all different.
struct Planted {
    task: Task,
    truth: Truth,
    names: EventNames,
    rule: ErrorRule,
    outcome: Outcome,
}

impl Planted {
    fn new() -> Self {
        let problem = problem();
        let horizon = problem.entry.instant.after_periods(2, 1);
        let grid = SampleGrid { per_period: SAMPLES_PER_PERIOD, count: 17 };
        let task = OscillatorTask::until(Parameters::default(), problem, horizon, grid);
        let (task, case) = (Task::of_oscillator(&task), Case::of_run(problem, Horizon::Periods(2)));
        let (Ok(task), Ok(case)) = (task, case) else { unreachable!("it is a system") };
        let states = [[0.5, -0.25, 0.5, 0.0], [1.0, 2.0, 0.75, 0.0], [3.0, 0.0, -1.0, 1.5]];
        let phases = [Contact, Progression, NoContact];
        let growth = [[2.0, 4.0, 5.0, 8.0, 10.0], [3.0, 1.0, 6.0, 1.0, 1.0], [7.0; 5]];
        let times = [1.0, 2.0, 8.0];
        let event = |i: usize| TruthRow {
            growth_time: growth[i][0],
            growth: growth[i][1..].to_vec(),
            ..row(times[i], phases[i], states[i])
        };
        let period = problem.model.period();
        let sample = |k: usize| TruthRow {
            growth: vec![1.0, 2.0, 4.0, 8.0],
            ..row(k as f64 * period / 8.0, NoContact, [0.25, 1.0, 0.0, 0.0])
        };
        let truth = Truth {
            start: row(0.0, NoContact, [0.25, 1.0, 0.0, 0.0]),
            events: (0..3).map(event).collect(),
            end: row(task.span, NoContact, [0.25, 1.0, 0.0, 1.5]),
            ended: Ending::Horizon,
            span: task.span,
            samples: (0..17).map(sample).collect(),
            ordered: true,
        };
        let state = |row: &TruthRow| Values::from_slice(&row.rounded());
        let event = |row: &TruthRow| Event {
            event: 0,
            mode: row.mode,
            elapsed: row.elapsed.value(),
            state: state(row),
            before: None,
        };
        let outcome = Outcome {
            events: truth.events.iter().map(event).collect(),
            samples: truth.samples.iter().map(state).collect(),
            end: state(&truth.end),
            ..Outcome::default()
        };
        let system = task.system.system();
        let (names, rule) = (EventNames::new(&case, system), ErrorRule::new(&case, system));
        Self { task, truth, names, rule, outcome }
    }

    fn measures(&self) -> Measures {
        let Self { task, truth, names, rule, outcome } = self;
        let scored_by = ScoredBy::new((Accuracy::Tolerance(UNIT), UNIT), &[], &[]);
        measure(MeasuredBy { task, truth, names, rule }, outcome, scored_by)
    }
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= ROUNDING * expected.abs(), "{found:e} {expected:e}");
}

#[test]
fn a_perfect_answer_has_no_error() {
    let found = Planted::new().measures();
    assert!(found.whole && found.phase_sequence_ok && found.is_scored());
    assert_eq!((found.total, found.expected, found.matched), (3, 3, 3));
    assert_near(found.horizon_periods, 2.0);
    assert_near(found.valid_periods, 2.0);
    assert_eq!((found.event_time.max, found.state.max, found.drift), (0.0, 0.0, 0.0));
    assert_eq!((found.event_constant, found.state_constant), (0.0, 0.0));
}

#[test]
fn an_events_time_counts_over_its_size_and_its_growth() {
    let mut planted = Planted::new();
    planted.outcome.events[1].elapsed += 1e-4;
    let found = planted.measures();
    let units = (planted.outcome.events[1].elapsed - 2.0) / (UNIT * 3.0 * 3.0);
    assert_near(found.event_constant, units);
    assert_near(found.event_time_units[1], units);
    assert_eq!((found.event_time_units[0], found.event_time_units[2]), (0.0, 0.0));
    assert_near(found.event_time.max, planted.outcome.events[1].elapsed - 2.0);
}

#[test]
fn an_events_state_counts_over_its_size_and_its_growth() {
    for (k, growth, size) in [(0, 1.0, 2.0), (1, 6.0, 3.0), (2, 1.0, 1.75), (3, 1.0, 1.0)] {
        let mut planted = Planted::new();
        planted.outcome.events[1].state[k] += 1e-4;
        let off = planted.outcome.events[1].state[k] - planted.truth.events[1].rounded()[k];
        assert_near(planted.measures().event_constant, off / (UNIT * growth * size));
    }
}

#[test]
fn a_samples_state_counts_over_its_size_and_its_growth() {
    for n in [1_usize, 5, 16] {
        for (k, growth, size) in [(0, 1.0, 1.25), (1, 2.0, 2.0), (2, 4.0, 1.0), (3, 8.0, 1.0)] {
            let mut planted = Planted::new();
            planted.outcome.samples[n][k] -= 1e-4;
            let found = planted.measures();
            let off = (planted.outcome.samples[n][k] - planted.truth.samples[n].rounded()[k]).abs();
            assert_near(found.state_constant, off / (UNIT * growth * size));
            // The drift is a quantity of its own.
            assert_near(found.state.max, if k < 3 { off } else { 0.0 });
        }
    }
}

/// A state before an impact differs from that after it by far more than any error: it is the error
/// of the event's time that counts. The largest error is reported all the same.
#[test]
fn a_sample_between_an_event_and_its_partner_is_in_no_constant() {
    for (before, after, counts) in [(1e-4, 1e-4, false), (0.0, 1e-4, true), (1e-4, 0.0, true)] {
        let mut planted = Planted::new();
        let sample = planted.truth.samples[3].elapsed.value();
        planted.truth.events[1].elapsed = TwoWord::new(sample - before);
        planted.outcome.events[1].elapsed = sample + after;
        planted.outcome.samples[3][0] += 1.0;
        let found = planted.measures();
        assert_eq!(found.state_constant > 0.0, counts, "{before} {after}");
        assert_near(found.state.max, 1.0);
    }
}

#[test]
fn an_answer_without_samples_is_measured_by_its_events() {
    let mut planted = Planted::new();
    planted.outcome.samples.clear();
    let found = planted.measures();
    assert_eq!((found.samples, found.sampled, found.matched), (0, 0, 3));
    assert!(found.valid_periods.is_nan() && found.drift.is_nan() && found.state.max.is_nan());
    assert_eq!(found.event_constant, 0.0);
    let of_samples = [Quantity::StateError, Quantity::StateConstant, Quantity::DriftError];
    assert!(of_samples.iter().all(|it| !found.concerns(*it)));
    assert!(!found.concerns(Quantity::ValidPeriods) && found.concerns(Quantity::EventConstant));
}

#[test]
fn a_number_that_is_none_is_the_largest_error() {
    assert!(worst([1.0, f64::NAN, 2.0].into_iter()).is_nan());
    assert_eq!(worst([1.0, 3.0, 2.0].into_iter()), 3.0);
    let mut planted = Planted::new();
    planted.outcome.samples[3][0] = f64::NAN;
    planted.outcome.samples[4][0] += 1.0;
    let found = planted.measures();
    assert!(found.state.max.is_nan() && found.state_constant.is_nan());
    let mut planted = Planted::new();
    planted.outcome.events[1].state[0] = f64::NAN;
    assert!(planted.measures().event_constant.is_nan());
}

#[test]
fn the_start_is_given() {
    let mut planted = Planted::new();
    planted.outcome.samples[0][0] += 1e-4;
    let found = planted.measures();
    assert_eq!((found.state.max, found.state_constant), (0.0, 0.0));
}

#[test]
fn a_run_is_valid_until_the_sample_before_the_first_that_is_off() {
    for (error, periods) in [(1.1e-3, 4.0 / 8.0), (0.9e-3, 2.0), (f64::NAN, 4.0 / 8.0)] {
        let mut planted = Planted::new();
        planted.outcome.samples[5][2] += error;
        assert_near(planted.measures().valid_periods, periods);
    }
}

#[test]
fn what_is_beyond_the_scored_horizon_does_not_count() {
    let mut planted = Planted::new();
    // A unit of error has grown past what is scored from the ninth sample on.
    for row in &mut planted.truth.samples[8..] {
        row.growth[1] = 2.0 * SCORED_ERROR / (crate::score::SCORED_FACTOR * UNIT);
    }
    planted.outcome.samples[9][0] += 0.5;
    planted.outcome.events[2].elapsed += 0.5;
    planted.outcome.end[3] += 0.5;
    let found = planted.measures();
    assert!(!found.whole && found.is_scored());
    assert_near(found.horizon_periods, 7.0 / 8.0);
    assert_eq!((found.total, found.expected, found.matched), (3, 2, 2));
    assert_eq!((found.event_constant, found.state_constant, found.state.max), (0.0, 0.0, 0.0));
    assert!(found.drift.is_nan() && found.drift_by_times.is_nan());
    assert!(found.lacks(Quantity::DriftError) && !found.lacks(Quantity::StateError));
}

#[test]
fn an_event_just_past_the_horizon_is_the_partner_of_one_just_before_it() {
    let mut planted = Planted::new();
    for row in &mut planted.truth.samples[8..] {
        row.growth[0] = 2.0 * SCORED_ERROR / (crate::score::SCORED_FACTOR * UNIT);
    }
    let horizon = planted.truth.samples[7].elapsed.value();
    let window = WINDOW * problem().model.period();
    planted.truth.events[1].elapsed = TwoWord::new(horizon - 0.4 * window);
    planted.outcome.events[1].elapsed = horizon + 0.4 * window;
    let found = planted.measures();
    assert_eq!((found.expected, found.matched), (2, 2));
    assert_eq!((found.mismatch.missed.len(), found.mismatch.spurious.len()), (0, 0));
    planted.outcome.events[1].elapsed = horizon + 0.7 * window;
    let found = planted.measures();
    assert_eq!((found.matched, found.mismatch.missed.len()), (1, 1));
}

#[test]
fn drift_is_what_the_end_lacks_and_late_slips_explain() {
    let mut planted = Planted::new();
    planted.outcome.end[3] -= 1e-3;
    planted.outcome.events[1].elapsed += 1e-3;
    let found = planted.measures();
    assert_near(found.drift, 1.5 - planted.outcome.end[3]);
    // The slip begins with y = 2 and q = 0.75: v' = 2 - 0.25/(2 xi).
    let late = planted.outcome.events[1].elapsed - 2.0;
    assert_near(found.drift_by_times, (late * (2.0 - 0.25 / 0.02)).abs());
}

#[test]
fn a_twentieth_of_the_events_is_enough() {
    let mut found = Planted::new().measures();
    (found.total, found.expected) = (40, 2);
    assert!(found.is_scored());
    found.total = 41;
    assert!(!found.is_scored());
    (found.total, found.expected, found.whole) = (0, 0, false);
    assert!(!found.is_scored() && !found.concerns(Quantity::EventConstant));
    found.whole = true;
    assert!(found.is_scored());
}

#[test]
fn one_event_has_errors_and_none_has_none() {
    let mut found = Planted::new().measures();
    for (total, concerned) in [(1, true), (0, false)] {
        found.total = total;
        assert_eq!(found.concerns(Quantity::EventTimeError), concerned);
        assert_eq!(found.concerns(Quantity::EventConstant), concerned);
    }
}

#[test]
fn what_no_event_and_no_horizon_measures_is_lacking() {
    let mut found = Planted::new().measures();
    found.matched = 0;
    assert!(found.lacks(Quantity::EventTimeError) && found.lacks(Quantity::EventConstant));
    assert!(!found.lacks(Quantity::StateConstant) && !found.lacks(Quantity::EventsMissed));
    found.sampled = 0;
    assert!(found.lacks(Quantity::StateError) && found.lacks(Quantity::StateConstant));
}
