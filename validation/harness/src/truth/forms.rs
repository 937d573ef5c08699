//! The closed forms of the three phases in 106 bits, and rounded for the search of first crossings.

use super::DoubleDouble;
use percuss::TwoWord;
use percuss::insides::Constants;
use percuss::insides::angle;
use percuss::insides::flow::contact::Contact;
use percuss::insides::flow::forcing::EntryAngle;
use percuss::insides::flow::no_contact::NoContact;
use percuss::insides::flow::progression::Progression;
use percuss::insides::flow::steps::Steps;
use percuss::insides::flow::{Flow, Point};
use percuss::number::Number;
use percuss::{Instant, Parameters, Phase, State};

/// The beginning of a phase, with the values that are known exactly at that instant.
#[derive(Clone, Copy, Debug)]
pub(super) enum TruthEntry<T> {
    /// No contact, the mass away from the slider.
    Apart,
    /// No contact, on the surface with this rate of h; zero at a separation.
    Surface { h_rate: T },
    /// Contact with trial force `reference + offset`.
    Contact { offset: T, reference: T },
    /// Progression with this drift velocity and velocity of the slider's top.
    Progression { drift_rate: T, closing: T },
}

/// The closed form of one phase.
#[derive(Clone, Copy, Debug)]
pub(super) enum TruthMotion<T> {
    NoContact(NoContact<T>),
    Contact(Contact<T>),
    Progression(Progression<T>),
}

/// The model's constants in both arithmetics.
#[derive(Clone, Copy, Debug)]
pub(super) struct TruthForms {
    pub(super) constants: Constants<DoubleDouble>,
    rounded: Constants<f64>,
    pub(super) steps: Steps,
    phi: DoubleDouble,
    pub(super) omega: f64,
}

impl TruthForms {
    pub(super) fn new(parameters: &Parameters) -> Self {
        let (_, phi) = angle::reduce(TwoWord::new(parameters.phi));
        Self {
            constants: Constants::new(parameters),
            rounded: Constants::new(parameters),
            steps: Steps::new(parameters),
            phi: phi.into(),
            omega: parameters.omega,
        }
    }

    /// The phase that begins so.
    pub(super) fn motion(
        &self,
        instant: &Instant,
        entry: State<DoubleDouble>,
        mode: TruthEntry<DoubleDouble>,
    ) -> TruthMotion<DoubleDouble> {
        let radians = DoubleDouble::from(instant.angle_two_word()) + self.phi;
        let (sin, cos) = radians.sin_cos();
        motion(self.constants, entry, EntryAngle { radians, sin, cos }, mode)
    }

    /// The phase with everything rounded to f64.
    pub(super) fn rounded(&self, exact: &TruthMotion<DoubleDouble>) -> TruthMotion<f64> {
        let f = |x: DoubleDouble| x.to_f64();
        let (state, angle) = exact.entry();
        let entry = State { p: f(state.p), y: f(state.y), q: f(state.q) };
        let mode = match exact {
            TruthMotion::NoContact(it) => {
                it.surface.map_or(TruthEntry::Apart, |rate| TruthEntry::Surface { h_rate: f(rate) })
            }
            TruthMotion::Contact(it) => {
                TruthEntry::Contact { offset: f(it.offset), reference: f(it.reference) }
            }
            TruthMotion::Progression(it) => {
                TruthEntry::Progression { drift_rate: f(it.drift_rate), closing: f(it.closing) }
            }
        };
        let [radians, sin, cos] = [angle.radians, angle.sin, angle.cos].map(f);
        let angle = EntryAngle { radians, sin, cos };
        motion(self.rounded, entry, angle, mode)
    }
}

fn motion<T: Number>(
    constants: Constants<T>,
    entry: State<T>,
    angle: EntryAngle<T>,
    mode: TruthEntry<T>,
) -> TruthMotion<T> {
    match mode {
        TruthEntry::Apart => {
            TruthMotion::NoContact(NoContact { constants, entry, angle, surface: None })
        }
        TruthEntry::Surface { h_rate } => {
            TruthMotion::NoContact(NoContact { constants, entry, angle, surface: Some(h_rate) })
        }
        TruthEntry::Contact { offset, reference } => {
            TruthMotion::Contact(Contact { constants, entry, angle, offset, reference })
        }
        TruthEntry::Progression { drift_rate, closing } => {
            TruthMotion::Progression(Progression { constants, entry, angle, drift_rate, closing })
        }
    }
}

impl<T: Number> TruthMotion<T> {
    pub(super) fn phase(&self) -> Phase {
        match self {
            Self::NoContact(_) => Phase::NoContact,
            Self::Contact(_) => Phase::Contact,
            Self::Progression(_) => Phase::Progression,
        }
    }

    pub(super) fn entry(&self) -> (State<T>, EntryAngle<T>) {
        match self {
            Self::NoContact(it) => (it.entry, it.angle),
            Self::Contact(it) => (it.entry, it.angle),
            Self::Progression(it) => (it.entry, it.angle),
        }
    }

    pub(super) fn at(&self, elapsed: T) -> Point<T> {
        match self {
            Self::NoContact(it) => it.at(elapsed),
            Self::Contact(it) => it.at(elapsed),
            Self::Progression(it) => it.at(elapsed),
        }
    }
}
