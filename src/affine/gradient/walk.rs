//! The derivatives of a run's events, one event after the other.

use super::ball::{Ball, Jet, applied, dot};
use super::coefficients::{ModeJets, guard_of};
use super::derivative::{Gradient, NoGradient, Side};
use super::exponential::exponential;
use super::first_order::{FirstOrder, InstantZeros, StartZeros, VariedRow};
use super::start::{StartRows, at_angle, independent, nearby_values};
use super::unmoved::Unmoved;
use crate::affine::arithmetic::clock::Time;
use crate::affine::model::system::StartPoint;
use crate::affine::model::tangent::Tangent;
use crate::affine::run::Run;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Ending, Event, What};
use crate::numeric::number::{Bound, Number};
use std::sync::Arc;

/// The derivatives along a run.
#[derive(Clone)]
pub struct Walk<'a, T: Number> {
    pub(super) solver: &'a Solver<T>,
    pub(super) tangent: Arc<Tangent>,
    pub(super) modes: Vec<ModeJets<T>>,
    pub(super) zeros: FirstOrder,
    unmoved: Unmoved,
    /// The mode, time and state of the last event, with derivatives.
    pub(super) mode: usize,
    time: Time<T>,
    time_error: T::Bound,
    time_rate: Ball<T>,
    pub(super) state: Vec<Jet<T>>,
    /// The guards of `until` that fire at the entry, as bits.
    pub(super) fires: u64,
    /// The event that ended the last mode: a mode and its `until`.
    entered_by: Option<[usize; 2]>,
    /// Whether the system's conditions have chosen the mode of the start.
    is_chosen_at_start: bool,
    /// Whether the last event is a sample, whose time does not move with the name.
    is_sampled: bool,
    /// The side of the name's value on which the derivatives are, if they are not those of both.
    pub(super) side: Option<Side>,
    /// The reason for which the next event has no derivative, if it has none.
    refused: Option<NoGradient>,
}

impl<'a, T: Number> Walk<'a, T> {
    /// The derivatives of a run of a solver from a start, which is this event: the tangent has
    /// those of the start. None for a run back in time, and where a coefficient is too long.
    #[must_use]
    pub fn new(
        solver: &'a Solver<T>,
        tangent: &Arc<Tangent>,
        point: &StartPoint,
        start: &Event<T>,
    ) -> Option<Self> {
        let (system, rates) = (solver.system(), tangent.start.as_ref()?);
        if solver.is_backward() {
            return None;
        }
        let rows = StartRows::new(system, tangent, [point, rates]);
        let is_at_zero = system.is_at_zero_angle(point);
        let [z, s] = [&rows.values, &rows.slopes].map(|it| independent(it, is_at_zero));
        let beside = tangent.nearby.as_ref();
        let nearby = beside.and_then(|it| nearby_values(it));
        let zeros = FirstOrder::at_start(
            [&system.modes, &tangent.modes],
            beside.map(|it| &it.modes[..]),
            start.mode,
            &StartZeros { s: &s, z: &z, nearby: nearby.as_deref() },
        )?;
        let modes = system.modes.iter().zip(&tangent.modes).map(ModeJets::new).collect();
        let mut own = Self {
            solver,
            tangent: Arc::clone(tangent),
            modes,
            zeros,
            unmoved: Unmoved::new(system, tangent, point),
            mode: start.mode,
            time: start.time,
            time_error: T::Bound::ZERO,
            time_rate: Ball::new(&rates.time),
            state: Vec::new(),
            fires: 0,
            entered_by: None,
            is_chosen_at_start: !tangent.start_modes.is_empty(),
            is_sampled: false,
            side: None,
            refused: None,
        };
        let values = own.values(start);
        let angle = own.angle(start);
        let slopes = rows.slopes.iter().map(|it| at_angle(it, &angle));
        own.state =
            values.iter().zip(slopes).map(|(value, rate)| Jet { value: *value, rate }).collect();
        own.refused = own.check_begun().err();
        Some(own)
    }

    /// Whether the next event has derivatives of one side at most.
    #[must_use]
    pub fn is_one_sided(&self) -> bool {
        self.side.is_none() && self.refused == Some(NoGradient::OneSided)
    }

