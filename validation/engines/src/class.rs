//! The classes of methods.

/// The class of a method. What a right method's errors are at most, in units of the tolerance, is
/// measured class by class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// One step from the last, by right-hand sides alone: Runge-Kutta methods and extrapolation.
    Explicit,
    /// One step from the last, by the solution of equations: Radau, Rosenbrock, DIRK and Gauss
    /// methods.
    Implicit,
    /// A step from several before it: Adams methods and BDF.
    Multistep,
    /// A step by the derivatives of the solution, to an order that the tolerance chooses.
    Taylor,
}
