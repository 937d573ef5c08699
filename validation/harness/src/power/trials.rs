//! The shares of wrong answers that the judgement of records catches, and of right ones that it
//! condemns.
//!
//! Each answer of a right set-up is spoiled in every way that there is ([`Variant`]). The set-ups
//! and cases are none of those whose defects set the limits of `classes.toml`.

use super::variants::Variant;
use crate::case::ClassBounds;
use crate::engine::{Accuracy, Engine, Outcome, answer};
use crate::integrators;
use crate::score::local::{Allowance, LocalJudgement};
use crate::suite::{PreparedCase, Suite, class_of};
use rayon::prelude::*;

/// Right set-ups whose defects set no limit: explicit methods of two orders, an implicit one and a
/// multistep one.
const SET_UPS: [&str; 4] = [
    "differential-equations-rkv767e",
    "differential-equations-dop853",
    "diffsol-tr_bdf2",
    "diffsol-bdf",
];

/// A right answer and the wrong ones that are made of it.
pub struct Trial {
    /// The set-up.
    pub engine: &'static str,
    /// The accuracy that it was asked for.
    pub accuracy: Accuracy,
    /// The case.
    pub case: String,
    /// The judgement of the right answer.
    pub right: LocalJudgement,
    /// Whether the right answer is condemned.
    pub is_condemned: bool,
    /// Whether each variant is caught; none where it spoils nothing.
    pub caught: Vec<Option<bool>>,
}

/// The count of answers of one wrong kind, and of those that are caught.
#[derive(Clone, Debug)]
pub struct Tally {
    /// The kind.
    pub variant: Variant,
    /// Answers that it spoils.
    pub spoiled: usize,
    /// Those of them that are condemned.
    pub caught: usize,
    /// The cases of the others.
    pub missed_on: Vec<String>,
}

/// Cases that are younger than the limits, and so set none.
const YOUNGER_CASES: [&str; 2] = ["belt-side-by-side", "percussive-on-slider"];

/// Whether each of all cases is one that limits were set from: every second of those that were
/// there then.
#[must_use]
pub fn set_limits(cases: &[PreparedCase]) -> Vec<bool> {
    let mut sets = false;
    let each = cases.iter().map(|it| {
        let is_younger = YOUNGER_CASES.contains(&it.case.name.as_str());
        sets ^= !is_younger;
        sets && !is_younger
    });
    each.collect()
}

/// The runs of which trials are made: set-ups that set no limit, on cases that set none.
fn runs(cases: &[PreparedCase]) -> Vec<(&PreparedCase, &'static dyn Engine)> {
    let is_chosen = |it: &&&'static dyn Engine| SET_UPS.contains(&it.declaration().name);
    let engines: Vec<_> = integrators::all().iter().filter(is_chosen).copied().collect();
    let others = cases.iter().zip(set_limits(cases)).filter(|(_, sets)| !sets);
    others.flat_map(|(case, _)| engines.iter().map(move |engine| (case, *engine))).collect()
}

/// The trials at a tolerance.
#[must_use]
pub fn trials(
    cases: &[PreparedCase],
    tolerance: f64,
    classes: &[ClassBounds],
    variants: &[Variant],
) -> Vec<Trial> {
    let accuracy = Accuracy::Tolerance(tolerance);
    let one = |(case, engine)| trial(case, (engine, accuracy), classes, variants);
    runs(cases).into_par_iter().filter_map(one).collect()
}

/// Counts answers that were made with a tolerance looser by a factor than the one that they are
/// labelled with: the condemned ones, and all.
#[must_use]
pub fn count_loosened(
    cases: &[PreparedCase],
    (tolerance, factor): (f64, f64),
    classes: &[ClassBounds],
) -> (usize, usize) {
    let condemned = |(case, engine): (&PreparedCase, &'static dyn Engine)| {
        let declaration = engine.declaration();
        let label = Accuracy::Tolerance(tolerance);
        let class = class_of(classes, &declaration, label)?;
        let made = answer_within_budget(case, engine, Accuracy::Tolerance(factor * tolerance))?;
        let unit = declaration.stepping.unit(label);
        let found = case.judge_records(&made, class, unit)?;
        Some(found.is_wrong(&Allowance::new(class, unit)))
    };
    let all: Vec<bool> = runs(cases).into_par_iter().filter_map(condemned).collect();
    (all.iter().filter(|it| **it).count(), all.len())
}

/// An engine's answer to a case; none where it has none, or takes more calls than the suite allows.
fn answer_within_budget(
    case: &PreparedCase,
    engine: &'static dyn Engine,
    accuracy: Accuracy,
) -> Option<Outcome> {
    let is_affordable = case.least_work(engine, accuracy) <= Suite::Quick.budget();
    if !is_affordable || engine.takes(&case.task).is_err() {
        return None;
    }
    answer(engine, &case.task, accuracy, &Suite::limits(&case.case)).ok()
}

/// One answer of an engine, judged, with the variants of it; none where the engine has no answer.
#[must_use]
pub fn trial(
    case: &PreparedCase,
    (engine, accuracy): (&'static dyn Engine, Accuracy),
    classes: &[ClassBounds],
    variants: &[Variant],
) -> Option<Trial> {
    let declaration = engine.declaration();
    let class = class_of(classes, &declaration, accuracy)?;
    let right = answer_within_budget(case, engine, accuracy)?;
    let unit = declaration.stepping.unit(accuracy);
    let allowance = Allowance::new(class, unit);
    let judge = |answer: &Outcome| case.judge_records(answer, class, unit);
    let caught = |variant: &Variant| {
        let wrong = variant.wrong_answer(&case.task, (&right, case.local.judged(&right)), unit)?;
        Some(judge(&wrong)?.is_wrong(&allowance))
    };
    let found = judge(&right)?;
    Some(Trial {
        engine: declaration.name,
        accuracy,
        case: case.case.name.clone(),
        is_condemned: found.is_wrong(&allowance),
        caught: variants.iter().map(caught).collect(),
        right: found,
    })
}

/// How often each variant is caught, where the right answer is not condemned.
#[must_use]
pub fn tallies(trials: &[Trial], variants: &[Variant]) -> Vec<Tally> {
    let tally = |(n, variant): (usize, &Variant)| {
        let right = trials.iter().filter(|it| !it.is_condemned);
        let spoiled: Vec<_> = right.filter(|it| it.caught[n].is_some()).collect();
        let missed = spoiled.iter().filter(|it| it.caught[n] == Some(false));
        let mut missed_on: Vec<String> = missed.map(|it| it.case.clone()).collect();
        let caught = spoiled.len() - missed_on.len();
        missed_on.dedup();
        Tally { variant: *variant, spoiled: spoiled.len(), caught, missed_on }
    };
    variants.iter().enumerate().map(tally).collect()
}
