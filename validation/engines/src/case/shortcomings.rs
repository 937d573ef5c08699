//! `shortcomings.toml`: expected failures of engines on the cases inside the binary, row by row.

use super::bound::{NamePattern, Quantity, Shortcoming, Statistic};
use super::located::{FileError, FileText};
use crate::accuracy::Accuracy;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KnownFile {
    #[serde(default)]
    defects: Vec<DefectTable>,
}

/// A defect of an engine with every row on which it shows.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DefectTable {
    engine: String,
    why: Spanned<String>,
    rows: Vec<Spanned<KnownRow>>,
}

/// Case, tolerance (or negative step), quantity, statistic, least and largest value.
type KnownRow = (String, f64, Quantity, Statistic, f64, f64);

/// Reads the expected failures.
pub(super) fn read_shortcomings(file: &str, text: &str) -> Result<Vec<Shortcoming>, FileError> {
    let source = FileText { file, text };
    let wire: KnownFile = source.parse()?;
    let mut known = Vec::new();
    for DefectTable { engine, why, rows } in wire.defects {
        if why.get_ref().trim().is_empty() {
            return Err(source.error(&why, "why is empty: a reason is accepted"));
        }
        for row in rows {
            known.push(source.known_shortcoming(&engine, why.get_ref(), &row)?);
        }
    }
    Ok(known)
}

impl FileText<'_> {
    fn known_shortcoming(
        &self,
        engine: &str,
        why: &str,
        row: &Spanned<KnownRow>,
    ) -> Result<Shortcoming, FileError> {
        let (ref case, setting, quantity, statistic, at_least, at_most) = *row.get_ref();
        self.range(row, at_least, at_most)?;
        let exactly = |name: &str| NamePattern::Exactly(name.to_owned());
        let accuracy =
            if setting < 0.0 { Accuracy::Step(-setting) } else { Accuracy::Tolerance(setting) };
        Ok(Shortcoming {
            case: Some(exactly(case)),
            engine: exactly(engine),
            at: vec![accuracy],
            quantity,
            statistic,
            at_least,
            at_most,
            why: why.to_owned(),
        })
    }
}
