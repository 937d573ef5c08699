//! Tests of the bounds on which certificates rest: each is held against the
//! derivative itself, which the guard's Taylor series gives at any later time.

use crate::crossing::Guarded;
use crate::crossing::contact::Split;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::flow::{Flow, Point};
use crate::parameters::Parameters;
use crate::state::State;
use proptest::prelude::*;

/// A lower and an upper bound of the guard's eighth derivative from an evaluation on, infinite on a
/// side without a threshold.
trait Eighth: Guarded {
    fn eighth_within(&self, at: &Point<f64>) -> (f64, f64);
}

impl Eighth for NoContact<f64> {
    fn eighth_within(&self, at: &Point<f64>) -> (f64, f64) {
        (f64::NEG_INFINITY, self.eighth_most(at))
    }
}

impl Eighth for Contact<f64> {
    fn eighth_within(&self, at: &Point<f64>) -> (f64, f64) {
        let bound = self.eighth(self.free_eighth(at, &self.split(at)));
        (-bound, bound)
    }
}

impl Eighth for Progression<f64> {
    fn eighth_within(&self, at: &Point<f64>) -> (f64, f64) {
        (self.eighth_least(at), f64::INFINITY)
    }
}

/// Times after the evaluation, in units of the motion's shortest time.
const LATER_TIMES: [f64; 8] = [0.0, 0.1, 0.3, 0.7, 1.3, 2.5, 5.0, 20.0];

