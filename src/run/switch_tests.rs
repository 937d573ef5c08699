//! Tests of how a phase ends: with a guess and without one.

use super::*;
use crate::crossing::allowances::SLACK;
use crate::flow::Flow;
use crate::model::start::Start;
use crate::parameters::Parameters;
use proptest::prelude::*;

/// What rounding of the guard moves a root by: each of two searches has a room of its own.
fn room(model: &Model, begun: &Begun, duration: f64) -> f64 {
    let guard = match Motion::new(model.constants(), &begun.entry, begun.angle) {
        Motion::NoContact(flight) => flight.at(duration).guard,
        Motion::Contact(contact) => contact.at(duration).guard,
        Motion::Progression(slip) => slip.at(duration).guard,
    };
    2.0 * (SLACK * guard.largest_term / guard.orders[1].abs() + f64::EPSILON * duration)
}

proptest! {
    /// Switches are proved, so that a guess may cost evaluations but not change the run.
    #[test]
    fn a_phase_ends_where_it_does_without_a_guess(
        (xi, omega) in (-7.0..2.5_f64, -3.0..3.0_f64).prop_map(|(x, o)| (x.exp(), o.exp())),
        (a, b, g) in (0.0..2.0_f64, -0.1..1.1_f64, 0.0..0.3_f64),
        (y, q, tau) in (-1.0..1.0_f64, 0.0..1.0_f64, 0.0..10.0_f64),
        gap in prop_oneof![Just(0.0), (-12.0..1.0_f64).prop_map(f64::exp)],
    ) {
        let parameters = Parameters { a, b, xi, omega, g, ..Parameters::default() };
        let Ok(model) = Model::new(parameters) else {
            return Err(TestCaseError::fail("out of range"));
        };
        let entry = model.start(&Start { p: q + g - gap, y, q: Some(q), tau, ..Start::default() });
        let Ok(entry) = entry else { return Ok(()) };
        let mut counters = Counters::default();
        let mut begun = Begun::at(&model, entry);
        for _ in 0..30 {
            let unguessed = Begun { guess: None, ..begun };
            let (mut next, mut alone) = (begun, begun);
            let passed = pass(&model, &begun, &mut next, None, &mut counters);
            let other = pass(&model, &unguessed, &mut alone, None, &mut counters);
            prop_assert_eq!(passed.end, other.end);
            if passed.end != End::Switch {
                break;
            }
            let (one, two) = (passed.duration.value(), other.duration.value());
            let room = room(&model, &begun, one);
            prop_assert!((one - two).abs() <= room, "{begun:?}: {one} {two} {room:e}");
            prop_assert_eq!(next.entry.phase(), alone.entry.phase());
            begun = next;
        }
    }
}
