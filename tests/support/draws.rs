//! Random phases in every regime: the same start in f64 and, exactly consistent, in double-double.

use super::random::Draw;
use percuss::affine::DoubleDouble;
use percuss::insides::Constants;
use percuss::insides::flow::contact::Contact;
use percuss::insides::flow::forcing::EntryAngle;
use percuss::insides::flow::no_contact::NoContact;
use percuss::insides::flow::progression::Progression;
use percuss::insides::flow::{Flow, Point};
use percuss::number::Number;
use percuss::{Parameters, Phase, State};

/// A range of damping and frequency in which the forms behave alike.
pub struct Regime {
    pub name: &'static str,
    draw: fn(&mut Draw) -> (f64, f64),
}

const OMEGA_RANGE: (f64, f64) = (0.01, 50.0);

fn any_omega(draw: &mut Draw) -> f64 {
    draw.decades(OMEGA_RANGE.0, OMEGA_RANGE.1)
}

/// Regimes of xi and omega.
pub const REGIMES: [Regime; 7] = [
    Regime { name: "light", draw: |d| (d.decades(1e-8, 0.5), any_omega(d)) },
    Regime { name: "medium", draw: |d| (d.between(0.5, 2.0), any_omega(d)) },
    Regime {
        name: "critical",
        draw: |d| (1.0 + d.sign() * 10_f64.powi(-(d.between(3.0, 16.0) as i32)), any_omega(d)),
    },
    Regime { name: "exactly critical", draw: |d| (1.0, any_omega(d)) },
    Regime { name: "heavy", draw: |d| (d.decades(2.0, 1e4), any_omega(d)) },
    Regime { name: "resonance", draw: |d| (1e-4, 1.0 + d.sign() * d.decades(1e-15, 1e-6)) },
    Regime {
        name: "near resonance",
        draw: |d| (d.decades(1e-8, 0.1), 1.0 + d.sign() * d.decades(1e-8, 0.1)),
    },
];

/// One phase in both arithmetics.
#[derive(Clone, Copy, Debug)]
pub enum Form<T> {
    Flight(NoContact<T>),
    Contact(Contact<T>),
    Slip(Progression<T>),
}

/// A phase as f64 sees it, and the same phase exactly.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub rounded: Form<f64>,
    pub exact: Form<DoubleDouble>,
    /// The time to look at, up to one forcing period.
    pub elapsed: f64,
}

impl<T: Number> Form<T> {
    pub fn at(&self, elapsed: T) -> Point<T> {
        match self {
            Self::Flight(flight) => flight.at(elapsed),
            Self::Contact(contact) => contact.at(elapsed),
            Self::Slip(slip) => slip.at(elapsed),
        }
    }

    pub fn phase(&self) -> Phase {
        match self {
            Self::Flight(_) => Phase::NoContact,
            Self::Contact(_) => Phase::Contact,
            Self::Slip(_) => Phase::Progression,
        }
    }

    pub fn constants(&self) -> &Constants<T> {
        match self {
            Self::Flight(NoContact { constants, .. })
            | Self::Contact(Contact { constants, .. })
            | Self::Slip(Progression { constants, .. }) => constants,
        }
    }

    pub fn entry(&self) -> (&State<T>, &EntryAngle<T>) {
        match self {
            Self::Flight(NoContact { entry, angle, .. })
            | Self::Contact(Contact { entry, angle, .. })
            | Self::Slip(Progression { entry, angle, .. }) => (entry, angle),
        }
    }

    /// The same phase under another sine and cosine of the forcing angle: the closed forms read no
    /// more of it.
    pub fn with_angle(mut self, change: fn(&EntryAngle<T>) -> (T, T)) -> Self {
        let (Self::Flight(NoContact { angle, .. })
        | Self::Contact(Contact { angle, .. })
        | Self::Slip(Progression { angle, .. })) = &mut self;
        let (sin, cos) = change(angle);
        *angle = EntryAngle { sin, cos, ..*angle };
        self
    }

    /// What the guard of a contact counts from.
    pub fn reference(&self) -> T {
        if let Self::Contact(contact) = self { contact.reference } else { T::zero() }
    }
}

/// The shortest phase looked at.
const MIN_PHASE_TIME: f64 = 1e-12;

impl Regime {
    /// Parameters of this regime, one phase of the kind asked for, and a time inside it.
    ///
    /// Forces are of the order of the threshold, as wherever the model switches at all.
    pub fn pair(&self, phase: Phase, draw: &mut Draw) -> Pair {
        let (xi, omega) = (self.draw)(draw);
        let a = if draw.once_in(10) { 0.0 } else { draw.between(0.0, 1.5) };
        let b = draw.between(-0.5, 1.5);
        let parameters = Parameters { a, b, xi, omega, g: draw.between(0.0, 0.5), phi: 0.0 };
        let radians = draw.between(0.0, std::f64::consts::TAU);
        let (sin, cos) = libm::sincos(radians);
        let angle = EntryAngle { radians, sin, cos };
        let (rounded, exact) = match phase {
            Phase::NoContact => flight(&parameters, angle, draw),
            Phase::Contact => contact(&parameters, angle, draw),
            Phase::Progression => slip(&parameters, angle, draw),
        };
        let period = std::f64::consts::TAU / omega;
        let elapsed = if draw.once_in(2) {
            draw.decades(MIN_PHASE_TIME, period)
        } else {
            draw.between(MIN_PHASE_TIME, period)
        };
        Pair { rounded, exact, elapsed }
    }
}

