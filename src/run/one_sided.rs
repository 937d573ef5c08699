//! How a phase ends by plain one-sided steps in any arithmetic, as a reference for the search.
//!
//! No step passes a crossing, as in [`crate::crossing::stepping`]; here the arithmetic may be one
//! of more digits, in which the phase begins with the same f64 values and is decided with its own
//! rounding room.

use crate::crossing::{Counters, Crossing, stepping};
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::flow::{Flow, Point};
use crate::model::Model;
use crate::model::entry::Motion;
use crate::numeric::number::Number;
use crate::numeric::roots::safe_step;
use crate::run::trajectory::Segment;
use crate::state::State;

/// How the one-sided search says that a phase ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OneSidedEnd {
    /// The phase ends by a crossing.
    Crossing {
        /// The elapsed time at which the guard crosses.
        elapsed: f64,
        /// Whether the guard crosses the upper threshold; else it crosses the lower one.
        rises: bool,
        /// What the rounding of the guard in f64 may move it by.
        width: f64,
    },
    /// The phase does not end before the horizon.
    Clear,
    /// This arithmetic does not decide how the phase ends, or not in so many evaluations.
    Undecided,
}

/// What one search is allowed.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The elapsed time up to which the phase is searched.
    pub horizon: f64,
    /// The largest number of evaluations.
    pub evaluations: usize,
    /// Half the distance from one to the next number of the arithmetic.
    pub unit: f64,
}

/// A phase in some arithmetic, with its thresholds and a bound of its guard's bend.
struct OneSidedSearch<'a, P, B> {
    phase: &'a P,
    /// The lower and the upper threshold.
    corridor: [Option<f64>; 2],
    /// An upper bound of the size of the outward second derivative from a point on.
    bend: B,
    /// A time in which nothing happens after a double zero at the beginning.
    head_start: f64,
    underflow: f64,
}

impl Segment {
    /// How long the phase lasts by one-sided steps in f64 ([`stepping`]): infinite if it does not
    /// end within `horizon`, none if that takes more than `evaluations`.
    #[doc(hidden)]
    #[must_use]
    pub fn one_sided_duration(&self, horizon: f64, evaluations: u64) -> Option<f64> {
        let mut counters = Counters::default();
        let crossing = match self.motion() {
            Motion::NoContact(flight) => {
                stepping::first_crossing(&flight, horizon, evaluations, &mut counters)
            }
            Motion::Contact(contact) => {
                stepping::first_crossing(&contact, horizon, evaluations, &mut counters)
            }
            Motion::Progression(slip) => {
                stepping::first_crossing(&slip, horizon, evaluations, &mut counters)
            }
        };
        crossing.map(|crossing| match crossing {
            Crossing::At(root) => root.elapsed().value(),
            _ => f64::INFINITY,
        })
    }

    /// How the phase ends by one-sided steps in the arithmetic `T`.
    #[doc(hidden)]
    #[must_use]
    pub fn one_sided_end_in<T: Number>(&self, model: &Model, effort: &Effort) -> OneSidedEnd {
        let constants = Constants::<T>::new(model.parameters());
        let it = Constants::<f64>::new(model.parameters());
        let State { p, y, q } = self.entry().state;
        let entry = State { p: T::exact(p), y: T::exact(y), q: T::exact(q) };
        let words = [self.entry().instant.angle_two_word(), model.phi()];
        let radians = words
            .into_iter()
            .fold(T::zero(), |sum, it| sum + (T::exact(it.high) + T::exact(it.low)));
        let (sin, cos) = radians.sin_cos();
        let angle = EntryAngle { radians, sin, cos };
        let underflow = it.underflow;
        match self.motion() {
            Motion::NoContact(flight) => {
                let surface = flight.surface.map(T::exact);
                let phase = NoContact { constants, entry, angle, surface };
                let pull = |at: &Point<T>| (-at.state.q.to_f64()).max(0.0) * it.rate * it.rate;
                let bend = |at: &Point<T>| it.a + it.b.max(0.0) + pull(at);
                let third = it.a * it.omega + q.max(0.0) * it.rate.powi(3);
                let first = phase.at(T::zero()).guard.orders[2].to_f64();
                let head_start =
                    if flight.surface == Some(0.0) { -3.0 * first / third } else { 0.0 };
                let corridor = [None, Some(0.0)];
                OneSidedSearch { phase: &phase, corridor, bend, head_start, underflow }.ends(effort)
            }
            Motion::Contact(contact) => {
                let [offset, reference] = [contact.offset, contact.reference].map(T::exact);
                let phase = Contact { constants, entry, angle, offset, reference };
                let bend = |at: &Point<T>| free_bend(&phase, at) + it.steady.amplitude * it.omega2;
                let corridor = [Some(-contact.reference), Some(1.0 - contact.reference)];
                OneSidedSearch { phase: &phase, corridor, bend, head_start: 0.0, underflow }
                    .ends(effort)
            }
            Motion::Progression(slip) => {
                let [drift_rate, closing] = [slip.drift_rate, slip.closing].map(T::exact);
                let phase = Progression { constants, entry, angle, drift_rate, closing };
                let bend = |at: &Point<T>| {
                    let lag = at.slider_velocity.to_f64().max(0.0);
                    it.a * it.omega + lag * it.rate * it.rate
                };
                let corridor = [Some(0.0), None];
                OneSidedSearch { phase: &phase, corridor, bend, head_start: 0.0, underflow }
                    .ends(effort)
            }
        }
    }
}

