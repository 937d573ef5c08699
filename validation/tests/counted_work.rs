//! What the engines count: right-hand sides, Jacobians, linear solves and steps belong together.

use crate::exact;
use percuss_validation::engine::{
    Accuracy, Engine, Limits, OscillatorTask, Outcome, SampleGrid, Stepping, Task, answer,
};
use percuss_validation::integrators::all;

fn outcome(engine: &dyn Engine) -> Outcome {
    let case = exact::case("chaos-from-rest");
    let task = OscillatorTask::new(
        case.of_oscillator().expect("it is one"),
        SampleGrid { per_period: 4, count: 161 },
    );
    let task = Task::of_oscillator(&task).expect("it is a system");
    answer(engine, &task, loose(engine), &Limits::default()).expect("it runs")
}

fn loose(engine: &dyn Engine) -> Accuracy {
    match engine.declaration().stepping {
        Stepping::Exact => Accuracy::Exact,
        Stepping::Fixed { .. } => Accuracy::Step(0.25),
        _ => Accuracy::Tolerance(1e-6),
    }
}

/// What is known beforehand of a run's work is never more than what the run takes, or a row that
/// the budget allows would not be run. It is most of the work where nothing happens but that steps
/// are short.
#[test]
fn the_least_work_is_a_lower_bound() {
    let mut largest: f64 = 0.0;
    for case in exact::prepared_systems(|_| true) {
        for engine in all().iter().filter(|engine| engine.takes(&case.task).is_ok()) {
            let least = case.least_work(*engine, loose(*engine));
            if !(1.0..1e5).contains(&least) {
                continue;
            }
            let limits = Limits { calls: 3_000_000, ..Limits::default() };
            let Ok(found) = answer(*engine, &case.task, loose(*engine), &limits) else {
                continue;
            };
            let share = least / found.work.rhs_evaluations as f64;
            let name = engine.declaration().name;
            assert!(share <= 1.0, "{name} on {}: {least}, {:?}", case.case.name, found.work);
            largest = largest.max(share);
        }
    }
    assert!(largest > 0.5, "{largest}");
}

/// Each right-hand side of a multistep method is one of Newton's iterations, which solves one
/// system, but for those that begin a phase (four in diffsol: one of ours and three that choose the
/// first step) and those of Hermite's cubic in differential-equations, at both ends of a step that
/// a state inside is asked of.
#[test]
fn newtons_iterations_solve_one_system_each() {
    for engine in all() {
        let (name, found) = (engine.declaration().name, outcome(*engine));
        let work = found.work;
        let phases = found.events.len() as u64 + 1;
        let iterations = work.rhs_evaluations.saturating_sub(4 * phases);
        match name {
            "diffsol-bdf" => assert_eq!(work.linear_solves, iterations, "{work:?}"),
            // An estimate of the error for each step, also for those that are rejected.
            "diffsol-tr_bdf2" | "diffsol-esdirk34" => {
                let estimates = work.linear_solves - iterations;
                assert!(
                    (work.steps..work.steps + work.steps / 10).contains(&estimates),
                    "{work:?}"
                );
            }
            "differential-equations-bdf" => {
                let of_cubics = work.rhs_evaluations - phases - work.linear_solves;
                assert!(of_cubics.is_multiple_of(2), "{work:?}");
                assert!((2 * (phases - 1)..work.steps).contains(&of_cubics), "{work:?}");
            }
            // The library decomposes its matrix anew for each system.
            "differential-equations-kvaerno745" => {
                assert_eq!(work.linear_solves, work.jacobian_evaluations, "{work:?}");
            }
            // A real and a complex system for three right-hand sides, and one an estimate.
            "differential-equations-radau5" => {
                assert!(work.linear_solves > 2 * work.steps, "{work:?}");
                assert!(work.linear_solves < work.rhs_evaluations, "{work:?}");
            }
            _ => assert_eq!((work.linear_solves, work.jacobian_evaluations), (0, 0), "{name}"),
        }
    }
}
