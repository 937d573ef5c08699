//! The return map of a section, and the times at which a motion may return to it.

use super::section::{Resolved, Returning, Section};
use crate::affine::arithmetic::clock::{Time, full_turn};
use crate::affine::arithmetic::vector::is_f64;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::{Forcing, System};
use crate::affine::run::place::Place;
use crate::affine::solver::Solver;
use crate::dynamics::diagram::ESCAPE_DISTANCE;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::number::Number;

/// The longest time of a return that is waited for, in the system's units of time.
pub const DEFAULT_MAX_RETURN_TIME: f64 = 1000.0;

/// The return map of a section of a system.
pub struct SectionMap<'a, T: Number> {
    solver: &'a Solver<T>,
    section: Resolved,
    longest: T,
    /// The forcing period, and the first time of the strobe's angle.
    period: Option<[Time<T>; 2]>,
    /// The drifts: orbits close without these.
    drifts: Vec<usize>,
    units: Vec<f64>,
}

impl<'a, T: Number> SectionMap<'a, T> {
    /// The return map of a section; returns are waited for at most 1000
    /// [`time_scale`](System::time_scale).
    ///
    /// # Errors
    /// A strobe of a system without forcing or of an angle beyond its range, an event that the
    /// system has not, and a solver of runs back in time.
    pub fn new(solver: &'a Solver<T>, section: &Section) -> Result<Self, SystemError> {
        let system = solver.system();
        let resolved = section.resolve(system)?;
        if solver.is_backward() {
            let what = "a run back in time has no returns: accepted is a run forward".to_owned();
            return Err(SystemError::Name { item: "section".to_owned(), what });
        }
        let angle = match resolved.returns {
            Returning::Strobe(angle) => angle,
            Returning::Events(_) => 0.0,
        };
        let period = system.forcing.as_ref().map(|it| strobes(it, angle));
        let longest = T::exact(DEFAULT_MAX_RETURN_TIME * system.time_scale);
        let drifts = system.drifts();
        let scales = system.scales.iter().chain([&system.time_scale]);
        let units = scales.map(|scale| power_of_two_near(*scale)).collect();
        Ok(Self { solver, section: resolved, longest, period, drifts, units })
    }

    /// Waits for a return no longer than this time. An infinite one is taken for the largest f64,
    /// and of one that is not positive there is no return.
    #[must_use]
    pub fn within(self, longest: T) -> Self {
        let most = T::exact(f64::MAX);
        Self { longest: if longest > most { most } else { longest }, ..self }
    }

