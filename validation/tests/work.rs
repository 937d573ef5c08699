//! What the engines count: right-hand sides, Jacobians, linear solves and steps belong together.

use crate::exact;
use percuss_validation::engine::{
    Accuracy, Engine, Limits, Outcome, SampleGrid, Stepping, Task, all,
};

fn outcome(engine: &dyn Engine) -> Outcome {
    let case = exact::case("chaos-from-rest");
    let task = Task::of(&case, exact::problem(&case), SampleGrid { per_period: 4, count: 161 });
    let accuracy = match engine.declaration().stepping {
        Stepping::Exact => Accuracy::Exact,
        Stepping::Fixed { .. } => Accuracy::Step(0.25),
        _ => Accuracy::Tolerance(1e-6),
    };
    engine.run(&task, accuracy, &Limits::default()).expect("it runs")
}

/// Each right-hand side of a multistep method is one of Newton's iterations, which solves one
/// system, but for those that begin a phase (four in diffsol: one of ours and three that choose the
/// first step) and those of Hermite's cubic at both ends of a step in differential-equations.
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
                let solves = work.rhs_evaluations - phases - 2 * work.steps;
                assert_eq!(work.linear_solves, solves, "{work:?}");
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
