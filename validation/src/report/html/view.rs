//! The parts of the page that need no script, as the template takes them.

use super::super::grazing::{Grazing, Seen, Touches};
use super::super::summary::{EngineSummary, SettingSummary};
use super::super::trouble::{Trouble, TroubleCell};
use super::super::{Report, ReportEvidence};
use crate::number::brief;
use crate::picture::{Look, Marker};
use crate::score::Verdict;
use std::fmt::Write;

/// Failures shown at the top; all are in the table.
const MAX_FAILURES: usize = 30;

pub(super) struct EngineLine {
    pub place: usize,
    pub name: &'static str,
    pub library: &'static str,
    pub version: String,
    pub method: &'static str,
    pub marker: &'static str,
    /// The verdict's style class and its text.
    pub verdict: (&'static str, String),
    pub counts: String,
    /// The typical errors of event times and of the state, and the right-hand sides.
    pub figures: [String; 3],
    pub finest: String,
    /// How many rows at the finest setting were run, and of how many.
    pub rows: String,
    /// Whether these are too few for its figures to stand beside those of others.
    pub partial: bool,
    pub recall: Vec<RecallCell>,
    /// Events found, checked and all, over all settings.
    pub overall: String,
    /// Whether events that were checked are missing.
    pub incomplete: bool,
}

pub(super) struct RecallCell {
    pub setting: String,
    pub text: String,
    pub note: String,
    /// The level from 0, nothing found, to 4, everything found and nothing spurious.
    pub level: u8,
}

pub(super) fn engines(
    report: &Report,
    summaries: &[EngineSummary],
    looks: &[Look],
) -> Vec<EngineLine> {
    let lines = report.engines.iter().zip(summaries).enumerate();
    let line =
        |(place, (engine, summary)): (usize, (&super::super::EngineEntry, &EngineSummary))| {
            let finest = summary.settings.last();
            let figure = |figure: fn(&SettingSummary) -> f64| {
                finest.map_or(String::new(), |it| formatted(figure(it)))
            };
            EngineLine {
                place,
                name: engine.name,
                library: engine.library,
                version: engine.version.clone(),
                method: engine.method,
                marker: looks.get(place).map_or("", |look| glyph(look.marker)),
                verdict: verdict(summary),
                counts: counts(summary),
                figures: [
                    figure(|it| it.time_error),
                    figure(|it| it.state_error),
                    finest.map_or(String::new(), |it| count(it.rhs)),
                ],
                rows: finest.map_or(String::new(), |it| format!("{} of {}", it.runs, it.rows)),
                partial: finest.is_some_and(|it| !it.is_over_most_rows()),
                finest: finest.map_or(String::new(), |it| it.setting.clone()),
                recall: summary.settings.iter().map(recall).collect(),
                overall: events_found(summary),
                incomplete: summary.settings.iter().any(|it| it.matched < it.expected),
            }
        };
    lines.map(line).collect()
}

fn formatted(value: f64) -> String {
    if value.is_nan() {
        "\u{2013}".to_owned()
    } else if value.is_infinite() {
        "\u{221e}".to_owned()
    } else {
        brief(value)
    }
}

/// A count with thin groups of three.
pub(super) fn count(value: f64) -> String {
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    let digits = format!("{value:.0}");
    let groups: Vec<_> = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy).collect();
    groups.join("\u{202f}")
}

fn verdict(summary: &EngineSummary) -> (&'static str, String) {
    let count = |verdict| summary.count(verdict);
    // A row that was not run hides nothing worse.
    let by_weight = [
        Verdict::Error,
        Verdict::Fail,
        Verdict::Known,
        Verdict::NotRun,
        Verdict::Unavailable,
        Verdict::NotScored,
        Verdict::Undecidable,
        Verdict::Pass,
    ];
    let worst = by_weight.into_iter().find(|it| count(*it) > 0);
    match worst.unwrap_or(Verdict::NotScored) {
        Verdict::Pass => ("pass", "every row passes".to_owned()),
        other => (other.as_str(), format!("{} {}", count(other), other.as_str())),
    }
}

