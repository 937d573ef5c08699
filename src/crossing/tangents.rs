//! The certificate of a whole flight, from the separation to the impact, by tangents and chords.
//!
//! h = H - q with H'' = F, and -q is concave because q >= 0: it lies below its tangent at the root
//! r. So h is at most E = H + that tangent, with E(r) = h(r) = 0 and E'' = F. The sign of F is
//! known: negative between the forcing angles t and 2 pi - t with cos t = -b/a. Where F is positive
//! E is convex and lies below its chord. Where it is negative E is concave and lies below its
//! tangents; at the ends of such a stretch sine and cosine are constants of the model. So a flight
//! is proved by a parabola at a few places. Behind the last of them that lies before r there is a
//! chord to r, or the tangent there.
//!
//! Near the double zero at the start E does not help. There h itself is concave as long as F is
//! negative; or, up to z = [`SEPARATION_DECAY_TIMES`](crate::flow::steps::SEPARATION_DECAY_TIMES)
//! decay times, q0 (exp(-z) - 1 + z) >= [`MIN_SLIDER_RETURN`] q0 z^2/2 outweighs the force, if
//! MIN_SLIDER_RETURN q0 rate^2 exceeds the largest force. What neither serves is left to
//! [`crate::crossing::piecewise`].

use crate::crossing::allowances::TANGENT_STRETCHES;
use crate::crossing::slack;
use crate::flow::Point;
use crate::flow::constants::Constants;
use crate::flow::no_contact::NoContact;
use crate::flow::steps::{FORCE_FACTOR, MIN_SLIDER_RETURN, Steps, Turning};
use crate::numeric::real::Real;
use std::borrow::Borrow;
use std::f64::consts::TAU;

/// A concave function at one place.
#[derive(Clone, Copy)]
pub struct Tangent<T> {
    /// The time at which the tangent touches.
    pub from: T,
    /// Value there.
    pub value: T,
    /// Slope there.
    pub slope: T,
}

impl<T: Real> Tangent<T> {
    /// Whether the function is negative up to a place further on, by the tangents at both: where
    /// they meet, times the difference of their slopes, if that lies between.
    #[inline(always)]
    pub fn stays_below_to(&self, end: &Self) -> T::Mask {
        let zero = self.value.broadcast(0.0);
        let ends = self.value.less(zero) & end.value.less(zero);
        let peaks = zero.less(self.slope) & end.slope.less(zero);
        let back = end.slope.times_from(end.from - self.from, end.value);
        ends & (!peaks | (self.slope * back).less(end.slope * self.value))
    }
}

/// E, raised by what its terms may round off.
pub struct TangentBound<T> {
    offset: T,
    slope: T,
    curvature: T,
    amplitude: T,
    speed: T,
}

/// A flight and the root that ends it, as E needs them.
pub struct EndedFlight<T> {
    /// b
    pub b: T,
    /// a/omega
    pub a_over_omega: T,
    /// a/omega^2
    pub a_over_omega2: T,
    /// Sine and cosine of the forcing angle at the separation.
    pub sin_cos: [T; 2],
    /// Velocity of the mass, and displacement of the slider's top, at the separation.
    pub begin: [T; 2],
    /// When the root is, the displacement of the slider's top there, and the rate at which it
    /// returns.
    pub root: [T; 3],
    /// Rounding room of the guard at the root.
    pub slack: T,
}

impl<T: Real> TangentBound<T> {
    /// The bound of a flight up to its root.
    #[inline(always)]
    pub fn new(flight: &EndedFlight<T>) -> Self {
        /// Eight roundings of terms that are counted twice.
        const ROUNDING_TOLERANCE: f64 = 16.0 * f64::EPSILON;
        let EndedFlight { b, a_over_omega, a_over_omega2, slack, .. } = *flight;
        let ([sin, cos], [y, q]) = (flight.sin_cos, flight.begin);
        let [elapsed, last_q, spring] = flight.root;
        let slope = a_over_omega.times_from(sin, y) + spring;
        let at_start = spring.times_plus(elapsed, last_q);
        let speeds = b.magnitude().times_plus(elapsed, y.magnitude() + a_over_omega) + spring;
        let turn = a_over_omega2.times_plus(a_over_omega2.broadcast(TAU), q + last_q);
        let terms = speeds.times_plus(elapsed, turn);
        Self {
            offset: (a_over_omega2.times_plus(cos, q) - at_start)
                + terms.times_plus(terms.broadcast(ROUNDING_TOLERANCE), slack),
            slope,
            curvature: b,
            amplitude: a_over_omega2,
            speed: a_over_omega,
        }
    }

    /// E where the forcing angle has this sine and cosine.
    #[inline(always)]
    pub fn at(&self, from: T, [sin, cos]: [T; 2]) -> Tangent<T> {
        let Self { offset, slope, curvature, amplitude, speed } = *self;
        let bent = (curvature * from.broadcast(0.5)).times_plus(from, slope);
        let value = amplitude.times_from(cos, from.times_plus(bent, offset));
        let rise = curvature.times_plus(from, slope);
        Tangent { from, value, slope: speed.times_plus(sin, rise) }
    }
}

