//! Bounds held against measures.

use super::measure::Measures;
use crate::case::{Bound, Quantity, Shortcoming, Statistic};
use crate::engine::Accuracy;
use crate::number::brief;
use serde::Serialize;

/// What became of a bound or of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within bounds.
    Pass,
    /// Out of bounds, as a known shortcoming has it.
    Expected,
    /// Out of bounds.
    Fail,
    /// The engine gave no result.
    Error,
    /// The engine is not installed.
    Unavailable,
}

/// A bound with the figure it was held against.
#[derive(Clone, Debug, Serialize)]
pub struct Checked {
    /// What is bounded.
    pub quantity: Quantity,
    /// Which figure of it.
    pub statistic: Statistic,
    /// The limit.
    pub limit: f64,
    /// What was measured.
    pub value: f64,
    /// Whether it is within.
    pub verdict: Verdict,
    /// The bound's reason.
    pub why: String,
}

impl Checked {
    /// The figure beside its limit, and why that is the limit.
    fn reason(&self) -> String {
        let quantity = serde_json::to_string(&self.quantity).unwrap_or_default();
        let quantity = quantity.trim_matches('"').replace('_', " ");
        let against = if self.quantity.is_to_be_large() { "at least" } else { "at most" };
        format!("{quantity} {} ({against} {}: {})", brief(self.value), brief(self.limit), self.why)
    }
}

/// The verdict on a row.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// Each bound.
    pub bounds: Vec<Checked>,
    /// The row's own verdict.
    pub verdict: Verdict,
    /// Whether it passed because a known shortcoming showed as stated.
    pub expected: bool,
    /// The reason, where there is one to give.
    pub why: String,
}

/// What is judged.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The case's name.
    pub case: &'a str,
    /// The engine's name.
    pub engine: &'a str,
    /// What the engine was asked for.
    pub accuracy: Accuracy,
    /// The unit in which its errors are counted.
    pub unit: f64,
}

/// Judges a run: `measures`, or the reason why there are none.
///
/// Bounds are taken in order, the first for a quantity and statistic counts.
#[must_use]
pub fn judge(
    subject: &Subject<'_>,
    measures: Result<(&Measures, bool), &str>,
    bounds: &[&Bound],
    shortcomings: &[&Shortcoming],
) -> Judgement {
    let Subject { case, engine, accuracy, .. } = *subject;
    let of = |it: &&&Shortcoming| it.is_for(case, engine, accuracy);
    let known: Vec<_> = shortcomings.iter().filter(of).copied().collect();
    match measures {
        Err(reason) => failed(reason, &known),
        Ok((measures, whole_run)) => {
            let mut checked = check(subject, measures, whole_run, bounds);
            let (verdict, expected, mut why) = settle(&mut checked, measures, &known);
            if why.is_empty() && measures.horizon_periods == 0.0 {
                why = NOTHING_SCORED.to_owned();
            }
            Judgement { bounds: checked, verdict, expected, why }
        }
    }
}

/// What is said of a run that no bound can say anything about.
const NOTHING_SCORED: &str =
    "nothing is scored: one unit of this setting's error is beyond 1e-3 from the start";

fn failed(reason: &str, known: &[&Shortcoming]) -> Judgement {
    let (verdict, expected, why) = match known.iter().find(|it| it.shows.is_none()) {
        Some(it) => (Verdict::Pass, true, format!("{reason} ({})", it.why)),
        None => (Verdict::Error, false, reason.to_owned()),
    };
    Judgement { bounds: Vec::new(), verdict, expected, why }
}

fn check(
    subject: &Subject<'_>,
    measures: &Measures,
    whole_run: bool,
    bounds: &[&Bound],
) -> Vec<Checked> {
    let mut checked: Vec<Checked> = Vec::new();
    for bound in
        bounds.iter().filter(|it| it.is_for(subject.engine, subject.accuracy, subject.unit))
    {
        let seen = |it: &Checked| it.quantity == bound.quantity && it.statistic == bound.statistic;
        if checked.iter().any(seen) || measures.is_empty_of(bound.quantity, whole_run) {
            continue;
        }
        let scale = if bound.times_tolerance { subject.unit } else { 1.0 };
        let limit = bound.limit * scale;
        let value = measures.figure(bound.quantity, bound.statistic);
        // Written so that a NaN is out of bounds.
        let within = if bound.quantity.is_to_be_large() { value >= limit } else { value <= limit };
        let verdict = if within { Verdict::Pass } else { Verdict::Fail };
        let Bound { quantity, statistic, why, .. } = (*bound).clone();
        checked.push(Checked { quantity, statistic, limit, value, verdict, why });
    }
    checked
}

/// The row's verdict; bounds that fail as a shortcoming has it become expected.
fn settle(
    checked: &mut [Checked],
    measures: &Measures,
    known: &[&Shortcoming],
) -> (Verdict, bool, String) {
    for it in known {
        let shows = it.shows.is_some_and(|(quantity, statistic, at_least)| {
            let value = measures.figure(quantity, statistic);
            value.is_nan() || value >= at_least
        });
        if !shows {
            return (
                Verdict::Fail,
                false,
                format!("the data are out of date: no longer shows: {}", it.why),
            );
        }
    }
    if !checked.iter().any(|it| it.verdict == Verdict::Fail) {
        return match known.first() {
            Some(it) => (Verdict::Pass, true, it.why.clone()),
            None => (Verdict::Pass, false, String::new()),
        };
    }
    let Some(it) = known.first() else {
        let failing = checked.iter().filter(|it| it.verdict == Verdict::Fail);
        let reasons: Vec<_> = failing.map(Checked::reason).collect();
        return (Verdict::Fail, false, reasons.join("; "));
    };
    for bound in checked.iter_mut().filter(|bound| bound.verdict == Verdict::Fail) {
        bound.verdict = Verdict::Expected;
    }
    (Verdict::Pass, true, it.why.clone())
}
