//! differential-equations 0.7.0: the interpolant of `dop853` is worse than its steps, because the
//! factors s and 1 - s of its higher terms are exchanged.

use differential_equations::prelude::*;

struct Decay;

impl ODE<f64, [f64; 1]> for Decay {
    fn diff(&self, _: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        dy[0] = -y[0];
    }
}

/// The largest error at the ends of steps, or inside them.
fn largest(solution: &Solution<f64, [f64; 1]>, ends: bool) -> f64 {
    let chosen = solution.iter().enumerate().filter(|(i, _)| (i % QUARTERS == 0) == ends);
    chosen.map(|(_, (t, y))| (y[0] - (-t).exp()).abs()).fold(0.0, f64::max)
}

/// After the start three points inside each step, and its end.
const QUARTERS: usize = 4;

fn main() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance);
        let run = IVP::ode(&Decay, 0.0, 5.0, [1.0]).dense(QUARTERS).method(method).solve();
        let run = run.expect("it succeeds");
        let (ends, inside) = (largest(&run, true), largest(&run, false));
        print!("tolerance {tolerance:.0e}: ");
        println!("error at ends of steps {ends:.1e}, inside them {inside:.1e}");
    }
}