fn counts(summary: &EngineSummary) -> String {
    let classes = Verdict::ALL.into_iter().rev().map(|it| (it, summary.count(it)));
    let shown = classes.filter(|it| it.1 > 0);
    shown.map(|(it, count)| format!("{count} {}", it.as_str())).collect::<Vec<_>>().join(", ")
}

fn recall(summary: &SettingSummary) -> RecallCell {
    let SettingSummary { matched, expected, total, spurious, failed, .. } = *summary;
    let share = summary.recall();
    let level = match share {
        share if share.is_nan() || share < 0.9 => 0,
        share if share < 0.99 => 1,
        share if share < 1.0 => 2,
        _ if spurious > 0 || failed > 0 => 3,
        _ => 4,
    };
    let mut note = format!("{matched} found of {expected} checked of {total} events");
    if spurious > 0 {
        let _ = write!(note, ", {spurious} spurious");
    }
    if failed > 0 {
        let _ = write!(note, ", {failed} runs without a result");
    }
    let text = format!("{matched}/{expected}/{total}");
    RecallCell { setting: summary.setting.clone(), text, note, level }
}

/// Events found, checked and all, over all settings.
fn events_found(summary: &EngineSummary) -> String {
    let sum =
        |count: fn(&SettingSummary) -> usize| -> usize { summary.settings.iter().map(count).sum() };
    format!("{}/{}/{}", sum(|it| it.matched), sum(|it| it.expected), sum(|it| it.total))
}

pub(super) struct FailureView {
    pub verdict: &'static str,
    pub case: String,
    pub who: String,
    pub why: String,
}

/// The failures and errors that the page lists, and the number of further ones.
pub(super) fn failures(report: &Report) -> (Vec<FailureView>, usize) {
    let bad =
        report.results.iter().filter(|it| matches!(it.verdict, Verdict::Fail | Verdict::Error));
    let all: Vec<_> = bad
        .map(|row| FailureView {
            verdict: row.verdict.as_str(),
            case: row.case.clone(),
            who: row.who(),
            why: row.why.clone(),
        })
        .collect();
    let more = all.len().saturating_sub(MAX_FAILURES);
    (all.into_iter().take(MAX_FAILURES).collect(), more)
}

/// Margins, and engines with one cell per margin: class, glyph and title of each setting.
pub(super) struct GrazingTable {
    pub margins: Vec<(bool, String)>,
    pub lines: Vec<(String, Vec<Vec<SeenCell>>)>,
}

pub(super) struct SeenCell {
    pub class: &'static str,
    pub glyph: &'static str,
    pub title: String,
}