    /// A copy of this walk, from its last event on, whose derivatives hold for only the smaller or
    /// only the larger values of the parameter or start state.
    #[must_use]
    pub fn on_side(&self, side: Side) -> Self {
        let mut own = Self { side: Some(side), ..self.clone() };
        own.refused = own.check_begun().err();
        own
    }

    /// Refuses a segment that does not begin in the same way to first order.
    fn check_begun(&mut self) -> Result<(), NoGradient> {
        if let Some([mode, until]) = self.entered_by {
            self.check_successor(mode, until)?;
        } else if self.is_chosen_at_start {
            self.check_start_mode()?;
        }
        self.check_entry()
    }

    /// The derivatives of the start.
    #[must_use]
    pub fn start(&self) -> Gradient<T> {
        self.gradient(self.time_rate)
    }

    /// The derivatives of the event that a run has just returned, or of a sample at its horizon.
    ///
    /// # Errors
    /// An event that has none, and each after it.
    pub fn step(&mut self, event: &Event<T>, run: &Run<'_, T>) -> Result<Gradient<T>, NoGradient> {
        let is_moved = |(mode, guard)| !self.unmoved.has_row(&self.guard(mode, guard));
        if run.touched_guards().any(is_moved) {
            self.refused = self.refused.or(Some(NoGradient::Touch));
        } else if run.work().undecidable > 0 {
            self.refused = self.refused.or(Some(NoGradient::Undecided));
        } else if run.is_silent() && event.what == What::End(Ending::Horizon) {
            self.refused = self.refused.or(Some(NoGradient::Accumulation));
        }
        if let Some(refused) = self.refused {
            return Err(refused);
        }
        let followed = self.follow(event);
        self.is_sampled = event.what == What::End(Ending::Horizon);
        self.refused = self.refused.or(followed.err());
        followed.map(|()| self.gradient(self.time_rate))
    }

    fn follow(&mut self, event: &Event<T>) -> Result<(), NoGradient> {
        match event.what {
            What::Until(mode, until) => self.until(event, mode, until),
            What::Watch(mode, watch) => {
                let guard = self.solver.system().modes[mode].until.len() + watch;
                self.cross(event, guard)?;
                self.replace_values(event);
                Ok(())
            }
            What::End(Ending::Horizon) => self.given_time(event),
            What::Limit(..) => Err(NoGradient::Accumulation),
            What::End(Ending::Undecided | Ending::LeavesDomain) | What::Start => {
                Err(NoGradient::Unknown)
            }
            // Time and state of other endings are those of the last event.
            What::End(_) => Ok(()),
        }
    }

    fn gradient(&self, time_rate: Ball<T>) -> Gradient<T> {
        let pair = |it: Ball<T>| (it.middle, it.radius);
        let states = self.solver.system().states.len();
        let state = self.state[..states].iter().map(|it| pair(it.rate)).collect();
        Gradient { time: pair(time_rate), state }
    }

    /// Ends the mode by an `until`.
    fn until(&mut self, event: &Event<T>, mode: usize, until: usize) -> Result<(), NoGradient> {
        let at_entry = self.fires >> until & 1 == 1;
        let zeros = if at_entry {
            self.zeros.with_guard(&self.guard(mode, until), true).ok_or(NoGradient::Unknown)?
        } else {
            self.cross(event, until)?
        };
        self.state = applied(&self.modes[mode].resets[until], &self.state);
        self.zeros.enter(&zeros, [mode, until], event.mode);
        self.mode = event.mode;
        self.replace_values(event);
        // The event itself has its derivatives, whatever begins with it.
        self.entered_by = Some([mode, until]);
        self.refused = self.check_begun().err();
        Ok(())
    }

    /// Moves to the instant at which a guard crosses.
    fn cross(&mut self, event: &Event<T>, guard: usize) -> Result<InstantZeros, NoGradient> {
        self.move_to(event)?;
        let rate = applied(&self.modes[self.mode].matrix, &self.state);
        let own = &self.modes[self.mode].guards[guard];
        let shift = dot(own, &self.state).rate.negative();
        let later = shift.over(dot(own, &rate).value).ok_or(NoGradient::Undecided)?;
        self.shift(&rate, later);
        self.time_rate = self.time_rate.plus(later);
        let zeros = self.zeros.with_guard(&self.guard(self.mode, guard), false);
        let zeros = zeros.ok_or(NoGradient::Unknown)?;
        self.check_others(guard, &zeros)?;
        Ok(zeros)
    }

