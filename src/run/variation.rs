//! The exact derivative of the motion with respect to its state, phase by phase and across
//! switches.
//!
//! The state is (angle, p, y, q, v) with the forcing angle omega tau in radians. Within a phase the
//! derivative is that of the closed form. The field is continuous at f = 0 and at f = 1, so only an
//! impact has a saltation: there the contact surface annihilates the direction A = dp - dq.

use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::{EntryAngle, Harmonic};
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::model::entry::{ModeEntry, Motion};
use crate::numeric::remainders::decay;
use crate::phase::Phase;
use crate::run::exit::Exit;
use crate::run::trajectory::Segment;

/// Index of the forcing angle in a [`Matrix`].
pub const ANGLE: usize = 0;
/// Index of p.
pub const P: usize = 1;
/// Index of y.
pub const Y: usize = 2;
/// Index of q.
pub const Q: usize = 3;
/// Index of v.
pub const V: usize = 4;

/// A derivative: row i holds the change of quantity i with (angle, p, y, q, v).
pub type Matrix = [[f64; 5]; 5];

/// A gradient with respect to (angle, p, y, q, v).
pub type Gradient = [f64; 5];

/// The identity matrix.
pub const IDENTITY: Matrix = {
    let mut identity = [[0.0; 5]; 5];
    let mut i = 0;
    while i < 5 {
        identity[i][i] = 1.0;
        i += 1;
    }
    identity
};

/// `after * before`: first `before`, then `after`.
#[must_use]
pub fn product(after: &Matrix, before: &Matrix) -> Matrix {
    after.map(|row| times(&row, before))
}

/// `gradient * before`.
#[must_use]
pub fn times(gradient: &Gradient, before: &Matrix) -> Gradient {
    std::array::from_fn(|column| gradient.iter().zip(before).map(|(g, row)| g * row[column]).sum())
}

/// The derivatives of the event that ends a phase: of its time and of the state there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchDerivative {
    /// Gradient of the event's time.
    pub time: Gradient,
    /// Derivative of the state at the event: flow derivative plus field times that gradient.
    pub state: Matrix,
}

impl Segment {
    /// Derivative of the motion a time `elapsed` into the phase, at fixed time.
    #[must_use]
    pub fn variation(&self, elapsed: f64) -> Matrix {
        match self.motion() {
            Motion::NoContact(flight) => flight_variation(&flight, elapsed),
            Motion::Contact(contact) => contact_variation(&contact, elapsed),
            Motion::Progression(slip) => progression_variation(&slip, elapsed),
        }
    }

    /// Derivative of the row at the switch that ends the phase, with respect to the state just
    /// before the switch; none if no switch ends it.
    #[must_use]
    pub fn switch_derivative(&self) -> Option<SwitchDerivative> {
        let landing = self.landing()?;
        let time = landing.guard.map(|slope| -slope / landing.guard_rate);
        let mut state = IDENTITY;
        for (row, speed) in state.iter_mut().zip(landing.field) {
            for (entry, slope) in row.iter_mut().zip(time) {
                *entry += speed * slope;
            }
        }
        Some(SwitchDerivative { time, state })
    }

    /// Derivative of the state just after the switch with respect to the state just before, both at
    /// the switch's time; the identity except at an impact.
    #[must_use]
    pub fn saltation(&self) -> Matrix {
        let mut saltation = IDENTITY;
        let (Some(landing), Exit::Switch(next)) = (self.landing(), self.exit()) else {
            return saltation;
        };
        let Motion::NoContact(flight) = self.motion() else { return saltation };
        let two_xi = flight.constants.two_xi;
        let f = two_xi * landing.guard_rate;
        // What one unit of A = dp - dq adds to (p, y, q, v).
        let [p, y, q, v] = match next.mode {
            ModeEntry::Progression { .. } => [(1.0 - f) / f, -two_xi / f, 1.0 / f, (f - 1.0) / f],
            _ => [0.0, -two_xi, 1.0, 0.0],
        };
        for (row, change) in [(P, p), (Y, y), (Q, q), (V, v)] {
            saltation[row][P] += change;
            saltation[row][Q] -= change;
        }
        saltation
    }

