//! The rows of a run: the state at which each phase begins, or samples.

use super::plan::Plan;
use anyhow::Result;
use percuss::{Exit, Instant, Leg, Sample};

/// One row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Counts the rows of switches from 0.
    pub(super) index: u64,
    pub(super) phase: &'static str,
    pub(super) instant: Instant,
    /// p, y, q and v.
    pub(super) state: [f64; 4],
    /// x = p + v and z = q + v, in tables of samples only.
    pub(super) co_ordinates: Option<[f64; 2]>,
}

/// Something that rows can be written to.
pub(super) trait Sink {
    fn begin(&mut self, plan: &Plan, samples: bool) -> Result<()>;
    fn row(&mut self, plan: &Plan, row: &Row) -> Result<()>;
    fn finish(&mut self) -> Result<()>;
}

fn state(sample: &Sample) -> [f64; 4] {
    [sample.state.p, sample.state.y, sample.state.q, sample.v]
}

/// Row 0 is the start, then each switch, and the horizon if that is what ends the run.
pub(super) fn switches(plan: &Plan, sink: &mut dyn Sink) -> Result<Option<String>> {
    let mut index = 0;
    let mut last = None;
    let mut entry = plan.problem.entry;
    for leg in std::iter::once(None).chain(plan.legs().map(Some)) {
        match leg.as_ref().map(Leg::exit) {
            None => {}
            Some(Exit::Switch(next)) => (index, entry) = (index + 1, *next),
            Some(Exit::Horizon | Exit::Endless(_)) => {
                last = leg;
                break;
            }
        }
        let state = [entry.state.p, entry.state.y, entry.state.q, entry.v()];
        sink.row(
            plan,
            &Row {
                index,
                phase: entry.phase().token(),
                instant: entry.instant,
                state,
                co_ordinates: None,
            },
        )?;
    }
    if let (Some(last), None) = (&last, plan.events) {
        let state = state(&last.at_instant(&plan.horizon));
        sink.row(
            plan,
            &Row {
                index: index + 1,
                phase: "end",
                instant: plan.horizon,
                state,
                co_ordinates: None,
            },
        )?;
    }
    Ok(plan.ending(last.as_ref(), index))
}

/// Rows at start + k 2 pi/(K omega), the horizon included.
pub(super) fn samples(plan: &Plan, per_period: u32, sink: &mut dyn Sink) -> Result<Option<String>> {
    let start = plan.problem.entry.instant;
    let mut k = 0;
    let mut switches = 0;
    let mut last = None;
    for leg in plan.legs() {
        switches += u64::from(matches!(leg.exit(), Exit::Switch(_)));
        loop {
            let instant = start.after_periods(k, u64::from(per_period));
            if instant > plan.horizon || leg.ends_by(&instant) {
                break;
            }
            plan.progress.at(&instant);
            let state = state(&leg.at_instant(&instant));
            let [p, _, q, v] = state;
            let co_ordinates = Some([p + v, q + v]);
            sink.row(
                plan,
                &Row { index: k, phase: leg.phase().token(), instant, state, co_ordinates },
            )?;
            k += 1;
        }
        last = Some(leg);
    }
    Ok(plan.ending(last.as_ref(), switches))
}
