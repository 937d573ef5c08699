//! ode_solvers 0.6.2: with dense output `Dopri5` calls `solout` with a time and a state that do not
//! belong together.

use ode_solvers::{Dopri5, OutputType, System, Vector1};

struct Decay {
    worst: f64,
}

impl System<f64, Vector1<f64>> for Decay {
    fn system(&self, _: f64, y: &Vector1<f64>, dy: &mut Vector1<f64>) {
        dy[0] = -y[0];
    }

    fn solout(&mut self, t: f64, y: &Vector1<f64>, _: &Vector1<f64>) -> bool {
        let off = (y[0] - (-t).exp()).abs();
        if off > self.worst {
            self.worst = off;
            println!("    at t = {t:.6} solout gets y = {:.6}, exp(-t) = {:.6}", y[0], (-t).exp());
        }
        false
    }
}

fn main() {
    for (name, output) in [("dense", OutputType::Dense), ("sparse", OutputType::Sparse)] {
        println!("{name} output, tolerance 1e-9:");
        let (decay, start) = (Decay { worst: 1e-6 }, Vector1::new(1.0));
        let mut solver = Dopri5::from_param(
            decay, 0.0, 5.0, 0.3, start, 1e-9, 1e-9, 0.9, 0.04, 0.2, 10.0, 5.0, 0.0, 100_000, 1_000,
            output,
        );
        solver.integrate().expect("it succeeds");
    }
}
