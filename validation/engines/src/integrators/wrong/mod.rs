//! Engines that are wrong on purpose, one fault each: a bound that no fault exceeds tests nothing.
//!
//! [`wrong`] are held to the exact solver's bounds, [`faulty`] to those of a good integrator. Some
//! faults each show in one [`Way`] of running a case of a system, and nowhere else.
//!
//! They never run beside the others; the power test runs them and asks which bounds notice. Four
//! are the exact solver on something slightly different; the others are a plain solver that
//! evaluates the closed forms in steps ([`stepper`]), and that stays within its bounds without a
//! fault.

mod altered;
mod closed;
mod integrator;
mod misled;
mod printed;
mod stepper;
mod systems;
mod ties;

use crate::engine::Engine;
use altered::{Alteration, Altered};
pub use closed::Closed;
use integrator::{Faulty, IntegratorFault};
use misled::SystemFault;
use stepper::{ClosedFormStepper, StepperFault};
pub use systems::COOLDOWN_TIME;
use systems::FaultyOnSystems;
use ties::LastFirst;

/// A wrong engine with a description of its fault.
#[derive(Clone, Copy)]
pub struct WrongEngine {
    /// The engine.
    pub engine: &'static dyn Engine,
    /// The engine's fault, in a phrase.
    pub fault: &'static str,
    /// The one way of running a case of a system in which the fault shows; others show on the
    /// oscillator.
    pub way: Option<Way>,
}

/// The walking solver without a fault: the control of the power test.
pub static CONTROL: &dyn Engine =
    &ClosedFormStepper { name: "stepper-control", fault: StepperFault::None };

/// The numbers of events of which the walking solver drops one.
pub const EVENTS_PER_DROPPED: [u64; 2] = [100, 1000];

static WRONG_ENGINES: [WrongEngine; 10] = [
    WrongEngine {
        engine: &ClosedFormStepper {
            name: "wrong-dropped-100",
            fault: StepperFault::Dropped(EVENTS_PER_DROPPED[0]),
        },
        fault: "every hundredth event is dropped",
        way: None,
    },
    WrongEngine {
        engine: &ClosedFormStepper {
            name: "wrong-dropped-1000",
            fault: StepperFault::Dropped(EVENTS_PER_DROPPED[1]),
        },
        fault: "every thousandth event is dropped",
        way: None,
    },
    WrongEngine {
        engine: &Altered { name: "wrong-omega", change: Alteration::Frequency },
        fault: "omega is larger by 0.002",
        way: None,
    },
    WrongEngine {
        engine: &Altered { name: "wrong-xi", change: Alteration::Damping },
        fault: "xi is larger by 1 %",
        way: None,
    },
    WrongEngine {
        engine: &Altered { name: "wrong-drift", change: Alteration::Drift },
        fault: "Eq. (20) as printed, with + before the exponential",
        way: None,
    },
    WrongEngine {
        engine: &ClosedFormStepper { name: "wrong-arctan", fault: StepperFault::Arctangent },
        fault: "Eqs. (15) to (17) as printed, with arctan for beta and delta",
        way: None,
    },
    WrongEngine {
        engine: &ClosedFormStepper { name: "wrong-sign-change", fault: StepperFault::SignChange },
        fault: "guards are looked at only where a step ends, for a change of sign",
        way: None,
    },
    WrongEngine {
        engine: &ClosedFormStepper { name: "wrong-impact", fault: StepperFault::ContactAtImpact },
        fault: "every impact goes into contact, none straight into progression",
        way: None,
    },
    WrongEngine {
        engine: &Altered { name: "wrong-clock", change: Alteration::Clock },
        fault: "time is one number: omega tau loses digits late in a run",
        way: None,
    },
    WrongEngine {
        engine: &LastFirst { name: "wrong-last-first" },
        fault: "of events in one instant the file's last comes first",
        way: Some(Way::Simultaneous),
    },
];

/// The wrong engines that have to exceed the exact solver's bounds.
#[must_use]
pub fn wrong() -> &'static [WrongEngine] {
    &WRONG_ENGINES
}

/// The integrator of [`faulty`] without a fault: the control of its power test.
pub static FAULTY_CONTROL: &dyn Engine =
    &Faulty { name: "dopri5-control", slip: IntegratorFault::None };

/// The number of events, or runs, of which an integrator drops, or gives up, one.
const CASES_PER_FAULT: u64 = 20;

macro_rules! faulty {
    ($name:literal, $slip:expr, $fault:literal) => {
        WrongEngine { engine: &Faulty { name: $name, slip: $slip }, fault: $fault, way: None }
    };
}

macro_rules! faulty_on_systems {
    ($way:ident, $name:literal, $slip:ident, $fault:literal) => {
        WrongEngine {
            engine: &FaultyOnSystems { name: $name, slip: SystemFault::$slip },
            fault: $fault,
            way: Some(Way::$way),
        }
    };
}

