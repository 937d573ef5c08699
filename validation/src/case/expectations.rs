//! What a case file says of engines: bounds and known shortcomings.

use super::bound::{Bound, Quantity, Shortcoming, Statistic};
use super::located::{FileError, Source};
use regex::Regex;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoundsFile {
    bounds: Vec<Spanned<BoundTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoundTable {
    engine: String,
    tolerance: Option<f64>,
    quantity: Quantity,
    statistic: Statistic,
    limit: f64,
    #[serde(default)]
    times_tolerance: bool,
    why: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShortcomingTable {
    engine: String,
    tolerance: Option<f64>,
    #[serde(default)]
    fails: bool,
    quantity: Option<Quantity>,
    statistic: Option<Statistic>,
    at_least: Option<f64>,
    why: String,
}

/// Reads the bounds that hold where a case has none of its own.
pub(super) fn read_bounds(file: &str, text: &str) -> Result<Vec<Bound>, FileError> {
    let source = Source { file, text };
    let wire: BoundsFile = source.parse()?;
    wire.bounds.into_iter().map(|bound| source.bound(bound)).collect()
}

impl Source<'_> {
    pub(super) fn bound(&self, item: Spanned<BoundTable>) -> Result<Bound, FileError> {
        let engine = self.regex(&item, &item.get_ref().engine)?;
        if item.get_ref().limit.is_nan() {
            return Err(self.error(&item, "limit = nan is not accepted: a number"));
        }
        let BoundTable { tolerance, quantity, statistic, limit, times_tolerance, why, .. } =
            item.into_inner();
        Ok(Bound { engine, tolerance, quantity, statistic, limit, times_tolerance, why })
    }

    pub(super) fn shortcoming(
        &self,
        item: Spanned<ShortcomingTable>,
    ) -> Result<Shortcoming, FileError> {
        let table = item.get_ref();
        let engine = self.regex(&item, &table.engine)?;
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
        let ShortcomingTable { tolerance, why, .. } = item.into_inner();
        Ok(Shortcoming { engine, tolerance, shows, why })
    }

    fn regex<T>(&self, item: &Spanned<T>, pattern: &str) -> Result<Regex, FileError> {
        Regex::new(&format!("^(?:{pattern})$")).map_err(|_| {
            self.error(item, &format!("engine {pattern:?} is not accepted: a regular expression"))
        })
    }
}
