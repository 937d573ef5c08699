//! The rows of `events` as CSV and as JSON, each written as soon as it is known.

use super::progress::RunEnd;
use super::rows::{EventRow, Rows, SampleRow, Sink};
use crate::cli::shared::output::json_value;
use anyhow::Result;
use percuss_programs::files::{EVENT_COLUMNS, SAMPLE_COLUMNS, printed_column};
use serde::Serialize;
use std::borrow::Cow;
use std::io::Write;

/// Rows as CSV.
pub(super) struct Csv<'a>(pub(super) &'a mut dyn Write);

impl Csv<'_> {
    /// Writes a line; an error is the output's own, as a reader who has left.
    fn line<'a>(&mut self, cells: impl Iterator<Item = &'a str>) -> Result<()> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(cells)?;
        Ok(self.0.write_all(&writer.into_inner()?)?)
    }

    fn row(&mut self, first: &[&str], state: &[(String, String)]) -> Result<()> {
        self.line(first.iter().copied().chain(state.iter().map(|(_, cell)| cell.as_str())))
    }
}

impl Sink for Csv<'_> {
    fn begin(&mut self, rows: &Rows<'_>) -> Result<()> {
        let own = if rows.samples.is_some() { &SAMPLE_COLUMNS[..] } else { &EVENT_COLUMNS[..] };
        let states = rows.system.states.iter().map(|name| printed_column(name));
        let names: Vec<_> = own.iter().map(|name| Cow::from(*name)).chain(states).collect();
        self.line(names.iter().map(AsRef::as_ref))
    }

    fn event(&mut self, row: &EventRow) -> Result<()> {
        self.row(&[&row.n.to_string(), &row.time, &row.event, &row.mode], &row.state)
    }

    fn sample(&mut self, row: &SampleRow) -> Result<()> {
        self.row(&[&row.time, &row.mode], &row.state)
    }

    fn finish(&mut self, _: &Rows<'_>, _: &RunEnd) -> Result<()> {
        Ok(())
    }
}

/// Rows as JSON. What is known at the end only stands after them.
pub(super) struct Json<'a> {
    out: &'a mut dyn Write,
    is_first: bool,
}

impl<'a> Json<'a> {
    pub(super) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, is_first: true }
    }

    fn row(&mut self, row: &impl Serialize) -> Result<()> {
        let separator = if std::mem::take(&mut self.is_first) { "" } else { "," };
        writeln!(self.out, "{separator}")?;
        json_value(self.out, row)
    }
}

impl Sink for Json<'_> {
    fn begin(&mut self, rows: &Rows<'_>) -> Result<()> {
        let version = env!("CARGO_PKG_VERSION");
        write!(self.out, "{{\"schema\":1,\"percuss\":\"{version}\",\"system\":")?;
        json_value(self.out, &rows.system.name)?;
        write!(self.out, ",\"parameters\":")?;
        json_value(self.out, &rows.system.parameters)?;
        Ok(write!(self.out, ",\"rows\":[")?)
    }

    fn event(&mut self, row: &EventRow) -> Result<()> {
        self.row(row)
    }

    fn sample(&mut self, row: &SampleRow) -> Result<()> {
        self.row(row)
    }

    fn finish(&mut self, _: &Rows<'_>, end: &RunEnd) -> Result<()> {
        write!(self.out, "],\"accumulation\":")?;
        json_value(self.out, &end.accumulation)?;
        Ok(writeln!(self.out, "}}")?)
    }
}
