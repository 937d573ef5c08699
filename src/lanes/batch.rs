//! As many phases of one kind as there are lanes: how they begin and what becomes of them.

use super::shape::Shape;
use super::wide::LaneValues;

/// The task that all lanes of a batch have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum LaneTask {
    /// Flights, from separation to impact.
    Flight,
    /// Contacts, to either threshold.
    Contact,
    /// Flights whose certificate has failed, certified again in finer pieces.
    FlightAgain,
    /// Contacts whose certificate has failed, certified again in finer pieces.
    ContactAgain,
    /// Progressions, until the slider's bottom stops.
    Slip,
    /// Strobes in a flight.
    FlightStrobe,
    /// Strobes in a contact.
    ContactStrobe,
    /// Strobes in a progression.
    SlipStrobe,
}

impl LaneTask {
    /// All tasks.
    pub const ALL: [Self; 8] = [
        Self::Flight,
        Self::Contact,
        Self::FlightAgain,
        Self::ContactAgain,
        Self::Slip,
        Self::FlightStrobe,
        Self::ContactStrobe,
        Self::SlipStrobe,
    ];

    /// Whether the task is a strobe.
    pub const fn is_strobe(self) -> bool {
        matches!(self, Self::FlightStrobe | Self::ContactStrobe | Self::SlipStrobe)
    }

    /// The task that certifies the same phase in finer pieces, where there is one.
    pub const fn finer_task(self) -> Option<Self> {
        match self {
            Self::Flight => Some(Self::FlightAgain),
            Self::Contact => Some(Self::ContactAgain),
            _ => None,
        }
    }

    /// Strobes in the same phase.
    pub const fn strobe(self) -> Self {
        match self {
            Self::Flight | Self::FlightAgain | Self::FlightStrobe => Self::FlightStrobe,
            Self::Contact | Self::ContactAgain | Self::ContactStrobe => Self::ContactStrobe,
            Self::Slip | Self::SlipStrobe => Self::SlipStrobe,
        }
    }
}

/// How the phases begin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Begin {
    /// omega tau mod 2 pi.
    pub angle: LaneValues,
    /// The second word of the forcing angle.
    pub angle_low: LaneValues,
    /// Velocity of the mass.
    pub y: LaneValues,
    /// Displacement of the slider's top; the mass is in touch with it.
    pub q: LaneValues,
    /// The guard's value: in contact the force less its reference; in progression the drift
    /// velocity.
    pub first: LaneValues,
    /// A second value: in contact the reference; in progression the velocity of the slider's top.
    pub second: LaneValues,
    /// The strobe's time in forcing cycles from the phase's own.
    pub due_cycles: LaneValues,
    /// The strobe's forcing angle.
    pub due: LaneValues,
    /// The second word of the strobe's forcing angle.
    pub due_low: LaneValues,
}

/// How the phases end.
#[derive(Clone, Copy, Debug, Default)]
pub struct PhaseEnds {
    /// One where the lane's result is proved; where it is not, the lane's other numbers mean
    /// nothing.
    pub proved: LaneValues,
    /// omega tau mod 2 pi at the switch.
    pub angle: LaneValues,
    /// The second word of the forcing angle at the switch.
    pub angle_low: LaneValues,
    /// Forcing cycles passed.
    pub cycles: LaneValues,
    /// Displacement of the mass (at a strobe).
    pub p: LaneValues,
    /// Velocity of the mass.
    pub y: LaneValues,
    /// Displacement of the slider's top (not where contact or progression end).
    pub q: LaneValues,
    /// The guard: at an impact the trial force, at a contact's end the threshold, at a strobe the
    /// guard.
    pub guard: LaneValues,
    /// Drift gained.
    pub drift: LaneValues,
    /// The velocity of the slider's top at a strobe in progression.
    pub closing: LaneValues,
    /// The largest term of the guard at a strobe in progression.
    pub terms: LaneValues,
}

/// Constants, beginnings and ends of all lanes; a column is as long as a line of the cache and
/// fills one.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub struct Batch {
    /// The constants of the lanes' models.
    pub shape: Shape<LaneValues>,
    /// How the phases begin.
    pub begin: Begin,
    /// How the phases end.
    pub end: PhaseEnds,
}
