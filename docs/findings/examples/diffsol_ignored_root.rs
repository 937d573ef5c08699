//! diffsol 0.18.0: a program that goes on with `step` after a root, without touching the state,
//! passes the stop time, and `step` panics there.

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(1e-6)
        .atol([1e-6])
        .rhs_implicit(|_, _, t, dy| dy[0] = t.cos(), |_, _, _, _, dw| dw[0] = 0.0)
        .init(|_, _, y| y[0] = 0.0, 1)
        .root(|_, _, t, g| (0..20).for_each(|i| g[i] = t - 0.5 * (i + 1) as f64), 20)
        .build()?;
    let mut solver = problem.bdf::<NalgebraLU<f64>>()?;
    solver.set_stop_time(10.0)?;
    while solver.step()? != OdeSolverStopReason::TstopReached {}
    println!("stopped at t = {}", solver.state().t);
    Ok(())
}
