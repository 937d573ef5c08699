//! The verdict on a row: bounds held against measures, with what grazes and expected failures
//! excuse.
//!
//! A row has one class, the first that applies of: unavailable, not-run, error, fail, known,
//! undecidable, not-scored, pass.

use super::local::FirstWrong;
use super::measures::Measures;
use super::mismatch::Excused;
use super::scored::{Checked, ScoredRun, Verdict};
use super::shortcoming::{Answer, answer};
use crate::case::{Bound, Quantity, Shortcoming, Statistic};
use crate::engine::Accuracy;
use crate::number::brief;

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

    /// The verdict on a run that has no result, which may be expected of the engine.
    #[must_use]
    pub fn failed(subject: &Subject<'_>, reason: &str, shortcomings: &[&Shortcoming]) -> Self {
        let said = |it: &&&Shortcoming| {
            it.quantity == Quantity::RunsFailed
                && it.is_for(subject.case, subject.engine, subject.accuracy)
        };
        let expected = shortcomings.iter().find(said);
        let (verdict, bound) = match expected {
            Some(_) => (Verdict::Known, Verdict::Known),
            None => (Verdict::Error, Verdict::Fail),
        };
        let why = match expected {
            Some(known) => format!("{reason}: {}", known.why),
            None => reason.to_owned(),
        };
        let bound = Checked {
            quantity: Quantity::RunsFailed,
            statistic: Statistic::Value,
            limit: 0.0,
            value: 1.0,
            verdict: bound,
            why: "a run has a result".to_owned(),
        };
        Self { bounds: vec![bound], verdict, why }
    }
}

/// The case, engine and accuracy of a row that is judged.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The case's name.
    pub case: &'a str,
    /// The engine's name.
    pub engine: &'a str,
    /// The accuracy that the engine was asked for.
    pub accuracy: Accuracy,
    /// The unit in which the engine's errors are counted.
    pub unit: f64,
}

/// The bounds and expected failures that apply to a subject.
#[derive(Clone, Copy)]
pub struct Expected<'a> {
    /// Bounds in order: the first for a quantity and statistic counts.
    pub bounds: &'a [&'a Bound],
    /// Bounds on every case, whose constant decides which grazes leave an exact engine either
    /// answer: what a case allows besides excuses no event.
    pub of_every_case: &'a [Bound],
    /// The expected failures of engines.
    pub shortcomings: &'a [&'a Shortcoming],
}

/// Judges a run.
#[must_use]
pub fn judge(subject: &Subject<'_>, run: &ScoredRun<'_>, expected: &Expected<'_>) -> RowJudgement {
    // The local judgement leaves grazes open by itself.
    let is_local = run.measures.local.is_some();
    let excused = if is_local {
        Excused::default()
    } else {
        undecided_grazes(subject, run, expected.of_every_case)
    };
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
        let wrong = run.measures.local.as_ref().and_then(|it| it.first_wrong.as_ref());
        if !self.failed.is_empty() {
            let why = self.failed.into_iter().chain(wrong.map(FirstWrong::sentence));
            (Verdict::Fail, why.collect::<Vec<_>>().join("; "))
        } else if !self.known.is_empty() {
            (Verdict::Known, self.known.join("; "))
        } else if let Some(first) = wrong {
            // Whatever the bounds say, what is wrong by the local judgement does not pass.
            (Verdict::Fail, first.sentence())
        } else if !excused.grazes.is_empty() {
            (Verdict::Undecidable, undecidable(excused))
        } else if let Some(open) =
            run.measures.local.as_ref().map(|it| it.undecidable).filter(|it| *it > 0)
        {
            (Verdict::Undecidable, left_open(open))
        } else if !run.measures.is_scored() {
            (Verdict::NotScored, little_scored(run.measures))
        } else if let Some(it) = unmeasured {
            (Verdict::NotScored, format!("nothing measures its {}", it.quantity.words()))
        } else {
            (Verdict::Pass, run.measures.not_given().unwrap_or_default().to_owned())
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

fn left_open(events: usize) -> String {
    format!(
        "either answer is right at {events} of its events: a guard's extremum, or the value that \
         chooses the next mode, is zero within the errors that are allowed"
    )
}

fn little_scored(measures: &Measures) -> String {
    if measures.local.is_some() {
        return format!(
            "none of {} events is judged: the first comes before the horizon by less than the errors \
             that are allowed",
            measures.total
        );
    }
    format!(
        "{} of {} events are scored: beyond, one unit of this setting's error has grown past 1e-3",
        measures.expected, measures.total
    )
}

/// The grazes that the bound on an exact engine's errors leaves undecided.
fn undecided_grazes(
    subject: &Subject<'_>,
    run: &ScoredRun<'_>,
    of_every_case: &[Bound],
) -> Excused {
    let constant = of_every_case.iter().find(|it| {
        it.quantity == Quantity::EventConstant
            && it.statistic == Statistic::Max
            && it.is_for(subject.engine, subject.accuracy)
    });
    let Some(constant) = constant else { return Excused::default() };
    let allowed = constant.limit * subject.unit;
    let ScoredRun { measures, grazes, window, .. } = *run;
    measures.mismatch.excused_by(grazes, &measures.found, window, allowed)
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
            Quantity::PhaseSequence => {
                let Self { measures, truth, .. } = self;
                let same = measures.mismatch.same_phases(truth, &measures.found, excused);
                f64::from(u8::from(!same))
            }
            _ => all,
        }
    }
}
