//! Earlier reports, to be no worse than the best of them.

use super::row::SCHEMA;
use super::{Report, ReportRow};
use crate::number::brief;
use serde::Deserialize;

/// An earlier `report.json`, as far as it is compared.
#[derive(Debug, Deserialize)]
pub struct Baseline {
    results: Vec<Earlier>,
}

/// The number of a report's format, whatever else is in it.
#[derive(Deserialize)]
struct Schema {
    schema: u32,
}

#[derive(Clone, Debug, Deserialize)]
struct Earlier {
    case: String,
    engine: String,
    tolerance: Option<f64>,
    step: Option<f64>,
    verdict: String,
    events_missed: Option<usize>,
    events_spurious: Option<usize>,
    events_wrong_mode: Option<usize>,
    event_time_error: Largest,
    state_error: Largest,
    drift_error: Option<f64>,
    rhs_evaluations: Option<u64>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
struct Largest {
    max: Option<f64>,
}

/// A row's place in a report.
#[derive(Clone, Copy, Debug)]
pub struct RowPlace<'a> {
    /// The case.
    pub case: &'a str,
    /// The engine.
    pub engine: &'a str,
    /// The tolerance, where it has one.
    pub tolerance: Option<f64>,
    /// The step, where it has one.
    pub step: Option<f64>,
}

/// The result of a comparison with a baseline, one line per finding.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// Rows that got worse, with the reason.
    pub worse: Vec<String>,
    /// Rows that take many more right-hand sides, with how many more.
    pub dearer: Vec<String>,
    /// Rows of the baseline that were asked for and not made.
    pub gone: Vec<String>,
    /// The number of rows in both reports.
    pub common: usize,
}

/// The largest ratio of an error to the baseline's: another processor or compiler rounds
/// differently, and a step that is accepted here is refused there. A method that loses an order, or
/// an adapter a digit, is beyond it.
const MAX_ERROR_RATIO: f64 = 1.5;
/// The ratio of a cost to the baseline's beyond which it is named.
const MAX_COST_RATIO: f64 = 1.2;
/// The error below which all is rounding.
const MIN_ERROR: f64 = 1e-14;

