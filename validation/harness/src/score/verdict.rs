//! The verdict on a row: bounds held against measures, with what grazes and expected failures
//! excuse.
//!
//! A row has one class, the first that applies of: unavailable, not-run, error, fail, known,
//! undecidable, not-scored, pass.

use super::graze::Graze;
use super::measure::Measures;
use super::mismatch::Excused;
use super::shortcoming::{Answer, answer};
use crate::case::{Bound, Quantity, Shortcoming, Statistic};
use crate::engine::{Accuracy, Outcome};
use crate::number::brief;
use crate::truth::Truth;
use serde::Serialize;

/// The class of a row or of a bound, from the first that applies to the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The engine is not installed.
    Unavailable,
    /// The run was beyond the suite's budget.
    NotRun,
    /// The engine gave no result.
    Error,
    /// A bound failed.
    Fail,
    /// A bound failed, and the failure is expected of the engine.
    Known,
    /// Events of a graze differ that the method's bounds leave undecided.
    Undecidable,
    /// Too little could be measured at this setting to say anything.
    NotScored,
    /// Every bound that applies was measured and holds.
    Pass,
}

impl Verdict {
    /// All classes, in the order in which they apply.
    pub const ALL: [Self; 8] = [
        Self::Unavailable,
        Self::NotRun,
        Self::Error,
        Self::Fail,
        Self::Known,
        Self::Undecidable,
        Self::NotScored,
        Self::Pass,
    ];

    /// The class's word in every table, file and page.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Unavailable => "unavailable",
            Self::NotRun => "not-run",
            Self::Error => "error",
            Self::Fail => "fail",
            Self::Known => "known",
            Self::Undecidable => "undecidable",
            Self::NotScored => "not-scored",
            Self::Pass => "pass",
        }
    }
}

/// A bound with the figure it was held against.
#[derive(Clone, Debug, Serialize)]
pub struct Checked {
    /// What is bounded.
    pub quantity: Quantity,
    /// Which statistic of the quantity is bounded.
    pub statistic: Statistic,
    /// The limit.
    pub limit: f64,
    /// What was measured, without the events that a graze excuses; NaN where nothing was.
    pub value: f64,
    /// The class of the bound: pass, undecidable, not-scored, fail, or known (expected failure).
    pub verdict: Verdict,
    /// The bound's reason.
    pub why: String,
}

impl Checked {
    /// The figure beside its limit, and why that is the limit.
    fn reason(&self) -> String {
        let against = if self.quantity.is_to_be_large() { "at least" } else { "at most" };
        let quantity = self.quantity.words();
        format!("{quantity} {} ({against} {}: {})", brief(self.value), brief(self.limit), self.why)
    }
}

/// The verdict on a row.
#[derive(Clone, Debug)]
pub struct RowJudgement {
    /// Each bound that applies.
    pub bounds: Vec<Checked>,
    /// The row's class.
    pub verdict: Verdict,
    /// The reason, where there is one to give.
    pub why: String,
}

impl RowJudgement {
    /// A verdict on a row that has no measures.
    #[must_use]
    pub const fn without_result(verdict: Verdict, why: String) -> Self {
        Self { bounds: Vec::new(), verdict, why }
    }
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

/// What is expected of a subject.
#[derive(Clone, Copy)]
pub struct Expected<'a> {
    /// Bounds in order: the first for a quantity and statistic counts.
    pub bounds: &'a [&'a Bound],
    /// Bounds of classes of methods alone, whose constants decide which grazes are undecidable:
    /// what a case allows besides excuses no event.
    pub of_classes: &'a [Bound],
    /// Failures that are expected of engines.
    pub shortcomings: &'a [&'a Shortcoming],
}

/// A run that has a result, with what tells whether its events are decidable.
#[derive(Clone, Copy)]
pub struct ScoredRun<'a> {
    /// What was measured.
    pub measures: &'a Measures,
    /// The engine's answer.
    pub outcome: &'a Outcome,
    /// The truth it was measured against.
    pub truth: &'a Truth,
    /// The truth's grazes.
    pub grazes: &'a [Graze],
    /// Events further apart than this, in units of time, are not the same.
    pub window: f64,
}

/// Judges a run.
#[must_use]
pub fn judge(subject: &Subject<'_>, run: &ScoredRun<'_>, expected: &Expected<'_>) -> RowJudgement {
    let excused = excused(subject, run, expected.of_classes);
    let mut checked = check(subject, run, &excused, expected.bounds);
    // A probe that the suite does not ask for can show no shortcoming.
    let of = |it: &&&Shortcoming| {
        it.is_for(subject.case, subject.engine, subject.accuracy)
            && run.measures.concerns(it.quantity)
    };
    let known: Vec<_> = expected.shortcomings.iter().filter(of).copied().collect();
    let answers = known.iter().map(|it| answer(it, run, &excused, &mut checked));
    let mut reasons = Reasons::default();
    for answer in answers {
        match answer {
            Answer::Shows(why) => reasons.known.push(why),
            Answer::OutOfDate(why) => reasons.failed.push(why),
        }
    }
    let failed = checked.iter().filter(|it| it.verdict == Verdict::Fail);
    reasons.failed.extend(failed.map(Checked::reason));
    let (verdict, why) = reasons.settle(run, &checked, &excused);
    RowJudgement { bounds: checked, verdict, why }
}

