//! The paper's side of the table (`paper.toml`): what it says, and nothing that we computed.

use crate::engine::Failure;
use percuss::Parameters;
use serde::Deserialize;
use std::collections::BTreeMap;

const FILE: &str = include_str!("../paper.toml");

/// A row of Table 1 as printed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedRow {
    /// Token of the phase that begins.
    pub phase: String,
    /// Time.
    pub tau: f64,
    /// Displacement of the mass.
    pub p: f64,
    /// The velocity of the mass.
    pub y: f64,
    /// Displacement of the slider's top.
    pub q: f64,
}

/// A claim with the values that the paper prints.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Printed {
    /// The claim in words.
    pub says: String,
    /// A printed number.
    pub value: Option<f64>,
    /// Half a unit of the last printed digit of the value.
    pub within: Option<f64>,
    /// Whether the paper calls the value approximate.
    #[serde(default)]
    pub approximate: bool,
    /// Periods of the periodic attractors, in forcing periods.
    #[serde(default)]
    pub periods: Vec<u32>,
    /// The number of chaotic attractors.
    pub chaotic: Option<usize>,
    /// The number of attractors.
    pub attractors: Option<usize>,
}

/// The paper's claims and printed values.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paper {
    /// Table 1.
    pub table1: Vec<PrintedRow>,
    claims: BTreeMap<String, Printed>,
}

/// Rounding of the printed value's own binary form, relative to it.
const BINARY_ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Printed {
    /// Whether a value is the printed one to its last digit.
    #[must_use]
    pub fn prints(&self, value: f64) -> bool {
        self.value.zip(self.within).is_some_and(|(paper, within)| (value - paper).abs() <= within)
    }

    /// Whether a value agrees with the printed one: it equals that to its last digit or, where the
    /// paper calls its value approximate, its digits are at most one unit of the last one away. The
    /// paper rounds some numbers and cuts others (Table 1 does both), so this has to hold for the
    /// rounded as for the cut value.
    #[must_use]
    pub fn agrees(&self, value: f64) -> bool {
        let near = |paper: f64, half: f64| {
            let (unit, rounding) = (2.0 * half, BINARY_ROUNDING * paper.abs());
            let units = (value - paper) / unit;
            let room = rounding / unit;
            // A value of at least one unit less keeps, when it is cut, the digits of one unit less;
            // one of up to one and a half units more is rounded to one unit more.
            -1.0 - room <= units && units < 1.5 + room
        };
        self.prints(value)
            || self.approximate
                && self.value.zip(self.within).is_some_and(|(paper, half)| near(paper, half))
    }
}

/// The unit of the last digit in Table 1.
pub const TABLE_1_UNIT: f64 = 1e-5;

impl Paper {
    /// Reads the paper's claims from the file inside the binary.
    ///
    /// # Errors
    /// A fault in the file; a test shows that there is none.
    pub fn read() -> Result<Self, Failure> {
        toml::from_str(FILE).map_err(|error| Failure::new(format!("paper.toml: {error}")))
    }

    /// The paper's statement of one claim.
    ///
    /// # Errors
    /// A claim that it does not make; a test shows that there is none.
    pub fn claim(&self, id: &str) -> Result<&Printed, Failure> {
        let unknown = || Failure::new(format!("paper.toml has no claim {id}"));
        self.claims.get(id).ok_or_else(unknown)
    }

    /// Ids of all claims.
    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.claims.keys().map(String::as_str)
    }
}

/// The parameters of Table 1 and Figs. 3 and 4.
#[must_use]
pub fn table_1_model() -> Parameters {
    Parameters { omega: 0.1, xi: 0.01, ..Parameters::default() }
}

/// The parameters of Figs. 5 and 6.
#[must_use]
pub fn chaotic_model() -> Parameters {
    Parameters { omega: 1.4, xi: 0.01, ..Parameters::default() }
}

/// The parameters of Figs. 7 to 10.
#[must_use]
pub fn attractors_model(omega: f64) -> Parameters {
    Parameters { omega, xi: 0.1, ..Parameters::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(approximate: bool) -> Printed {
        Printed {
            says: String::new(),
            value: Some(1.571),
            within: Some(0.0005),
            approximate,
            periods: Vec::new(),
            chaotic: None,
            attractors: None,
        }
    }

    #[test]
    fn an_approximate_value_has_room_of_one_unit_however_its_digits_were_made() {
        for (value, prints, agrees) in [
            (1.571, true, true),
            (1.5714, true, true),
            // 1.572 rounded and cut
            (1.5721, false, true),
            (1.5724, false, true),
            // 1.573 rounded
            (1.5726, false, false),
            // 1.570 rounded and cut
            (1.5700, false, true),
            // 1.570 rounded, but 1.569 cut
            (1.5699997, false, false),
            (f64::NAN, false, false),
        ] {
            assert_eq!(printed(false).prints(value), prints, "{value}");
            assert_eq!(printed(false).agrees(value), prints, "{value}");
            assert_eq!(printed(true).agrees(value), agrees, "{value}");
        }
    }
}
