//! The choice of rows that get a picture of their first wrong event.

use super::EventPicture;
use super::mismatch::{EventMismatch, picture};
use crate::engine::Engine;
use crate::integrators;
use crate::score::Verdict;
use crate::suite::{PreparedCase, Scored, Status, Suite};
use rayon::prelude::*;

/// Rows that get a picture: a page stays quick, and so does the run, with that many.
const MOST_PICTURES: usize = 200;
/// A run that took more right-hand sides is not made again for a picture.
const MOST_WORK: u64 = 10_000_000;

/// A row that has something to show, and what.
struct RowChoice<'a> {
    row: &'a Scored,
    prepared: &'a PreparedCase,
    mismatch: EventMismatch,
    engine: &'static dyn Engine,
    mean_step: f64,
}

/// Pictures of rows with a missed or a spurious event, or with a displaced one and out of bounds;
/// of more rows than can be shown those out of bounds come first, then one row per case in turn.
#[must_use]
pub fn event_pictures(cases: &[PreparedCase], rows: &[Scored]) -> Vec<EventPicture> {
    let candidates: Vec<_> = rows.par_iter().filter_map(|row| candidate(cases, row)).collect();
    let draw = |it: RowChoice<'_>| {
        let limits = Suite::limits(&it.prepared.case);
        picture(it.prepared, it.row, &it.mismatch, (it.engine, it.mean_step, &limits))
    };
    chosen(candidates).into_par_iter().with_max_len(1).filter_map(draw).collect()
}

/// Chooses as many as can be shown, in the order of the rows.
fn chosen(candidates: Vec<RowChoice<'_>>) -> Vec<RowChoice<'_>> {
    let key = |i: &usize| {
        let row = candidates[*i].row;
        let before = candidates[..*i].iter().filter(|it| it.row.case == row.case).count();
        (row.judgement.verdict != Verdict::Fail, before, *i)
    };
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    order.sort_by_cached_key(key);
    order.truncate(MOST_PICTURES);
    let all = candidates.into_iter().enumerate();
    all.filter(|(i, _)| order.contains(i)).map(|(_, it)| it).collect()
}

fn candidate<'a>(cases: &'a [PreparedCase], row: &'a Scored) -> Option<RowChoice<'a>> {
    let Status::Ok(measures, outcome) = &row.status else { return None };
    let mismatch = &measures.mismatch;
    let wrong = match &measures.local {
        Some(local) => local.first_wrong.is_some(),
        None => !(mismatch.missed.is_empty() && mismatch.spurious.is_empty()),
    };
    let affordable = outcome.work.rhs_evaluations <= MOST_WORK;
    if !affordable || !(wrong || row.judgement.verdict == Verdict::Fail) {
        return None;
    }
    let engine = *integrators::all().iter().find(|it| it.declaration().name == row.engine)?;
    let prepared = cases.iter().find(|it| it.case.name == row.case)?;
    let mismatch = EventMismatch::first(prepared, measures, outcome, row)?;
    let mean_step = prepared.task.span / outcome.work.steps.max(1) as f64;
    Some(RowChoice { row, prepared, mismatch, engine, mean_step })
}
