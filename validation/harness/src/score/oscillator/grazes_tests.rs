use super::*;
use crate::case::{Given, embedded};
use crate::engine::SampleGrid;
use crate::truth::Library;
use percuss::TwoWord;

/// A case with its truth.
fn followed(name: &str) -> (OscillatorTask, Truth, RunGrowth) {
    let case = embedded().unwrap_or_default().into_iter().find(|it| it.name == name);
    let Some(case) = case else { unreachable!("{name} is embedded") };
    let truth = Library::embedded().and_then(|library| library.truth(&case));
    let given = Given { parameters: case.parameters, start: case.start, ..Given::default() };
    let (Ok(truth), Ok(problem)) = (truth, given.check()) else { unreachable!("{name} is valid") };
    let grid = SampleGrid { per_period: Truth::SAMPLES_PER_PERIOD, count: truth.samples.len() };
    let task = OscillatorTask::of(&case, problem, grid);
    let growth = RunGrowth::along(&truth, &case.parameters, task.forcing_angle);
    (task, truth, growth)
}

fn of_case(name: &str) -> Vec<Graze> {
    let (task, truth, growth) = followed(name);
    grazes(&task, &truth, &growth)
}

/// What the margins of the case files and the margins found may differ by: the files' seven digits,
/// and the rounding of displacements of up to 1.
fn agrees(found: f64, stated: f64) -> bool {
    (found - stated).abs() <= 1e-6 * stated.abs() + 4.0 * f64::EPSILON
}

#[test]
fn stated_margins_are_found_from_both_sides() {
    for exponent in [3, 6, 9, 12] {
        let size: f64 = format!("1e-{exponent}").parse().unwrap_or(f64::NAN);
        let touch = of_case(&format!("graze-overlap-1e-{exponent}"));
        let touch = touch.iter().find(|it| agrees(it.margin, size));
        assert!(touch.is_some_and(|it| it.events == [0, 1]), "1e-{exponent}: {touch:?}");
        let miss = of_case(&format!("graze-miss-1e-{exponent}"));
        let miss = miss.iter().find(|it| agrees(it.margin, -size));
        assert!(miss.is_some_and(|it| it.events.is_empty()), "-1e-{exponent}: {miss:?}");
    }
}

#[test]
fn the_double_zero_after_a_separation_is_no_graze() {
    for name in ["table1-from-rest", "fig7a-period-4", "stiff-xi-0-03"] {
        let found = of_case(name);
        let tiny = |it: &&Graze| it.margin.abs() < 1e-9;
        assert_eq!(found.iter().find(tiny), None, "{name}");
    }
}

#[test]
fn only_what_is_allowed_anyway_is_undecidable() {
    let graze = Graze {
        elapsed: 1.0,
        margin: -1e-6,
        growth: 2.0,
        events: Vec::new(),
        mode: 1,
        event: None,
        ends: true,
        makes: 2,
    };
    assert!(graze.is_undecidable(5e-7));
    assert!(!graze.is_undecidable(4.9e-7));
    assert!(!graze.is_undecidable(f64::NAN));
}

/// On `small-b` the guard turns close to its threshold in three forcing periods one after the
/// other, before any event and once more after six; on `resonance` in two half oscillations.
#[test]
fn all_near_misses_of_a_segment_are_found() {
    let between = |name: &str, event: usize| -> Vec<f64> {
        let (task, truth, growth) = followed(name);
        let begin = event.checked_sub(1).map_or(0.0, |n| truth.events[n].elapsed.value());
        let segment = begin..truth.events.get(event).unwrap_or(&truth.end).elapsed.value();
        let misses = grazes(&task, &truth, &growth).into_iter().filter(|it| it.events.is_empty());
        misses.map(|it| it.elapsed).filter(|it| segment.contains(it)).collect()
    };
    let period = std::f64::consts::TAU / 1.4;
    for (name, event, count, apart) in
        [("small-b", 0, 3, period), ("small-b", 6, 3, period), ("resonance", 0, 2, PI)]
    {
        let found = between(name, event);
        assert_eq!(found.len(), count, "{name}: {found:?}");
        let steps = found.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(steps.into_iter().all(|it| (it - apart).abs() < 1e-2 * apart), "{name}: {found:?}");
    }
}

