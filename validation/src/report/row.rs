//! The keys of `report.json`.

use super::gradients::GradientEntry;
use super::ranking::{Ranked, ranking};
use super::records::JudgedRecords;
use crate::engine::{Declaration, Engine, Work};
use crate::provenance::{self, Build};
use crate::score::attractor::Comparison;
use crate::score::{Checked, Horizons, Restart, Spread, Verdict, order};
use crate::suite::{CaseTraits, Scored, Status, Suite};
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Duration;

/// The number of the format: 2 since each record is judged from the one before it.
pub(super) const SCHEMA: u32 = 2;

/// A whole report.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The number of the format, and the build and machine.
    #[serde(flatten)]
    pub build: Build,
    /// The suite that was run.
    pub suite: Suite,
    /// The engines that were run.
    pub engines: Vec<EngineEntry>,
    /// A row for each case, engine and tolerance.
    pub results: Vec<ReportRow>,
    /// The engines, the best first; exact ones stand above, as the reference.
    pub ranking: Vec<Ranked>,
    /// The number of rows per verdict.
    pub summary: Summary,
    /// The verdicts on derivatives through events; left out where no engine answers any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gradients: Vec<GradientEntry>,
}

/// An engine's declaration, as the report has it.
#[derive(Clone, Debug, Serialize)]
pub struct EngineEntry {
    /// The engine's name.
    pub name: &'static str,
    /// The library that the engine belongs to.
    pub library: &'static str,
    /// The library's version.
    pub version: String,
    /// The method.
    pub method: &'static str,
    /// The language of the library, or of the program that runs it.
    pub language: String,
    /// The order of convergence that it claims, where it has one.
    #[serde(skip)]
    pub order: Option<u32>,
}

/// The number of rows per verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Summary {
    /// Every bound that applies was measured and holds.
    pub pass: usize,
    /// Rows that are out of bounds by expected failures alone.
    pub known: usize,
    /// Rows that differ from the truth only in events of grazes that are undecidable.
    pub undecidable: usize,
    /// Too little of the run could be scored.
    pub not_scored: usize,
    /// Rows that are out of bounds.
    pub fail: usize,
    /// Rows whose run gave no result.
    pub error: usize,
    /// Rows that were not run, because they would have exceeded the suite's budget.
    pub not_run: usize,
    /// The number of rows of engines that are not installed.
    pub unavailable: usize,
}

/// One row. Errors are in the model's units; a figure that was not measured is NaN (`null`).
#[derive(Clone, Debug, Serialize)]
#[allow(
    missing_docs,
    reason = "the keys are those of the command line's contract, explained in the schema"
)]
pub struct ReportRow {
    pub case: String,
    /// The kinds of trouble that the case makes; none on the oscillator's.
    pub trouble: Vec<String>,
    /// What of the case decides where the row is counted in the ranking.
    #[serde(skip)]
    pub traits: CaseTraits,
    /// Whether the engine gave samples, without which no row is wholly right.
    #[serde(skip)]
    pub is_sampled: bool,
    pub engine: &'static str,
    pub tolerance: Option<f64>,
    pub step: Option<f64>,
    pub status: &'static str,
    pub horizon_periods: f64,
    pub events_expected: Option<usize>,
    /// The truth's events on the case's horizon, scored or not.
    pub events_total: usize,
    pub events_matched: Option<usize>,
    #[serde(flatten)]
    pub records: JudgedRecords,
    pub phase_word_ok: Option<bool>,
    pub event_time_error: Spread,
    pub state_error: Spread,
    pub drift_error: f64,
    /// How much of it the errors of the events' times explain to first order.
    pub drift_error_by_event_times: f64,
    pub valid_periods: f64,
    /// The valid horizons of runs from many states in chaos.
    pub valid_horizon: Option<ValidHorizons>,
    /// Errors of the restart test in units of error x (1 + |value|) x growth.
    pub restart: Option<RestartFigures>,
    /// Distances of the same-attractor test, by name.
    pub distance: Option<BTreeMap<&'static str, Distance>>,
    /// The order at which the engine converges on this case, over all its rows.
    pub order: Option<f64>,
    pub rhs_evaluations: Option<u64>,
    pub jacobian_evaluations: Option<u64>,
    /// Linear systems solved.
    pub linear_solves: Option<u64>,
    pub steps: Option<u64>,
    pub wall_ns: Option<u64>,
    /// The part of it that a program says its integrator took.
    pub own_ns: Option<u64>,
    pub bounds: Vec<Checked>,
    pub verdict: Verdict,
    pub why: String,
}