/// E of a flight up to its root.
#[inline(always)]
fn bound<C: Borrow<Constants<f64>>>(
    flight: &NoContact<f64, C>,
    root: &Point<f64>,
) -> TangentBound<f64> {
    let Constants { b, a_over_omega, a_over_omega2, .. } = *flight.constants.borrow();
    TangentBound::new(&EndedFlight {
        b,
        a_over_omega,
        a_over_omega2,
        sin_cos: [flight.angle.sin, flight.angle.cos],
        begin: [flight.entry.y, flight.entry.q],
        root: [root.elapsed, root.state.q, -root.slider_velocity],
        slack: slack(flight, root, root),
    })
}

/// Whether h is negative between the separation that begins the flight and this root: proved, or
/// not known.
#[inline]
pub fn stays_below<C: Borrow<Constants<f64>>>(
    flight: &NoContact<f64, C>,
    steps: &Steps,
    root: &Point<f64>,
) -> bool {
    let Turning { angle, sin, cos, length, period } = steps.turning;
    let omega = flight.constants.borrow().omega;
    let bound = bound(flight, root);
    let Some(start) = off_the_surface(flight, steps, &bound) else { return false };
    // Written so that a NaN proves nothing.
    if !(start.from < root.elapsed && start.value < 0.0 && flight.entry.q > 0.0) {
        return false;
    }
    // The stretch of negative force that the flight begins in, or the first one after that.
    let late = flight.angle.radians > TAU - angle;
    let mut begins = (angle - flight.angle.radians) / omega + if late { period } else { 0.0 };
    for _ in 0..TANGENT_STRETCHES {
        let ends = begins + length;
        if ends >= root.elapsed {
            return true;
        }
        let begun = bound.at(begins, [sin, cos]);
        let near = if begins < start.from { start } else { begun };
        let below = near.stays_below_to(&bound.at(ends, [-sin, cos]));
        // One jump for both: which of them holds cannot be foretold.
        if !(below | (ends <= start.from)) {
            return false;
        }
        begins += period;
    }
    false
}

