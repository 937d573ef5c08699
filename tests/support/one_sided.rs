//! The end of a phase by plain one-sided steps, as a reference for the search.
//!
//! If a guard's excess e is negative and M bounds e'' from above from here on, no crossing lies
//! closer than the smallest r > 0 with e + e' r + M r^2/2 = 0. Stepping by r never passes a
//! crossing, needs no grid and no guess, and converges quadratically on a transversal crossing. It
//! shares with the search the closed forms alone. The arithmetic may be one of more digits: the
//! phase begins with the same f64 values there and is decided with that arithmetic's rounding.

use percuss::insides::flow::contact::Contact;
use percuss::insides::flow::forcing::EntryAngle;
use percuss::insides::flow::no_contact::NoContact;
use percuss::insides::flow::progression::Progression;
use percuss::insides::flow::{Flow, Point};
use percuss::insides::roots::safe_step;
use percuss::insides::{Constants, Motion};
use percuss::number::Number;
use percuss::{Model, Segment, State};

/// The end of a phase as one-sided steps find it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OneSidedEnd {
    /// The phase ends by a crossing.
    Crossing {
        /// The elapsed time at which the guard crosses.
        elapsed: f64,
        /// Whether the guard crosses the upper threshold; else it crosses the lower one.
        rises: bool,
        /// The time by which the rounding of the guard in f64 may move the crossing.
        width: f64,
    },
    /// The phase does not end before the horizon.
    Clear,
    /// This arithmetic does not decide how the phase ends, or not in so many evaluations.
    Undecided,
}

/// The limits of one search.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// The elapsed time up to which the phase is searched.
    pub horizon: f64,
    /// The largest number of evaluations.
    pub evaluations: usize,
    /// Half the distance from one to the next number of the arithmetic.
    pub unit: f64,
}

/// A phase in some arithmetic, with its thresholds and a bound of its guard's curvature.
struct OneSidedSearch<'a, P, B> {
    phase: &'a P,
    /// The lower and the upper threshold.
    corridor: [Option<f64>; 2],
    /// An upper bound of the outward second derivative from a point on.
    curvature_bound: B,
    /// A time in which nothing happens after a double zero at the beginning.
    head_start: f64,
    underflow: f64,
}

/// Searches the end of a phase by one-sided steps in the arithmetic `T`.
#[must_use]
pub fn one_sided_end<T: Number>(model: &Model, segment: &Segment, effort: &Effort) -> OneSidedEnd {
    let constants = Constants::<T>::new(model.parameters());
    let it = Constants::<f64>::new(model.parameters());
    let State { p, y, q } = segment.entry().state;
    let entry = State { p: T::exact(p), y: T::exact(y), q: T::exact(q) };
    let angle = entry_angle(model, segment);
    let underflow = it.underflow;
    match segment.motion() {
        Motion::NoContact(flight) => {
            let surface = flight.surface.map(T::exact);
            let phase = NoContact { constants, entry, angle, surface };
            let pull = |at: &Point<T>| (-at.state.q.to_f64()).max(0.0) * it.rate * it.rate;
            let curvature_bound = |at: &Point<T>| it.a + it.b.max(0.0) + pull(at);
            // h'' is negative until h''', which this bounds, may have brought it to zero; h stays
            // negative three times as long.
            let third = it.a * it.omega + q.max(0.0) * it.rate.powi(3);
            let second = phase.at(T::zero()).guard.orders[2].to_f64();
            let head_start = if flight.surface == Some(0.0) { -3.0 * second / third } else { 0.0 };
            let corridor = [None, Some(0.0)];
            OneSidedSearch { phase: &phase, corridor, curvature_bound, head_start, underflow }
                .end(effort)
        }
        Motion::Contact(contact) => {
            let [offset, reference] = [contact.offset, contact.reference].map(T::exact);
            let phase = Contact { constants, entry, angle, offset, reference };
            let forced = it.steady.amplitude * it.omega2;
            let curvature_bound = |at: &Point<T>| free_curvature(&phase, at) + forced;
            let corridor = [Some(-contact.reference), Some(1.0 - contact.reference)];
            OneSidedSearch { phase: &phase, corridor, curvature_bound, head_start: 0.0, underflow }
                .end(effort)
        }
        Motion::Progression(slip) => {
            let [drift_rate, closing] = [slip.drift_rate, slip.closing].map(T::exact);
            let phase = Progression { constants, entry, angle, drift_rate, closing };
            let curvature_bound = |at: &Point<T>| {
                let lag = at.slider_velocity.to_f64().max(0.0);
                it.a * it.omega + lag * it.rate * it.rate
            };
            let corridor = [Some(0.0), None];
            OneSidedSearch { phase: &phase, corridor, curvature_bound, head_start: 0.0, underflow }
                .end(effort)
        }
    }
}

