//! differential-equations 0.7.0: the built-in location of an event on a convex guard ends far from
//! the root, whatever the tolerance: its Brent-Dekker iteration loses the other end of the bracket.

use differential_equations::prelude::*;

struct Growth;

impl ODE<f64, [f64; 1]> for Growth {
    fn diff(&self, _: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        dy[0] = y[0];
    }
}

/// y rises to a level.
struct Level(f64);

impl Event<f64, [f64; 1]> for Level {
    fn config(&self) -> EventConfig {
        EventConfig::new(CrossingDirection::Positive, Some(1))
    }

    fn event(&self, _: f64, y: &[f64; 1]) -> f64 {
        y[0] - self.0
    }
}

fn main() {
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let mut off = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0].map(|level| {
            let method = ExplicitRungeKutta::rkv655e().rtol(tolerance).atol(tolerance);
            let event = Level(level);
            let run = IVP::ode(&Growth, 0.0, 5.0, [1.0]).event(&event).method(method).solve();
            (run.expect("it succeeds").t.last().expect("an event") - level.ln()).abs()
        });
        off.sort_by(f64::total_cmp);
        print!("tolerance {tolerance:.0e}: ");
        println!("time off by {:.1e} (median), {:.1e} (worst)", off[4], off[8]);
    }
}
