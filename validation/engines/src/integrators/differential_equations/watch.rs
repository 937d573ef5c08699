//! The end of each step, where the library hands its interpolant over.

use super::method::{Inside, LibraryMethod};
use super::{ModeField, reason};
use crate::equations::Equations;
use crate::failure::Failure;
use crate::integration::{
    Cubic, CubicEnd, GuardRise, GuardSearch, Moment, Sampler, StateAt, StepEnds, StretchEnd,
};
use differential_equations::control::ControlFlag;
use differential_equations::interpolate::Interpolation;
use differential_equations::solout::Solout;
use differential_equations::solution::Solution;
use differential_equations::traits::State;
use std::marker::PhantomData;

/// Searches each step for the end of the mode, and takes samples on the way.
pub(super) struct StepWatch<'a, M, E: Equations> {
    field: ModeField<'a, E>,
    looks: Looks<'a, E>,
    tolerance: f64,
    span: f64,
    sampler: &'a mut Sampler<E::State>,
    last: E::State,
    ended: Option<Result<StretchEnd<E::State>, Failure>>,
    method: PhantomData<M>,
}

/// The places inside a step at which the guards are looked at.
enum Looks<'a, E: Equations> {
    /// The guards are looked at inside the step, whose interpolant costs nothing.
    Inside(GuardSearch<'a, E>),
    /// The guards are looked at at the step's ends, and inside only where these show something.
    Ends(StepEnds<'a, E>),
}

impl<'a, M: LibraryMethod, E: Equations<State: State<f64>>> StepWatch<'a, M, E> {
    pub(super) fn new(
        field: ModeField<'a, E>,
        from: &Moment<E>,
        (tolerance, span): (f64, f64),
        sampler: &'a mut Sampler<E::State>,
    ) -> Self {
        let search = GuardSearch::new(field.equations, from, field.meter);
        let looks = match M::INSIDE {
            Inside::Again => Looks::Ends(StepEnds::new(search, from)),
            Inside::Interpolant | Inside::Cubic => Looks::Inside(search),
        };
        let (last, ended, method) = (from.state, None, PhantomData);
        Self { field, looks, tolerance, span, sampler, last, ended, method }
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

    fn step(
        &mut self,
        begin: f64,
        right: CubicEnd<E::State>,
        state_at: &mut StateAt<'_, E::State>,
    ) -> Result<Option<StretchEnd<E::State>>, Failure> {
        self.field.meter.steps(1);
        let search = match &mut self.looks {
            Looks::Inside(search) => search,
            Looks::Ends(ends) => {
                return ends.advance(right, self.sampler, |_, _, t| state_at(t));
            }
        };
        let counted = &mut self.sampler.counted;
        let Some(GuardRise { t, guard }) = search.step(begin, right.0, state_at, counted)? else {
            self.sampler.take(right.0, state_at)?;
            return Ok(None);
        };
        self.sampler.take(t, &mut *state_at)?;
        Ok(Some(StretchEnd::Event { t, guard, state: state_at(t)? }))
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
            _ if t <= begin => Ok(*before),
            _ if t >= end => Ok(*state),
            Inside::Interpolant => interpolator.interpolate(t).map_err(|error| reason(&error)),
            Inside::Again => M::again(&field, tolerance, (begin, *before), t),
            Inside::Cubic => Ok(cubic
                .get_or_insert_with(|| {
                    Cubic::between([(begin, *before), (end, *state)], |(t, state), rates| {
                        field.equations.derivatives(field.mode, t, state.as_ref(), rates);
                        field.meter.rhs(rates);
                    })
                })
                .at(t)),
        };
        match self.step(begin, (end, *state), &mut state_at).transpose() {
            None => ControlFlag::Continue,
            ended => {
                self.ended = ended;
                ControlFlag::Terminate
            }
        }
    }
}
