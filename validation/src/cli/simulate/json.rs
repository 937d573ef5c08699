//! A run as JSON, written row by row: a long run costs no memory.

use super::plan::{PlannedRun, RunEnding};
use super::rows::{RunRow, Sink};
use crate::cli::shared::model::ParametersJson;
use crate::cli::shared::output::json_value;
use anyhow::Result;
use percuss::Phase;
use serde::Serialize;
use std::io::Write;

pub(super) struct Json<'a> {
    out: &'a mut dyn Write,
    rows: u64,
}

/// The start as the run takes it; the phase only where it was stated.
#[derive(Serialize)]
struct StartJson {
    tau: f64,
    p: f64,
    y: f64,
    q: f64,
    v: f64,
    cycle: i64,
    phase: Option<&'static str>,
}

#[derive(Serialize)]
struct SwitchRow {
    index: u64,
    phase: &'static str,
    tau: f64,
    p: f64,
    y: f64,
    q: f64,
    v: f64,
    cycle: i128,
    angle: f64,
}

#[derive(Serialize)]
struct SampleRow {
    tau: f64,
    phase: &'static str,
    p: f64,
    y: f64,
    q: f64,
    v: f64,
    x: f64,
    z: f64,
    cycle: i128,
    angle: f64,
}

impl<'a> Json<'a> {
    pub(super) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, rows: 0 }
    }
}

impl Sink for Json<'_> {
    fn begin(&mut self, plan: &PlannedRun, _: bool) -> Result<()> {
        write!(
            self.out,
            "{{\"schema\":1,\"percuss\":\"{}\",\"parameters\":",
            env!("CARGO_PKG_VERSION")
        )?;
        json_value(self.out, &ParametersJson::from(plan.problem.model.parameters()))?;
        write!(self.out, ",\"start\":")?;
        let given = plan.problem.start;
        let state = plan.problem.entry.state;
        json_value(
            self.out,
            &StartJson {
                tau: given.tau,
                p: state.p,
                y: state.y,
                q: state.q,
                v: given.v,
                cycle: given.cycle,
                phase: given.phase.map(Phase::as_str),
            },
        )?;
        Ok(write!(self.out, ",\"rows\":[")?)
    }

    fn row(&mut self, plan: &PlannedRun, row: &RunRow) -> Result<()> {
        writeln!(self.out, "{}", if self.rows == 0 { "" } else { "," })?;
        self.rows += 1;
        let RunRow { index, phase, instant, state: [p, y, q, v], co_ordinates } = *row;
        let (tau, cycle, angle) = (instant.tau(plan.omega()), instant.cycle(), instant.angle());
        match co_ordinates {
            None => {
                json_value(self.out, &SwitchRow { index, phase, tau, p, y, q, v, cycle, angle })
            }
            Some([x, z]) => {
                json_value(self.out, &SampleRow { tau, phase, p, y, q, v, x, z, cycle, angle })
            }
        }
    }

    fn finish(&mut self, _: &PlannedRun, ending: &RunEnding) -> Result<()> {
        write!(self.out, "]")?;
        if ending.touches > 0 {
            write!(self.out, ",\"undecidable\":{}", ending.touches)?;
        }
        Ok(writeln!(self.out, "}}")?)
    }
}
