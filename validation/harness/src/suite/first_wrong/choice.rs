//! The choice of rows whose first wrong event is shown.

use super::FirstWrongEvent;
use super::mismatch::EventMismatch;
use crate::engine::Engine;
use crate::integrators;
use crate::score::Verdict;
use crate::suite::{PreparedCase, Scored, Status};
use rayon::prelude::*;

/// Rows whose event is shown: a page stays quick, and so does the run, with that many.
const MAX_ROWS: usize = 200;
/// A run that took more right-hand sides is not made again to be watched.
const MAX_RHS_EVALUATIONS: u64 = 10_000_000;

/// A row that has something to show, and what.
struct RowChoice<'a> {
    row: &'a Scored,
    prepared: &'a PreparedCase,
    mismatch: EventMismatch,
    /// The engine, where it is run again and watched.
    again: Option<&'static dyn Engine>,
}

/// The first wrong events of rows with a missed or a spurious event, or with a displaced one and
/// out of bounds; of more rows than can be shown those out of bounds come first, then one row per
/// case in turn.
#[must_use]
pub fn first_wrong_events<'a>(
    cases: &'a [PreparedCase],
    rows: &'a [Scored],
) -> Vec<FirstWrongEvent<'a>> {
    let candidates: Vec<_> = rows.par_iter().filter_map(|row| candidate(cases, row)).collect();
    let observe = |RowChoice { row, prepared, mismatch, again }: RowChoice<'a>| {
        FirstWrongEvent::observed((prepared, row), mismatch, again)
    };
    choose(candidates).into_par_iter().with_max_len(1).filter_map(observe).collect()
}

/// Chooses as many as can be shown, in the order of the rows.
fn choose(candidates: Vec<RowChoice<'_>>) -> Vec<RowChoice<'_>> {
    let key = |i: &usize| {
        let row = candidates[*i].row;
        let before = candidates[..*i].iter().filter(|it| it.row.case == row.case).count();
        (row.judgement.verdict != Verdict::Fail, before, *i)
    };
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    order.sort_by_cached_key(key);
    order.truncate(MAX_ROWS);
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
    if !(wrong || row.judgement.verdict == Verdict::Fail) {
        return None;
    }
    let prepared = cases.iter().find(|it| it.case.name == row.case)?;
    let mismatch = EventMismatch::first(prepared, measures, outcome, row)?;
    let affordable = outcome.work.rhs_evaluations <= MAX_RHS_EVALUATIONS;
    let own = integrators::all().iter().find(|it| it.declaration().name == row.engine);
    Some(RowChoice { row, prepared, mismatch, again: own.filter(|_| affordable).copied() })
}
