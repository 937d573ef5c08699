//! The choice of rows that get a picture of their first wrong event.

use super::EventPicture;
use super::mismatch::EventMismatch;
use super::scene::picture;
use super::system;
use crate::case::{Case, Given};
use crate::engine::{Engine, Limits, OscillatorTask, SampleGrid};
use crate::integrators;
use crate::score::Verdict;
use crate::suite::{Prepared, PreparedSystem, Scored, Status, Suite};
use crate::truth::Truth;
use rayon::prelude::*;

/// Rows that get a picture: a page stays quick, and so does the run, with that many.
const MOST_PICTURES: usize = 200;
/// A run that took more right-hand sides is not made again for a picture.
const MOST_WORK: u64 = 10_000_000;

/// Draws a row's picture; the run that is made again stays within limits.
type Draw<'a> = dyn Fn(&Limits) -> Option<EventPicture> + Send + Sync + 'a;

/// A row that has something to show, and how it is drawn.
struct RowChoice<'a> {
    row: &'a Scored,
    draw: Box<Draw<'a>>,
}

/// Pictures of rows with a missed or a spurious event, or with a displaced one and out of bounds;
/// of more rows than can be shown those out of bounds come first, then one row per case in turn.
#[must_use]
pub fn event_pictures(
    cases: (&[Prepared], &[PreparedSystem]),
    rows: &[Scored],
    suite: Suite,
) -> Vec<EventPicture> {
    let candidates: Vec<_> = rows.par_iter().filter_map(|row| candidate(cases, row)).collect();
    let limits = suite.limits();
    let chosen = chosen(candidates).into_par_iter().with_max_len(1);
    chosen.filter_map(|it| (it.draw)(&limits)).collect()
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

fn candidate<'a>(
    (cases, systems): (&'a [Prepared], &'a [PreparedSystem]),
    row: &'a Scored,
) -> Option<RowChoice<'a>> {
    let Status::Ok(measures, outcome) = &row.status else { return None };
    let mismatch = &measures.mismatch;
    let wrong = !(mismatch.missed.is_empty() && mismatch.spurious.is_empty());
    let affordable = outcome.work.rhs_evaluations <= MOST_WORK;
    if !affordable || !(wrong || row.judgement.verdict == Verdict::Fail) {
        return None;
    }
    let engine = *integrators::all().iter().find(|it| it.declaration().name == row.engine)?;
    let steps = outcome.work.steps.max(1) as f64;
    if let Some(prepared) = cases.iter().find(|it| it.case.name == row.case) {
        return of_oscillator(prepared, row, (engine, steps));
    }
    let prepared = systems.iter().find(|it| it.case.name == row.case)?;
    let it = system::SystemMismatch::first(prepared, measures, outcome, row)?;
    let mean_step = prepared.task.span / steps;
    let draw =
        move |limits: &Limits| system::picture(prepared, row, &it, (engine, mean_step, limits));
    Some(RowChoice { row, draw: Box::new(draw) })
}

fn of_oscillator<'a>(
    prepared: &'a Prepared,
    row: &'a Scored,
    (engine, steps): (&'static dyn Engine, f64),
) -> Option<RowChoice<'a>> {
    let task = task(&prepared.case)?;
    let mismatch = EventMismatch::first(prepared, &task, row)?;
    let mean_step = task.span / steps;
    let draw = move |limits: &Limits| {
        picture(prepared, &task, row, &mismatch, (engine, mean_step, limits))
    };
    Some(RowChoice { row, draw: Box::new(draw) })
}

/// The run of a case, without samples.
fn task(case: &Case) -> Option<OscillatorTask> {
    let given = Given { parameters: case.parameters, start: case.start, ..Given::default() };
    let grid = SampleGrid { per_period: Truth::SAMPLES_PER_PERIOD, count: 0 };
    Some(OscillatorTask::of(case, given.check().ok()?, grid))
}