/// A bound of the free part's second derivative from `at` on, by its energy.
fn free_bend<T: Number>(contact: &Contact<T>, at: &Point<T>) -> f64 {
    let forced = contact.constants.steady.orders(at.force);
    let [_, _, second, third] = at.guard.orders;
    (second - forced[2]).to_f64().hypot((third - forced[3]).to_f64())
}

impl<P, B> OneSidedSearch<'_, P, B> {
    fn ends<T: Number>(&self, effort: &Effort) -> OneSidedEnd
    where
        P: Flow<T>,
        B: Fn(&Point<T>) -> f64,
    {
        /// Steps over a place where rounding hides the guard's sign.
        const BLIND: usize = 4;
        let head_start = if self.head_start > 0.0 { self.head_start } else { 0.0 };
        let mut elapsed = T::exact(head_start);
        let mut blind = 0;
        for number in 0..effort.evaluations {
            let point = self.phase.at(elapsed);
            let room = 32.0 * effort.unit * point.guard.largest_term.to_f64() + self.underflow;
            let slope = point.guard.orders[1].to_f64();
            let [below, above] = self.excesses(&point);
            let bend = ((self.bend)(&point) * (1.0 + 1e-9)).max(f64::MIN_POSITIVE);
            let worst = below.max(above);
            let begins = number == 0 && worst == 0.0;
            if worst > room && number > 0 {
                return crossing(&point, above > below, worst);
            }
            let mut step = safe_step(above, slope, bend).min(safe_step(below, -slope, bend));
            if worst >= -room && !begins {
                blind += 1;
                step = step.max((2.0 * room / bend).sqrt()).max(2.0 * room / slope.abs());
            } else if blind > 0 {
                return OneSidedEnd::Undecided;
            }
            // Written so that a NaN decides nothing.
            if !(step > 0.0 && blind <= BLIND) {
                return OneSidedEnd::Undecided;
            }
            elapsed = elapsed + T::exact(step);
            if elapsed.to_f64() > effort.horizon {
                return if blind == 0 { OneSidedEnd::Clear } else { OneSidedEnd::Undecided };
            }
        }
        OneSidedEnd::Undecided
    }

    /// How far the guard is outside each threshold.
    fn excesses<T: Number>(&self, point: &Point<T>) -> [f64; 2] {
        let [value, ..] = point.guard.orders;
        let over = |at: Option<f64>| at.map(|it| (value - T::exact(it)).to_f64());
        let [low, high] = self.corridor.map(over);
        [low.map_or(f64::NEG_INFINITY, |it| -it), high.unwrap_or(f64::NEG_INFINITY)]
    }
}

/// The crossing just before a point that is outside by `excess`.
fn crossing<T: Number>(point: &Point<T>, rises: bool, excess: f64) -> OneSidedEnd {
    let slope = point.guard.orders[1].to_f64().abs();
    let room = 4.0 * f64::EPSILON * point.guard.largest_term.to_f64();
    let width = (room + excess) / slope + 4.0 * f64::EPSILON * point.elapsed.to_f64();
    OneSidedEnd::Crossing { elapsed: point.elapsed.to_f64(), rises, width }
}