static FAULTY_ENGINES: [WrongEngine; 19] = [
    faulty!(
        "dopri5-drops",
        IntegratorFault::Dropped(CASES_PER_FAULT),
        "every twentieth event is not noticed"
    ),
    faulty!("dopri5-at-step-end", IntegratorFault::AtStepEnd, "an event is put at its step's end"),
    faulty!(
        "dopri5-sign-at-ends",
        IntegratorFault::SignAtEnds,
        "guards are looked at only at steps' ends"
    ),
    faulty!("dopri5-late", IntegratorFault::Late, "an event is found thirty tolerances late"),
    faulty!(
        "dopri5-old-derivative",
        IntegratorFault::OldDerivative,
        "a restart begins with the derivative of the phase before"
    ),
    faulty!(
        "dopri5-any-direction",
        IntegratorFault::AnyDirection,
        "the direction of a guard is ignored"
    ),
    faulty!(
        "dopri5-low-order",
        IntegratorFault::LowOrder,
        "the interpolant is of order 3 instead of 4"
    ),
    faulty!(
        "dopri5-parameters",
        IntegratorFault::Parameters,
        "b and xi are larger by 1e-4 of themselves"
    ),
    faulty!(
        "dopri5-gives-up",
        IntegratorFault::GivesUp(CASES_PER_FAULT),
        "some restarts end without a result"
    ),
    faulty_on_systems!(
        Backward,
        "dopri5-forward-directions",
        ForwardDirections,
        "back in time a watched guard counts in its direction of forward time"
    ),
    faulty_on_systems!(
        Backward,
        "dopri5-forward-forcing",
        ForwardForcing,
        "back in time the forcing's clock goes on ahead"
    ),
    faulty_on_systems!(
        Backward,
        "dopri5-past-boundary",
        PastBoundary,
        "back in time a run goes on past the boundary of its mode"
    ),
    faulty_on_systems!(
        Direction,
        "dopri5-both-directions",
        BothDirections,
        "the direction of a watched guard is ignored"
    ),
    faulty_on_systems!(
        StartOnGuard,
        "dopri5-fires-at-start",
        FiresAtStart,
        "a guard that is zero at the start is an event there"
    ),
    faulty_on_systems!(
        StartOnGuard,
        "dopri5-misses-at-start",
        MissesAtStart,
        "an event at the start is not noticed"
    ),
    faulty_on_systems!(
        OutputAtEvents,
        "dopri5-state-before",
        StateBefore,
        "an event has the state before its reset"
    ),
    faulty_on_systems!(
        OutputBetweenEvents,
        "dopri5-uncut-output",
        UncutOutput,
        "states in a step that an event cuts short are those of the whole step"
    ),
    faulty_on_systems!(
        Simultaneous,
        "dopri5-one-at-once",
        OneAtOnce,
        "of events in one instant the first alone is noticed"
    ),
    faulty_on_systems!(
        CloseEvents,
        "dopri5-cooldown",
        Cooldown,
        "for a hundredth of the system's unit of time after an event none is noticed"
    ),
];

/// Integrators with one fault each, held to the bounds of the engine without it,
/// [`CORRECT_ENGINE`].
#[must_use]
pub fn faulty() -> &'static [WrongEngine] {
    &FAULTY_ENGINES
}

/// The engine whose bounds [`faulty`] integrators are held to.
pub const CORRECT_ENGINE: &str = "ode_solvers-dopri5";

/// A way of running a case of a system, as far as the case itself tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// The case runs back in time.
    Backward,
    /// The case watches a guard in one direction.
    Direction,
    /// The case starts on a guard.
    StartOnGuard,
    /// The case asks for states at events: each event has the state after its reset.
    OutputAtEvents,
    /// The case asks for states between events, in steps that an event cuts short.
    OutputBetweenEvents,
    /// The case has several events in one instant.
    Simultaneous,
    /// The case has events in close succession, as in chatter and before an accumulation.
    CloseEvents,
}

impl Way {
    /// The property of the cases, in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Backward => "a run back in time",
            Self::Direction => "a guard that is watched in one direction",
            Self::StartOnGuard => "a start on a guard",
            Self::OutputAtEvents => "resets, after which each event has its state",
            Self::OutputBetweenEvents => "states asked for soon after an event",
            Self::Simultaneous => "several events in one instant",
            Self::CloseEvents => "events that follow each other closely",
        }
    }
}

/// The integrator of [`faulty`] on systems, without a fault.
pub static FAULTY_ON_SYSTEMS_CONTROL: &dyn Engine =
    &FaultyOnSystems { name: "dopri5-control", slip: SystemFault::None };