    /// The system of the map.
    #[must_use]
    pub fn system(&self) -> &'a System {
        self.solver.system()
    }

    /// The rates of the states at a place.
    #[must_use]
    pub fn rates(&self, place: &Place<T>) -> Vec<T> {
        let rates = self.solver.rates(place.mode, &place.time, &place.state);
        rates[..place.state.len()].to_vec()
    }

    /// Whether the section's points have times of their own beside their states: those of an event
    /// in a forced system.
    #[must_use]
    pub fn has_times(&self) -> bool {
        self.period.is_some() && matches!(self.section.returns, Returning::Events(_))
    }

    /// Whether a state is a [drift](System::drifts): orbits close without it.
    #[must_use]
    pub fn is_drift(&self, state: usize) -> bool {
        self.drifts.contains(&state)
    }

    /// The units in which small changes of the states, and of the time after them, are measured:
    /// the powers of two next to their scales, by which nothing is rounded.
    pub(super) fn units(&self) -> &[f64] {
        &self.units
    }

    /// Whether a motion has escaped that returns with these states: one that is no drift is no
    /// number, or is larger than [`ESCAPE_DISTANCE`] of its scales. A drift of an orbit grows for
    /// ever.
    pub(in crate::affine) fn has_escaped(&self, state: &[T]) -> bool {
        let states = state.iter().map(|it| it.to_f64()).zip(&self.system().scales);
        let mut counted = states.enumerate().filter(|(n, _)| !self.is_drift(*n));
        counted.any(|(_, (state, scale))| state.is_nan() || state.abs() > ESCAPE_DISTANCE * scale)
    }

    /// Whether a return is no motion but a rest, to rounding: of a system without forcing, that the
    /// states go nowhere in its time; of a forced one, that it takes none of the forcing's periods.
    pub(in crate::affine) fn is_rest(&self, mode: usize, states: &[T], elapsed: T) -> bool {
        /// The largest change of a state of size one that is taken for none.
        const REST_TOLERANCE: f64 = 1e-12;
        if let Some(period) = self.forcing_period() {
            return elapsed.to_f64() <= REST_TOLERANCE * period.to_f64();
        }
        let rates = self.solver.rates(mode, &Time { high: T::zero(), low: T::zero() }, states);
        let moved = states.iter().zip(rates).zip(&self.system().scales).enumerate();
        let mut counted = moved.filter(|(n, _)| !self.is_drift(*n));
        counted.all(|(_, ((state, rate), scale))| {
            let moved = (rate * elapsed).to_f64().abs();
            moved <= REST_TOLERANCE * scale.max(state.to_f64().abs())
        })
    }

    /// The [drifts](System::drifts) of a state, in their order.
    pub(in crate::affine) fn drift_of(&self, state: &[T]) -> Vec<T> {
        self.drifts.iter().filter_map(|n| state.get(*n).copied()).collect()
    }

    /// The forcing period, of a forced system.
    #[must_use]
    pub fn forcing_period(&self) -> Option<T> {
        self.period.map(|[period, _]| period.value())
    }

    /// The time from a place to another; of a forced system less whole forcing periods.
    #[must_use]
    pub fn time_apart(&self, from: &Place<T>, to: &Place<T>) -> T {
        let apart = to.time.since(&from.time).value();
        let Some([period, _]) = &self.period else { return T::zero() };
        let turns = libm::round((apart / period.high).to_f64());
        Time { high: apart, low: T::zero() }.since(&multiple(period, turns)).value()
    }

    /// The place with the same motion at the earliest time that is not negative.
    #[must_use]
    pub fn rebased(&self, place: &Place<T>) -> Place<T> {
        let time = match &self.period {
            Some([period, _]) => {
                let turns = libm::floor((place.time.value() / period.high).to_f64());
                place.time.since(&multiple(period, turns))
            }
            None => Time { high: T::zero(), low: T::zero() },
        };
        place.moved_to(time, place.state.clone())
    }

    /// The time of a place as a share of the forcing period; 0 where nothing is forced.
    fn share_of_period(&self, place: &Place<T>) -> T {
        self.period.map_or(T::zero(), |[period, _]| place.time.value() / period.high)
    }

    /// The time that is so large a share of the forcing period; at a strobe it is the first of its
    /// angle.
    fn time_at_share(&self, share: T) -> Time<T> {
        match (&self.section.returns, self.period) {
            (_, None) => Time { high: T::zero(), low: T::zero() },
            (Returning::Strobe(_), Some([_, first])) => first,
            (Returning::Events(_), Some([period, _])) => {
                let high = share * period.high;
                Time { high, low: share.product_error(period.high) + share * period.low }
            }
        }
    }

    pub(in crate::affine) fn solver(&self) -> &'a Solver<T> {
        self.solver
    }

    pub(super) fn section(&self) -> &Resolved {
        &self.section
    }

    /// The number of the first strobe after a time, or at it where that counts.
    pub(super) fn strobe_after(&self, time: &Time<T>, counts_this: bool) -> f64 {
        match self.turns_at(time) {
            (_, Some(strobe)) if counts_this => strobe,
            (_, Some(strobe)) => strobe + 1.0,
            (turns, None) => libm::ceil(turns),
        }
    }

    /// The forcing periods from the angle's first strobe to a time, and the number of the strobe
    /// that the time is, if it is one.
    fn turns_at(&self, time: &Time<T>) -> (f64, Option<f64>) {
        /// The largest distance of a time from a strobe, in forcing periods, at which it counts as
        /// the strobe: a start's time may be written to ten digits.
        const STROBE_TOLERANCE: f64 = 1e-9;
        /// The rounding of a time and of its quotient by the period, in eps of the quotient.
        const ROUNDINGS: f64 = 4.0;
        let Some([period, first]) = &self.period else { return (0.0, None) };
        let turns = (time.since(first).value() / period.high).to_f64();
        let nearest = libm::round(turns);
        let tolerance = STROBE_TOLERANCE.max(ROUNDINGS * f64::EPSILON * turns.abs());
        let is_strobe = (turns - nearest).abs() <= tolerance;
        (turns, is_strobe.then_some(nearest))
    }

    /// Whether a time is that of a strobe, where strobes are the section's points.
    pub(super) fn is_strobe(&self, time: &Time<T>) -> bool {
        matches!(self.section.returns, Returning::Strobe(_)) && self.turns_at(time).1.is_some()
    }

    /// The time by which the search for events goes beyond a strobe: about as far as to the next.
    pub(super) fn search_ahead(&self) -> Option<T> {
        let is_strobe = matches!(self.section.returns, Returning::Strobe(_));
        self.forcing_period().filter(|_| is_strobe)
    }

    /// The time up to which a run goes from a return: that of the strobe of this number, or the
    /// longest that is waited for.
    pub(super) fn horizon(&self, returned: &Time<T>, strobe: f64) -> Time<T> {
        let strobe = match self.section.returns {
            Returning::Strobe(_) => self.strobe(strobe),
            Returning::Events(_) => None,
        };
        strobe.unwrap_or_else(|| returned.after(self.longest))
    }

    /// The time of the strobe of this number from the angle's first on, where the system is forced.
    /// The angle of a section of events is zero.
    pub(super) fn strobe(&self, number: f64) -> Option<Time<T>> {
        let [period, first] = self.period.as_ref()?;
        let Time { high, low } = multiple(period, number);
        Some(first.after(high).after(low))
    }
}

