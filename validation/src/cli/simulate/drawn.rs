//! The picture of a run of the impact oscillator, drawn when the run has ended.

use super::plan::{PlannedRun, RunEnding};
use super::rows::{RunRow, Sink};
use crate::cli::shared::picture::{PictureFlags, PictureFormat};
use crate::picture::DrawnMotion;
use anyhow::Result;
use percuss::Segment;
use std::io::Write;

pub(super) struct Drawn<'a> {
    pub(super) out: &'a mut dyn Write,
    pub(super) flags: &'a PictureFlags,
    pub(super) format: PictureFormat,
    pub(super) segments: Vec<Segment>,
}

impl Sink for Drawn<'_> {
    fn begin(&mut self, plan: &PlannedRun, _: bool) -> Result<()> {
        plan.check_picture(&plan.horizon, plan.events.is_none())
    }

    fn segment(&mut self, plan: &PlannedRun, segment: &Segment) -> Result<()> {
        plan.check_picture(&segment.entry().instant, true)?;
        self.segments.push(*segment);
        Ok(())
    }

    fn row(&mut self, _: &PlannedRun, _: &RunRow) -> Result<()> {
        Ok(())
    }

    fn finish(&mut self, plan: &PlannedRun, _: &RunEnding) -> Result<()> {
        let last = plan.last_instant(&self.segments);
        let motion = DrawnMotion::new(&plan.problem, &self.segments, &last);
        self.flags.write_drawing(&motion, self.format, self.out)
    }
}
