//! The programs of `programs.toml`, as far as they are installed, on runs that are known.
//!
//! Those that are set up by default are run too: what they miss is what a comparison is for.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a panic is a failure")]

use percuss::{Parameters, Start};
use percuss_engines::case::Given;
use percuss_engines::engine::{
    Accuracy, Engine, Event, Limits, OscillatorTask, Outcome, SampleGrid, Stepping, Task, answer,
};
use percuss_engines::integrators::exact;
use percuss_engines::system::{CheckedSystem, Direction, Mode, System, Until, Watch};
use percuss_programs::ProgramEngine;
use std::path::Path;
use std::sync::Arc;

/// Engines that no set-up makes right, as measured on these two runs.
const WRONG_ENGINES: [&str; 6] = [
    // The root's state comes with a time that is not the root's, the end of the step.
    "desolve-radau",
    // Times of events in the oscillator are off by more than the 200 tolerances that others stay
    // within; an interpolant of a lower order than the steps is the likely reason.
    "arkode-dirk",
    "arkode-erk8",
    "odeint-rosenbrock4",
    // Its error control is absolute: flights of the ball as low as the tolerance are not resolved.
    "octave-ode15s",
    // It misses an impact of the ball; whether the library or its program does is not known.
    "commons-math-gbs",
];

const TOLERANCE: Accuracy = Accuracy::Tolerance(1e-8);
const SPAN: f64 = 3.9;
const SAMPLES: u32 = 50;
/// The relative difference of a state after a reset from the reset of the state before it: of
/// doubles near 1 that are written in decimals, a few units of the last place.
const DECIMAL_TOLERANCE: f64 = 1e-15;

/// A ball with e = 1/2 that is thrown up from the floor; where it is highest is counted.
fn ball() -> Task {
    let impact = Until {
        name: "impact".to_owned(),
        guard: vec![-1.0, 0.0, 0.0, 0.0, 0.0],
        reset: Some(vec![vec![0.0; 5], vec![0.0, -0.5, 0.0, 0.0, 0.0]]),
        next: vec![(None, 0)],
    };
    let top = Watch {
        name: "top".to_owned(),
        guard: vec![0.0, 1.0, 0.0, 0.0, 0.0],
        direction: Direction::Falling,
    };
    let flight = Mode {
        name: "flight".to_owned(),
        a: vec![vec![0.0, 1.0], vec![0.0, 0.0]],
        b: vec![[0.0; 2]; 2],
        c: vec![0.0, -1.0],
        until: vec![impact],
        watch: vec![top],
    };
    let system = System {
        name: "ball".to_owned(),
        states: vec!["x".to_owned(), "v".to_owned()],
        scales: vec![1.0; 2],
        time_scale: 1.0,
        modes: vec![flight],
        ..System::default()
    };
    let system = Arc::new(CheckedSystem::new(system).expect("it is whole"));
    let samples = (0..=SAMPLES).map(|k| SPAN * f64::from(k) / f64::from(SAMPLES)).collect();
    Task::new(system, 0, &[0.0, 1.0], SPAN, samples).expect("it is whole")
}

/// When the ball's flight at a time began, and its speed then.
fn flight(t: f64) -> (f64, f64) {
    let (mut begin, mut speed) = (0.0, 1.0);
    while t > begin + 2.0 * speed {
        begin += 2.0 * speed;
        speed *= 0.5;
    }
    (begin, speed)
}

/// The state before an event's reset: the reset of the ball makes its speed half as large and
/// turns it, and the event that is only counted changes nothing.
fn check_before(found: &Event) -> Result<(), String> {
    let before = found.before.ok_or("it has no state before its reset")?;
    let expected = if found.event == 0 { [0.0, -0.5 * before[1]] } else { [before[0], before[1]] };
    let error = (0..2).map(|i| (found.state[i] - expected[i]).abs()).fold(0.0, f64::max);
    if error <= DECIMAL_TOLERANCE { Ok(()) } else { Err(format!("its state before is {before:?}")) }
}

