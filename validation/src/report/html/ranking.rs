//! The page's tables of engines: their ranking, and their valid horizons.

use super::super::{Ranked, Report, ReportRow};
use super::view::{count, glyph};
use crate::number::brief;
use crate::picture::Look;

/// A line of the ranking, for one engine.
pub(super) struct RankedLine {
    pub place: usize,
    /// The rank, or nothing for the reference.
    pub rank: String,
    pub name: &'static str,
    pub marker: &'static str,
    pub counts: [String; 3],
    /// Events found and missed, as percentages of all.
    pub shares: [f64; 2],
    pub missed: usize,
    pub spurious: usize,
    pub median: String,
    pub worst: String,
    pub rhs: String,
    pub fails: Vec<String>,
}

/// The ranking in its order; `looks` are those of the report's engines.
pub(super) fn ranked(report: &Report, looks: &[Look]) -> Vec<RankedLine> {
    let line = |it: &Ranked| {
        let place = report.engines.iter().position(|engine| engine.name == it.engine);
        let of_all = |events: usize| 100.0 * events as f64 / it.events_total.max(1) as f64;
        let marker = place.and_then(|place| looks.get(place)).map_or("", |it| glyph(it.marker));
        let shown = |value: f64| if value.is_finite() { brief(value) } else { NOTHING.to_owned() };
        RankedLine {
            place: place.unwrap_or(0),
            rank: if it.is_reference() { String::new() } else { it.rank.to_string() },
            name: it.engine,
            marker,
            counts: [it.events_found, it.events_checked, it.events_total]
                .map(|events| count(events as f64)),
            shares: [of_all(it.events_found), of_all(it.events_missed)],
            missed: it.events_missed,
            spurious: it.events_spurious,
            median: shown(it.event_time_error_units.median),
            worst: shown(it.event_time_error_units.max),
            rhs: it.rhs_per_event.map_or(NOTHING.to_owned(), count),
            fails: it.fails_on.clone(),
        }
    };
    report.ranking.iter().map(line).collect()
}

const NOTHING: &str = "\u{2013}";

/// The valid horizons of one row, as the page shows them.
pub(super) struct HorizonLine {
    pub case: String,
    pub who: String,
    pub runs: usize,
    pub figures: [f64; 3],
}

/// One line per row with valid horizons.
pub(super) fn horizons(report: &Report) -> Vec<HorizonLine> {
    let line = |row: &ReportRow| {
        let it = row.valid_horizon?;
        Some(HorizonLine {
            case: row.case.clone(),
            who: row.who(),
            runs: it.runs,
            figures: [it.q01, it.median, it.predicted_median],
        })
    };
    report.results.iter().filter_map(line).collect()
}
