//! Systems that are made or changed by hand: each mistake has an error that names its item, and
//! none makes the library panic.

use super::PLASTIC;
use percuss::affine::{
    Direction, DoubleDouble, Rational, Row, Solver, StartPoint, System, SystemError, Watch,
};
use percuss::number::Number;
use proptest::prelude::*;
use std::path::Path;
use std::sync::OnceLock;

/// A ball on a shaking table: two states, forced, the modes "flight" and "stuck".
fn plastic() -> System {
    super::system(PLASTIC)
}

/// The text of the error of a changed system, which every way into the library gives.
fn refusal(change: impl FnOnce(&mut System)) -> String {
    let mut system = plastic();
    change(&mut system);
    let error = system.check().unwrap_err();
    assert_eq!(Solver::<f64>::new(&system).unwrap_err(), error);
    assert_eq!(Solver::<f64>::backward(&system).unwrap_err(), error);
    error.to_string()
}

fn zeros(length: usize) -> Row {
    vec![Rational::ZERO; length]
}

#[test]
fn rows_of_the_wrong_length_are_refused() {
    assert_eq!(
        refusal(|it| drop(it.modes[0].matrix[1].pop())),
        "mode \"flight\", row 2 of the matrix: 4 entries are not accepted: 5 are"
    );
    assert_eq!(
        refusal(|it| drop(it.modes[1].matrix.remove(0))),
        "mode \"stuck\", matrix: 4 entries are not accepted: 5 are"
    );
    assert_eq!(
        refusal(|it| it.modes[0].until[0].guard.push(Rational::ONE)),
        "mode \"flight\", until \"impact\", guard: 6 entries are not accepted: 5 are"
    );
    assert_eq!(
        refusal(|it| it.modes[0].until[0].reset.clear()),
        "mode \"flight\", until \"impact\", reset: 0 entries are not accepted: 5 are"
    );
    assert_eq!(
        refusal(|it| it.modes[0].until[0].reset[4].clear()),
        "mode \"flight\", until \"impact\", row 5 of the reset: 0 entries are not accepted: 5 are"
    );
    assert_eq!(
        refusal(|it| it.modes[0].until[0].next[0].when.iter_mut().for_each(Vec::clear)),
        "mode \"flight\", until \"impact\", successor 1, condition: 0 entries are not accepted: \
         5 are"
    );
    let watch = Watch { name: "top".to_owned(), guard: zeros(3), direction: Direction::Both };
    assert_eq!(
        refusal(|it| it.modes[1].watch.push(watch)),
        "mode \"stuck\", watch \"top\", guard: 3 entries are not accepted: 5 are"
    );
    assert_eq!(refusal(|it| it.scales.push(1.0)), "scales: 3 entries are not accepted: 2 are");
}

#[test]
fn a_clock_that_stands_still_is_refused() {
    let refused = "mode \"flight\": the matrix has not the rows of the forcing: \
                   cos' = -omega sin and sin' = omega cos are accepted";
    assert_eq!(refusal(|it| it.modes[0].matrix[2] = zeros(5)), refused);
    assert_eq!(refusal(|it| it.modes[0].matrix.swap(2, 3)), refused);
    assert_eq!(refusal(|it| it.modes[0].matrix[3][0] = Rational::ONE), refused);
    assert_eq!(refusal(|it| it.forcing.as_mut().unwrap().omega = Rational::from(3)), refused);
    assert_eq!(
        refusal(|it| it.forcing = None),
        "mode \"flight\", matrix: 5 entries are not accepted: 3 are"
    );
    assert_eq!(
        refusal(|it| it.forcing.as_mut().unwrap().omega = Rational::ZERO),
        "forcing: omega is not accepted as 0"
    );
    assert_eq!(
        refusal(|it| it.modes[1].matrix[4][0] = Rational::ONE),
        "mode \"stuck\": the last row of the matrix, that of 1, is accepted as zeros only"
    );
}

