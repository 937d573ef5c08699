//! The six parameters of the model and their ranges.

use crate::error::InputError;
use crate::unknown_name::UnknownName;
use std::fmt;
use std::str::FromStr;

/// The model's parameters, all non-dimensional (Section 2 of the paper).
///
/// Forces are in units of the dry-friction threshold d, lengths in d/k, time in sqrt(m/k). Ranges
/// are checked by [`Model::new`](crate::Model::new), not when parameters are read with `serde`;
/// what is not given there has its default.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Parameters {
    /// Amplitude of the harmonic force, 0 to 1e9.
    pub a: f64,
    /// Static force, -1e9 to 1e9.
    pub b: f64,
    /// Damping ratio of the slider, 1e-8 to 1e4.
    pub xi: f64,
    /// Frequency of the harmonic force, 1e-6 to 1e6.
    pub omega: f64,
    /// Gap between mass and slider top, 0 to 1e9.
    pub g: f64,
    /// Phase of the harmonic force, radians, -1e15 to 1e15.
    pub phi: f64,
}

impl Default for Parameters {
    /// The chaotic example of the paper (Fig. 5).
    fn default() -> Self {
        Self { a: 0.3, b: 0.1, xi: 0.01, omega: 1.4, g: 0.02, phi: std::f64::consts::FRAC_PI_2 }
    }
}

impl Parameters {
    /// Checks every parameter against its range.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] names the first parameter that is outside.
    pub fn check(&self) -> Result<(), InputError> {
        within("a", self.a, 0.0, 1e9, "0 <= a <= 1e9")?;
        within("b", self.b, -1e9, 1e9, "-1e9 <= b <= 1e9")?;
        within("xi", self.xi, 1e-8, 1e4, "1e-8 <= xi <= 1e4")?;
        within("omega", self.omega, 1e-6, 1e6, "1e-6 <= omega <= 1e6")?;
        within("g", self.g, 0.0, 1e9, "0 <= g <= 1e9")?;
        within("phi", self.phi, -1e15, 1e15, "-1e15 <= phi <= 1e15")
    }
}

/// A parameter, named by the paper's symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Parameter {
    /// Amplitude of the harmonic force.
    A,
    /// Static force.
    B,
    /// Damping ratio.
    Xi,
    /// Forcing frequency.
    Omega,
    /// Gap.
    G,
    /// Phase of the harmonic force.
    Phi,
}

impl Parameter {
    /// All parameters.
    pub const ALL: [Self; 6] = [Self::A, Self::B, Self::Xi, Self::Omega, Self::G, Self::Phi];

    /// The name used in files and on the command line.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
            Self::Xi => "xi",
            Self::Omega => "omega",
            Self::G => "g",
            Self::Phi => "phi",
        }
    }

    /// The parameter's value.
    #[must_use]
    pub const fn of(self, parameters: &Parameters) -> f64 {
        match self {
            Self::A => parameters.a,
            Self::B => parameters.b,
            Self::Xi => parameters.xi,
            Self::Omega => parameters.omega,
            Self::G => parameters.g,
            Self::Phi => parameters.phi,
        }
    }

    /// The parameters with this one set to `value`, unchecked.
    #[must_use]
    pub const fn set(self, mut parameters: Parameters, value: f64) -> Parameters {
        match self {
            Self::A => parameters.a = value,
            Self::B => parameters.b = value,
            Self::Xi => parameters.xi = value,
            Self::Omega => parameters.omega = value,
            Self::G => parameters.g = value,
            Self::Phi => parameters.phi = value,
        }
        parameters
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Parameter {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("parameter", &Self::ALL, Self::as_str, name)
    }
}

/// `low <= value <= high`; a NaN is outside.
pub(crate) fn within(
    name: &'static str,
    value: f64,
    low: f64,
    high: f64,
    accepted: &'static str,
) -> Result<(), InputError> {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(InputError::OutOfRange { name, value, accepted })
    }
}
