//! differential-equations 0.7.0 in dual numbers: y' = p y from 1 comes to 2 at T = ln 2/p. A run
//! that starts at T at 1 again has dy/dp = e/2 at the time 1, which is 1.359140914.

use differential_equations::prelude::*;
use num_dual::Dual64;

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
    for (k, (name, filter)) in [6, 9].into_iter().flat_map(|k| filters.map(|it| (k, it))) {
        let to = Dual64::from(0.1_f64.powi(k));
        let method = || ExplicitRungeKutta::dopri5().rtol(to).atol(to).filter(filter);
        let found = IVP::ode(&p, zero, two, one).event(&p).method(method()).solve().unwrap();
        let (t, y) = found.last().unwrap();
        let newton = (*t - (*y - two) / (p.0 * *y)).eps;
        println!("{name}1e-{k}: T {:.6}, dT/dp {:.6}, by Newton {newton:.6}", t.re, t.eps);
        let again = IVP::ode(&p, Dual64::new(2_f64.ln(), -2_f64.ln()), one, one);
        let asked = again.clone().t_eval([one]).method(method()).solve().unwrap().y[0].eps;
        let last = again.method(method()).solve().unwrap().t.pop().unwrap().eps;
        println!("    by t_eval dy/dp {asked:.6}, and that of the last time is {last:.6}");
    }
}
