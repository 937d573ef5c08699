//! differential-equations 0.7.0: `bdf` chooses a first step below rounding, and a longest step
//! makes its answers worse: its differences are rescaled as if the step had not been shortened.

use differential_equations::prelude::*;

struct Oscillator;

impl ODE<f64, [f64; 2]> for Oscillator {
    fn diff(&self, _: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        *dy = [y[1], -y[0]];
    }
}

/// The error after ten units of time from t = 1000, with a first and a longest step; 0 is none.
fn error(tolerance: f64, first: f64, longest: f64) -> String {
    let method = BackwardDifferentiationFormula::adaptive().rtol(tolerance).atol(tolerance);
    let method = method.h0(first).h_max(longest).max_steps(1_000_000);
    match IVP::ode(&Oscillator, 1000.0, 1010.0, [1.0, 0.0]).method(method).solve() {
        Ok(run) => format!("{:.1e}", (run.y.last().expect("an end")[0] - 10f64.cos()).abs()),
        Err(error) => format!("{error:?}").split(" at ").next().unwrap_or_default().to_owned(),
    }
}

fn main() {
    for tolerance in [1e-6_f64, 1e-9, 1e-12] {
        let first = 1e-4 * tolerance.sqrt();
        println!("tolerance {tolerance:.0e}: {}", error(tolerance, 0.0, f64::INFINITY));
        println!("    given its first step {}", error(tolerance, first, f64::INFINITY));
        println!("    given its first step and a longest one {}", error(tolerance, first, 0.003));
    }
}
