//! An engine's declaration: everything that the rest of the program has to know about the engine.

use crate::accuracy::Stepping;
pub use crate::class::Class;

/// The name of the exact solver, with which the names of all exact engines begin and no other.
pub const REFERENCE: &str = "exact";

/// The way in which an engine locates events.
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

/// The tests in which an engine takes part. Each role includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// The engine takes part in the suite's rows of case, engine and tolerance only.
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
    /// The colours of all engines that are not part of percuss.
    pub const OTHERS: Self = Self::Hues(282.0, 336.0);
}

/// An engine's declaration of its method and its abilities.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// The engine's name, as in `-e`.
    pub name: &'static str,
    /// The library that the engine belongs to.
    pub library: &'static str,
    /// The library's version, which is pinned.
    pub version: String,
    /// The method.
    pub method: &'static str,
    /// The method's class; closed forms have none.
    pub class: Option<Class>,
    /// The order of convergence that the method's authors state. Methods of variable order and
    /// closed forms have none.
    pub order: Option<u32>,
    /// The way in which the engine locates events.
    pub events: Location,
    /// Whether the method has dense output of its own.
    pub dense_output: bool,
    /// The way in which the engine's accuracy is chosen.
    pub stepping: Stepping,
    /// The tests beyond ordinary rows in which the engine takes part.
    pub role: Role,
    /// The colours in which the engine is drawn.
    pub colours: Colours,
}

impl Declaration {
    /// The method's class and order, where they are declared.
    #[must_use]
    pub const fn class_and_order(&self) -> (Option<Class>, Option<u32>) {
        (self.class, self.order)
    }

    /// Whether stiffness shortens the method's steps: those of a fixed length stay as they are.
    #[must_use]
    pub fn is_slowed_by_stiffness(&self) -> bool {
        self.class == Some(Class::Explicit) && !matches!(self.stepping, Stepping::Fixed { .. })
    }
}