impl Pair {
    /// Flights and progressions are cut before the guard leaves its corridor: afterwards p and v
    /// come back from afar through zero, where (1 + |value|) says nothing about them. Contacts are
    /// not cut, because nothing in them grows.
    pub fn while_it_lasts(mut self) -> Self {
        const PLACES: u32 = 32;
        let inside = |d: f64| {
            let [guard, ..] = self.rounded.at(d).guard.orders;
            match self.rounded.phase() {
                Phase::NoContact => guard <= 0.0,
                Phase::Contact => true,
                Phase::Progression => guard >= 0.0,
            }
        };
        let place = |k: u32| self.elapsed * f64::from(k) / f64::from(PLACES);
        let last = (1..=PLACES).map(place).take_while(|d| inside(*d)).last();
        self.elapsed = last.unwrap_or(MIN_PHASE_TIME);
        self
    }
}

type Both = (Form<f64>, Form<DoubleDouble>);

fn dd(value: f64) -> DoubleDouble {
    DoubleDouble::exact(value)
}

fn exact_angle(angle: EntryAngle<f64>) -> EntryAngle<DoubleDouble> {
    EntryAngle { radians: dd(angle.radians), sin: dd(angle.sin), cos: dd(angle.cos) }
}

fn rounded_state(state: State<DoubleDouble>) -> State<f64> {
    State { p: state.p.to_f64(), y: state.y.to_f64(), q: state.q.to_f64() }
}

/// What the guard's value depends on is the same f64 in both; the rest follows exactly.
fn flight(parameters: &Parameters, angle: EntryAngle<f64>, draw: &mut Draw) -> Both {
    let exact = Constants::<DoubleDouble>::new(parameters);
    let two_xi = 2.0 * parameters.xi;
    // The mass leaves with at most its own speed.
    let speed = draw.between(-3.0, 1.0) / two_xi.max(1.0);
    let surface = match draw.between(0.0, 3.0) as u32 {
        0 => None,
        1 => Some(0.0),
        _ => Some(-draw.between(0.0, 1.0) / two_xi.max(1.0)),
    };
    let entry = match surface {
        None => {
            let q = draw.between(0.0, 1.0);
            State { p: dd(q - draw.between(0.0, 2.0)), y: dd(speed), q: dd(q) }
        }
        Some(h_rate) => {
            // h' = y + q/(2 xi)
            let q = dd(two_xi * (h_rate - speed));
            State { p: q + exact.g, y: dd(h_rate) - q / exact.two_xi, q }
        }
    };
    let flight =
        NoContact { constants: exact, entry, angle: exact_angle(angle), surface: surface.map(dd) };
    let constants = Constants::new(parameters);
    let rounded = NoContact { constants, entry: rounded_state(entry), angle, surface };
    (Form::Flight(rounded), Form::Flight(flight))
}

fn contact(parameters: &Parameters, angle: EntryAngle<f64>, draw: &mut Draw) -> Both {
    let exact = Constants::<DoubleDouble>::new(parameters);
    let (offset, reference) = match draw.between(0.0, 4.0) as u32 {
        0 => (0.0, 0.0),
        1 => (0.0, 1.0),
        _ => (draw.between(0.0, 1.0), 0.0),
    };
    let y = draw.between(-3.0, 3.0) / parameters.xi.max(1.0);
    // f = 2 xi y + q
    let q = dd(offset) + dd(reference) - exact.two_xi * dd(y);
    let entry = State { p: q + exact.g, y: dd(y), q };
    let contact = Contact {
        constants: exact,
        entry,
        angle: exact_angle(angle),
        offset: dd(offset),
        reference: dd(reference),
    };
    let constants = Constants::new(parameters);
    let rounded = Contact { constants, entry: rounded_state(entry), angle, offset, reference };
    (Form::Contact(rounded), Form::Contact(contact))
}

fn slip(parameters: &Parameters, angle: EntryAngle<f64>, draw: &mut Draw) -> Both {
    let exact = Constants::<DoubleDouble>::new(parameters);
    let closing = draw.between(0.0, 3.0) / parameters.xi.max(1.0);
    let drift_rate = if draw.once_in(2) { 0.0 } else { draw.between(0.0, 2.0) };
    // (1 - q)/(2 xi) = closing
    let q = DoubleDouble::one() - exact.two_xi * dd(closing);
    let entry = State { p: q + exact.g, y: dd(closing) + dd(drift_rate), q };
    let slip = Progression {
        constants: exact,
        entry,
        angle: exact_angle(angle),
        drift_rate: dd(drift_rate),
        closing: dd(closing),
    };
    let constants = Constants::new(parameters);
    let rounded =
        Progression { constants, entry: rounded_state(entry), angle, drift_rate, closing };
    (Form::Slip(rounded), Form::Slip(slip))
}