/// Guards are looked at 128 times in a period of the forcing, or in one of the contact where that
/// is shorter.
#[test]
fn looks_follow_the_faster_of_forcing_and_contact() {
    for (omega, expected) in [(0.1, 2.0 * PI / 128.0), (5.0, 2.0 * PI / 5.0 / 128.0)] {
        let parameters = Parameters { omega, ..Parameters::default() };
        let Ok(problem) = (Given { parameters, ..Given::default() }).check() else {
            unreachable!("the parameters are in range")
        };
        let horizon = problem.entry.instant.after_periods(1, 1);
        let task = OscillatorTask::until(
            parameters,
            problem,
            horizon,
            SampleGrid { per_period: 8, count: 9 },
        );
        let Ok(truth) = Truth::replayed(&parameters, &problem.entry, horizon, (9, 8)) else {
            unreachable!("106 bits decide it")
        };
        let growth = RunGrowth::along(&truth, &parameters, task.forcing_angle);
        let step = Scan { task: &task, truth: &truth, growth: &growth }.step();
        assert!((step - expected).abs() <= 1e-14, "{step} {expected}");
    }
}

/// The forcing goes on between the start of the run and that of a segment.
#[test]
fn rates_are_the_slopes_of_guards_in_segments_that_begin_late() {
    /// Differences of this length err by its square times a third derivative of at most about 1.
    const STEP: f64 = 1e-4;
    let parameters = Parameters::default();
    let (angle, began) = (0.3, 5.0);
    for phase in Phase::ALL {
        let begun = [0.3 + parameters.g, 0.1, 0.3, 0.0];
        let angle_there = angle + parameters.omega * began;
        let segment = ScannedSegment {
            phase,
            began,
            oscillator: Oscillator::of(&parameters, angle),
            closed: Closed::new(&parameters, phase, begun, angle_there, false),
        };
        for d in [0.2, 1.1, 2.7] {
            let (before, after) = (segment.guards(d - STEP), segment.guards(d + STEP));
            for (guard, rate) in segment.rates(d).into_iter().enumerate() {
                let slope = (after[guard] - before[guard]) / (2.0 * STEP);
                assert!((rate - slope).abs() <= 1e-7, "{phase:?} {d}: {rate} {slope}");
            }
        }
    }
}

/// A guard that crosses its threshold and would turn comes back after twice the time to its turn,
/// if it is a parabola: a phase that comes back within twice that again belongs to the graze.
#[test]
fn a_phase_that_comes_back_soon_belongs_to_the_graze() {
    let (task, truth, growth) = followed("graze-overlap-1e-3");
    let length = truth.events[0].elapsed.value();
    let events_with_return_at = |turns: f64| {
        let whole = Scan { task: &task, truth: &truth, growth: &growth };
        let found = whole.segment(0, &truth.start, &truth.events[0]);
        let Some(graze) = found.iter().find(|it| !it.events.is_empty()) else {
            unreachable!("the case has a graze at its first event")
        };
        let mut truth = truth.clone();
        truth.events[1].elapsed = TwoWord::new(length + turns * (graze.elapsed - length));
        let scan = Scan { task: &task, truth: &truth, growth: &growth };
        let found = scan.segment(0, &truth.start, &truth.events[0]);
        found.into_iter().find(|it| it.elapsed == graze.elapsed).map(|it| it.events)
    };
    assert_eq!(events_with_return_at(3.9), Some(vec![0, 1]));
    assert_eq!(events_with_return_at(4.1), Some(vec![0]));
}

/// An error is allowed against 1 + |value|: the largest of the three contributions counts, whatever
/// the signs of the values.
#[test]
fn the_growth_of_a_guard_counts_the_size_of_each_value() {
    let (task, truth, mut growth) = followed("graze-overlap-1e-3");
    growth.samples = vec![[2.0, 3.0, 5.0, 7.0]];
    let scan = Scan { task: &task, truth: &truth, growth: &growth };
    let two_xi = 2.0 * task.parameters.xi;
    for sign in [1.0, -1.0] {
        let of = |phase, state: [f64; 4]| scan.guard_growth(phase, &state.map(|it| sign * it), 0.0);
        // p counts once, y not at all, q once.
        assert_eq!(of(Phase::NoContact, [4.0, 90.0, 0.5, 90.0]), 10.0);
        assert_eq!(of(Phase::NoContact, [0.5, 90.0, 4.0, 90.0]), 25.0);
        // y counts 2 xi times, q once, p not at all.
        let (y, q) = (3.0 * 31.0 * two_xi, 5.0 * 1.25);
        assert_eq!(of(Phase::Contact, [90.0, 30.0, 0.25, 90.0]), y.max(q));
    }
}

/// The trial force is q + 2 xi y, and the gap is p - q but for its sign.
#[test]
fn a_guard_depends_on_the_state_as_the_model_says() {
    let parameters = Parameters { xi: 0.05, ..Parameters::default() };
    assert_eq!(gradient(Phase::Contact, &parameters), [0.0, 0.1, 1.0]);
    assert_eq!(gradient(Phase::Progression, &parameters), [0.0, 0.1, 1.0]);
    assert_eq!(gradient(Phase::NoContact, &parameters), [1.0, 0.0, 1.0]);
}
