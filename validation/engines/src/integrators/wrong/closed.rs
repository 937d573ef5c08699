//! One phase's closed form from a plain state (p, y, q, v) at a forcing angle.

use super::printed;
use percuss::insides::Constants;
use percuss::insides::flow::Flow;
use percuss::insides::flow::contact::Contact;
use percuss::insides::flow::forcing::EntryAngle;
use percuss::insides::flow::no_contact::NoContact;
use percuss::insides::flow::progression::Progression;
use percuss::{Parameters, Phase, State};

/// A phase that began in a state at a forcing angle.
pub struct Closed {
    parameters: Parameters,
    begun: [f64; 4],
    angle: f64,
    form: ClosedForm,
}

enum ClosedForm {
    Flight(NoContact<f64>),
    Contact(Contact<f64>),
    Printed,
    Slip(Progression<f64>),
}

impl Closed {
    /// The phase that begins in a state p, y, q, v at a forcing angle; contact by Eqs. (15) to (17)
    /// as printed where that is asked for and xi is below 1.
    #[must_use]
    pub fn new(
        parameters: &Parameters,
        phase: Phase,
        begun: [f64; 4],
        angle: f64,
        as_printed: bool,
    ) -> Self {
        let constants = Constants::new(parameters);
        let [p, y, q, _] = begun;
        let entry = State { p, y, q };
        let (sin, cos) = angle.sin_cos();
        let angles = EntryAngle { radians: angle, sin, cos };
        let force = constants.two_xi * y + q;
        let form = match phase {
            Phase::NoContact => {
                ClosedForm::Flight(NoContact { constants, entry, angle: angles, surface: None })
            }
            Phase::Contact if as_printed && parameters.xi < 1.0 => ClosedForm::Printed,
            Phase::Contact => {
                let (offset, reference) = (force, 0.0);
                ClosedForm::Contact(Contact { constants, entry, angle: angles, offset, reference })
            }
            Phase::Progression => {
                let closing = (1.0 - q) * constants.rate;
                let drift_rate = y - closing;
                ClosedForm::Slip(Progression {
                    constants,
                    entry,
                    angle: angles,
                    drift_rate,
                    closing,
                })
            }
        };
        Self { parameters: *parameters, begun, angle, form }
    }

    /// The state `d` later.
    #[must_use]
    pub fn at(&self, d: f64) -> [f64; 4] {
        let point = match &self.form {
            ClosedForm::Flight(flight) => flight.at(d),
            ClosedForm::Contact(contact) => contact.at(d),
            ClosedForm::Slip(slip) => slip.at(d),
            ClosedForm::Printed => {
                let [_, y, q, v] = self.begun;
                let [y, q] = printed::contact(&self.parameters, self.angle, [y, q], d);
                return [q + self.parameters.g, y, q, v];
            }
        };
        let State { p, y, q } = point.state;
        [p, y, q, self.begun[3] + point.drift]
    }
}