/// The place of a return that a motion of another system may take up: a place at the earliest time
/// with its forcing angle, and that time as a share of the forcing period.
#[derive(Clone, Debug)]
pub(in crate::affine) struct Carried {
    place: Place<f64>,
    share: f64,
}

impl SectionMap<'_, f64> {
    /// The place of a return, for a system that differs in its parameters.
    pub(in crate::affine) fn carry(&self, place: &Place<f64>) -> Carried {
        let place = self.rebased(place);
        let share = self.share_of_period(&place);
        Carried { place, share }
    }

    /// The place in this map's system: mode and state stay, with what the model has made zero there
    /// before, and so does the forcing angle.
    pub(in crate::affine) fn take_up(&self, carried: &Carried) -> Place<f64> {
        let time = self.time_at_share(carried.share);
        carried.place.moved_to(time, carried.place.state.clone())
    }
}

fn power_of_two_near(scale: f64) -> f64 {
    libm::scalbn(1.0, libm::round(libm::log2(scale)) as i32)
}

/// A forcing period, and the time at which omega t is an angle first.
fn strobes<T: Number>(forcing: &Forcing, angle: f64) -> [Time<T>; 2] {
    [(1.0, 0.0), (0.0, angle)].map(|(turns, angle)| time_of(forcing, turns, angle))
}

/// The time that so many turns and an angle take, in two words.
fn time_of<T: Number>(forcing: &Forcing, turns: f64, angle: f64) -> Time<T> {
    if !is_f64::<T>() {
        return Time { high: rounded_time(forcing, turns, angle), low: T::zero() };
    }
    let time: DoubleDouble = rounded_time(forcing, turns, angle);
    let high = time.to_f64();
    let low = (time - DoubleDouble::exact(high)).to_f64();
    Time { high: T::exact(high), low: T::exact(low) }
}

fn rounded_time<T: Number>(forcing: &Forcing, turns: f64, angle: f64) -> T {
    let omega = Time::<T>::new(&forcing.omega).value();
    (T::exact(turns) * full_turn::<T>() + T::exact(angle)) / omega
}

/// A whole multiple of a time.
fn multiple<T: Number>(time: &Time<T>, count: f64) -> Time<T> {
    let count = T::exact(count);
    let high = count * time.high;
    Time { high, low: count.product_error(time.high) + count * time.low }
}
