//! differential-equations 0.7.0: `radau5` takes steps with matrices that were factorised for steps
//! of another length. The error that a step adds is known here: the flow is linear.

use differential_equations::prelude::*;

struct Forced;

impl ODE<f64, [f64; 2]> for Forced {
    fn diff(&self, t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        *dy = [y[1], 0.3 * (5.0 * t).cos() - y[0]];
    }
}

/// The largest step of a fixed ratio: so large that no matrices are kept from one step to the next.
fn power_of_ratio(h: f64) -> f64 {
    1.25f64.powf((h.ln() / 1.25f64.ln() + 1e-9).floor())
}

/// The median and the largest error that a step adds, in units of the tolerance.
fn errors(tolerance: f64, filter: fn(f64) -> f64) -> String {
    let method = ImplicitRungeKutta::radau5().rtol(tolerance).atol(tolerance).filter(filter);
    let run = IVP::ode(&Forced, 0.0, 200.0, [1.0, 0.0]).method(method).solve();
    let points: Vec<_> = run.expect("it succeeds").iter().map(|(t, y)| (*t, *y)).collect();
    let steady = |t: f64| [(5.0 * t).cos(), -5.0 * (5.0 * t).sin()].map(|x| 0.3 / (1.0 - 25.0) * x);
    let added = |ends: &[(f64, [f64; 2])]| {
        let [(t0, y0), (t1, y1)] = [ends[0], ends[1]];
        let ([p, v], [after, _], (sin, cos)) = (steady(t0), steady(t1), (t1 - t0).sin_cos());
        (y1[0] - ((y0[0] - p) * cos + (y0[1] - v) * sin + after)).abs() / tolerance
    };
    let mut errors: Vec<f64> = points.windows(2).map(added).collect();
    errors.sort_by(f64::total_cmp);
    format!("{:.1} (median), {:.1} (worst)", errors[errors.len() / 2], errors[errors.len() - 1])
}

fn main() {
    for tolerance in [1e-6, 1e-8, 1e-10] {
        println!("tolerance {tolerance:.0e}: a step adds {} tolerances", errors(tolerance, |h| h));
        println!("    with steps of fixed ratios {}", errors(tolerance, power_of_ratio));
    }
}
