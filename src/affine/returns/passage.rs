//! Where a motion returns to a section, with the derivative of that.

use super::map::SectionMap;
use super::section::{Guard, Section};
use super::walk::{NoReturn, Returns, Walk};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::events::{self, Answer};
use crate::affine::model::error::SystemError;
use crate::affine::model::system::{LARGEST_DIMENSION, StartPoint};
use crate::affine::run::place::Place;
use crate::affine::run::variation::Variation;
use crate::affine::solver::Solver;
use crate::numeric::number::Number;

/// The image of a place under a return map, with the derivative of that.
#[derive(Clone, Debug)]
pub struct Passage<T> {
    /// The place of the return.
    pub image: Place<T>,
    /// The events on the way, the return's own too.
    pub events: Vec<Guard>,
    /// The changes of the image where each state of the place changes alone: at a fixed time.
    pub at_fixed_time: Vec<Vector<T>>,
    /// The changes of the state at the return itself, whose time changes too.
    pub at_return: Vec<Vector<T>>,
    /// The changes of the return's time; zero at a strobe.
    pub delays: Vec<T>,
    /// Whether rounding left no order of events open: where it did there may be no derivative.
    pub is_decided: bool,
}

impl<A: Answer<Prepared = Solver<A>> + Number> events::Solver<A> {
    /// The return map of a section.
    ///
    /// ```
    /// use percuss::system::Section;
    /// use percuss::{System, gallery};
    ///
    /// let room = System::from_toml(gallery::THERMOSTAT)?;
    /// let solver = room.solver::<f64>()?;
    /// let map = solver.section(&Section::event("switch-off"))?;
    /// let mut returns = map.returns(room.start()?)?;
    /// let first = returns.next().expect("a return").expect("a switch");
    /// assert!((first.state[0] - 21.0).abs() < 1e-12);
    /// // From there Newton's method reaches the cycle: one return, with one event more.
    /// let cycle = map.orbit(&returns.place()?, 1)?;
    /// assert_eq!(cycle.event_names(&room), ["switch-on@off", "switch-off@on"]);
    /// assert!(cycle.is_stable());
    /// // Small changes along the motion stay, and others decay at the rate of the equations.
    /// let exponents = map.exponents(&returns.place()?, 20, 40, &mut |_| ())?;
    /// assert!(exponents.per_time()[0].abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A strobe of a system without forcing, and an event that the system has not.
    pub fn section(&self, section: &Section) -> Result<SectionMap<'_, A>, SystemError> {
        SectionMap::new(self.prepared(), section)
    }
}

impl<T: Number> SectionMap<'_, T> {
    /// The returns of the motion from a start. Where that is a strobe it is the first of them.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn returns(&self, start: &StartPoint) -> Result<Returns<'_, T>, SystemError> {
        Ok(self.returns_from(&self.solver().place(start)?))
    }

    /// The returns of the motion from a place.
    #[must_use]
    pub fn returns_from(&self, place: &Place<T>) -> Returns<'_, T> {
        Returns::begin(self, place)
    }

    /// The returns of the motion from a place, without one at that place itself.
    pub(in crate::affine) fn returns_after(&self, place: &Place<T>) -> Returns<'_, T> {
        Returns::after(self, place)
    }

    /// The next return from a place, with its derivative.
    ///
    /// # Errors
    /// A motion that does not return.
    pub fn passage(&self, place: &Place<T>) -> Result<Passage<T>, NoReturn> {
        let mut walk = Walk::beside(self, place);
        let mut variation = Variation::of_each_state(self.solver());
        let mut crossed = Vec::new();
        let event = walk.next_with_derivative(&mut |from, to| {
            variation.pass(self.solver(), from, to);
            Guard::join_accumulated(&to.what, &mut crossed, |it: &(Guard, Time<T>)| it.0);
            crossed.extend(Guard::new(&to.what).map(|guard| (guard, to.time)));
        })?;
        let onto = walk.place_of_onto_section(crossed.iter().map(|(guard, _)| *guard));
        if let Some(repeated) = onto.or_else(|| self.repeated_at_strobe(&crossed)) {
            crossed.remove(repeated);
        }
        let events = crossed.into_iter().map(|(guard, _)| guard).collect();
        let image = walk.place()?;
        let (at_return, delays) = (variation.columns.clone(), variation.delays.clone());
        variation.settle(self.solver(), &event);
        let delays = delays.unwrap_or_else(|| vec![T::zero(); at_return.len()]);
        let at_fixed_time = variation.columns;
        let is_decided = walk.undecidable() == 0;
        Ok(Passage { image, events, at_fixed_time, at_return, delays, is_decided })
    }

    /// The first event of a way from strobe to strobe, if it is the last one as well: an event at
    /// the strobe itself lies on either side of it by rounding, and belongs to one return.
    fn repeated_at_strobe(&self, crossed: &[(Guard, Time<T>)]) -> Option<usize> {
        let [(first, begun), .., (last, ended)] = crossed else { return None };
        let is_repeated = first == last && [begun, ended].iter().all(|it| self.is_strobe(it));
        is_repeated.then_some(0)
    }

    /// The delays and the changes of an event's place for a change of its time alone: `passage` is
    /// that from the place.
    pub(super) fn by_time(&self, place: &Place<T>, passage: &Passage<T>) -> (Vector<T>, T) {
        let mut change = [T::zero(); LARGEST_DIMENSION];
        let mut delay = T::zero();
        let columns = passage.at_return.iter().zip(&passage.delays);
        for (rate, (column, own)) in self.rates(place).iter().zip(columns) {
            change.iter_mut().zip(column).for_each(|(sum, it)| *sum = *sum - *rate * *it);
            delay = delay - *rate * *own;
        }
        (change, delay)
    }
}