/// Reasons for the classes that speak of bounds.
#[derive(Default)]
struct Reasons {
    failed: Vec<String>,
    known: Vec<String>,
}

impl Reasons {
    fn settle(
        self,
        run: &ScoredRun<'_>,
        checked: &[Checked],
        excused: &Excused,
    ) -> (Verdict, String) {
        let unmeasured = checked.iter().find(|it| it.verdict == Verdict::NotScored);
        if !self.failed.is_empty() {
            (Verdict::Fail, self.failed.join("; "))
        } else if !self.known.is_empty() {
            (Verdict::Known, self.known.join("; "))
        } else if !excused.grazes.is_empty() {
            (Verdict::Undecidable, undecidable(excused))
        } else if !run.measures.is_scored() {
            (Verdict::NotScored, little_scored(run.measures))
        } else if let Some(it) = unmeasured {
            (Verdict::NotScored, format!("nothing measures its {}", it.quantity.words()))
        } else {
            (Verdict::Pass, String::new())
        }
    }
}

fn undecidable(excused: &Excused) -> String {
    let graze = |(elapsed, margin): &(f64, f64)| {
        format!(
            "the graze {} after the start has a margin of {}, within the error allowed: either answer \
             is right",
            brief(*elapsed),
            brief(*margin)
        )
    };
    excused.grazes.iter().map(graze).collect::<Vec<_>>().join("; ")
}

fn little_scored(measures: &Measures) -> String {
    format!(
        "{} of {} events are scored: beyond, one unit of this setting's error has grown past 1e-3",
        measures.expected, measures.total
    )
}

/// The grazes that the bound on errors of the engine's class leaves undecided.
fn excused(subject: &Subject<'_>, run: &ScoredRun<'_>, of_classes: &[Bound]) -> Excused {
    let constant = of_classes.iter().find(|it| {
        it.quantity == Quantity::EventConstant
            && it.statistic == Statistic::Max
            && it.is_for(subject.engine, subject.accuracy)
    });
    let Some(constant) = constant else { return Excused::default() };
    let allowed = constant.limit * subject.unit;
    let ScoredRun { measures, outcome, grazes, window, .. } = *run;
    measures.mismatch.excused(grazes, &outcome.events, window, allowed)
}

fn check(
    subject: &Subject<'_>,
    run: &ScoredRun<'_>,
    excused: &Excused,
    bounds: &[&Bound],
) -> Vec<Checked> {
    let mut checked: Vec<Checked> = Vec::new();
    for bound in bounds.iter().filter(|it| it.is_for(subject.engine, subject.accuracy)) {
        let Bound { quantity, statistic, ref why, .. } = **bound;
        let seen = |it: &Checked| it.quantity == quantity && it.statistic == statistic;
        if checked.iter().any(seen) || !run.measures.concerns(quantity) {
            continue;
        }
        let limit = bound.limit * if bound.times_tolerance { subject.unit } else { 1.0 };
        // What grazes excuse is left out; the row's own counts keep it.
        let value = run.decidable(quantity, statistic, excused);
        // A NaN is out of bounds.
        let within =
            |value: f64| if quantity.is_to_be_large() { value >= limit } else { value <= limit };
        let verdict = if within(run.measures.figure(quantity, statistic)) {
            Verdict::Pass
        } else if within(value) {
            Verdict::Undecidable
        } else if run.measures.lacks(quantity) {
            Verdict::NotScored
        } else {
            Verdict::Fail
        };
        checked.push(Checked { quantity, statistic, limit, value, verdict, why: why.clone() });
    }
    checked
}

impl ScoredRun<'_> {
    /// A figure once the events that grazes excuse are left out.
    pub(super) fn decidable(
        &self,
        quantity: Quantity,
        statistic: Statistic,
        excused: &Excused,
    ) -> f64 {
        let all = self.measures.figure(quantity, statistic);
        match quantity {
            Quantity::EventsMissed => all - excused.missed.len() as f64,
            Quantity::EventsSpurious => all - excused.spurious.len() as f64,
            Quantity::PhaseWord => {
                let Self { measures, outcome, truth, .. } = self;
                let mismatch = &measures.mismatch;
                let same = mismatch.same_word(&truth.switches, &outcome.events, excused);
                f64::from(u8::from(!same))
            }
            _ => all,
        }
    }
}
