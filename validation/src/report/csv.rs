//! `errors.csv`: the rows of `report.json`, flat. What is `null` there is empty or `nan` here.

use super::row::{Distance, ValidHorizons};
use super::{Exporter, Report, ReportEvidence, ReportRow};
use crate::number::shortest;
use crate::score::Spread;
use std::collections::BTreeMap;
use std::io::{self, Write};

pub(super) struct Csv;

const COLUMNS: [&str; 68] = [
    "case",
    "trouble",
    "engine",
    "tolerance",
    "step",
    "status",
    "horizon_periods",
    "events_expected",
    "events_total",
    "events_matched",
    "events_judged",
    "events_right",
    "events_missed",
    "events_spurious",
    "events_wrong_mode",
    "events_undecidable",
    "first_wrong_n",
    "first_wrong_kind",
    "first_wrong_event",
    "first_wrong_mode",
    "first_wrong_time",
    "first_wrong_exact_event",
    "first_wrong_exact_mode",
    "first_wrong_exact_time",
    "first_wrong_defect",
    "location_median",
    "location_q99",
    "location_max",
    "time_defect_median",
    "time_defect_q99",
    "time_defect_max",
    "time_defect_signed_median",
    "state_defect_median",
    "state_defect_q99",
    "state_defect_max",
    "sample_defect_median",
    "sample_defect_q99",
    "sample_defect_max",
    "inconsistency_max",
    "phase_word_ok",
    "event_time_error_median",
    "event_time_error_q99",
    "event_time_error_max",
    "state_error_median",
    "state_error_q99",
    "state_error_max",
    "drift_error",
    "drift_error_by_event_times",
    "valid_periods",
    "valid_horizon_runs",
    "valid_horizon_median",
    "valid_horizon_q01",
    "valid_horizon_predicted_median",
    "restart_runs",
    "restart_with_impact",
    "restart_median",
    "restart_q99",
    "restart_max",
    "distance",
    "order",
    "rhs_evaluations",
    "jacobian_evaluations",
    "linear_solves",
    "steps",
    "wall_ns",
    "own_ns",
    "verdict",
    "why",
];

impl Exporter for Csv {
    fn file_name(&self) -> &'static str {
        "errors.csv"
    }

    fn write(&self, report: &Report, _: &ReportEvidence, out: &mut dyn Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(COLUMNS)?;
        for row in &report.results {
            writer.write_record(fields(row))?;
        }
        writer.flush()
    }
}

fn optional<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

fn text(value: Option<String>) -> String {
    value.unwrap_or_default()
}

fn number(value: Option<f64>) -> String {
    optional(value.map(shortest))
}

/// The largest distance in units of its limit.
fn share(distances: &BTreeMap<&'static str, Distance>) -> String {
    let shares = distances.values().map(|it| it.value / it.limit);
    shortest(shares.fold(0.0, f64::max))
}

fn spread(spread: &Spread) -> [String; 3] {
    [spread.median, spread.q99, spread.max].map(shortest)
}

fn fields(row: &ReportRow) -> [String; 68] {
    let [time_median, time_q99, time_max] = spread(&row.event_time_error);
    let [state_median, state_q99, state_max] = spread(&row.state_error);
    let records = &row.records;
    let defect = records.defect;
    let first = records.first_wrong.as_ref();
    let restart = row.restart.map(|it| spread(&it.error)).unwrap_or_default();
    let [restart_median, restart_q99, restart_max] = restart;
    let horizon = |figure: fn(&ValidHorizons) -> f64| {
        optional(row.valid_horizon.as_ref().map(figure).map(shortest))
    };
    [
        row.case.clone(),
        row.trouble.join(" "),
        row.engine.to_owned(),
        optional(row.tolerance.map(shortest)),
        optional(row.step.map(shortest)),
        row.status.to_owned(),
        shortest(row.horizon_periods),
        optional(row.events_expected),
        row.events_total.to_string(),
        optional(row.events_matched),
        optional(records.events_judged),
        optional(records.events_right),
        optional(records.events_missed),
        optional(records.events_spurious),
        optional(records.events_wrong_mode),
        optional(records.events_undecidable),
        optional(first.map(|it| it.n)),
        first.map(|it| it.kind.as_str().to_owned()).unwrap_or_default(),
        text(first.and_then(|it| it.event.clone())),
        text(first.and_then(|it| it.mode.clone())),
        number(first.and_then(|it| it.time)),
        text(first.and_then(|it| it.exact_event.clone())),
        text(first.and_then(|it| it.exact_mode.clone())),
        number(first.and_then(|it| it.exact_time)),
        number(first.and_then(|it| it.defect)),
        number(defect.location.median),
        number(defect.location.q99),
        number(defect.location.max),
        number(defect.time.size.median),
        number(defect.time.size.q99),
        number(defect.time.size.max),
        number(defect.time.signed_median),
        number(defect.state.median),
        number(defect.state.q99),
        number(defect.state.max),
        number(defect.sample.median),
        number(defect.sample.q99),
        number(defect.sample.max),
        number(records.inconsistency_max),
        optional(row.phase_word_ok),
        time_median,
        time_q99,
        time_max,
        state_median,
        state_q99,
        state_max,
        shortest(row.drift_error),
        shortest(row.drift_error_by_event_times),
        shortest(row.valid_periods),
        optional(row.valid_horizon.map(|it| it.runs)),
        horizon(|it| it.median),
        horizon(|it| it.q01),
        horizon(|it| it.predicted_median),
        optional(row.restart.map(|it| it.runs)),
        optional(row.restart.map(|it| it.with_impact)),
        restart_median,
        restart_q99,
        restart_max,
        optional(row.distance.as_ref().map(share)),
        optional(row.order.map(shortest)),
        optional(row.rhs_evaluations),
        optional(row.jacobian_evaluations),
        optional(row.linear_solves),
        optional(row.steps),
        optional(row.wall_ns),
        optional(row.own_ns),
        row.verdict.as_str().to_owned(),
        row.why.clone(),
    ]
}
