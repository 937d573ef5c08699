//! What an engine says of itself: all that the rest of the program has to know about it.

use crate::accuracy::Stepping;

/// The name of the exact solver, with which the names of all exact engines begin and no other.
pub const REFERENCE: &str = "exact";

/// How an engine finds its events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Location {
    /// Events are located in closed form and proved to be the first.
    Proved,
    /// Events are located by the library's own event location.
    Library,
    /// Events are located by this harness on the library's dense output.
    Harness,
}

/// What an engine is run for beside its rows. Each role includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// The engine has its rows, and nothing else.
    Rows,
    /// `bench` also measures what the engine's work costs against the damping ratio.
    Damping,
    /// The engine stands for its library where all engines would be too many: in the probes of the
    /// quick suite, in long runs, and in pictures.
    Representative,
}

/// The family of colours that a library's engines are drawn in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colours {
    /// Black on white and white on black: the reference.
    Ink,
    /// Hues from the first to the second, degrees; each engine of the family has a shade.
    Hues(f64, f64),
}

impl Colours {
    /// The family of engines that are not percuss's own.
    pub const OTHERS: Self = Self::Hues(282.0, 336.0);
}

/// What an engine says of itself.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// The engine's name, as in `-e`.
    pub name: &'static str,
    /// The library it is of.
    pub library: &'static str,
    /// The library's version, which is pinned.
    pub version: String,
    /// The method.
    pub method: &'static str,
    /// The order of convergence that the method's authors state. Methods of variable order and
    /// closed forms have none.
    pub order: Option<u32>,
    /// How it finds events.
    pub events: Location,
    /// Whether it has dense output of its own.
    pub dense_output: bool,
    /// How its accuracy is chosen.
    pub stepping: Stepping,
    /// What it is run for beside its rows.
    pub role: Role,
    /// The colours it is drawn in.
    pub colours: Colours,
}