fn check_ball(outcome: &Outcome, unit: f64) -> Result<(), String> {
    let mut expected = Vec::new();
    let (mut t, mut speed) = (0.0, 1.0);
    while t + 2.0 * speed < SPAN {
        expected.extend([(1, t + speed), (0, t + 2.0 * speed)]);
        t += 2.0 * speed;
        speed *= 0.5;
    }
    for (n, (event, t)) in expected.iter().enumerate() {
        let found = outcome.events.get(n).ok_or(format!("event {n} is missed"))?;
        let error = (found.elapsed - t).abs() / (unit * (1.0 + t) * (n + 1) as f64);
        if found.event != *event || error.is_nan() || error > 20.0 {
            return Err(format!("event {n} is {found:?}, not {event} at {t}"));
        }
        check_before(found).map_err(|why| format!("event {n} is {found:?}: {why}"))?;
    }
    for (k, sample) in outcome.samples.iter().enumerate() {
        let t = SPAN * k as f64 / f64::from(SAMPLES);
        let (begin, speed) = flight(t);
        let height = speed * (t - begin) - 0.5 * (t - begin).powi(2);
        let error = (sample[0] - height).abs();
        if error.is_nan() || error > 40.0 * unit {
            return Err(format!("sample {k} is {sample:?}, {error:e} off"));
        }
    }
    Ok(())
}

/// Four forcing periods of the oscillator from rest.
fn oscillator() -> Task {
    let given =
        Given { parameters: Parameters::default(), start: Start::default(), ..Given::default() };
    let problem = given.check().expect("the default model is accepted");
    let horizon = problem.entry.instant.after_periods(4, 1);
    let grid = SampleGrid { per_period: 4, count: 17 };
    let own = OscillatorTask::until(given.parameters, problem, horizon, grid);
    Task::of_oscillator(&own).expect("it is a system")
}

fn check_oscillator(outcome: &Outcome, truth: &Outcome, unit: f64) -> Result<(), String> {
    let word = |outcome: &Outcome| -> Vec<_> {
        outcome.events.iter().map(|it| (it.event, it.mode)).collect()
    };
    if word(outcome) != word(truth) || truth.events.len() < 5 {
        return Err(format!("the events are {:?}, not {:?}", word(outcome), word(truth)));
    }
    for (found, event) in outcome.events.iter().zip(&truth.events) {
        let error = (found.elapsed - event.elapsed).abs() / (1.0 + event.elapsed);
        if error.is_nan() || error > 200.0 * unit {
            return Err(format!("an event at {} is {error:e} off", event.elapsed));
        }
    }
    for (found, sample) in outcome.samples.iter().zip(&truth.samples) {
        let error = found.iter().zip(sample.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if error.is_nan() || error > 1e4 * unit {
            return Err(format!("a sample {found:?} is {error:e} off"));
        }
    }
    Ok(())
}

fn check(engine: &ProgramEngine, truth: &Outcome) -> Result<(), String> {
    let unit = match engine.declaration().stepping {
        Stepping::Fixed { .. } => return Ok(()),
        stepping => stepping.unit(TOLERANCE),
    };
    let limits = Limits::default();
    let failed = |failure: percuss_engines::engine::Failure| failure.reason;
    let outcome = answer(engine, &ball(), TOLERANCE, &limits).map_err(failed)?;
    check_ball(&outcome, unit).map_err(|why| format!("ball: {why}"))?;
    if outcome.own_time.is_none() || outcome.work.rhs_evaluations == 0 {
        return Err("it counts nothing".to_owned());
    }
    let outcome = answer(engine, &oscillator(), TOLERANCE, &limits).map_err(failed)?;
    check_oscillator(&outcome, truth, unit).map_err(|why| format!("oscillator: {why}"))
}

#[test]
#[ignore = "needs what validation/programs/setup installs"]
fn programs_that_experts_set_up_are_right() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs.toml");
    let programs = percuss_programs::read(&path).expect("the file is right");
    let truth = answer(exact(), &oscillator(), Accuracy::Exact, &Limits::default());
    let truth = truth.expect("the exact solver runs it");
    let is_excused = |name: &str| name.ends_with("-default") || WRONG_ENGINES.contains(&name);
    let (mut wrong, mut right) = (Vec::new(), 0);
    for program in programs {
        let engines = match program.start() {
            Ok(engines) => engines,
            Err(why) => {
                println!("{why}");
                continue;
            }
        };
        for engine in engines {
            let name = engine.declaration().name;
            let checked = check(&engine, &truth);
            println!("{name}: {checked:?}");
            match checked {
                Ok(()) if WRONG_ENGINES.contains(&name) => {
                    wrong.push(format!("{name} is right now"))
                }
                Ok(()) => right += 1,
                Err(why) if !is_excused(name) => wrong.push(format!("{name}: {why}")),
                Err(_) => {}
            }
        }
    }
    assert!(wrong.is_empty() && right > 0, "{right} are right: {wrong:#?}");
}
