//! A run of a system as JSON, each row written as soon as it is known.

use super::plan::PlannedRun;
use super::sink::{Row, RunEnd, Sink};
use crate::cli::shared::output::json_value;
use anyhow::Result;
use serde::{Serialize, Serializer};
use std::io::Write;

pub(super) struct Json<'a> {
    out: &'a mut dyn Write,
    rows: u64,
}

#[derive(Serialize)]
struct EventRow<'a> {
    n: u64,
    time: f64,
    event: &'a str,
    mode: &'a str,
    state: State<'a>,
}

#[derive(Serialize)]
struct SampleRow<'a> {
    time: f64,
    mode: &'a str,
    state: State<'a>,
}

#[derive(Serialize)]
struct Accumulation {
    earliest: f64,
    latest: f64,
}

/// The states by their names, in the order of the file.
struct State<'a> {
    names: &'a [String],
    values: &'a [f64],
}

impl Serialize for State<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.names.iter().zip(self.values))
    }
}

impl<'a> Json<'a> {
    pub(super) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, rows: 0 }
    }
}

impl Sink for Json<'_> {
    fn begin(&mut self, plan: &PlannedRun<'_>) -> Result<()> {
        let version = env!("CARGO_PKG_VERSION");
        write!(self.out, "{{\"schema\":1,\"percuss\":\"{version}\",\"system\":")?;
        json_value(self.out, &plan.system().name)?;
        write!(self.out, ",\"parameters\":")?;
        json_value(self.out, &plan.system().parameters)?;
        Ok(write!(self.out, ",\"rows\":[")?)
    }

    fn row(&mut self, plan: &PlannedRun<'_>, row: &Row<'_>) -> Result<()> {
        writeln!(self.out, "{}", if self.rows == 0 { "" } else { "," })?;
        self.rows += 1;
        let system = plan.system();
        let state = State { names: &system.states, values: row.state };
        let (time, mode) = (row.time, system.modes[row.mode].name.as_str());
        match plan.samples {
            Some(_) => json_value(self.out, &SampleRow { time, mode, state }),
            None => {
                let event = row.event.unwrap_or_default();
                json_value(self.out, &EventRow { n: row.n, time, event, mode, state })
            }
        }
    }

    fn finish(&mut self, _: &PlannedRun<'_>, end: &RunEnd) -> Result<()> {
        write!(self.out, "],\"accumulation\":")?;
        let ends = end.accumulation.map(|[earliest, latest]| Accumulation { earliest, latest });
        json_value(self.out, &ends)?;
        if end.undecidable > 0 {
            write!(self.out, ",\"undecidable\":{}", end.undecidable)?;
        }
        Ok(writeln!(self.out, "}}")?)
    }
}