    /// The field, the guard's gradient and its rate just before the switch that ends the phase.
    fn landing(&self) -> Option<LandingPoint> {
        let Exit::Switch(_) = self.exit() else { return None };
        let sample = self.point(self.duration());
        let guard_rate = sample.guard.orders[1];
        let &Constants { omega, two_xi, .. } = self.constants();
        let (guard, guard_rate) = match self.phase() {
            Phase::NoContact => ([0.0, 1.0, 0.0, -1.0, 0.0], guard_rate),
            Phase::Contact => ([0.0, 0.0, two_xi, 1.0, 0.0], guard_rate),
            // The guard is w; f = 1 + 2 xi w.
            Phase::Progression => ([0.0, 0.0, two_xi, 1.0, 0.0], two_xi * guard_rate),
        };
        let [p, y, q, v] = self.field(&sample);
        Some(LandingPoint { field: [omega, p, y, q, v], guard, guard_rate })
    }
}

struct LandingPoint {
    field: Gradient,
    guard: Gradient,
    guard_rate: f64,
}

/// Derivatives of the harmonic force's two integrals with respect to the entry angle.
fn by_angle(
    constants: &Constants<f64>,
    angle: &EntryAngle<f64>,
    d: f64,
) -> (f64, f64, Harmonic<f64>) {
    let harmonic = angle.harmonic(&constants.drive(), d);
    let turn = harmonic.turn;
    let impulse = constants.a_over_omega * (angle.cos * turn.cos_minus_1 - angle.sin * turn.sin);
    let displacement =
        constants.a_over_omega2 * (angle.sin * turn.cos_minus_1 + angle.cos * turn.sin_minus_x);
    (impulse, displacement, harmonic)
}

fn flight_variation(flight: &NoContact<f64, &Constants<f64>>, d: f64) -> Matrix {
    let (impulse, displacement, _) = by_angle(flight.constants, &flight.angle, d);
    let mut variation = IDENTITY;
    variation[P][ANGLE] = displacement;
    variation[P][Y] = d;
    variation[Y][ANGLE] = impulse;
    variation[Q][Q] = decay(flight.constants.rate * d).exp;
    variation
}

fn progression_variation(slip: &Progression<f64, &Constants<f64>>, d: f64) -> Matrix {
    let (impulse, displacement, _) = by_angle(slip.constants, &slip.angle, d);
    let decay = decay(slip.constants.rate * d);
    let mut variation = IDENTITY;
    variation[P][Q] = decay.minus_1;
    variation[Q][Q] = decay.exp;
    variation[Y][ANGLE] = impulse;
    variation[V][ANGLE] = displacement;
    variation[V][Y] = d;
    variation[V][Q] = -decay.minus_1;
    variation
}

fn contact_variation(contact: &Contact<f64, &Constants<f64>>, d: f64) -> Matrix {
    let Constants { a, damping, forced, .. } = contact.constants;
    let (_, _, harmonic) = by_angle(contact.constants, &contact.angle, d);
    let free = damping.at(d);
    let response = forced.at(d, &harmonic.turn, &free);
    let EntryAngle { sin, cos, .. } = contact.angle;
    let q_by_angle = -(a * (sin * response.displacement.re + cos * response.displacement.im));
    let y_by_angle = -(a * (sin * response.rate.re + cos * response.rate.im));
    let mut variation = IDENTITY;
    variation[P] = [q_by_angle, 1.0, free.s, free.c_minus_1, 0.0];
    variation[Q] = [q_by_angle, 0.0, free.s, 1.0 + free.c_minus_1, 0.0];
    variation[Y] = [y_by_angle, 0.0, 1.0 + free.s_rate_minus_1, -free.s, 0.0];
    variation
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;
    use crate::{Model, Start};

    /// A guard depends on the state alone: its rate is its gradient along the field.
    #[test]
    fn a_guards_gradient_along_the_field_is_its_rate() {
        let mut switches = [0; 3];
        for xi in [0.05, 0.6] {
            let parameters = Parameters { xi, ..Parameters::default() };
            let start = Start { p: -0.4, y: 1.2, ..Start::default() };
            let model = Model::new(parameters);
            let Ok((model, entry)) = model.and_then(|it| Ok((it, it.start(&start)?))) else {
                unreachable!("model and start are in range")
            };
            let horizon = entry.instant.after_periods(20, 1);
            for segment in model.trajectory(entry).until(horizon) {
                let Some(LandingPoint { field, guard, guard_rate }) = segment.landing() else {
                    continue;
                };
                let terms: Vec<f64> = guard.iter().zip(field).map(|(g, speed)| g * speed).collect();
                let off = (terms.iter().sum::<f64>() - guard_rate).abs();
                // The field rounds in a few sums of forces and speeds of at most about 2.
                let room = 64.0 * f64::EPSILON;
                assert!(off <= room, "{:?} {xi}: {terms:?} {guard_rate}", segment.phase());
                switches[segment.phase() as usize] += 1;
            }
        }
        assert!(switches.iter().all(|count| *count > 2), "{switches:?}");
    }
}
