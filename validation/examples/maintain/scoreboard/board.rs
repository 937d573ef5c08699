//! The scoreboard: one line per engine, its default set-up beside the expert's.

use super::read::{EngineJson, ReportJson, RowJson};
use anyhow::{Result, bail};
use percuss_validation::score::Spread;
use std::collections::BTreeSet;

/// What the name of a set-up ends with that is the documentation's first example.
pub(crate) const DEFAULT_SUFFIX: &str = "-default";
/// The kind of the cases of the oscillator, which name no trouble.
pub(crate) const OSCILLATOR: &str = "oscillator";

/// The scoreboard.
pub(crate) struct Board {
    /// What the reports were made with and on.
    pub(crate) made: Vec<String>,
    /// The tolerances of the rows, and on how many cases they are.
    pub(crate) tolerances: Vec<f64>,
    pub(crate) cases: usize,
    /// The kinds of trouble.
    pub(crate) kinds: Vec<String>,
    /// The engines, the best first.
    pub(crate) lines: Vec<BoardLine>,
}

/// An engine with both of its set-ups, as far as they were run.
pub(crate) struct BoardLine {
    /// The name without the ending of the default.
    pub(crate) name: String,
    pub(crate) library: String,
    pub(crate) version: String,
    pub(crate) language: String,
    pub(crate) expert: Option<SetupResult>,
    pub(crate) default: Option<SetupResult>,
}

/// The judgement of a set-up, and its cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SetupResult {
    /// Whether no row fails or errs unexpectedly.
    pub(crate) clean: bool,
    /// The rows that are wholly right, as a share of all.
    pub(crate) right: f64,
    /// Over all rows.
    pub(crate) all: EventCounts,
    /// For each kind of trouble.
    pub(crate) kinds: Vec<EventCounts>,
    /// Right-hand sides per event: the median over the rows that are wholly right.
    pub(crate) rhs: Option<f64>,
    /// Microseconds per event in the integrator itself, over the same rows.
    pub(crate) own: Option<f64>,
    /// Microseconds per event beside it, in a program of its own.
    pub(crate) overhead: Option<f64>,
}

/// Events that were judged, those of them that are right, and those that are spurious.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct EventCounts {
    pub(crate) right: u64,
    pub(crate) spurious: u64,
    pub(crate) judged: u64,
}

impl EventCounts {
    fn add(&mut self, row: &RowJson) {
        if ["not-run", "unavailable"].contains(&row.verdict.as_str()) {
            return;
        }
        // A run without a result has none of the truth's events.
        self.judged += row.events_judged.unwrap_or(row.events_total);
        self.right += row.events_right.unwrap_or_default();
        self.right += row.events_undecidable.unwrap_or_default();
        self.spurious += row.events_spurious.unwrap_or_default();
    }

    /// Events that are right in per cent of those that were judged, rounded down; nothing where
    /// there are none.
    pub(crate) fn percent(&self) -> Option<u64> {
        (self.judged > 0).then(|| 100 * self.right / self.judged)
    }
}

impl Board {
    /// The scoreboard of these reports.
    pub(crate) fn new(reports: &[ReportJson]) -> Result<Self> {
        let rows = || reports.iter().flat_map(|report| &report.results);
        let mut kinds: BTreeSet<String> = rows().flat_map(|row| row.trouble.clone()).collect();
        if rows().any(|row| row.trouble.is_empty()) {
            kinds.insert(OSCILLATOR.to_owned());
        }
        let kinds: Vec<String> = kinds.into_iter().collect();
        let mut tolerances: Vec<f64> = rows().filter_map(|row| row.tolerance).collect();
        tolerances.sort_by(|a, b| b.total_cmp(a));
        tolerances.dedup();
        let mut lines: Vec<BoardLine> = Vec::new();
        let is_installed = |rows: &[&RowJson]| rows.iter().any(|it| it.verdict != "unavailable");
        for (engine, rows) in setups(reports)?.into_iter().filter(|(_, rows)| is_installed(rows)) {
            put(&mut lines, engine, SetupResult::new(&rows, &kinds));
        }
        let by_rank = |a: &BoardLine, b: &BoardLine| {
            let ((of_a, right_of_a), (of_b, right_of_b)) = (a.rank(), b.rank());
            of_b.cmp(&of_a).then(right_of_b.total_cmp(&right_of_a))
        };
        lines.sort_by(by_rank);

        let made = |it: &ReportJson| {
            let commit = it.commit.as_deref().unwrap_or("no commit");
            format!("percuss {} at {commit}, on {}", it.percuss, it.cpu)
        };
        let mut made: Vec<String> = reports.iter().map(made).collect();
        made.dedup();
        let cases: BTreeSet<&str> = rows().map(|row| row.case.as_str()).collect();
        Ok(Self { made, tolerances, cases: cases.len(), kinds, lines })
    }
}

