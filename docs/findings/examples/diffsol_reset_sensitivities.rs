//! diffsol 0.18.0: after a reset, sensitivities go on with the rates that they had before it.
//! y' = p y from 1 goes back to 1 at y = 2, once up to t = 1: dy/dp is e/2 there.

use diffsol::OdeSolverStopReason::{InternalTimestep, RootFound, TstopReached};
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};

macro_rules! end {
    ($solver:expr, $repaired:expr) => {{
        let mut solver = $solver.unwrap();
        solver.set_stop_time(1.0).unwrap();
        loop {
            match solver.step().unwrap() {
                InternalTimestep => continue,
                TstopReached => break solver.state().s[0],
                RootFound(t, _) => solver.state_mut_back(t).unwrap(),
            }
            solver.apply_reset_with_sens(0).unwrap();
            let state = solver.state_mut();
            state.ds[0] = if $repaired { state.s[0] + state.y[0] } else { state.ds[0] };
            solver.set_stop_time(1.0).unwrap();
        }
    }};
}

fn main() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let it = OdeBuilder::<NalgebraMat<f64>>::new().p([1.0]).rtol(tolerance).atol([tolerance]);
        let rate = |y: &[f64], p: &[f64], _, f: &mut [f64]| f[0] = p[0] * y[0];
        let by_p = move |y: &[f64], _: &[f64], t, v: &[f64], f: &mut [f64]| rate(y, v, t, f);
        let it = it.rhs_sens_implicit(rate, move |_, p, t, v, f| rate(v, p, t, f), by_p);
        let it = it.init_sens(|_, _, y| y[0] = 1.0, |_, _, _, f| f[0] = 0.0, 1);
        let times = |k| move |_: &[f64], _: &[f64], _, v: &[f64], f: &mut [f64]| f[0] = k * v[0];
        let (own, none) = (times(1.0), times(0.0));
        let it = it.root_sens_implicit(|y, _, _, r| r[0] = y[0] - 2.0, own, none, 1);
        let it = it.reset_sens_implicit(|_, _, _, y| y[0] = 1.0, none, none).build().unwrap();
        let rk = [false, true].map(|repaired| end!(it.tsit45_sens(), repaired));
        let bdf = [false, true].map(|repaired| end!(it.bdf_sens::<NalgebraLU<f64>>(), repaired));
        println!("{tolerance:e}: tsit45 {rk:.9?}, bdf {bdf:.9?}");
    }
}