/// The bounds at `from` hold at all later times, up to the rounding of the derivatives: each order
/// multiplies the guard's terms by the fastest rate, with a few roundings.
fn hold<P: Eighth>(phase: &P, from: f64) -> Result<(), TestCaseError> {
    let here = phase.at(from);
    let (least, most) = phase.eighth_within(&here);
    let rate = phase.fastest_rate();
    for later in LATER_TIMES {
        let there = phase.at(from + later / rate);
        let derivatives = phase.series::<9>(&there).0;
        let size: f64 = (0..4).map(|k| derivatives[k].abs() / rate.powi(k as i32)).sum();
        let room = |order| 64.0 * f64::EPSILON * size * rate.powi(order);
        let eighth = derivatives[8];
        let eighth_holds = least - room(8) <= eighth && eighth <= most + room(8);
        prop_assert!(eighth_holds, "{eighth:e} not within {least:e} to {most:e}, {later}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn bounds_of_derivatives_hold_from_an_evaluation_on(
        // The forcing is left out often enough that the exponential alone has to be bounded.
        (a, b) in (prop_oneof![Just(0.0), 0.0..1.0_f64], -0.5..1.0_f64),
        (xi, omega) in (-6.0..2.5_f64, -2.0..2.0_f64).prop_map(|(x, o)| (x.exp(), o.exp())),
        (y, q, angle) in (-1.0..1.0_f64, -1.0..1.0_f64, 0.0..6.3_f64),
        (d, closing) in (0.0..3.0_f64, -1.0..1.0_f64),
    ) {
        let parameters = Parameters { a, b, xi, omega, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let angle = EntryAngle { radians: angle, sin: angle.sin(), cos: angle.cos() };
        let entry = State { p: q + 0.02, y, q };
        hold(&NoContact { constants, entry, angle, surface: None }, d)?;
        let offset = 2.0 * xi * y + q;
        hold(&Contact { constants, entry, angle, offset, reference: 0.0 }, d)?;
        let entry = State { q: 1.0 - 2.0 * xi * closing, ..entry };
        let drift_rate = y - closing;
        hold(&Progression { constants, entry, angle, drift_rate, closing }, d)?;
    }
}

/// The fourth Bernstein coefficient of degree eight is the sum of C(3, k)/C(8, k) L^k f^(k)/k!: so
/// much of the derivatives' rounding is in it, where each has that of the guard times 2 xi to the
/// k.
#[test]
fn the_room_of_a_long_contact_has_the_weights_of_its_coefficients() {
    // A derivative repeats the rounding of the one below it times 2 xi under strong damping, and
    // times 1, the rate of the elastic contact, under light damping.
    for (xi, rate) in [(1.1, 2.2), (0.05, 1.0)] {
        let constants = Constants::new(&Parameters { xi, omega: 0.05, ..Parameters::default() });
        let angle = EntryAngle { radians: 1.0, sin: 1.0_f64.sin(), cos: 1.0_f64.cos() };
        let entry = State { p: 0.32, y: 0.01, q: 0.3 };
        let contact = Contact { constants, entry, angle, offset: 0.322, reference: 0.0 };
        let left = contact.at(40.0);
        for length in [1.0, 1.8, 2.0, 5.0, 12.0_f64] {
            let right = contact.at(40.0 + length);
            let reach: f64 = rate * length;
            let share = [3.0 / 8.0, 3.0 / 28.0 / 2.0, 1.0 / 56.0 / 6.0];
            let weights: f64 = (1..4).map(|k| share[k - 1] * reach.powi(k as i32)).sum();
            let largest = left.guard.largest_term.max(right.guard.largest_term);
            let expected = if reach > 4.0 { f64::EPSILON * weights * largest } else { 0.0 };
            let room = contact.room_of_length(&left, &right);
            let off = (room - expected).abs();
            assert!(off <= 1e-12 * expected, "{xi}, {length}: {room:e} {expected:e}");
        }
    }
}

/// What dies out from critical damping on keeps its sign if x and x' + fast x have the same one.
/// Both are sums: a sign is believed from sixteen roundings of the terms on, each of which counts
/// with its size.
#[test]
fn a_contact_rests_on_one_side_where_both_signs_are_beyond_rounding() {
    const ROUNDING_TOLERANCE: f64 = 16.0 * f64::EPSILON;
    // The faster decay has the rate 2.
    let (a, b, xi, omega, fast) = (0.01, 0.5, 1.25, 0.7, 2.0);
    let constants = Constants::new(&Parameters { a, b, xi, omega, ..Parameters::default() });
    let angle = EntryAngle { radians: 1.0, sin: 1.0_f64.sin(), cos: 1.0_f64.cos() };
    for y in [2.0, -2.0] {
        let entry = State { p: 0.32, y, q: 0.3 };
        let contact = Contact { constants, entry, angle, offset: 0.8, reference: 0.0 };
        let left = contact.at(0.0);
        let amplitude = contact.split(&left).amplitude;
        let terms = left.guard.largest_term + left.guard.orders[0].abs() + b + a + amplitude;
        let rates = 2.0 * xi * terms + 2.0 + omega * amplitude;
        let rests = |x: f64, rate: f64| {
            contact.rests_on_one_side(&left, &Split { free: [x, rate, 0.0, 0.0], amplitude })
        };
        for sign in [1.0, -1.0] {
            let x = 0.01 * sign;
            let rate = |share: f64| -fast * x + share * sign * ROUNDING_TOLERANCE * rates;
            assert!(!rests(x, rate(0.97)) && rests(x, rate(1.03)), "the rate, {sign} {y}");
            let x = |share: f64| share * sign * ROUNDING_TOLERANCE * terms;
            let (less, more) = (rests(x(0.97), 1e-3 * sign), rests(x(1.03), 1e-3 * sign));
            assert!(!less && more, "the value, {sign} {y}");
        }
    }
}

/// Clearly above critical damping the derivatives are computed from the equation of motion as long
/// as the fast part lives, for one of its decay times, and from the parts afterwards.
#[test]
fn the_room_of_a_long_contact_is_wide_while_its_fast_part_lives() {
    let (xi, omega, length) = (5.0, 0.7, 12.0);
    let constants = Constants::new(&Parameters { xi, omega, ..Parameters::default() });
    let angle = EntryAngle { radians: 1.0, sin: 1.0_f64.sin(), cos: 1.0_f64.cos() };
    let entry = State { p: 0.32, y: 0.01, q: 0.3 };
    let contact = Contact { constants, entry, angle, offset: 0.4, reference: 0.0 };
    let fast = xi + (xi * xi - 1.0_f64).sqrt();
    for (decay_times, rate) in [(0.2, 2.0 * xi), (0.9, 2.0 * xi), (1.1, omega), (5.0, omega)] {
        let left = contact.at(decay_times / fast);
        let right = contact.at(left.elapsed + length);
        let reach = rate * length;
        let weights = reach * (3.0 / 8.0 + reach * (3.0 / 56.0 + reach / 336.0));
        let largest = left.guard.largest_term.max(right.guard.largest_term);
        let (room, expected) =
            (contact.room_of_length(&left, &right), f64::EPSILON * weights * largest);
        assert!(
            (room - expected).abs() <= 1e-12 * expected,
            "{decay_times}: {room:e} {expected:e}"
        );
    }
}
