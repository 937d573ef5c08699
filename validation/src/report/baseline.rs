//! An earlier report, to be no worse than.

use super::{Report, Row};
use crate::number::brief;
use serde::Deserialize;

/// What is read of an earlier `report.json`.
#[derive(Debug, Deserialize)]
pub struct Baseline {
    schema: u32,
    results: Vec<Earlier>,
}

#[derive(Debug, Deserialize)]
struct Earlier {
    case: String,
    engine: String,
    tolerance: Option<f64>,
    step: Option<f64>,
    verdict: String,
    events_missed: Option<usize>,
    events_spurious: Option<usize>,
    event_time_error: Largest,
    state_error: Largest,
    drift_error: Option<f64>,
}

#[derive(Debug, Deserialize)]
struct Largest {
    max: Option<f64>,
}

/// Errors may grow by this factor: another processor or compiler rounds differently, and a step that
/// is accepted here is refused there. A method that loses an order, or an adapter a digit, is beyond it.
const FACTOR: f64 = 2.0;
/// Errors below this are rounding.
const ROUNDING: f64 = 1e-14;

impl Baseline {
    /// Reads a report.
    ///
    /// # Errors
    /// What is wrong with the text, in one line.
    pub fn read(text: &str) -> Result<Self, String> {
        let baseline: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if baseline.schema == 1 {
            Ok(baseline)
        } else {
            Err(format!("schema {} is not accepted: 1", baseline.schema))
        }
    }

    /// Every way in which a report is worse, a line each; rows that are in one of them only do not
    /// count.
    #[must_use]
    pub fn worse(&self, report: &Report) -> Vec<String> {
        let mut lines = Vec::new();
        for row in &report.results {
            let same = |it: &&Earlier| {
                it.case == row.case
                    && it.engine == row.engine
                    && it.tolerance == row.tolerance
                    && it.step == row.step
            };
            if let Some(earlier) = self.results.iter().find(same) {
                let who = format!("{} {} {}", row.case, row.engine, row.setting());
                lines.extend(earlier.against(row).into_iter().map(|it| format!("{who}: {it}")));
            }
        }
        lines
    }
}

impl Earlier {
    fn against(&self, row: &Row) -> Vec<String> {
        let mut worse = Vec::new();
        let failing = |verdict: &str| matches!(verdict, "fail" | "error");
        if failing(super::csv::word(row.verdict)) && !failing(&self.verdict) {
            worse.push(format!("{}, was {}", super::csv::word(row.verdict), self.verdict));
        }
        let counts = [
            ("missed", row.events_missed, self.events_missed),
            ("invented", row.events_spurious, self.events_spurious),
        ];
        for (what, now, then) in counts {
            if let (Some(now), Some(then)) = (now, then)
                && now > then
            {
                worse.push(format!("{now} switches {what}, {then} before"));
            }
        }
        let errors = [
            ("event time error", row.event_time_error.max, self.event_time_error.max),
            ("state error", row.state_error.max, self.state_error.max),
            ("drift error", row.drift_error, self.drift_error),
        ];
        for (what, now, then) in errors {
            if let Some(then) = then
                && now > FACTOR * then.max(ROUNDING)
            {
                worse.push(format!("{what} {}, was {}", brief(now), brief(then)));
            }
        }
        worse
    }
}
