//! The paper's side of the table (`paper.toml`): what it says, and nothing that we computed.

use crate::engine::Failure;
use percuss::Parameters;
use serde::Deserialize;
use std::collections::BTreeMap;

const FILE: &str = include_str!("../../paper.toml");

/// One row of Table 1 as printed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedRow {
    /// Token of the phase that begins.
    pub phase: String,
    /// Time.
    pub tau: f64,
    /// Displacement of the mass.
    pub p: f64,
    /// Its velocity.
    pub y: f64,
    /// Displacement of the slider's top.
    pub q: f64,
}

/// One claim as the paper makes it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Printed {
    /// In words.
    pub says: String,
    /// A printed number.
    pub value: Option<f64>,
    /// Half a unit of its last printed digit.
    pub within: Option<f64>,
    /// Periods of the periodic attractors, in forcing periods.
    #[serde(default)]
    pub periods: Vec<u32>,
    /// How many chaotic attractors there are.
    pub chaotic: Option<usize>,
    /// How many attractors there are.
    pub attractors: Option<usize>,
}

/// All that the paper says.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paper {
    /// Table 1.
    pub table1: Vec<PrintedRow>,
    claims: BTreeMap<String, Printed>,
}

/// The unit of the last digit in Table 1.
pub const TABLE_1_UNIT: f64 = 1e-5;

impl Paper {
    /// Reads it.
    ///
    /// # Errors
    /// A fault in the file; a test shows that there is none.
    pub fn read() -> Result<Self, Failure> {
        toml::from_str(FILE).map_err(|error| Failure::new(format!("paper.toml: {error}")))
    }

    /// What it says of one claim.
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