/// The figures of a restart test.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct RestartFigures {
    pub runs: usize,
    pub with_impact: usize,
    #[serde(flatten)]
    pub error: Spread,
}

/// Valid horizons in chaos, forcing periods.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ValidHorizons {
    /// Runs made.
    pub runs: usize,
    /// The median of the valid horizons.
    pub median: f64,
    /// The horizon that 99 % of the runs reach.
    pub q01: f64,
    /// What the truth's growth along each run makes of the engine's unit of error: the median.
    pub predicted_median: f64,
}

/// A distance of two sections.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Distance {
    /// The measured distance.
    pub value: f64,
    /// The limit, which reference runs hardly ever reach.
    pub limit: f64,
}

impl Report {
    /// The report of these rows.
    #[must_use]
    pub fn new<E: Engine + ?Sized>(suite: Suite, engines: &[&E], rows: &[Scored]) -> Self {
        let mut results: Vec<ReportRow> = rows.iter().map(ReportRow::new).collect();
        fill_orders(&mut results);
        Self {
            build: Build { schema: SCHEMA, ..provenance::this() },
            suite,
            engines: engines.iter().map(|engine| EngineEntry::new(*engine)).collect(),
            summary: Summary::new(&results),
            ranking: ranking(&results),
            results,
            gradients: Vec::new(),
        }
    }

    /// The number of cases that were run.
    #[must_use]
    pub fn number_of_cases(&self) -> usize {
        self.results.chunk_by(|a, b| a.case == b.case).count()
    }
}

/// The rows of one engine on one case are settings of one method, as far as they are scored to the
/// same horizon: over a longer one in chaos errors grow by more.
fn fill_orders(rows: &mut [ReportRow]) {
    for rows in rows.chunk_by_mut(|a, b| a.case == b.case && a.engine == b.engine) {
        let longest = rows.iter().map(|row| row.horizon_periods).fold(0.0, f64::max);
        let point = |row: &ReportRow| {
            let comparable = row.horizon_periods == longest;
            Some((row.steps.filter(|_| comparable)? as f64, row.state_error.max))
        };
        let points: Vec<_> = rows.iter().filter_map(point).collect();
        let found = order(&points);
        rows.iter_mut().for_each(|row| row.order = found);
    }
}

impl EngineEntry {
    fn new(engine: &(impl Engine + ?Sized)) -> Self {
        let Declaration { name, library, version, method, order, .. } = engine.declaration();
        Self { name, library, version, method, language: engine.language().to_owned(), order }
    }
}

impl Summary {
    /// Counts the rows of each class.
    #[must_use]
    pub fn new(rows: &[ReportRow]) -> Self {
        let count = |verdict| rows.iter().filter(|row| row.verdict == verdict).count();
        Self {
            pass: count(Verdict::Pass),
            known: count(Verdict::Known),
            undecidable: count(Verdict::Undecidable),
            not_scored: count(Verdict::NotScored),
            fail: count(Verdict::Fail),
            error: count(Verdict::Error),
            not_run: count(Verdict::NotRun),
            unavailable: count(Verdict::Unavailable),
        }
    }
}

impl RestartFigures {
    fn new(restart: &Restart) -> Self {
        Self { runs: restart.runs, with_impact: restart.with_impact, error: restart.units }
    }
}