/// The kinds of trouble by engines.
pub(super) struct TroubleTable {
    pub engines: Vec<(&'static str, String)>,
    pub lines: Vec<TroubleLine>,
}

/// A kind of trouble, the number of its cases, and one cell per engine.
pub(super) struct TroubleLine {
    pub kind: String,
    pub cases: usize,
    pub cells: Vec<TroubleSign>,
}

/// A cell of the table of troubles.
pub(super) struct TroubleSign {
    pub engine: &'static str,
    /// The level, as of [`RecallCell`]; 5 where nothing was scored.
    pub level: u8,
    pub shown: String,
    /// What a narrow cell shows: nothing where all is found, because there the colour says it.
    pub short: String,
    pub title: String,
}

/// The matrix of kinds of trouble, as it is shown.
pub(super) fn trouble(report: &Report, evidence: &ReportEvidence) -> TroubleTable {
    let trouble = Trouble::new(report, evidence);
    let sign = |(cell, (engine, _)): (&TroubleCell, &(&'static str, String))| {
        let level = match cell.percent() {
            None => 5,
            Some(100) if cell.failing == 0 => 4,
            Some(100) => 3,
            Some(99) => 2,
            Some(1..) => 1,
            Some(0) => 0,
        };
        let TroubleCell { judged, right, spurious, failing } = cell;
        let shown = cell.percent().map_or("\u{2013}".to_owned(), |it| it.to_string());
        TroubleSign {
            engine,
            level,
            short: if cell.percent() == Some(100) { String::new() } else { shown.clone() },
            shown,
            title: format!(
                "{right} of {judged} judged events right, {spurious} spurious, {failing} rows fail"
            ),
        }
    };
    let line = |(kind, cases, cells): (String, usize, Vec<TroubleCell>)| TroubleLine {
        kind,
        cases,
        cells: cells.iter().zip(&trouble.engines).map(sign).collect(),
    };
    let lines = trouble.lines.clone().into_iter().map(line).collect();
    TroubleTable { engines: trouble.engines, lines }
}

pub(super) fn grazing(report: &Report, evidence: &ReportEvidence) -> GrazingTable {
    let grazing = Grazing::new(report, evidence);
    let cell = |(setting, seen): (String, Seen)| {
        let (class, glyph, words) = match seen {
            Seen::Right => ("right", "\u{25cf}", "right"),
            Seen::Missed => ("missed", "\u{25cb}", "missed events"),
            Seen::Spurious => ("spurious", "\u{00d7}", "spurious events"),
            Seen::Undecidable => ("either", "\u{25d0}", "undecidable: either answer is right"),
            Seen::Nothing => ("nothing", "\u{2013}", "no result, or nothing scored"),
        };
        let of = if setting.is_empty() { String::new() } else { format!("{setting}: ") };
        SeenCell { class, glyph, title: format!("{of}{words}") }
    };
    let cells = |cells: Vec<Touches>| {
        cells.into_iter().map(|here| here.into_iter().map(cell).collect()).collect()
    };
    GrazingTable {
        margins: grazing.margins.into_iter().map(|(margin, label)| (margin > 0.0, label)).collect(),
        lines: grazing.lines.into_iter().map(|(engine, here)| (engine, cells(here))).collect(),
    }
}

/// Wrong engines by gates.
pub(super) struct PowerTable {
    pub gates: Vec<String>,
    pub lines: Vec<FaultLine>,
}

pub(super) struct FaultLine {
    pub engine: String,
    pub fault: String,
    /// Per gate, whether it was caught and the figure; `None`: not held against it.
    pub cells: Vec<Option<(bool, String)>>,
    pub caught: bool,
}

pub(super) fn power(evidence: &ReportEvidence) -> PowerTable {
    let mut gates: Vec<String> = Vec::new();
    for (gate, ..) in evidence.faults.iter().flat_map(|fault| &fault.gates) {
        if !gates.contains(gate) {
            gates.push(gate.clone());
        }
    }
    let line = |fault: &super::super::FaultRow| {
        let cell = |gate: &String| {
            let found = fault.gates.iter().find(|(name, ..)| name == gate);
            found.map(|(_, caught, detail)| (*caught, detail.clone()))
        };
        let caught = fault.gates.iter().any(|(_, caught, _)| *caught);
        FaultLine {
            engine: fault.engine.clone(),
            fault: fault.fault.clone(),
            cells: gates.iter().map(cell).collect(),
            caught,
        }
    };
    let lines = evidence.faults.iter().map(line).collect();
    PowerTable { gates, lines }
}

/// One custom property per engine, on white and on black.
pub(super) fn colours(looks: &[Look]) -> String {
    let rule = |of: fn(&Look) -> crate::picture::Colour| {
        looks.iter().enumerate().fold(String::new(), |mut rule, (i, look)| {
            let _ = write!(rule, "--e{i}:{};", of(look));
            rule
        })
    };
    let (light, dark) = (rule(|look| look.light), rule(|look| look.dark));
    format!(":root{{{light}}}@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}")
}

pub(super) fn glyph(marker: Marker) -> &'static str {
    match marker {
        Marker::Circle => "\u{25cf}",
        Marker::Square => "\u{25a0}",
        Marker::Triangle => "\u{25b2}",
        Marker::Diamond => "\u{25c6}",
        Marker::Cross => "\u{2715}",
        Marker::Plus => "\u{271a}",
        Marker::Nabla => "\u{25bc}",
    }
}
