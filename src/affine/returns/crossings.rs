//! The events of a motion on its way to the next return, with the rates at which guards are
//! crossed.

use super::map::SectionMap;
use super::section::Guard;
use super::walk::{NoReturn, Walk};
use crate::affine::run::place::Place;
use crate::affine::run::variation::is_at_once;
use crate::affine::solver::event::Event;

/// An event of a motion.
#[derive(Clone, Debug)]
pub(in crate::affine) struct Crossing {
    pub guard: Guard,
    /// The time since the place from which the motion was followed.
    pub time: f64,
    /// The rate of the guard as it is crossed; infinite for an event at the entry of its mode.
    pub rate: f64,
    /// The size of the states' rates there, in their units.
    pub speed: f64,
}

impl SectionMap<'_, f64> {
    /// The events on the way from a place to the next return, that of the return too.
    ///
    /// # Errors
    /// A motion that does not return.
    pub(in crate::affine) fn crossings(
        &self,
        place: &Place<f64>,
    ) -> Result<Vec<Crossing>, NoReturn> {
        let mut walk = Walk::beside(self, place);
        let mut crossings = Vec::new();
        walk.next(&mut |from, to| {
            Guard::join_accumulated(&to.what, &mut crossings, |it: &Crossing| it.guard);
            if let Some(guard) = Guard::new(&to.what) {
                let time = to.time.since(&place.time).value();
                let [rate, speed] = self.rates_of(guard, from, to);
                crossings.push(Crossing { guard, time, rate, speed });
            }
        })?;
        if let Some(onto) = walk.place_of_onto_section(crossings.iter().map(|it| it.guard)) {
            crossings.remove(onto);
        }
        Ok(crossings)
    }

    /// The rate of a guard just before the event that it is, and the size of the states' rates.
    fn rates_of(&self, guard: Guard, from: &Event<f64>, to: &Event<f64>) -> [f64; 2] {
        if is_at_once(from, to) {
            return [f64::INFINITY, 1.0];
        }
        let row = (guard.mode, guard.place_among_all(self.system()));
        let state = self.solver().state_at(from, &to.time);
        let [_, rate, _] = self.solver().guard_and_rate(row, &to.time, &state);
        let rates = self.solver().rates(guard.mode, &to.time, &state);
        let scaled = rates[..state.len()].iter().zip(self.units()).map(|(it, unit)| it / unit);
        [rate, scaled.map(|it| it * it).sum::<f64>().sqrt()]
    }
}
