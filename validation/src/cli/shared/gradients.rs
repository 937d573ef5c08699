//! Derivatives through events, asked of the engines that answer them.

use super::judged::CaseFlags;
use super::long_work;
use crate::engine::{Engine, REFERENCE};
use crate::gradients::{
    self, GradientCase, GradientJudgement, Reference, TOLERANCES, embedded, one, run,
};
use crate::report::GradientEntry;
use anyhow::{Result, anyhow};
use percuss_programs::files::{FileEngine, GRADIENTS_ENDING};
use rayon::prelude::*;
use std::path::Path;

/// The names of all cases of derivatives, where the chosen engines are asked for them.
pub(in crate::cli) fn names(
    chosen: &CaseFlags,
    engines: &[&'static dyn Engine],
) -> Vec<&'static str> {
    let is_asked = chosen.cases.is_none() && !answering(engines).is_empty();
    if is_asked { gradients::names() } else { Vec::new() }
}

/// The engines that are asked; none where only the reference answers derivatives.
fn answering(engines: &[&'static dyn Engine]) -> Vec<&'static dyn Engine> {
    let all: Vec<_> = engines.iter().copied().filter(|it| it.differentiates()).collect();
    let is_peer = |it: &&dyn Engine| !it.declaration().name.starts_with(REFERENCE);
    if all.iter().any(|it| is_peer(&(*it as &dyn Engine))) { all } else { Vec::new() }
}

/// The verdicts on the derivatives of the chosen cases; none where only the reference answers them
/// or the cases are a user's own. With fewer than two tolerances both of the usual ones are asked.
pub(in crate::cli) fn judged(
    chosen: &CaseFlags,
    engines: &[&'static dyn Engine],
    tolerances: &[f64],
) -> Result<Vec<GradientEntry>> {
    let answering = answering(engines);
    if answering.is_empty() {
        return Ok(Vec::new());
    }
    let ready = ready(cases(chosen, |_| true)?)?;
    let tolerances = if tolerances.len() < 2 { &TOLERANCES[..] } else { tolerances };
    let bar = long_work::bar((ready.len() * answering.len()) as u64, "derivatives");
    let rows = run(&ready, &answering, tolerances, &|| bar.inc(1));
    bar.finish_and_clear();
    Ok(rows.into_iter().map(GradientEntry::from).collect())
}

/// The chosen cases of derivatives with wanted names; none where the cases are a user's own.
pub(in crate::cli) fn cases(
    chosen: &CaseFlags,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Vec<GradientCase>> {
    let is_chosen = |it: &str| chosen.cases.is_none() && chosen.accepts(it) && is_wanted(it);
    Ok(embedded(is_chosen)?)
}

/// Those of the chosen cases of derivatives to which a folder has answers.
pub(in crate::cli) fn answered(chosen: &CaseFlags, folder: &Path) -> Result<Vec<GradientCase>> {
    cases(chosen, |name| folder.join(format!("{name}{GRADIENTS_ENDING}")).exists())
}

/// The verdicts on the answers in files to these cases, made at one tolerance.
pub(in crate::cli) fn judged_files(
    cases: Vec<GradientCase>,
    engine: impl Fn(&str) -> FileEngine + Sync,
    tolerance: f64,
) -> Result<Vec<GradientEntry>> {
    let entries = ready(cases)?.into_par_iter().flat_map_iter(|reference| {
        let case = reference.case.name.clone();
        let engine = engine(&case);
        let name = engine.declaration().name;
        let judged = one(&reference, &engine, &[tolerance]).into_iter();
        judged.map(move |judged| GradientJudgement { engine: name, case: case.clone(), judged })
    });
    Ok(entries.map(GradientEntry::from).collect())
}

/// Cases of derivatives made ready to be judged.
fn ready(cases: Vec<GradientCase>) -> Result<Vec<Reference>> {
    let ready = cases.into_par_iter().map(Reference::new).collect::<Result<Vec<_>, _>>();
    ready.map_err(|failure| anyhow!("the cases of derivatives: {}", failure.reason))
}