/// Each set-up of a version, with its rows: a long run is made in portions of some cases each.
fn setups(reports: &[ReportJson]) -> Result<Vec<(&EngineJson, Vec<&RowJson>)>> {
    let mut found: Vec<(&EngineJson, Vec<&RowJson>)> = Vec::new();
    for report in reports {
        for engine in &report.engines {
            let rows = report.results.iter().filter(|it| it.engine == engine.name);
            let is_same =
                |it: &EngineJson| (&it.name, &it.version) == (&engine.name, &engine.version);
            let Some((_, known)) = found.iter_mut().find(|(it, _)| is_same(it)) else {
                found.push((engine, rows.collect()));
                continue;
            };
            let cases: BTreeSet<&str> = known.iter().map(|it| it.case.as_str()).collect();
            for row in rows {
                if cases.contains(row.case.as_str()) {
                    let EngineJson { name, version, .. } = engine;
                    bail!("{name} {version} has {} in more than one report", row.case);
                }
                known.push(row);
            }
        }
    }
    Ok(found)
}

/// Puts a set-up into the line of its engine and version.
fn put(lines: &mut Vec<BoardLine>, engine: &EngineJson, score: SetupResult) {
    let name = engine.name.strip_suffix(DEFAULT_SUFFIX).unwrap_or(&engine.name);
    let place = lines.iter().position(|it| it.name == name && it.version == engine.version);
    let place = place.unwrap_or_else(|| {
        lines.push(BoardLine {
            name: name.to_owned(),
            library: engine.library.clone(),
            version: engine.version.clone(),
            language: engine.language.clone(),
            expert: None,
            default: None,
        });
        lines.len() - 1
    });
    let is_default = engine.name.ends_with(DEFAULT_SUFFIX);
    let slot = if is_default { &mut lines[place].default } else { &mut lines[place].expert };
    *slot = Some(score);
}

impl BoardLine {
    /// Whether it is the reference, whether nothing fails unexpectedly, and the share of its rows
    /// that are wholly right: of the expert's set-up, where there is one.
    fn rank(&self) -> ([bool; 2], f64) {
        let own = self.expert.as_ref().or(self.default.as_ref());
        let (clean, right) = own.map_or((false, 0.0), |it| (it.clean, it.right));
        ([self.name.starts_with("exact"), clean], right)
    }
}

impl SetupResult {
    fn new(rows: &[&RowJson], kinds: &[String]) -> Self {
        let tally = |rows: &mut dyn Iterator<Item = &&RowJson>| {
            let mut tally = EventCounts::default();
            rows.for_each(|row| tally.add(row));
            tally
        };
        let is_of = |row: &RowJson, kind: &String| {
            row.trouble.contains(kind) || (row.trouble.is_empty() && kind == OSCILLATOR)
        };
        let of_kind = |kind: &String| tally(&mut rows.iter().filter(|row| is_of(row, kind)));
        let whole = |row: &&&RowJson| row.events_total > 0 && row.is_right();
        let each = |figure: fn(&RowJson) -> Option<f64>| {
            let of = |row: &&RowJson| Some(figure(row)? / row.events_total as f64);
            let median = Spread::new(rows.iter().filter(whole).filter_map(of).collect()).median;
            Some(median).filter(|it| it.is_finite())
        };
        let right = rows.iter().filter(|row| row.is_right()).count();
        Self {
            clean: !rows.iter().any(|row| row.is_unexpected()),
            right: right as f64 / rows.len().max(1) as f64,
            all: tally(&mut rows.iter()),
            kinds: kinds.iter().map(of_kind).collect(),
            rhs: each(|row| row.rhs_evaluations.map(|count| count as f64)),
            own: each(|row| row.own_ns.or(row.wall_ns).map(microseconds)),
            overhead: each(|row| Some(microseconds(row.wall_ns?.saturating_sub(row.own_ns?)))),
        }
    }
}

fn microseconds(ns: u64) -> f64 {
    ns as f64 / 1000.0
}
