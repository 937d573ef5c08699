//! A phase continued from an evaluation by its series arrives where another evaluation does.

use crate::crossing::Guarded;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::numeric::series::{SHORT_TERMS, TERMS};
use crate::parameters::Parameters;
use crate::state::State;
use proptest::prelude::*;

fn agrees<G: Guarded>(phase: &G, d: f64, share: f64) -> Result<(), TestCaseError> {
    let [few_terms, all] = phase.reaches();
    agrees_by::<G, SHORT_TERMS>(phase, d, share * few_terms)?;
    agrees_by::<G, TERMS>(phase, d, share * all)
}

fn agrees_by<G: Guarded, const N: usize>(
    phase: &G,
    d: f64,
    step: f64,
) -> Result<(), TestCaseError> {
    let (from, to) = (phase.at(d), phase.at(d + step));
    let step = to.elapsed - from.elapsed;
    let series = phase.series::<N>(&from);
    let reached = phase.continued(&from, step, &series, series.value_and_slope(step));
    // Two evaluations, each within the four roundings of its terms that the search grants it.
    let rate = phase.fastest_rate();
    let size = 1.0 + from.guard.largest_term.max(to.guard.largest_term);
    let room = 16.0 * f64::EPSILON * size;
    for (order, (a, b)) in reached.guard.orders.iter().zip(to.guard.orders).enumerate() {
        let scale = rate.powi(order as i32);
        prop_assert!((a - b).abs() <= room * scale, "order {order}: {a:e} {b:e} {room:e}");
    }
    let of = |state: &State| [state.p, state.y, state.q];
    for (a, b) in of(&reached.state).into_iter().zip(of(&to.state)) {
        prop_assert!((a - b).abs() <= room * rate, "state {a:e} {b:e} {room:e}");
    }
    prop_assert!((reached.drift - to.drift).abs() <= room * (1.0 + d), "drift");
    Ok(())
}

proptest! {
    #[test]
    fn a_series_leads_where_an_evaluation_does(
        (xi, omega) in (-6.0..2.5_f64, -2.0..2.0_f64).prop_map(|(x, o)| (x.exp(), o.exp())),
        (y, q, angle) in (-1.0..1.0_f64, 0.0..1.0_f64, 0.0..6.3_f64),
        (d, share) in (0.0..5.0_f64, -1.0..1.0_f64),
    ) {
        let parameters = Parameters { xi, omega, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let d = d + 0.1;
        let angle = EntryAngle { radians: angle, sin: angle.sin(), cos: angle.cos() };
        let entry = State { p: q + 0.02, y, q };
        agrees(&NoContact { constants, entry, angle, surface: None }, d, share)?;
        let offset = 2.0 * xi * y + q;
        agrees(&Contact { constants, entry, angle, offset, reference: 0.0 }, d, share)?;
        let closing = (1.0 - q) / (2.0 * xi);
        let drift_rate = y - closing;
        agrees(&Progression { constants, entry, angle, drift_rate, closing }, d, share)?;
    }
}
