//! The rows of a run: the state at which each phase begins, or samples.

use super::plan::{PlannedRun, RunEnding};
use anyhow::Result;
use percuss::{Exit, Instant, Sample, Segment};

/// A row of the output.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunRow {
    /// Counts the rows of events from 0.
    pub(super) index: u64,
    pub(super) phase: &'static str,
    pub(super) instant: Instant,
    /// p, y, q and v.
    pub(super) state: [f64; 4],
    /// x = p + v and z = q + v, in tables of samples only.
    pub(super) co_ordinates: Option<[f64; 2]>,
}

/// An output for rows.
pub(super) trait Sink {
    fn begin(&mut self, plan: &PlannedRun, samples: bool) -> Result<()>;
    /// Takes a phase of the run, before the rows that it ends in.
    fn segment(&mut self, _: &PlannedRun, _: &Segment) -> Result<()> {
        Ok(())
    }
    fn row(&mut self, plan: &PlannedRun, row: &RunRow) -> Result<()>;
    fn finish(&mut self, plan: &PlannedRun, ending: &RunEnding) -> Result<()>;
}

/// Several outputs of one run.
pub(super) struct All<'a>(pub(super) Vec<Box<dyn Sink + 'a>>);

impl Sink for All<'_> {
    fn begin(&mut self, plan: &PlannedRun, samples: bool) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.begin(plan, samples))
    }

    fn segment(&mut self, plan: &PlannedRun, segment: &Segment) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.segment(plan, segment))
    }

    fn row(&mut self, plan: &PlannedRun, row: &RunRow) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.row(plan, row))
    }

    fn finish(&mut self, plan: &PlannedRun, ending: &RunEnding) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.finish(plan, ending))
    }
}

fn state(sample: &Sample) -> [f64; 4] {
    [sample.state.p, sample.state.y, sample.state.q, sample.v]
}

/// Row 0 is the start, then each event, and the horizon if that is what ends the run, or where it
/// is no longer decided.
pub(super) fn events(plan: &PlannedRun, sink: &mut dyn Sink) -> Result<RunEnding> {
    let mut index = 0;
    let mut last = None;
    let mut entry = plan.problem.entry;
    let mut segments = plan.segments();
    for segment in std::iter::once(None).chain(segments.by_ref().map(Some)) {
        if let Some(segment) = &segment {
            sink.segment(plan, segment)?;
        }
        match segment.as_ref().map(Segment::exit) {
            None => {}
            Some(Exit::Switch(next)) => (index, entry) = (index + 1, *next),
            Some(_) => {
                last = segment;
                break;
            }
        }
        let state = [entry.state.p, entry.state.y, entry.state.q, entry.v()];
        sink.row(
            plan,
            &RunRow {
                index,
                phase: entry.phase().as_str(),
                instant: entry.instant,
                state,
                co_ordinates: None,
            },
        )?;
    }
    let ending = plan.ending(last.as_ref(), &segments);
    if let Some(last) = last
        && (plan.events.is_none() || ending.undecided)
    {
        let instant = plan.end_of(&last);
        let state = state(&last.at_instant(&instant));
        sink.row(
            plan,
            &RunRow {
                index: index + 1,
                phase: if ending.undecided { UNDECIDABLE } else { "end" },
                instant,
                state,
                co_ordinates: None,
            },
        )?;
    }
    Ok(ending)
}

/// Rows at start + k 2 pi/(K omega), the horizon included; a last one where the run is no longer
/// decided.
pub(super) fn samples(
    plan: &PlannedRun,
    per_period: u32,
    sink: &mut dyn Sink,
) -> Result<RunEnding> {
    let start = plan.problem.entry.instant;
    let mut k = 0;
    let mut last = None;
    let mut segments = plan.segments();
    for segment in segments.by_ref() {
        sink.segment(plan, &segment)?;
        loop {
            let instant = start.after_periods(k, u64::from(per_period));
            let over = instant > plan.horizon || segment.is_undecided_at(&instant);
            if over || segment.ends_by(&instant) {
                break;
            }
            plan.progress.at(&instant);
            sink.row(plan, &sample(k, segment.phase().as_str(), &segment, instant))?;
            k += 1;
        }
        last = Some(segment);
    }
    let ending = plan.ending(last.as_ref(), &segments);
    if let Some(last) = last
        && ending.undecided
    {
        sink.row(plan, &sample(k, UNDECIDABLE, &last, plan.end_of(&last)))?;
    }
    Ok(ending)
}

/// The phase of a row at which the run is no longer decided.
const UNDECIDABLE: &str = "undecidable";

fn sample(index: u64, phase: &'static str, segment: &Segment, instant: Instant) -> RunRow {
    let state = state(&segment.at_instant(&instant));
    let [p, _, q, v] = state;
    RunRow { index, phase, instant, state, co_ordinates: Some([p + v, q + v]) }
}