    /// Moves to the horizon, which does not move with the name.
    fn given_time(&mut self, event: &Event<T>) -> Result<(), NoGradient> {
        let elapsed = self.elapsed(event);
        if elapsed.middle == T::zero() && self.time_error == T::Bound::ZERO {
            // The horizon is the start, which has to be there for all values of the name.
            let stays = self.time_rate.size() == T::Bound::ZERO;
            return if stays { Ok(()) } else { Err(NoGradient::OneSided) };
        }
        // An event may be at the horizon itself; a sample that is there is the same state.
        if !self.is_sampled {
            elapsed.sign().ok_or(NoGradient::Undecided)?;
        }
        self.move_to(event)?;
        self.replace_values(event);
        let rate = applied(&self.modes[self.mode].matrix, &self.state);
        self.shift(&rate, self.time_rate.negative());
        self.time_rate = Ball::zero();
        self.check_along()
    }

    /// Adds to the derivatives what the motion makes in a time that moves with the name.
    fn shift(&mut self, rate: &[Jet<T>], later: Ball<T>) {
        for (entry, rate) in self.state.iter_mut().zip(rate) {
            entry.rate = entry.rate.plus(rate.value.times(later));
        }
    }

    fn elapsed(&self, event: &Event<T>) -> Ball<T> {
        let Time { high, low } = event.time.since(&self.time);
        let error = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        Ball::exact(high).plus(Ball::within(low, self.time_error + error))
    }

    /// Moves values and derivatives by the time to an event, as if that were fixed.
    fn move_to(&mut self, event: &Event<T>) -> Result<(), NoGradient> {
        let elapsed = self.elapsed(event);
        let matrix = &self.modes[self.mode].matrix;
        let flow = exponential(matrix, elapsed).ok_or(NoGradient::Unknown)?;
        self.state = applied(&flow, &self.state);
        self.time = event.time;
        self.time_error = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        Ok(())
    }

    /// Takes the values of an event, whose errors are smaller than those of one segment's motion.
    fn replace_values(&mut self, event: &Event<T>) {
        let values = self.values(event);
        for (entry, value) in self.state.iter_mut().zip(values) {
            entry.value = value;
        }
    }

    /// The entries of z at an event.
    fn values(&self, event: &Event<T>) -> Vec<Ball<T>> {
        let error = |n: usize| event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.state[n]);
        let states = event.state.iter().enumerate();
        let mut all: Vec<_> = states.map(|(n, it)| Ball::within(*it, error(n))).collect();
        let [cos, sin, one] = self.angle(event);
        if self.solver.system().forcing.is_some() {
            all.extend([cos, sin]);
        }
        all.push(one);
        all
    }

    /// Cosine and sine of the forcing angle at an event, and 1.
    fn angle(&self, event: &Event<T>) -> [Ball<T>; 3] {
        let one = Ball::exact(T::one());
        let Some(forcing) = &self.solver.system().forcing else {
            return [one, Ball::zero(), one];
        };
        let (sin, cos) = self.solver.sin_cos(&event.time);
        let moved = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        let states = self.solver.system().states.len();
        let phase = self.solver.phase_roundings(&event.time)[states];
        // Sine and cosine themselves are good to a few units.
        let error = Ball::<T>::new(&forcing.omega).size() * moved + phase + T::unit() * 8.0;
        [Ball::within(cos, error), Ball::within(sin, error), one]
    }

    /// A guard of a mode with its derivative.
    pub(super) fn guard(&self, mode: usize, guard: usize) -> VariedRow<'_> {
        let [row, rate] = [&self.solver.system().modes[mode], &self.tangent.modes[mode]]
            .map(|it| guard_of(it, guard));
        let nearby = self.tangent.nearby.as_ref().map(|it| guard_of(&it.modes[mode], guard));
        VariedRow { row, rate, nearby }
    }
}