impl Baseline {
    /// Reads a report.
    ///
    /// # Errors
    /// What is wrong with the text, in one line.
    pub fn read(text: &str) -> Result<Self, String> {
        let Schema { schema } = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if schema != SCHEMA {
            return Err(format!(
                "schema {schema} is not accepted: {SCHEMA}; events are judged otherwise since, so \
                 make the baseline anew with --out of this version"
            ));
        }
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    /// The best of several reports, figure by figure: what has crept from one to the next, each
    /// time by less than is worse, is not lost so.
    #[must_use]
    pub fn best(all: impl IntoIterator<Item = Self>) -> Option<Self> {
        let mut all = all.into_iter();
        let mut best = all.next()?;
        for other in all {
            for row in other.results {
                match best.results.iter_mut().find(|it| it.is_alike(&row)) {
                    Some(own) => own.take_the_better(&row),
                    None => best.results.push(row),
                }
            }
        }
        Some(best)
    }

    /// Holds a report against this one; `asked` says whether a row of the baseline was asked for.
    #[must_use]
    pub fn compare(&self, report: &Report, asked: impl Fn(&RowPlace<'_>) -> bool) -> Compared {
        let mut compared = Compared::default();
        for earlier in &self.results {
            let who = earlier.who();
            match report.results.iter().find(|row| earlier.is(row)) {
                Some(row) => {
                    compared.common += 1;
                    compared.worse.extend(earlier.against(row).map(|it| format!("{who}: {it}")));
                    compared.dearer.extend(earlier.cost_ratio(row).map(|it| format!("{who} {it}")));
                }
                None if asked(&earlier.place()) => compared.gone.push(who),
                None => {}
            }
        }
        compared
    }
}

impl Earlier {
    fn place(&self) -> RowPlace<'_> {
        let Self { case, engine, tolerance, step, .. } = self;
        RowPlace { case, engine, tolerance: *tolerance, step: *step }
    }

    fn who(&self) -> String {
        let setting = super::setting::setting(self.tolerance, self.step);
        format!("{} {}", self.case, super::setting::who(&self.engine, &setting))
    }

    /// Whether another earlier row has the same place.
    fn is_alike(&self, other: &Self) -> bool {
        let place = |it: &Self| (it.tolerance, it.step);
        self.case == other.case && self.engine == other.engine && place(self) == place(other)
    }

    /// Takes what is better in another earlier row of the same place.
    fn take_the_better(&mut self, other: &Self) {
        if rank(&other.verdict) < rank(&self.verdict) {
            self.verdict.clone_from(&other.verdict);
        }
        let count = |own: &mut Option<usize>, other: Option<usize>| {
            *own = own.iter().copied().chain(other).min();
        };
        count(&mut self.events_missed, other.events_missed);
        count(&mut self.events_spurious, other.events_spurious);
        count(&mut self.events_wrong_mode, other.events_wrong_mode);
        self.rhs_evaluations = self.rhs_evaluations.into_iter().chain(other.rhs_evaluations).min();
        let error = |own: &mut Option<f64>, other: Option<f64>| {
            *own = own.iter().copied().chain(other).reduce(f64::min);
        };
        error(&mut self.event_time_error.max, other.event_time_error.max);
        error(&mut self.state_error.max, other.state_error.max);
        error(&mut self.drift_error, other.drift_error);
    }

    /// How many times as many right-hand sides a row takes, where they are many more.
    fn cost_ratio(&self, row: &ReportRow) -> Option<String> {
        let factor = row.rhs_evaluations? as f64 / self.rhs_evaluations? as f64;
        (factor > MAX_COST_RATIO && factor.is_finite()).then(|| format!("{factor:.2} times"))
    }

    fn is(&self, row: &ReportRow) -> bool {
        self.case == row.case
            && self.engine == row.engine
            && self.tolerance == row.tolerance
            && self.step == row.step
    }

    /// What is worse in a row, each with the first wrong event of the row.
    fn against(&self, row: &ReportRow) -> impl Iterator<Item = String> {
        let mut worse = Vec::new();
        let now = row.verdict.as_str();
        let lost = self.verdict == "pass" && now != "pass";
        let failing = |verdict: &str| matches!(verdict, "fail" | "error");
        let newly = failing(now) && now != self.verdict;
        if lost || newly {
            worse.push(format!("{now}, was {}", self.verdict));
        }
        let records = &row.records;
        let counts = [
            ("missed", records.events_missed, self.events_missed),
            ("spurious", records.events_spurious, self.events_spurious),
            ("in a wrong mode", records.events_wrong_mode, self.events_wrong_mode),
        ];
        for (what, now, then) in counts {
            if let (Some(now), Some(then)) = (now, then)
                && now > then
            {
                worse.push(format!("{now} events {what}, {then} before"));
            }
        }
        let errors = [
            ("event time error", row.event_time_error.max, self.event_time_error.max),
            ("state error", row.state_error.max, self.state_error.max),
            ("drift error", row.drift_error, self.drift_error),
        ];
        for (what, now, then) in errors {
            if let Some(then) = then
                && now > MAX_ERROR_RATIO * then.max(MIN_ERROR)
            {
                worse.push(format!("{what} {}, was {}", brief(now), brief(then)));
            }
        }
        let first = row.records.first_wrong.as_ref();
        let first = first.map_or_else(String::new, |it| format!("; {}", it.sentence));
        worse.into_iter().map(move |it| format!("{it}{first}"))
    }
}

/// The place of a verdict among all, the best first.
fn rank(verdict: &str) -> usize {
    const VERDICTS_BEST_FIRST: [&str; 8] =
        ["pass", "known", "undecidable", "not-scored", "not-run", "unavailable", "fail", "error"];
    VERDICTS_BEST_FIRST.iter().position(|it| *it == verdict).unwrap_or(VERDICTS_BEST_FIRST.len())
}