#[test]
fn a_reset_changes_states_only() {
    for (row, entry) in [(2, "cos"), (3, "sin"), (4, "1")] {
        assert_eq!(
            refusal(|it| it.modes[1].until[0].reset[row][0] = Rational::ONE),
            format!(
                "mode \"stuck\", until \"detach\": the reset changes {entry}: accepted is one \
                 that changes states"
            )
        );
    }
}

#[test]
fn a_mode_that_is_not_there_is_refused() {
    assert_eq!(
        refusal(|it| it.modes[0].until[0].next[1].mode = 2),
        "mode \"flight\", until \"impact\", successor 2: there is no mode 2: accepted are indices \
         below 2"
    );
    assert_eq!(
        refusal(|it| it.start.as_mut().unwrap().mode = 9),
        "start: there is no mode 9: accepted are indices below 2"
    );
    assert_eq!(
        refusal(|it| drop(it.start.as_mut().unwrap().state.pop())),
        "start, state: 1 entries are not accepted: 2 are"
    );
}

#[test]
fn the_last_successor_alone_has_no_condition() {
    let refused = "mode \"flight\", until \"impact\": every successor but the last has a \
                   condition, and the last has none";
    assert_eq!(refusal(|it| drop(it.modes[0].until[0].next.pop())), refused);
    assert_eq!(refusal(|it| it.modes[0].until[0].next[0].when = None), refused);
    assert_eq!(
        refusal(|it| it.modes[0].until[0].next.clear()),
        "mode \"flight\", until \"impact\", successors: 0 are not accepted: 1 to 64 are"
    );
}

#[test]
fn too_many_and_too_few_are_refused() {
    assert_eq!(refusal(|it| it.modes.clear()), "modes: 0 are not accepted: 1 to 64 are");
    let first = plastic().modes[0].clone();
    assert_eq!(refusal(|it| it.modes = vec![first; 65]), "modes: 65 are not accepted: 1 to 64 are");
    let watch = Watch { name: "top".to_owned(), guard: zeros(5), direction: Direction::Both };
    assert_eq!(
        refusal(|it| it.modes[0].watch = vec![watch; 64]),
        "mode \"flight\", events: 65 are not accepted: 0 to 64 are"
    );
    assert_eq!(refusal(|it| it.states.clear()), "states: 0 are not accepted: 1 to 9 are");
    assert_eq!(
        refusal(|it| it.states = vec!["x".to_owned(); 10]),
        "states: 10 are not accepted: 1 to 9 are"
    );
}

#[test]
fn names_are_those_of_files() {
    assert_eq!(
        refusal(|it| "Two words".clone_into(&mut it.name)),
        "system: \"Two words\" is not accepted: lower-case words joined by hyphens are"
    );
    assert_eq!(
        refusal(|it| "cos".clone_into(&mut it.states[0])),
        "state \"cos\": cos is reserved for theta = omega t + phi"
    );
    assert_eq!(
        refusal(|it| "x".clone_into(&mut it.states[1])),
        "state \"x\": the state is there twice"
    );
    assert_eq!(
        refusal(|it| "flight".clone_into(&mut it.modes[1].name)),
        "mode \"flight\": it is there twice"
    );
    assert_eq!(
        refusal(|it| "end".clone_into(&mut it.modes[0].until[0].name)),
        "mode \"flight\", until \"end\": \"end\" is the name of an ending"
    );
    let trouble = refusal(|it| it.trouble.push("none".to_owned()));
    assert!(trouble.starts_with("trouble: \"none\" is not accepted: any of jump,"), "{trouble}");
}

