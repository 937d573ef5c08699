//! The end of each step, where the library hands its interpolant over.

use super::method::{Inside, LibraryMethod};
use super::{ModeField, reason};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{Cubic, GuardSearch, Moment, Sampler, StepEnds, StretchEnd};
use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;
use differential_equations::traits::State;
use std::marker::PhantomData;

/// Searches each step for the end of the mode, and takes samples on the way.
pub(super) struct StepWatch<'a, M, E: Equations> {
    field: ModeField<'a, E>,
    ends: StepEnds<'a, E>,
    tolerance: f64,
    span: f64,
    sampler: &'a mut Sampler<E::State>,
    last: E::State,
    ended: Option<Result<StretchEnd<E::State>, Failure>>,
    method: PhantomData<M>,
}

impl<'a, M: LibraryMethod, E: Equations<State: State<f64>>> StepWatch<'a, M, E> {
    pub(super) fn new(
        field: ModeField<'a, E>,
        from: &Moment<E>,
        (tolerance, span): (f64, f64),
        sampler: &'a mut Sampler<E::State>,
    ) -> Self {
        let search = GuardSearch::new(field.equations, from, field.meter);
        let ends = StepEnds::new(search, from, M::INSIDE == Inside::Again);
        let (last, ended, method) = (from.state, None, PhantomData);
        Self { field, ends, tolerance, span, sampler, last, ended, method }
    }

    /// The ending of the stretch, once the library has returned.
    pub(super) fn ended(
        self,
        solved: Result<(), Failure>,
    ) -> Result<StretchEnd<E::State>, Failure> {
        match self.ended {
            Some(ended) => ended,
            None => solved.map(|()| StretchEnd::Inside { t: self.span, state: self.last }),
        }
    }
}

impl<M: LibraryMethod, E: Equations<State: State<f64>>> Solout<f64, E::State>
    for StepWatch<'_, M, E>
{
    fn solout<I>(
        &mut self,
        end: f64,
        begin: f64,
        state: &E::State,
        before: &E::State,
        interpolator: &mut I,
        _: &mut Solution<f64, E::State>,
    ) -> ControlFlag<f64, E::State>
    where
        I: Interpolation<f64, E::State> + ?Sized,
    {
        if end <= begin {
            // The call before the first step.
            return ControlFlag::Continue;
        }
        self.last = *state;
        let (field, tolerance) = (self.field, self.tolerance);
        let mut cubic: Option<Cubic<E::State>> = None;
        let mut state_at = |t: f64| match M::INSIDE {
            Inside::Interpolant => interpolator.interpolate(t).map_err(|error| reason(&error)),
            Inside::Again => M::recomputed_state(&field, tolerance, (begin, *before), t),
            Inside::Cubic => Ok(cubic
                .get_or_insert_with(|| {
                    Cubic::between([(begin, *before), (end, *state)], |(t, state), rates| {
                        field.equations.derivatives(field.mode, t, state.as_ref(), rates);
                        field.meter.rhs(rates);
                    })
                })
                .at(t)),
        };
        field.meter.steps(1);
        match self.ends.advance((end, *state), self.sampler, |_, _, t| state_at(t)).transpose() {
            None => ControlFlag::Continue,
            ended => {
                self.ended = ended;
                ControlFlag::Terminate
            }
        }
    }
}
