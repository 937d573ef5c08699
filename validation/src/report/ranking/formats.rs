//! The ranked summary for a paper, a wiki or a script: Markdown, CSV and JSON.

use super::{Ranked, SettingCounts};
use crate::number::shortest;
use crate::report::Report;
use crate::report::screen::figure;
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

const COLUMNS: [&str; 19] = [
    "rank",
    "engine",
    "clean",
    "settings",
    "cases_right",
    "cases_total",
    "stiff_cases_right",
    "stiff_cases_total",
    "events_judged",
    "events_right",
    "events_missed",
    "events_spurious",
    "events_wrong_mode",
    "defect_units_median",
    "defect_units_q99",
    "cost_area",
    "cost_within_twice",
    "cost_rhs_per_event",
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
        "| # | engine | settings | cases right | of | missed | spurious | wrong mode | defect, \
         median | cost area | rhs/event | fails on |\n|--:|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\
         ---|\n",
    );
    for it in ranking {
        text.push_str(&format!("| {} |\n", cells(it).join(" | ")));
    }
    text
}

/// The cells of the Markdown table.
fn cells(it: &Ranked) -> [String; 12] {
    let dash = || "\u{2013}".to_owned();
    let shown = |value: Option<f64>| value.map_or_else(dash, figure);
    let counts = |it: &SettingCounts| join_counts(it, |(_, count)| count.to_string(), " / ");
    let engine = if it.clean { it.engine.to_owned() } else { format!("{} (!)", it.engine) };
    [
        it.shown_rank().map_or_else(dash, |rank| rank.to_string()),
        engine,
        join_counts(&it.cases_right, |(key, _)| key.clone(), " / "),
        counts(&it.cases_right),
        counts(&it.cases_total),
        it.events_missed.to_string(),
        it.events_spurious.to_string(),
        it.events_wrong_mode.to_string(),
        shown(it.defect_units.median),
        shown(it.cost.area),
        it.cost.rhs_per_event.map_or_else(dash, |cost| format!("{cost:.0}")),
        it.fails_on.join(", "),
    ]
}

/// The settings, or their counts, in one cell.
fn join_counts(
    counts: &SettingCounts,
    part: fn(&(String, usize)) -> String,
    between: &str,
) -> String {
    counts.0.iter().map(part).collect::<Vec<_>>().join(between)
}

fn csv(ranking: &[Ranked]) -> io::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for it in ranking {
        writer.write_record(record(it))?;
    }
    let bytes = writer.into_inner().map_err(io::Error::other)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// A line of the CSV; of the settings' counts one beside the other in a cell.
fn record(it: &Ranked) -> [String; 19] {
    let figure = |value: Option<f64>| value.map_or(String::new(), shortest);
    let counts = |it: &SettingCounts| join_counts(it, |(_, count)| count.to_string(), " ");
    [
        it.rank.map_or(String::new(), |rank| rank.to_string()),
        it.engine.to_owned(),
        it.clean.to_string(),
        join_counts(&it.cases_right, |(key, _)| key.clone(), " "),
        counts(&it.cases_right),
        counts(&it.cases_total),
        it.stiff.cases_right.to_string(),
        it.stiff.cases_total.to_string(),
        it.events_judged.to_string(),
        it.events_right.to_string(),
        it.events_missed.to_string(),
        it.events_spurious.to_string(),
        it.events_wrong_mode.to_string(),
        figure(it.defect_units.median),
        figure(it.defect_units.q99),
        figure(it.cost.area),
        figure(it.cost.within_twice),
        figure(it.cost.rhs_per_event),
        it.fails_on.join(" "),
    ]
}

#[derive(Serialize)]
struct Whole<'a> {
    schema: u32,
    percuss: &'a str,
    suite: crate::suite::Suite,
    ranking: &'a [Ranked],
    summary: crate::report::Summary,
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
