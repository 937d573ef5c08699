//! differential-equations 0.7.0 in dual numbers: y' = p y from 1 comes to 2 at T = ln 2/p. A run
//! that starts at T at 1 again has dy/dp = e/2 at the time 1, which is 1.359140914.

use differential_equations::prelude::*;
use num_dual::{Dual64, DualNum};

struct Growth(Dual64);

impl ODE<Dual64, Dual64> for Growth {
    fn diff(&self, _: Dual64, y: &Dual64, out: &mut Dual64) {
        *out = self.0 * *y;
    }
}

impl Event<Dual64, Dual64> for Growth {
    fn config(&self) -> EventConfig {
        EventConfig::new(CrossingDirection::Positive, Some(1))
    }
    fn event(&self, _: Dual64, y: &Dual64) -> Dual64 {
        *y - 2.0
    }
}

fn main() {
    let [zero, one, two] = [0.0, 1.0, 2.0].map(Dual64::from_re);
    let p = Growth(one.derivative());
    let filters: [(&str, fn(Dual64) -> Dual64); 2] = [("", |h| h), ("filter, ", |h| h.re.into())];
    for (tolerance, (name, filter)) in [1e-6, 1e-9].iter().flat_map(|it| filters.map(|f| (it, f))) {
        let to = Dual64::from(*tolerance);
        let method = || ExplicitRungeKutta::dopri5().rtol(to).atol(to).filter(filter);
        let found = IVP::ode(&p, zero, two, one).event(&p).method(method()).solve().unwrap();
        let (t, y) = found.last().unwrap();
        let newton = *t - (*y - two) / (p.0 * *y);
        println!("{name}{tolerance:e}: T = {t:.6}, after a step of Newton {newton:.6}");
        let again = IVP::ode(&p, DualNum::ln(&two) / p.0, one, one);
        let at = again.clone().t_eval([one]).method(method()).solve().unwrap();
        let last = again.method(method()).solve().unwrap();
        println!("  y(1) by t_eval {:.6}, else at {:.6} {:.6}", at.y[0], last.t[1..].last().unwrap(), last.y.last().unwrap());
    }
}
