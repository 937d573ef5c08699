//! Whether the digits of an event suffice, beside the sizes that its states have had.

use crate::affine::solver::event::Event;
use crate::numeric::number::{Bound, Number};

/// The largest size of each state so far, beside which a value may be zero.
pub(super) struct Sizes<B>(Vec<B>);

impl<B: Bound> Sizes<B> {
    /// The sizes at the start of a run.
    pub fn new<T: Number<Bound = B>>(start: &Event<T>) -> Self {
        Self(start.state.iter().map(|it| it.bound().abs()).collect())
    }

    /// Adds the sizes of an event, and says whether the time or a state has fewer digits than are
    /// wanted. A value that may be zero has enough of them if it is known that well beside the
    /// largest that the state has had: more bits would not make it another one than zero.
    pub fn have_too_few_digits<T: Number<Bound = B>>(
        &mut self,
        event: &Event<T>,
        digits: usize,
    ) -> bool {
        let Some(errors) = &event.errors else { return false };
        let share = B::from_f64(0.5 * 10_f64.powi(-(digits as i32)));
        let time = event.time.value().bound().abs();
        let mut too_few = time > errors.time && errors.time > time * share;
        for ((value, error), size) in event.state.iter().zip(&errors.state).zip(&mut self.0) {
            let value = value.bound().abs();
            *size = size.max(value);
            let beside = if value > *error { value } else { *size };
            too_few |= *error > beside * share;
        }
        too_few
    }
}
