//! Guards that turn back within rounding of their threshold: a plain run has the events that there
//! are, or counts what it cannot decide.
//!
//! Each motion is chosen so that rounding is much larger than what is left of the guard there:
//! terms that cancel, and co-ordinates of nearly equal eigenvalues.

use super::system;
use percuss::affine::DoubleDouble;
use percuss::affine::{Direction, Ending, Event, Rational, Row, Solver, System, Watch, What};
use percuss::number::Number;
use proptest::prelude::*;
use std::fmt::Write;

const HORIZON: f64 = 12.0;

/// A motion of the states "a", "b", ... by its equations, its parameters and its start.
fn motion(equations: &[&str], parameters: &[(&str, f64)], start: &[f64]) -> System {
    let names: Vec<_> = (b'a'..).take(equations.len()).map(char::from).collect();
    let states: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let rates = names.iter().zip(equations).map(|(name, rate)| format!("\"{name}' = {rate}\""));
    let mut text = format!(
        "schema = 1\nname = \"touch\"\nstates = [{}]\n[[mode]]\nname = \"free\"\nequations = [{}]\n\
         [[mode.watch]]\nname = \"level\"\nguard = \"a > 0\"\ndirection = \"both\"\n[parameters]\n",
        states.join(", "),
        rates.collect::<Vec<_>>().join(", "),
    );
    for (name, value) in parameters {
        let _ = writeln!(text, "{name} = {value:?}");
    }
    text.push_str("[start]\nmode = \"free\"\n");
    for (name, value) in names.iter().zip(start) {
        let _ = writeln!(text, "{name} = {value:?}");
    }
    system(&text)
}

/// A parabola whose lowest point is a small share of its start.
fn parabola([x, g, share]: [f64; 3]) -> System {
    let (x, g, share) = (1.0 + 99.0 * x, 0.5 + 9.0 * g, 10_f64.powf(-1.0 - 3.0 * share));
    let v = -(2.0 * g * x * (1.0 - share)).sqrt();
    motion(&["b", "q"], &[("q", g)], &[x, v])
}

/// Three equal eigenvalues.
fn defective([x, g, share]: [f64; 3]) -> System {
    let start = [10.0 * x - 5.0, 10.0 * g - 5.0, 10.0 * share - 5.0];
    motion(&["b - p*a", "c - p*b", "q - p*c"], &[("q", g), ("p", x)], &start)
}

/// Two pairs of eigenvalues at a small distance.
fn close_pairs([x, g, share]: [f64; 3]) -> System {
    let parameters = [("p", 0.5 + g), ("q", 10_f64.powf(-1.0 - 4.0 * share))];
    let start = [10.0 * x - 5.0, 10.0 * g - 5.0, 10.0 * share - 5.0, 2.0 - 4.0 * x];
    motion(&["b", "c - p*a", "d", "-p*c - q*c"], &parameters, &start)
}

/// The value of "a" where its rate is zero, in two words, one of several such places.
fn crest(system: &System, which: usize) -> Option<(System, [f64; 2])> {
    let mut system = system.clone();
    let mode = &mut system.modes[0];
    let guard = mode.matrix[0].clone();
    let (name, direction) = ("crest".to_owned(), Direction::Both);
    mode.watch = vec![Watch { name, guard, direction }];
    let solver = Solver::<DoubleDouble>::new(&system).unwrap();
    let mut run = solver.run(system.start.as_ref()?, DoubleDouble::exact(HORIZON)).ok()?;
    let crests: Vec<_> = run.by_ref().filter(|it| matches!(it.what, What::Watch(..))).collect();
    let crest = crests.get(which % crests.len().max(1))?;
    let (high, low) = crest.state[0].words();
    (run.work().undecidable == 0).then_some((system, [high, low]))
}

/// Whether each event is a crossing of the level; none if the run is undecided.
fn crossings<T: Number>(events: &[Event<T>]) -> Option<Vec<bool>> {
    let ends_open = |it: &Event<T>| matches!(it.what, What::End(Ending::Undecided));
    let crossing = |it: &Event<T>| matches!(it.what, What::Watch(..));
    (!events.iter().any(ends_open)).then(|| events.iter().map(crossing).collect())
}

/// Whether a plain run decides a touch: none where nothing is known.
fn is_decided(system: &System, which: usize, shift: f64) -> Option<bool> {
    let (mut system, [high, low]) = crest(system, which)?;
    let start = system.start.clone()?;
    let size = start.state.iter().map(|it| it[2].to_f64().abs()).fold(0.0, f64::max);
    let mut guard: Row = vec![Rational::ZERO; system.modes[0].matrix.len()];
    let word = |it: f64| Rational::try_from(it).unwrap();
    guard[0] = word(1.0);
    *guard.last_mut()? = -(word(high) + word(low) + word(shift * size * f64::EPSILON));
    system.modes[0].watch[0].guard = guard;
    let wide = Solver::<DoubleDouble>::new(&system).unwrap();
    let truth = wide.run_enclosed(&start, DoubleDouble::exact(HORIZON)).ok()?.collect::<Vec<_>>();
    let truth = crossings(&truth)?;
    let narrow = Solver::<f64>::new(&system).unwrap();
    let mut run = narrow.run(&start, HORIZON).ok()?;
    let own: Vec<_> = run.by_ref().collect();
    let (own, counted) = (crossings(&own), run.work().undecidable > 0);
    assert!(counted || own.as_ref() == Some(&truth), "{own:?} instead of {truth:?}");
    Some(!counted)
}

fn kind() -> impl Strategy<Value = fn([f64; 3]) -> System> {
    let all: [fn([f64; 3]) -> System; 3] = [parabola, defective, close_pairs];
    (0..all.len()).prop_map(move |n| all[n])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn what_a_plain_run_misses_next_to_a_touch_it_counts(
        kind in kind(),
        shape in [0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64],
        which in 0..8_usize,
        shift in prop_oneof![-1.0..1.0_f64, -8.0..8.0_f64, -60.0..60.0_f64],
    ) {
        is_decided(&kind(shape), which, shift);
    }
}

/// The checks above compare runs: far from a touch nothing is counted.
#[test]
fn what_is_clear_of_rounding_is_not_counted() {
    for kind in [parabola, defective, close_pairs] {
        let shapes = (1..=20_u8).map(|n| [0.37, 0.59, 0.83].map(|it| (it * f64::from(n)) % 1.0));
        let decided: Vec<_> = shapes.filter_map(|shape| is_decided(&kind(shape), 0, 1e7)).collect();
        assert!(decided.len() > 5 && decided.iter().all(|it| *it), "{decided:?}");
    }
}
