//! The exact solver as the harness runs it, and the problems that cases pose.

use percuss::lanes::Instructions;
use percuss_validation::case::{Case, OscillatorCase, Problem, embedded};
use percuss_validation::engine::{
    Accuracy, Engine, Failure, Limits, OscillatorTask, Outcome, Task, answer,
};
use percuss_validation::integrators::all;
use percuss_validation::suite::{PreparedCase, Suite, prepare};
use percuss_validation::truth::Library;

fn engine() -> &'static dyn Engine {
    let mut engines = all().iter().copied();
    engines.find(|engine| engine.declaration().name == "exact").expect("it is an engine")
}

/// Runs a task.
pub fn run(task: &Task) -> Result<Outcome, Failure> {
    answer(engine(), task, Accuracy::Exact, &Limits::default())
}

/// Runs a task by these instructions.
pub fn run_in_lanes(by: Instructions, task: &Task) -> Outcome {
    let task = own(task);
    percuss_validation::integrators::run_in_lanes(by, task, 1).pop().expect("one motion")
}

/// A task in the oscillator's own words.
pub fn own(task: &Task) -> &OscillatorTask {
    task.of_the_oscillator().expect("it is a task of the oscillator")
}

/// The embedded case of this name.
pub fn case(name: &str) -> Case {
    let cases = embedded().expect("the cases are read");
    cases.into_iter().find(|case| case.name == name).expect("the case is there")
}

/// The embedded cases in the oscillator's own words.
pub fn of_oscillator() -> Vec<Case> {
    let cases = embedded().expect("the cases are read").into_iter();
    cases.filter(|case| case.oscillator.is_some()).collect()
}

/// The embedded cases of systems.
pub fn of_systems() -> Vec<Case> {
    let cases = embedded().expect("the cases are read").into_iter();
    cases.filter(|case| case.oscillator.is_none()).collect()
}

/// The embedded cases of systems whose names are accepted, without restarts.
pub fn prepared_systems(accepts: impl Fn(&str) -> bool) -> Vec<PreparedCase> {
    systems(accepts, None)
}

/// The embedded cases of systems whose names are accepted, with the restarts of the quick suite.
pub fn probed_systems(accepts: impl Fn(&str) -> bool) -> Vec<PreparedCase> {
    systems(accepts, Some(Suite::Quick))
}

fn systems(accepts: impl Fn(&str) -> bool, probes: Option<Suite>) -> Vec<PreparedCase> {
    of_cases(of_systems().into_iter().filter(|case| accepts(&case.name)).collect(), probes)
}

/// The embedded cases whose names are accepted, with the probes of a suite if one is given.
pub fn prepared(accepts: impl Fn(&str) -> bool, probes: Option<Suite>) -> Vec<PreparedCase> {
    let cases = embedded().expect("the cases are read").into_iter();
    of_cases(cases.filter(|case| accepts(&case.name)).collect(), probes)
}

fn of_cases(cases: Vec<Case>, probes: Option<Suite>) -> Vec<PreparedCase> {
    let library = Library::embedded().expect("the tables are read");
    prepare(cases, &library, probes).expect("the cases are made ready")
}

/// A case's model at its start.
pub fn problem(case: &Case) -> Problem {
    case.of_oscillator().expect("it is of the oscillator").problem
}

/// The case of another problem, with its other words.
pub fn with_problem(case: &Case, problem: Problem) -> Case {
    let own = case.of_oscillator().expect("it is of the oscillator");
    let run = Case::of_run(problem, own.horizon).expect("the system takes it");
    let words = |it| OscillatorCase { regime: own.regime.clone(), probed: own.probed, ..it };
    let oscillator = run.oscillator.map(words);
    Case { name: case.name.clone(), file: case.file.clone(), oscillator, ..run }
}