#[test]
fn numbers_are_those_of_files() {
    for (number, written) in [(0.0, "0.0"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let said = |item: &str| format!("{item}: {written} is not accepted: a positive number is");
        assert_eq!(refusal(|it| it.scales[1] = number), said("scales"));
        assert_eq!(refusal(|it| it.time_scale = number), said("time_scale"));
    }
    assert_eq!(
        refusal(|it| it.modes[0].matrix[1][4] = "1e400".parse().unwrap()),
        "mode \"flight\", row 2 of the matrix: a coefficient of about 2^1328 is not accepted: 0 \
         is, and sizes from 2^-1000 to 2^1000"
    );
    let long = "1e6000".parse::<Rational>().unwrap();
    let near_one = (&long + Rational::ONE) / long;
    assert_eq!(
        refusal(|it| it.modes[0].until[0].guard[0] = near_one),
        "mode \"flight\", until \"impact\", guard: a coefficient of 19932 bits is too long: up to \
         16384 are accepted"
    );
}

#[test]
fn a_run_refuses_a_start_that_is_none() {
    let system = plastic();
    let solver = Solver::<f64>::new(&system).unwrap();
    let start = system.start().unwrap();
    let refused = |start: &StartPoint| {
        let error = solver.run(start, 1.0).map(|_| ()).unwrap_err();
        assert_eq!(solver.run_enclosed(start, 1.0).map(|_| ()), Err(error.clone()));
        error.to_string()
    };
    assert_eq!(
        refused(&StartPoint { mode: 2, ..start.clone() }),
        "start: there is no mode 2: accepted are indices below 2"
    );
    assert_eq!(
        refused(&StartPoint { state: Vec::new(), ..start.clone() }),
        "start, state: 0 entries are not accepted: 2 are"
    );
    let many = vec![start.state[0].clone(); 20];
    assert_eq!(
        refused(&StartPoint { state: many, ..start.clone() }),
        "start, state: 20 entries are not accepted: 2 are"
    );
    let mut without = system.clone();
    without.start = None;
    assert_eq!(without.check(), Ok(()));
    assert_eq!(without.start().unwrap_err().to_string(), format!("{} has no start", system.name));
}

/// The primes modulo which structural zeros are decided divide the coefficient.
#[test]
fn structural_zeros_that_cannot_be_decided_are_refused() {
    let prime = Rational::from((1_u64 << 61) - 1);
    let mut system = plastic();
    system.modes[0].until[0].guard[0] = prime.clone();
    let error = Solver::<f64>::new(&system).map(|_| ()).unwrap_err();
    assert_eq!(error, SystemError::Undecidable { item: system.name.clone() });
    assert_eq!(
        error.to_string(),
        format!("the structural zeros of {} cannot be decided", system.name)
    );
    let system = plastic();
    let solver = Solver::<f64>::new(&system).unwrap();
    let mut start = system.start().unwrap().clone();
    start.state[0] = [Rational::ZERO, Rational::ZERO, prime];
    assert_eq!(
        solver.run(&start, 1.0).map(|_| ()).unwrap_err().to_string(),
        format!("the structural zeros of a start of {} cannot be decided", system.name)
    );
}

/// The systems of the repository.
pub(super) fn all_systems() -> &'static [System] {
    static ALL: OnceLock<Vec<System>> = OnceLock::new();
    ALL.get_or_init(|| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/systems");
        let files = std::fs::read_dir(folder).unwrap();
        let mut paths: Vec<_> = files.map(|it| it.unwrap().path()).collect();
        paths.sort();
        let texts = paths.iter().map(|it| std::fs::read_to_string(it).unwrap());
        texts.map(|text| super::system(&text)).collect()
    })
}

#[test]
fn every_system_that_is_read_is_one() {
    assert_eq!(all_systems().len(), 14);
    for system in all_systems() {
        assert_eq!(system.check(), Ok(()), "{}", system.name);
        assert_eq!(system.reversed().check(), Ok(()), "{} reversed", system.name);
    }
}

/// A change: its kind, and numbers that say where and by what.
type Change = (u8, usize, usize, usize);

/// The number of kinds of changes.
const KINDS: u8 = 20;