/// The forcing's angle at the entry, from the words in which the solver keeps it.
fn entry_angle<T: Number>(model: &Model, segment: &Segment) -> EntryAngle<T> {
    let words = [segment.entry().instant.angle_two_word(), model.phi()];
    let radians =
        words.into_iter().fold(T::zero(), |sum, it| sum + (T::exact(it.high) + T::exact(it.low)));
    let (sin, cos) = radians.sin_cos();
    EntryAngle { radians, sin, cos }
}

/// A bound of the free part's second derivative from `at` on, by its energy.
fn free_curvature<T: Number>(contact: &Contact<T>, at: &Point<T>) -> f64 {
    let forced = contact.constants.steady.orders(at.force);
    let [_, _, second, third] = at.guard.orders;
    (second - forced[2]).to_f64().hypot((third - forced[3]).to_f64())
}

impl<P, B> OneSidedSearch<'_, P, B> {
    fn end<T: Number>(&self, effort: &Effort) -> OneSidedEnd
    where
        P: Flow<T>,
        B: Fn(&Point<T>) -> f64,
    {
        /// Steps over a place where rounding hides the guard's sign.
        const MAX_BLIND_STEPS: usize = 4;
        let head_start = if self.head_start > 0.0 { self.head_start } else { 0.0 };
        let mut elapsed = T::exact(head_start);
        let (mut blind, mut last_step) = (0, 0.0);
        for number in 0..effort.evaluations {
            let point = self.phase.at(elapsed);
            let room = 32.0 * effort.unit * point.guard.largest_term.to_f64() + self.underflow;
            let slope = point.guard.orders[1].to_f64();
            let [below, above] = self.excesses(&point);
            let bound = ((self.curvature_bound)(&point) * (1.0 + 1e-9)).max(f64::MIN_POSITIVE);
            let worst = below.max(above);
            let begins = number == 0 && worst == 0.0;
            if worst > room && number > 0 {
                return crossing(&point, above > below, (worst, last_step));
            }
            let mut step = safe_step(above, slope, bound).min(safe_step(below, -slope, bound));
            if worst >= -room && !begins {
                blind += 1;
                step = step.max((2.0 * room / bound).sqrt()).max(2.0 * room / slope.abs());
            } else if blind > 0 {
                return OneSidedEnd::Undecided;
            }
            // Written so that a NaN decides nothing.
            if !(step > 0.0 && blind <= MAX_BLIND_STEPS) {
                return OneSidedEnd::Undecided;
            }
            last_step = step;
            elapsed = elapsed + T::exact(step);
            if elapsed.to_f64() > effort.horizon {
                return if blind == 0 { OneSidedEnd::Clear } else { OneSidedEnd::Undecided };
            }
        }
        OneSidedEnd::Undecided
    }

    /// The guard's distances outside each threshold.
    fn excesses<T: Number>(&self, point: &Point<T>) -> [f64; 2] {
        let [value, ..] = point.guard.orders;
        let over = |at: Option<f64>| at.map(|it| (value - T::exact(it)).to_f64());
        let [low, high] = self.corridor.map(over);
        [low.map_or(f64::NEG_INFINITY, |it| -it), high.unwrap_or(f64::NEG_INFINITY)]
    }
}

/// The crossing just before a point that is outside by an excess after a step: by Newton's method,
/// not before the step.
fn crossing<T: Number>(
    point: &Point<T>,
    rises: bool,
    (excess, last_step): (f64, f64),
) -> OneSidedEnd {
    let slope = point.guard.orders[1].to_f64().abs();
    let room = 4.0 * f64::EPSILON * point.guard.largest_term.to_f64();
    let width = (room + excess) / slope + 4.0 * f64::EPSILON * point.elapsed.to_f64();
    let back = T::exact((excess / slope).min(last_step));
    OneSidedEnd::Crossing { elapsed: (point.elapsed - back).to_f64(), rises, width }
}
