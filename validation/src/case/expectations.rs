//! What a case file says of engines: bounds and known shortcomings.

use super::bound::{Bound, Quantity, Shortcoming, Statistic};
use super::located::{FileError, Source};
use crate::engine::Accuracy;
use regex::Regex;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DefaultsFile {
    bounds: Vec<Spanned<BoundTable>>,
    #[serde(default)]
    shortcomings: Vec<Spanned<ShortcomingTable>>,
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
    #[serde(default)]
    coarser_than: f64,
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
    #[serde(default)]
    fails: bool,
    quantity: Option<Quantity>,
    statistic: Option<Statistic>,
    at_least: Option<f64>,
    why: String,
}

/// Reads what is expected on every case.
pub(super) fn read_defaults(file: &str, text: &str) -> Result<Defaults, FileError> {
    let source = Source { file, text };
    let wire: DefaultsFile = source.parse()?;
    let bounds = wire.bounds.into_iter().map(|it| source.bound(it)).collect::<Result<_, _>>()?;
    let shortcomings = wire.shortcomings.into_iter().map(|it| source.shortcoming(it));
    Ok(Defaults { bounds, shortcomings: shortcomings.collect::<Result<_, _>>()? })
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
            coarser_than: table.coarser_than,
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
        let statistic = table.statistic.unwrap_or(Statistic::Value);
        let shows = match (table.fails, table.quantity, table.at_least) {
            (true, None, None) => None,
            (false, Some(quantity), Some(at_least)) if !at_least.is_nan() => {
                Some((quantity, statistic, at_least))
            }
            _ => {
                let what = "shortcoming: either fails = true or quantity and at_least are accepted";
                return Err(self.error(&item, what));
            }
        };
        let ShortcomingTable { tolerance, step, why, .. } = item.into_inner();
        Ok(Shortcoming { case, engine, at: accuracies(tolerance, step), shows, why })
    }

    fn regex<T>(&self, item: &Spanned<T>, of: &str, pattern: &str) -> Result<Regex, FileError> {
        Regex::new(&format!("^(?:{pattern})$")).map_err(|_| {
            self.error(item, &format!("{of} {pattern:?} is not accepted: a regular expression"))
        })
    }
}
