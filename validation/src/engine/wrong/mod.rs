//! Engines that are wrong on purpose, one fault each: what no fault trips is no gate.
//!
//! They never run beside the others; the power test runs them and asks which bounds notice. Three
//! are the exact solver on something slightly different; the others are a plain solver that walks
//! along the closed forms ([`walk`]), which without a fault stays within the bounds it is held to.

mod altered;
mod closed;
mod printed;
mod walk;

use super::Engine;
use altered::{Altered, Change};
pub(crate) use closed::Closed;
use walk::{Fault, Walk};

/// A wrong engine and what is wrong with it.
#[derive(Clone, Copy)]
pub struct Wrong {
    /// The engine.
    pub engine: &'static dyn Engine,
    /// Its fault, in a phrase.
    pub fault: &'static str,
}

/// The walking solver without a fault: the control of the power test.
pub static CONTROL: &dyn Engine = &Walk { name: "walk-control", fault: Fault::None };

/// How rarely an engine drops an event.
pub const DROPPED: [u64; 2] = [100, 1000];

static WRONG: [Wrong; 9] = [
    Wrong {
        engine: &Walk { name: "wrong-dropped-100", fault: Fault::Dropped(DROPPED[0]) },
        fault: "every hundredth event is dropped",
    },
    Wrong {
        engine: &Walk { name: "wrong-dropped-1000", fault: Fault::Dropped(DROPPED[1]) },
        fault: "every thousandth event is dropped",
    },
    Wrong {
        engine: &Altered { name: "wrong-omega", change: Change::Frequency },
        fault: "omega is larger by 0.002",
    },
    Wrong {
        engine: &Altered { name: "wrong-xi", change: Change::Damping },
        fault: "xi is larger by 1 %",
    },
    Wrong {
        engine: &Altered { name: "wrong-drift", change: Change::Drift },
        fault: "Eq. (20) as printed, with + before the exponential",
    },
    Wrong {
        engine: &Walk { name: "wrong-arctan", fault: Fault::Arctangent },
        fault: "Eqs. (15) to (17) as printed, with arctan for beta and delta",
    },
    Wrong {
        engine: &Walk { name: "wrong-sign-change", fault: Fault::SignChange },
        fault: "guards are looked at only where a step ends, for a change of sign",
    },
    Wrong {
        engine: &Walk { name: "wrong-impact", fault: Fault::ContactAtImpact },
        fault: "every impact goes into contact, none straight into progression",
    },
    Wrong {
        engine: &Altered { name: "wrong-clock", change: Change::Clock },
        fault: "time is one number: omega tau loses digits late in a run",
    },
];

/// All of them.
#[must_use]
pub fn wrong() -> &'static [Wrong] {
    &WRONG
}
