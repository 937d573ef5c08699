//! A run of a system as CSV, each row written as soon as it is known.

use super::plan::PlannedRun;
use super::sink::{Row, RunEnd, Sink};
use crate::number::Shortest;
use anyhow::Result;
use percuss_programs::files::{EVENT_COLUMNS, SAMPLE_COLUMNS, printed_column};
use std::io::Write;

pub(super) struct Csv<'a> {
    out: &'a mut dyn Write,
    /// The memory for a row.
    line: Vec<u8>,
}

impl<'a> Csv<'a> {
    pub(super) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, line: Vec::new() }
    }
}

impl Sink for Csv<'_> {
    fn begin(&mut self, plan: &PlannedRun<'_>) -> Result<()> {
        let own = if plan.samples.is_some() { &SAMPLE_COLUMNS[..] } else { &EVENT_COLUMNS[..] };
        write!(self.out, "{}", own.join(","))?;
        for state in &plan.system().states {
            write!(self.out, ",{}", printed_column(state))?;
        }
        Ok(writeln!(self.out)?)
    }

    fn row(&mut self, plan: &PlannedRun<'_>, row: &Row<'_>) -> Result<()> {
        let (line, time) = (&mut self.line, Shortest(row.time));
        // Names of modes and events hold nothing that CSV has to quote.
        let mode = &plan.system().modes[row.mode].name;
        line.clear();
        match plan.samples {
            Some(_) => write!(line, "{time},{mode}")?,
            None => write!(line, "{},{time},{},{mode}", row.n, row.event.unwrap_or_default())?,
        }
        for value in row.state {
            write!(line, ",{}", Shortest(*value))?;
        }
        line.push(b'\n');
        Ok(self.out.write_all(line)?)
    }

    fn finish(&mut self, _: &PlannedRun<'_>, _: &RunEnd) -> Result<()> {
        Ok(())
    }
}
