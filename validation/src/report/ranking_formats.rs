//! The ranked summary for a paper, a wiki or a script: Markdown, CSV and JSON.

use super::Report;
use super::ranking::Ranked;
use super::screen::figure;
use crate::number::shortest;
use serde::Serialize;
use std::io;

/// The summary's formats besides the screen for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RankingFormat {
    /// A Markdown table.
    Markdown,
    /// Comma-separated values with a header.
    Csv,
    /// An object with the ranking and the number of rows of each class.
    Json,
}

const COLUMNS: [&str; 11] = [
    "rank",
    "engine",
    "events_found",
    "events_checked",
    "events_total",
    "events_missed",
    "events_spurious",
    "event_time_error_units_median",
    "event_time_error_units_max",
    "rhs_per_event",
    "fails_on",
];

/// The ranked summary in a format.
///
/// # Errors
/// What the format's writer says; writing to memory gives none.
pub fn ranking_text(report: &Report, format: RankingFormat) -> io::Result<String> {
    match format {
        RankingFormat::Markdown => Ok(markdown(&report.ranking)),
        RankingFormat::Csv => csv(&report.ranking),
        RankingFormat::Json => json(report),
    }
}

fn markdown(ranking: &[Ranked]) -> String {
    let mut text = String::from(
        "| # | engine | found of checked of all | missed | spurious | time error, median | worst \
         | rhs/event | fails on |\n|--:|---|--:|--:|--:|--:|--:|--:|---|\n",
    );
    for it in ranking {
        let units = it.event_time_error_units;
        let rank = if it.is_reference() { "\u{2013}".to_owned() } else { it.rank.to_string() };
        let cost = it.rhs_per_event.map_or("\u{2013}".to_owned(), |cost| format!("{cost:.0}"));
        text.push_str(&format!(
            "| {rank} | {} | {} of {} of {} | {} | {} | {} | {} | {cost} | {} |\n",
            it.engine,
            it.events_found,
            it.events_checked,
            it.events_total,
            it.events_missed,
            it.events_spurious,
            figure(units.median),
            figure(units.max),
            it.fails_on.join(", ")
        ));
    }
    text
}

fn csv(ranking: &[Ranked]) -> io::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for it in ranking {
        let units = it.event_time_error_units;
        writer.write_record([
            it.rank.to_string(),
            it.engine.to_owned(),
            it.events_found.to_string(),
            it.events_checked.to_string(),
            it.events_total.to_string(),
            it.events_missed.to_string(),
            it.events_spurious.to_string(),
            shortest(units.median),
            shortest(units.max),
            it.rhs_per_event.map_or(String::new(), shortest),
            it.fails_on.join(" "),
        ])?;
    }
    let bytes = writer.into_inner().map_err(io::Error::other)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

#[derive(Serialize)]
struct Whole<'a> {
    schema: u32,
    percuss: &'a str,
    suite: crate::suite::Suite,
    ranking: &'a [Ranked],
    summary: super::Summary,
}

fn json(report: &Report) -> io::Result<String> {
    let whole = Whole {
        schema: report.build.schema,
        percuss: &report.build.percuss,
        suite: report.suite,
        ranking: &report.ranking,
        summary: report.summary,
    };
    Ok(serde_json::to_string_pretty(&whole)? + "\n")
}
