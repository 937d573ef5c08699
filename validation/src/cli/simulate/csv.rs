//! A run as CSV.

use super::plan::{PlannedRun, RunEnding};
use super::rows::{RunRow, Sink};
use crate::number::shortest;
use anyhow::Result;
use std::io::Write;

pub(super) struct Csv<'a>(pub(super) &'a mut dyn Write);

const EVENTS: &str = "index,phase,tau,p,y,q,v";
const SAMPLES: &str = "tau,phase,p,y,q,v,x,z";

impl Sink for Csv<'_> {
    fn begin(&mut self, _: &PlannedRun, samples: bool) -> Result<()> {
        Ok(writeln!(self.0, "{}", if samples { SAMPLES } else { EVENTS })?)
    }

    fn row(&mut self, plan: &PlannedRun, row: &RunRow) -> Result<()> {
        let tau = shortest(row.instant.tau(plan.omega()));
        let [p, y, q, v] = row.state.map(shortest);
        match row.co_ordinates {
            None => writeln!(self.0, "{},{},{tau},{p},{y},{q},{v}", row.index, row.phase)?,
            Some(original) => {
                let [x, z] = original.map(shortest);
                writeln!(self.0, "{tau},{},{p},{y},{q},{v},{x},{z}", row.phase)?;
            }
        }
        Ok(())
    }

    fn finish(&mut self, _: &PlannedRun, _: &RunEnding) -> Result<()> {
        Ok(())
    }
}
