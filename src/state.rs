//! The bounded co-ordinates of Eq. (10).

/// Displacements relative to the slider's bottom, and the velocity of the mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State<T = f64> {
    /// Displacement of the mass, p = x - v.
    pub p: T,
    /// Velocity of the mass, y = x'.
    pub y: T,
    /// Displacement of the slider's top, q = z - v.
    pub q: T,
}
