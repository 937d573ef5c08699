//! The rows of `events` as CSV and as JSON.

use super::precision::{InBits, Precision};
use super::progress::RunEnd;
use super::row::EventRow;
use super::rows::{Outcome, Rows};
use super::samples::SampleRow;
use crate::cli::shared::output::json_value;
use anyhow::Result;
use percuss::affine::{Arithmetic, System};
use std::borrow::Cow;
use std::io::Write;

/// The columns beside those of the states.
const COLUMNS: [&str; 4] = ["n", "time", "event", "mode"];

/// Writes CSV, a row as soon as it is known.
pub(super) fn csv(
    run: &Precision<'_>,
    samples: Option<u32>,
    out: &mut dyn Write,
) -> Result<RunEnd> {
    let states = || run.system.states.iter().map(|name| column(name));
    let header = |names: &[&'static str], out: &mut dyn Write| {
        let names: Vec<_> = names.iter().map(|name| Cow::from(*name)).chain(states()).collect();
        line(out, names.iter().map(AsRef::as_ref))
    };
    if let Some(samples) = samples {
        header(&["time", "mode"], out)?;
        return run.each(&mut EachSample(samples, |row: SampleRow| {
            let first = [row.time.as_str(), &row.mode];
            line(out, first.into_iter().chain(row.state.iter().map(|(_, cell)| cell.as_str())))
        }));
    }
    header(&COLUMNS, out)?;
    run.each(&mut EachEvent(|row: EventRow| {
        let n = row.n.to_string();
        let first = [n.as_str(), &row.time, &row.event, &row.mode];
        line(out, first.into_iter().chain(row.state.iter().map(|(_, cell)| cell.as_str())))
    }))
}

/// What is done with each event.
struct EachEvent<F>(F);

impl<F: FnMut(EventRow) -> Result<()>> InBits for EachEvent<F> {
    fn run<T: Arithmetic>(&mut self, rows: &Rows<'_, T>) -> Result<Outcome> {
        rows.each(&mut |row, _| self.0(row))
    }
}

/// What is done with each of so many samples in a unit of time.
struct EachSample<F>(u32, F);

impl<F: FnMut(SampleRow) -> Result<()>> InBits for EachSample<F> {
    fn run<T: Arithmetic>(&mut self, rows: &Rows<'_, T>) -> Result<Outcome> {
        rows.each_sample(self.0, &mut |row| self.1(row))
    }
}

/// The column of a state: its name, unless that is another column's.
fn column(state: &str) -> Cow<'_, str> {
    if COLUMNS.contains(&state) { format!("state.{state}").into() } else { state.into() }
}

/// Writes a line of CSV; an error is the output's own, as a reader who has left.
fn line<'a>(out: &mut dyn Write, cells: impl Iterator<Item = &'a str>) -> Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(cells)?;
    Ok(out.write_all(&writer.into_inner()?)?)
}

/// Writes JSON. What is known at the end only stands after the rows.
pub(super) fn json(
    run: &Precision<'_>,
    samples: Option<u32>,
    out: &mut dyn Write,
) -> Result<RunEnd> {
    begin_json(run.system, out)?;
    let mut is_first = true;
    let mut separate = |out: &mut dyn Write| {
        let separator = if std::mem::take(&mut is_first) { "" } else { "," };
        writeln!(out, "{separator}")
    };
    let end = match samples {
        Some(samples) => run.each(&mut EachSample(samples, |row: SampleRow| {
            separate(out)?;
            json_value(out, &row)
        }))?,
        None => run.each(&mut EachEvent(|row: EventRow| {
            separate(out)?;
            json_value(out, &row)
        }))?,
    };
    write!(out, "],\"accumulation\":")?;
    json_value(out, &end.accumulation)?;
    writeln!(out, "}}")?;
    Ok(end)
}

fn begin_json(system: &System, out: &mut dyn Write) -> Result<()> {
    write!(out, "{{\"schema\":1,\"percuss\":\"{}\",\"system\":", env!("CARGO_PKG_VERSION"))?;
    json_value(out, &system.name)?;
    write!(out, ",\"parameters\":")?;
    json_value(out, &system.parameters)?;
    Ok(write!(out, ",\"rows\":[")?)
}