impl ValidHorizons {
    fn new(horizons: &Horizons) -> Self {
        Self {
            runs: horizons.runs.len(),
            median: horizons.valid.median,
            q01: horizons.valid_q01,
            predicted_median: horizons.predicted.median,
        }
    }
}

fn by_name(comparison: &Comparison) -> BTreeMap<&'static str, Distance> {
    let distances = comparison.distances.iter();
    distances
        .map(|(name, value, limit)| (*name, Distance { value: *value, limit: *limit }))
        .collect()
}

impl ReportRow {
    /// Whether the engine was run at all.
    #[must_use]
    pub fn was_run(&self) -> bool {
        !matches!(self.verdict, Verdict::Unavailable | Verdict::NotRun)
    }

    /// Whether its errors are over all events of the truth, and it has no others.
    #[must_use]
    pub fn is_of_all_events(&self) -> bool {
        self.events_matched == Some(self.events_total) && self.records.events_spurious == Some(0)
    }

    fn new(scored: &Scored) -> Self {
        let empty = Self::empty(scored);
        let Status::Ok(measures, outcome) = &scored.status else { return empty };
        let whole_ns = |time: Duration| u64::try_from(time.as_nanos()).ok();
        // Where nothing at all was counted the work is not known.
        let work = Some(outcome.work).filter(|work| *work != Work::default());
        Self {
            horizon_periods: measures.horizon_periods,
            events_expected: Some(measures.expected),
            events_matched: Some(measures.matched),
            records: JudgedRecords::new(measures),
            phase_word_ok: Some(measures.phase_sequence_ok),
            event_time_error: measures.event_time,
            state_error: measures.state,
            drift_error: measures.drift,
            drift_error_by_event_times: measures.drift_by_times,
            valid_periods: measures.valid_periods,
            rhs_evaluations: work.map(|it| it.rhs_evaluations),
            jacobian_evaluations: work.map(|it| it.jacobian_evaluations),
            linear_solves: work.map(|it| it.linear_solves),
            steps: work.map(|it| it.steps),
            wall_ns: Some(scored.wall).filter(|wall| !wall.is_zero()).and_then(whole_ns),
            own_ns: outcome.own_time.and_then(whole_ns),
            valid_horizon: measures.probed.horizons.as_ref().map(ValidHorizons::new),
            restart: measures.probed.restart.as_ref().map(RestartFigures::new),
            distance: measures
                .probed
                .attractor
                .as_ref()
                .and_then(|it| it.as_ref().ok())
                .map(by_name),
            ..empty
        }
    }

    fn empty(scored: &Scored) -> Self {
        Self {
            case: scored.case.clone(),
            trouble: scored.trouble.clone(),
            traits: scored.traits,
            is_sampled: matches!(&scored.status, Status::Ok(it, _) if it.is_sampled),
            engine: scored.engine,
            tolerance: scored.accuracy.tolerance(),
            step: scored.accuracy.step(),
            status: match &scored.status {
                Status::Ok(..) => "ok",
                Status::Failed(_) => "failed",
                Status::NotRun => "not-run",
                Status::Unavailable => "unavailable",
            },
            horizon_periods: f64::NAN,
            events_expected: None,
            events_total: scored.events,
            events_matched: None,
            records: JudgedRecords::default(),
            phase_word_ok: None,
            event_time_error: Spread::NONE,
            state_error: Spread::NONE,
            drift_error: f64::NAN,
            drift_error_by_event_times: f64::NAN,
            valid_periods: f64::NAN,
            valid_horizon: None,
            restart: None,
            distance: None,
            order: None,
            rhs_evaluations: None,
            jacobian_evaluations: None,
            linear_solves: None,
            steps: None,
            wall_ns: None,
            own_ns: None,
            bounds: scored.judgement.bounds.clone(),
            verdict: scored.judgement.verdict,
            why: scored.judgement.why.clone(),
        }
    }
}