/// E at a time until which h is negative by what happens at its beginning.
#[inline]
fn off_the_surface<C: Borrow<Constants<f64>>>(
    flight: &NoContact<f64, C>,
    steps: &Steps,
    bound: &TangentBound<f64>,
) -> Option<Tangent<f64>> {
    let Constants { a, b, omega, rate, .. } = *flight.constants.borrow();
    let Turning { sin, cos, .. } = steps.turning;
    let entry = flight.angle;
    let interval = &steps.separation_interval;
    let negative_until = steps.turning.negative_until(entry.radians);
    let concave_until = (negative_until.unwrap_or(entry.radians) - entry.radians) / omega;
    let sinks =
        (a + b.max(0.0)) * FORCE_FACTOR < flight.entry.q * (rate * rate) * MIN_SLIDER_RETURN;
    if sinks && interval.length > concave_until {
        let turned = [
            entry.sin * interval.cos + entry.cos * interval.sin,
            entry.cos * interval.cos - entry.sin * interval.sin,
        ];
        return Some(bound.at(interval.length, turned));
    }
    (concave_until > 0.0).then(|| bound.at(concave_until, [-sin, cos]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::Flow;
    use crate::flow::forcing::EntryAngle;
    use crate::parameters::Parameters;
    use crate::state::State;

    /// e(x) = top - bend x^2 at a place.
    fn tangent(top: f64, bend: f64, from: f64) -> Tangent<f64> {
        Tangent { from, value: top - bend * from * from, slope: -2.0 * bend * from }
    }

    #[test]
    fn tangents_prove_what_lies_below_where_they_meet() {
        for bend in [1e-3, 0.1, 1.0, 50.0] {
            for reach in [0.1, 1.0, 3.0] {
                // The tangents at -reach and reach meet at bend reach^2 above the top.
                let room = bend * reach * reach;
                for (top, below) in [(-1.1, true), (-0.9, false), (-0.1, false), (0.1, false)] {
                    let at = |from: f64| tangent(top * room, bend, from);
                    let proved = at(-reach).stays_below_to(&at(reach));
                    assert_eq!(proved, below, "{bend} {reach} {top}");
                    // On one side of the top the ends alone decide.
                    assert!(at(-3.0 * reach).stays_below_to(&at(-2.0 * reach)));
                    assert!(at(2.0 * reach).stays_below_to(&at(3.0 * reach)));
                }
                let crossed = tangent(5.0 * room, bend, -reach);
                assert!(!tangent(5.0 * room, bend, -3.0 * reach).stays_below_to(&crossed));
                assert!(!crossed.stays_below_to(&tangent(5.0 * room, bend, 3.0 * reach)));
            }
        }
    }

    /// E is the guard itself at the root, but for the room of its rounding, which is larger than
    /// the rounding of each of its terms.
    #[test]
    fn the_bound_is_raised_by_more_than_it_rounds() {
        for (xi, omega, y) in [(0.1, 1.0, -0.5), (0.01, 3.0, -2.0), (1.0, 0.2, -0.1)] {
            let parameters = Parameters { xi, omega, ..Parameters::default() };
            let constants = Constants::new(&parameters);
            let radians = 2.0_f64;
            let angle = EntryAngle { radians, sin: radians.sin(), cos: radians.cos() };
            let q = -2.0 * xi * y;
            let entry = State { p: q + parameters.g, y, q };
            let flight = NoContact { constants, entry, angle, surface: Some(0.0) };
            for d in [0.5, 2.0, 11.0] {
                let root = flight.at(d);
                let there = (radians + omega * d).sin_cos().into();
                let raised = bound(&flight, &root).at(d, there).value - root.guard.orders[0];
                let terms = [q, y * d, parameters.b * d * d, parameters.a / (omega * omega)];
                for term in terms {
                    assert!(raised > 8.0 * f64::EPSILON * term.abs(), "{d}: {raised:e} {term}");
                }
                let all: f64 = terms.iter().map(|term| term.abs()).sum();
                assert!(raised < 200.0 * f64::EPSILON * all, "{d}: {raised:e} {all}");
            }
        }
    }

    /// All places where the guard's closed form rises to zero within six forcing periods, in
    /// flights that begin with a separation; with how many such places there were before.
    fn for_each_rise(mut check: impl FnMut(&NoContact<f64>, &Steps, &Point<f64>, usize)) {
        const PLACES_PER_PERIOD: u32 = 32;
        let models = [(0.02, 0.7, 0.02), (0.05, 1.4, 0.05), (0.3, 2.0, 0.03), (0.2, 0.4, 0.1)];
        for (xi, omega, b) in models {
            let parameters = Parameters { xi, omega, b, ..Parameters::default() };
            let constants: Constants<f64> = Constants::new(&parameters);
            let steps = Steps::new(&parameters);
            let flights = (0..96).flat_map(|k| [-0.02, -0.05, -0.1, -0.2].map(|y| (k, y)));
            for (k, y) in flights {
                let radians = TAU * f64::from(k) / 96.0;
                let angle = EntryAngle { radians, sin: radians.sin(), cos: radians.cos() };
                let q = -2.0 * xi * y;
                let entry = State { p: q + parameters.g, y, q };
                let flight = NoContact { constants, entry, angle, surface: Some(0.0) };
                let guard = |d: f64| flight.at(d).guard.orders[0];
                // Else no separation.
                if parameters.a * angle.cos + b >= q * constants.rate.powi(2) {
                    continue;
                }
                let places = (1..6 * PLACES_PER_PERIOD)
                    .map(|i| TAU / omega * f64::from(i) / f64::from(PLACES_PER_PERIOD));
                let places: Vec<f64> = places.collect();
                let rises =
                    places.windows(2).filter(|pair| guard(pair[0]) < 0.0 && guard(pair[1]) >= 0.0);
                for (before, pair) in rises.enumerate() {
                    let (mut inside, mut outside) = (pair[0], pair[1]);
                    for _ in 0..60 {
                        let middle = 0.5 * (inside + outside);
                        if guard(middle) < 0.0 { inside = middle } else { outside = middle }
                    }
                    check(&flight, &steps, &flight.at(outside), before);
                }
            }
        }
    }

    /// A guard that has been positive before is not negative up to where it rises again. Of the
    /// first rises about three quarters are proved.
    #[test]
    fn no_flight_is_proved_up_to_a_later_root() {
        let (mut first, mut proved, mut later) = (0, 0, 0);
        for_each_rise(|flight, steps, root, before| {
            let stays = stays_below(flight, steps, root);
            if before == 0 {
                (first, proved) = (first + 1, proved + u32::from(stays));
            } else {
                let (xi, angle) = (flight.constants.two_xi / 2.0, flight.angle.radians);
                assert!(!stays, "xi {xi}, angle {angle}, y {}: {}", flight.entry.y, root.elapsed);
                later += 1;
            }
        });
        assert!(later > 50 && 2 * proved > first, "{later} later, {proved} of {first} proved");
    }

    /// Where F is positive E lies below its chord, which says something only if E is negative at
    /// both of its ends.
    #[test]
    fn nothing_is_proved_where_the_bound_is_positive_off_the_surface() {
        let mut positive = 0;
        for_each_rise(|flight, steps, root, _| {
            let start = off_the_surface(flight, steps, &bound(flight, root));
            if start.is_some_and(|start| start.value >= 0.0 && start.from < root.elapsed) {
                assert!(!stays_below(flight, steps, root), "{}", root.elapsed);
                positive += 1;
            }
        });
        assert!(positive > 20, "{positive}");
    }
}
