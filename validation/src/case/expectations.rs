//! What a case file says of engines: bounds and known shortcomings.

use super::bound::{Bound, Quantity, Shortcoming, Statistic};
use super::located::{FileError, Source};
use crate::engine::Accuracy;
use regex::Regex;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoundsFile {
    bounds: Vec<Spanned<BoundTable>>,
}

/// What is expected of engines on every case, after what the case says itself.
#[derive(Clone, Debug, Default)]
pub struct Defaults {
    /// Bounds that come after the case's own.
    pub bounds: Vec<Bound>,
    /// Shortcomings that show on many cases.
    pub shortcomings: Vec<Shortcoming>,
}

/// One or several.
#[derive(Deserialize)]
#[serde(untagged, expecting = "accepted is a number or a list of numbers")]
enum Several {
    One(f64),
    Many(Vec<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[bounds]]")]
pub(super) struct BoundTable {
    engine: String,
    tolerance: Option<Several>,
    step: Option<Several>,
    quantity: Quantity,
    statistic: Statistic,
    limit: f64,
    #[serde(default)]
    times_tolerance: bool,
    why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[shortcomings]]")]
pub(super) struct ShortcomingTable {
    case: Option<String>,
    engine: String,
    tolerance: Option<Several>,
    step: Option<Several>,
    quantity: Quantity,
    statistic: Option<Statistic>,
    at_least: f64,
    at_most: f64,
    why: String,
}

/// Reads the bounds of every case.
pub(super) fn read_bounds(file: &str, text: &str) -> Result<Vec<Bound>, FileError> {
    let source = Source { file, text };
    let wire: BoundsFile = source.parse()?;
    wire.bounds.into_iter().map(|it| source.bound(it)).collect()
}

/// The tolerances and steps that are named.
fn accuracies(tolerance: Option<Several>, step: Option<Several>) -> Vec<Accuracy> {
    let numbers = |several: Option<Several>| match several {
        None => Vec::new(),
        Some(Several::One(number)) => vec![number],
        Some(Several::Many(numbers)) => numbers,
    };
    let tolerances = numbers(tolerance).into_iter().map(Accuracy::Tolerance);
    tolerances.chain(numbers(step).into_iter().map(Accuracy::Step)).collect()
}

impl Source<'_> {
    pub(super) fn bound(&self, item: Spanned<BoundTable>) -> Result<Bound, FileError> {
        let engine = self.regex(&item, "engine", &item.get_ref().engine)?;
        if item.get_ref().limit.is_nan() {
            return Err(self.error(&item, "limit = nan is not accepted: a number"));
        }
        let table = item.into_inner();
        Ok(Bound {
            engine,
            at: accuracies(table.tolerance, table.step),
            quantity: table.quantity,
            statistic: table.statistic,
            limit: table.limit,
            times_tolerance: table.times_tolerance,
            why: table.why,
        })
    }

    pub(super) fn shortcoming(
        &self,
        item: Spanned<ShortcomingTable>,
    ) -> Result<Shortcoming, FileError> {
        let table = item.get_ref();
        let engine = self.regex(&item, "engine", &table.engine)?;
        let case = table.case.as_ref().map(|it| self.regex(&item, "case", it)).transpose()?;
        let (at_least, at_most) = (table.at_least, table.at_most);
        // Written so that a NaN is refused.
        let ordered = at_least <= at_most;
        if !ordered {
            let what = format!(
                "at_least = {at_least:?} and at_most = {at_most:?} are not accepted: a floor and a \
                 ceiling above it"
            );
            return Err(self.error(&item, &what));
        }
        let ShortcomingTable { tolerance, step, quantity, statistic, why, .. } = item.into_inner();
        let (at, statistic) = (accuracies(tolerance, step), statistic.unwrap_or(Statistic::Value));
        Ok(Shortcoming { case, engine, at, quantity, statistic, at_least, at_most, why })
    }

    pub(super) fn regex<T>(
        &self,
        item: &Spanned<T>,
        of: &str,
        pattern: &str,
    ) -> Result<Regex, FileError> {
        Regex::new(&format!("^(?:{pattern})$")).map_err(|_| {
            self.error(item, &format!("{of} {pattern:?} is not accepted: a regular expression"))
        })
    }
}
