//! differential-equations 0.7.0: of two events inside one step that both end the run, the one that
//! was added first ends it, not the one that comes first.

use differential_equations::prelude::*;

struct Line;

impl ODE<f64, [f64; 1]> for Line {
    fn diff(&self, _: f64, _: &[f64; 1], dy: &mut [f64; 1]) {
        dy[0] = 1.0;
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
    let (two, three) = (Level(2.0), Level(3.0));
    let run = |first: &Level, second: &Level| {
        let method = ExplicitRungeKutta::rkv655e().h0(10.0).rtol(1e-9).atol(1e-9);
        let run = IVP::ode(&Line, 0.0, 10.0, [0.0]).event(first).event(second);
        let run = run.method(method).solve();
        let end = *run.expect("it succeeds").t.last().expect("an event");
        println!("added y = {} and then y = {}: the run ends at t = {end:.6}", first.0, second.0);
    };
    run(&two, &three);
    run(&three, &two);
}
