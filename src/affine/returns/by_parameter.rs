//! The derivative of a return map by a parameter.

use super::map::SectionMap;
use super::shooting::{Change, MAX_COORDINATES};
use super::walk::Walk;
use crate::affine::run::parameter::CoefficientRates;
use crate::affine::run::place::Place;
use crate::affine::run::variation::Variation;
use std::sync::Arc;

impl SectionMap<'_, f64> {
    /// The derivative by a parameter of the image of a place, whose states and share of the forcing
    /// period do not depend on it; none where a motion does not return, or has none.
    pub(in crate::affine) fn by_parameter(
        &self,
        place: &Place<f64>,
        rates: &Arc<CoefficientRates<f64>>,
    ) -> Option<Change> {
        let solver = self.solver();
        let mut walk = Walk::beside(self, place);
        let mut variation = Variation::by_parameter(solver, Arc::clone(rates), &place.time);
        let pass = &mut |from: &_, to: &_| variation.pass(solver, from, to);
        let event = walk.next_with_derivative(pass).ok()?;
        let with_period = solver.delay_at_fixed_angle(rates, event.time.value());
        let mut change = [0.0; MAX_COORDINATES];
        let states = event.state.len();
        change[..states].copy_from_slice(&variation.columns[0][..states]);
        match &variation.delays {
            Some(delays) if self.has_times() => change[states] = delays[0] - with_period,
            Some(_) => {}
            None => {
                let motion = solver.rates(event.mode, &event.time, &event.state);
                change[..states]
                    .iter_mut()
                    .zip(motion)
                    .for_each(|(it, by)| *it += by * with_period);
            }
        }
        (0..states).filter(|n| self.is_drift(*n)).for_each(|n| change[n] = 0.0);
        change.iter().all(|it| it.is_finite()).then_some(change)
    }
}