/// Changes a system; `n`, `k` and `v` pick a row, an entry and a value.
fn change(system: &mut System, (kind, n, k, v): Change) {
    fn pick<T>(items: &mut [T], n: usize) -> Option<&mut T> {
        let length = items.len();
        if length == 0 { None } else { items.get_mut(n % length) }
    }
    let number = Rational::from(v as i64 % 5 - 2) / Rational::from(v as i64 % 3 + 1);
    let states = system.states.len();
    let mode = pick(&mut system.modes, v);
    let mut none = Vec::new();
    let (rows, until, watch) = match mode {
        Some(mode) => (&mut mode.matrix, pick(&mut mode.until, n), pick(&mut mode.watch, n)),
        None => (&mut none, None, None),
    };
    match kind {
        0 => drop(rows.pop()),
        1 => pick(rows, n).into_iter().for_each(|row| drop(row.pop())),
        2 => {
            pick(rows, n).and_then(|it| pick(it, k)).into_iter().for_each(|it| *it = number.clone())
        }
        3 if rows.len() > 1 => {
            let most = states.clamp(1, rows.len());
            rows.swap(n % most, k % most);
        }
        4 => until.into_iter().for_each(|it| it.guard.truncate(k)),
        5 => until
            .and_then(|it| pick(&mut it.guard, k))
            .into_iter()
            .for_each(|it| *it = number.clone()),
        6 => until.into_iter().for_each(|it| it.reset.truncate(k)),
        7 => {
            let row = until.and_then(|it| pick(&mut it.reset, k % states.max(1)));
            row.and_then(|it| pick(it, v)).into_iter().for_each(|it| *it = number.clone());
        }
        8 => until.into_iter().for_each(|it| it.reset.reverse()),
        9 => until.into_iter().for_each(|it| it.next.truncate(k % 2)),
        10 => until.and_then(|it| pick(&mut it.next, k)).into_iter().for_each(|it| it.mode = v % 5),
        11 => until.and_then(|it| pick(&mut it.next, k)).into_iter().for_each(|it| it.when = None),
        12 => watch.into_iter().for_each(|it| drop(it.guard.pop())),
        13 => system.start.iter_mut().for_each(|it| it.mode = v % 5),
        14 => system.start.iter_mut().for_each(|it| it.state.truncate(k)),
        15 => system
            .start
            .iter_mut()
            .flat_map(|it| &mut it.state)
            .for_each(|it| it[k % 3] = number.clone()),
        16 => pick(&mut system.scales, n).into_iter().for_each(|it| *it = v as f64 - 2.0),
        17 => system.forcing = None,
        18 => system.modes.truncate(k % 3),
        19 => pick(&mut system.modes, n).into_iter().for_each(|mode| mode.until.clear()),
        _ => {}
    }
}

/// The first events of a run in either direction, none of which panics; whether there was one.
fn run<T: Number>(solver: &Solver<T>, system: &System, enclosed: bool, until: f64) -> bool {
    let Some(start) = &system.start else { return false };
    let until = T::exact(until);
    let run = if enclosed { solver.run_enclosed(start, until) } else { solver.run(start, until) };
    run.is_ok_and(|run| run.take(20).count() > 0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn a_changed_system_is_refused_or_runs(
        which in 0..14_usize,
        changes in prop::collection::vec((0..KINDS, 0..20_usize, 0..20_usize, 0..20_usize), 1..4),
    ) {
        let original = &all_systems()[which];
        let mut system = original.clone();
        changes.into_iter().for_each(|it| change(&mut system, it));
        let begin = system.start.as_ref().map_or(0.0, |it| it.time.to_f64());
        let span = 20.0 * original.time_scale;
        let sides = [(Solver::<f64>::new(&system), span), (Solver::backward(&system), -span)];
        match system.check() {
            Err(error) => {
                for (solver, _) in sides {
                    prop_assert_eq!(solver.map(|_| ()), Err(error.clone()));
                }
            }
            Ok(()) => {
                for (solver, span) in sides {
                    let Ok(solver) = solver else { continue };
                    run(&solver, &system, false, begin + span);
                    run(&solver, &system, true, begin + span);
                }
                let wide = Solver::<DoubleDouble>::new(&system).unwrap();
                prop_assert!(run(&wide, &system, true, begin + span));
            }
        }
        // A start of another system, and of the changed one, is refused or runs.
        let solver = Solver::<f64>::new(original).unwrap();
        run(&solver, &system, false, begin + span);
        run(&solver, &all_systems()[(which + 1) % 14], true, begin + span);
    }
}
