//! ode_solvers 0.6.2: `Dop853`, of order 8, converges at order 1 where the right-hand side depends
//! on time: its node c12 is 0 and should be 1. With time as a second state its order is 8.

use ode_solvers::{Dop853, OutputType, SVector, System};

struct Cosine;

/// y' = cos t, of which N = 1 uses the library's t and N = 2 a state that is time.
impl<const N: usize> System<f64, SVector<f64, N>> for Cosine {
    fn system(&self, t: f64, y: &SVector<f64, N>, dy: &mut SVector<f64, N>) {
        dy.fill(1.0);
        dy[0] = if N == 1 { t.cos() } else { y[N - 1].cos() };
    }
}

/// Steps of length h from 0 to 10; how far the end is from sin 10.
fn error<const N: usize>(h: f64) -> f64 {
    let (start, loose) = (SVector::<f64, N>::zeros(), 1e9);
    let mut solver = Dop853::from_param(
        Cosine, 0.0, 10.0, h, start, loose, loose, 0.9, 0.0, 0.333, 6.0, h, h, 100_000, 1_000,
        OutputType::Sparse,
    );
    solver.integrate().expect("it succeeds");
    (solver.y_out().last().expect("an end")[0] - 10_f64.sin()).abs()
}

fn main() {
    println!("step    error, t of the library    error, time as a state");
    for h in [0.5, 0.25, 0.125] {
        println!("{h:<7} {:<26.1e} {:.1e}", error::<1>(h), error::<2>(h));
    }
}
