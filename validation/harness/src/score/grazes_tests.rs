use super::*;
use crate::case::embedded;
use crate::truth::Library;
use percuss::TwoWord;

/// A case with its truth.
struct Followed {
    problem: SystemProblem,
    truth: Truth,
    told: (EventNames, ErrorRule),
}

fn follow(name: &str) -> Followed {
    let case = embedded().unwrap_or_default().into_iter().find(|it| it.name == name);
    let Some(case) = case else { unreachable!("{name} is embedded") };
    let truth = Library::embedded().and_then(|library| library.truth(&case));
    let (Ok(truth), Ok(problem)) = (truth, case.problem()) else { unreachable!("{name} is valid") };
    let system = problem.checked.system();
    let told = (EventNames::new(&case, system), ErrorRule::new(&case, system));
    Followed { problem, truth, told }
}

fn of_case(name: &str) -> Vec<Graze> {
    let Followed { problem, truth, told } = follow(name);
    grazes(&problem, &truth, (&told.0, &told.1))
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
    const MAX_MARGIN: f64 = 1e-2;
    let between = |name: &str, event: usize| -> Vec<f64> {
        let Followed { problem, truth, told } = follow(name);
        let begin = event.checked_sub(1).map_or(0.0, |n| truth.events[n].elapsed.value());
        let segment = begin..truth.events.get(event).unwrap_or(&truth.end).elapsed.value();
        let misses = grazes(&problem, &truth, (&told.0, &told.1)).into_iter();
        let misses = misses.filter(|it| it.events.is_empty() && it.margin >= -MAX_MARGIN);
        misses.map(|it| it.elapsed).filter(|it| segment.contains(it)).collect()
    };
    let period = std::f64::consts::TAU / 1.4;
    for (name, event, count, apart) in [
        ("small-b", 0, 3, period),
        ("small-b", 6, 3, period),
        ("resonance", 0, 2, std::f64::consts::PI),
    ] {
        let found = between(name, event);
        assert_eq!(found.len(), count, "{name}: {found:?}");
        let steps = found.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(steps.into_iter().all(|it| (it - apart).abs() < 1e-2 * apart), "{name}: {found:?}");
    }
}

/// A guard that crosses its threshold and would turn comes back after twice the time to its turn,
/// if it is a parabola: a phase that comes back within twice that again belongs to the graze.
#[test]
fn a_phase_that_comes_back_soon_belongs_to_the_graze() {
    let Followed { problem, truth, told } = follow("graze-overlap-1e-3");
    let of = |truth: &Truth| grazes(&problem, truth, (&told.0, &told.1));
    let length = truth.events[0].elapsed.value();
    let Some(graze) = of(&truth).into_iter().find(|it| it.events.first() == Some(&0)) else {
        unreachable!("the case has a graze at its first event")
    };
    let events_with_return_at = |turns: f64| {
        let mut truth = truth.clone();
        truth.events[1].elapsed = TwoWord::new(length + turns * (graze.elapsed - length));
        let found = of(&truth);
        found.into_iter().find(|it| it.elapsed == graze.elapsed).map(|it| it.events)
    };
    assert_eq!(events_with_return_at(3.9), Some(vec![0, 1]));
    assert_eq!(events_with_return_at(4.1), Some(vec![0]));
}

/// An error is allowed against 1 + |value|: the largest of the three contributions counts, whatever
/// the signs of the values.
#[test]
fn the_growth_of_a_guard_counts_the_size_of_each_value() {
    let Followed { problem, truth, told: (_, rule) } = follow("graze-overlap-1e-3");
    let row = TruthRow { growth: vec![2.0, 3.0, 5.0, 7.0], ..truth.start };
    let system = problem.checked.system();
    let [flight, contact] = [0, 1].map(|mode| &system.modes[mode].until[0].guard);
    let two_xi = contact[1];
    for sign in [1.0, -1.0] {
        let of = |guard: &[f64], state: [f64; 4]| {
            rule.guard_growth(guard, &row, &state.map(|it| sign * it))
        };
        // p counts once, y not at all, q once.
        assert_eq!(of(flight, [4.0, 90.0, 0.5, 90.0]), 10.0);
        assert_eq!(of(flight, [0.5, 90.0, 4.0, 90.0]), 25.0);
        // y counts 2 xi times, q once, p not at all.
        let (y, q) = (3.0 * 31.0 * two_xi, 5.0 * 1.25);
        assert!((of(contact, [90.0, 30.0, 0.25, 90.0]) - y.max(q)).abs() <= 1e-12);
    }
}
