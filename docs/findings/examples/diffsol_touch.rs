//! diffsol 0.18.0: roots that come in pairs inside one step are passed over, because the root
//! finder compares signs at the ends of steps. y = sin t exceeds 0.999 for 0.089 in every turn.

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(tolerance)
            .atol([tolerance])
            .rhs(|_, _, t, dy| dy[0] = t.cos())
            .init(|_, _, y| y[0] = 0.0, 1)
            .root(|y, _, _, guard| guard[0] = y[0] - 0.999, 1)
            .build()?;
        let mut solver = problem.tsit45()?;
        solver.set_stop_time(32.0 * std::f64::consts::PI)?;
        let mut roots = 0;
        loop {
            match solver.step()? {
                OdeSolverStopReason::RootFound(..) => {
                    roots += 1;
                    // Without this the root finder keeps its old bracket.
                    let _ = solver.state_mut();
                }
                OdeSolverStopReason::InternalTimestep => {}
                OdeSolverStopReason::TstopReached => break,
            }
        }
        println!("tolerance {tolerance:.0e}: {roots} of 32 roots in 16 turns");
    }
    Ok(())
}
