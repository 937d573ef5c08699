//! Tests of touches in contact.

use super::*;
use crate::flow::Flow;
use crate::parameters::Parameters;

/// A touch in a wide room stands where shorter pieces would touch as well: at both ends the
/// guard is beyond its threshold, or short of it by no more than rounding.
#[test]
fn a_touch_in_a_wide_room_stands_between_two_ends_on_a_threshold() {
    let constants: Constants<f64> = Constants::new(&Parameters::default());
    let angle = EntryAngle { radians: 1.0, sin: 1.0_f64.sin(), cos: 1.0_f64.cos() };
    let entry = State { p: 0.32, y: 0.01, q: 0.3 };
    let contact = Contact { constants, entry, angle, offset: 0.322, reference: 0.0 };
    let mut point = contact.at(3.0);
    let slack = slack(&contact, &point, &point);
    let mut at = |excess: f64| {
        point.guard.orders[0] = -excess;
        point
    };
    let (on, beyond, off) = (at(-0.5 * slack), at(0.5 * slack), at(-2.0 * slack));
    let room = 1e-3 * slack;
    let near = |room, left, right| contact.trusted_verdict(Proof::Touches, room, [left, right]);
    for left in [&on, &beyond] {
        assert_eq!(near(room, left, &on), Proof::Touches);
        assert_eq!(near(room, left, &off), Proof::Open);
        assert_eq!(near(room, &off, left), Proof::Open);
    }
    assert_eq!(near(room, &off, &off), Proof::Open);
    assert_eq!(near(0.0, &off, &off), Proof::Touches);
}
