//! Rows for tests.

use super::{
    DefectQuantiles, EngineEntry, JudgedRecords, Quantiles, Report, ReportRow, Summary, ranking,
};
use crate::provenance;
use crate::score::{Spread, Verdict};
use crate::suite::{CaseTraits, Suite};

/// A row that is wholly right: ten events, a hundred right-hand sides.
pub(crate) fn row(case: &str, engine: &'static str, tolerance: Option<f64>) -> ReportRow {
    let error = tolerance.unwrap_or(1e-15);
    let sample = Quantiles { median: Some(0.1), q99: Some(0.5), max: Some(1.0) };
    ReportRow {
        case: case.to_owned(),
        trouble: Vec::new(),
        traits: CaseTraits { states: 2, ..CaseTraits::default() },
        is_sampled: true,
        engine,
        tolerance,
        step: None,
        status: "ok",
        horizon_periods: 10.0,
        events_expected: Some(10),
        events_total: 10,
        events_matched: Some(10),
        records: JudgedRecords {
            events_judged: Some(10),
            events_right: Some(10),
            events_missed: Some(0),
            events_spurious: Some(0),
            events_wrong_mode: Some(0),
            events_undecidable: Some(0),
            defect: DefectQuantiles { sample, state: sample, ..DefectQuantiles::default() },
            ..JudgedRecords::default()
        },
        phase_word_ok: Some(true),
        event_time_error: Spread { median: error, q99: error, max: error },
        state_error: Spread { median: error, q99: error, max: error },
        drift_error: 0.0,
        drift_error_by_event_times: 0.0,
        valid_periods: 10.0,
        valid_horizon: None,
        restart: None,
        distance: None,
        order: None,
        rhs_evaluations: Some(100),
        jacobian_evaluations: Some(0),
        linear_solves: Some(0),
        steps: Some(20),
        wall_ns: Some(90_000),
        own_ns: None,
        bounds: Vec::new(),
        verdict: Verdict::Pass,
        why: String::new(),
    }
}

/// The report of some rows.
pub(crate) fn report(results: Vec<ReportRow>) -> Report {
    let mut names: Vec<&'static str> = results.iter().map(|row| row.engine).collect();
    names.sort_unstable();
    names.dedup();
    let engine = |name| EngineEntry {
        name,
        library: "a-library-with-a-name",
        version: "1.0".to_owned(),
        method: "m",
        language: "Rust".to_owned(),
        order: None,
    };
    Report {
        gradients: Vec::new(),
        build: provenance::this(),
        suite: Suite::Quick,
        engines: names.into_iter().map(engine).collect(),
        summary: Summary::new(&results),
        ranking: ranking(&results),
        results,
    }
}
