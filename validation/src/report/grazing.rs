//! Grazing: what each engine made of near misses and light touches, by margin.

use super::setting::setting;
use super::{Report, ReportEvidence};
use crate::score::Verdict;
use std::collections::BTreeMap;

/// The result of an engine on one touch or miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    /// All events were found, and no other.
    Right,
    /// Events were missed.
    Missed,
    /// Events are spurious.
    Spurious,
    /// The events of a graze differ; it is undecidable for the method.
    Undecidable,
    /// The run had no result, or nothing of it is scored.
    Nothing,
}

/// The result at each setting.
pub(super) type Touches = Vec<(String, Seen)>;

/// Engines by margins; in each cell what was seen from the coarse to the fine settings.
#[derive(Clone, Debug, Default)]
pub(super) struct Grazing {
    /// The margins from the widest miss to the deepest touch, as (margin, label).
    pub margins: Vec<(f64, String)>,
    /// Engine and cells.
    pub lines: Vec<(String, Vec<Touches>)>,
}

struct GrazingEntry {
    engine: String,
    margin: f64,
    fineness: f64,
    setting: String,
    seen: Seen,
}

impl Grazing {
    /// The table that follows from the evidence, or from the rows of cases that state a margin.
    pub fn new(report: &Report, evidence: &ReportEvidence) -> Self {
        let mut entries = if evidence.grazes.is_empty() {
            of_rows(report, evidence)
        } else {
            given_entries(evidence)
        };
        entries.sort_by(|a, b| b.fineness.total_cmp(&a.fineness));
        let mut margins: Vec<f64> = entries.iter().map(|entry| entry.margin).collect();
        margins.sort_by(|a, b| order(*a).total_cmp(&order(*b)));
        margins.dedup();
        let mut names: Vec<&str> = report.engines.iter().map(|engine| engine.name).collect();
        let others = entries.iter().map(|entry| entry.engine.as_str());
        let others: BTreeMap<&str, ()> = others.map(|name| (name, ())).collect();
        names.extend(
            others.keys().filter(|name| !report.engines.iter().any(|it| it.name == **name)),
        );
        let cell = |name: &str, margin: f64| {
            let here = entries.iter().filter(|it| it.engine == name && it.margin == margin);
            here.map(|it| (it.setting.clone(), it.seen)).collect::<Vec<_>>()
        };
        let line = |name: &str| {
            let cells: Vec<_> = margins.iter().map(|margin| cell(name, *margin)).collect();
            cells.iter().any(|cell| !cell.is_empty()).then(|| (name.to_owned(), cells))
        };
        let lines = names.into_iter().filter_map(line).collect();
        Self { margins: margins.iter().map(|it| (*it, label(*it))).collect(), lines }
    }
}

/// Wide misses first, deep touches last, the closest calls in the middle.
fn order(margin: f64) -> f64 {
    let far = 400.0 + margin.abs().max(f64::MIN_POSITIVE).log10();
    far.copysign(margin)
}

fn label(margin: f64) -> String {
    let text = format!("{:.0e}", margin.abs());
    if margin < 0.0 { format!("\u{2212}{text}") } else { format!("+{text}") }
}

fn seen_of(missed: usize, spurious: usize) -> Seen {
    match (missed, spurious) {
        (0, 0) => Seen::Right,
        (0, _) => Seen::Spurious,
        _ => Seen::Missed,
    }
}

fn given_entries(evidence: &ReportEvidence) -> Vec<GrazingEntry> {
    let entry = |graze: &super::GrazeRow| GrazingEntry {
        engine: graze.engine.clone(),
        margin: graze.margin,
        fineness: graze.tolerance.unwrap_or(0.0),
        setting: setting(graze.tolerance, None),
        seen: seen_of(graze.missed, graze.spurious),
    };
    evidence.grazes.iter().map(entry).collect()
}

fn of_rows(report: &Report, evidence: &ReportEvidence) -> Vec<GrazingEntry> {
    let margins: BTreeMap<&str, f64> =
        evidence.cases.iter().filter_map(|note| Some((note.name.as_str(), note.margin?))).collect();
    let entry = |row: &super::ReportRow| {
        let margin = *margins.get(row.case.as_str())?;
        let seen = match (row.verdict, row.records.events_missed, row.records.events_spurious) {
            (Verdict::NotScored, ..) => Seen::Nothing,
            (Verdict::Undecidable, ..) => Seen::Undecidable,
            (_, Some(missed), Some(spurious)) => seen_of(missed, spurious),
            _ => Seen::Nothing,
        };
        let fineness = row.tolerance.or(row.step).unwrap_or(0.0);
        let engine = row.engine.to_owned();
        Some(GrazingEntry { engine, margin, fineness, setting: row.setting(), seen })
    };
    report.results.iter().filter_map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margins_go_from_wide_misses_to_deep_touches() {
        let mut margins = [1e-3, -1e-12, 1e-12, -1e-3];
        margins.sort_by(|a, b| order(*a).total_cmp(&order(*b)));
        assert_eq!(margins.map(label), ["\u{2212}1e-3", "\u{2212}1e-12", "+1e-12", "+1e-3"]);
    }
}
