//! The bounds and expected failures in a case file.

use super::bound::{Bound, NamePattern, Quantity, Shortcoming, Statistic};
use super::classes::ClassBounds;
use super::located::{FileError, FileText};
use crate::accuracy::Accuracy;
use regex::Regex;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoundsFile {
    bounds: Vec<BoundTable>,
}

/// The bounds and expected failures on every case, which come after the case's own.
#[derive(Clone, Debug, Default)]
pub struct Defaults {
    /// Bounds on every case, after the case's own.
    pub bounds: Vec<Bound>,
    /// Expected failures on many cases.
    pub shortcomings: Vec<Shortcoming>,
    /// The largest defects of right engines, by class of method.
    pub classes: Vec<ClassBounds>,
}

/// A key's value that is one number or a list of numbers.
#[derive(Deserialize)]
#[serde(untagged, expecting = "accepted is a number or a list of numbers")]
enum Several {
    One(f64),
    Many(Vec<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[bounds]]")]
pub(super) struct BoundTable {
    engine: Spanned<String>,
    tolerance: Option<Several>,
    step: Option<Several>,
    quantity: Quantity,
    statistic: Statistic,
    limit: Spanned<f64>,
    #[serde(default)]
    times_tolerance: bool,
    why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[shortcomings]]")]
pub(super) struct ShortcomingTable {
    case: Option<Spanned<String>>,
    engine: Spanned<String>,
    tolerance: Option<Several>,
    step: Option<Several>,
    quantity: Quantity,
    statistic: Option<Statistic>,
    at_least: Spanned<f64>,
    at_most: f64,
    why: String,
}

/// Reads the bounds of every case.
pub(super) fn read_bounds(file: &str, text: &str) -> Result<Defaults, FileError> {
    let source = FileText { file, text };
    let wire: BoundsFile = source.parse()?;
    let bounds = wire.bounds.into_iter().map(|it| source.bound(it));
    Ok(Defaults { bounds: bounds.collect::<Result<_, _>>()?, ..Defaults::default() })
}

/// The tolerances and steps that a bound names.
fn accuracies(tolerance: Option<Several>, step: Option<Several>) -> Vec<Accuracy> {
    let numbers = |several: Option<Several>| match several {
        None => Vec::new(),
        Some(Several::One(number)) => vec![number],
        Some(Several::Many(numbers)) => numbers,
    };
    let tolerances = numbers(tolerance).into_iter().map(Accuracy::Tolerance);
    tolerances.chain(numbers(step).into_iter().map(Accuracy::Step)).collect()
}

impl FileText<'_> {
    pub(super) fn bound(&self, table: BoundTable) -> Result<Bound, FileError> {
        let engine = self.pattern("engine", &table.engine)?;
        if table.limit.get_ref().is_nan() {
            return Err(self.refused("limit", &table.limit));
        }
        Ok(Bound {
            engine,
            at: accuracies(table.tolerance, table.step),
            quantity: table.quantity,
            statistic: table.statistic,
            limit: table.limit.into_inner(),
            times_tolerance: table.times_tolerance,
            why: table.why,
        })
    }

    pub(super) fn shortcoming(&self, table: ShortcomingTable) -> Result<Shortcoming, FileError> {
        let ShortcomingTable { at_least, at_most, quantity, why, .. } = table;
        self.range(&at_least, *at_least.get_ref(), at_most)?;
        Ok(Shortcoming {
            case: table.case.map(|case| self.pattern("case", &case)).transpose()?,
            engine: self.pattern("engine", &table.engine)?,
            at: accuracies(table.tolerance, table.step),
            quantity,
            statistic: table.statistic.unwrap_or(Statistic::Value),
            at_least: at_least.into_inner(),
            at_most,
            why,
        })
    }

    /// Refuses a range from a least to a largest value that holds no number.
    pub(super) fn range<T>(
        &self,
        place: &Spanned<T>,
        at_least: f64,
        at_most: f64,
    ) -> Result<(), FileError> {
        // Written so that a NaN is refused.
        let ordered = at_least <= at_most;
        if ordered {
            return Ok(());
        }
        let what = format!(
            "at_least = {at_least:?} and at_most = {at_most:?} are not accepted: at_least is at \
             most at_most"
        );
        Err(self.error(place, &what))
    }

    /// A pattern of whole names.
    fn pattern(&self, key: &str, pattern: &Spanned<String>) -> Result<NamePattern, FileError> {
        let whole = Regex::new(&format!("^(?:{})$", pattern.get_ref()));
        whole.map(NamePattern::Matching).map_err(|_| self.refused(key, pattern))
    }
}
