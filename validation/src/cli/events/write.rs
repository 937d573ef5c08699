//! The rows of `events` as CSV and as JSON.

use super::progress::RunEnd;
use super::rows::{EventRow, Rows};
use super::samples::SampleRow;
use crate::cli::shared::output::json_value;
use anyhow::Result;
use percuss::System;
use percuss_programs::files::{PRINTED, PRINTED_SAMPLE, printed_column};
use std::borrow::Cow;
use std::io::Write;

/// Writes CSV, a row as soon as it is known.
pub(super) fn csv(run: &Rows<'_>, samples: Option<u32>, out: &mut dyn Write) -> Result<RunEnd> {
    let states = || run.system.states.iter().map(|name| printed_column(name));
    let header = |names: &[&'static str], out: &mut dyn Write| {
        let names: Vec<_> = names.iter().map(|name| Cow::from(*name)).chain(states()).collect();
        line(out, names.iter().map(AsRef::as_ref))
    };
    if let Some(samples) = samples {
        header(&PRINTED_SAMPLE, out)?;
        return run.each_sample(samples, &mut |row: SampleRow| {
            let first = [row.time.as_str(), &row.mode];
            line(out, first.into_iter().chain(row.state.iter().map(|(_, cell)| cell.as_str())))
        });
    }
    header(&PRINTED, out)?;
    run.each(&mut |row: EventRow, _| {
        let n = row.n.to_string();
        let first = [n.as_str(), &row.time, &row.event, &row.mode];
        line(out, first.into_iter().chain(row.state.iter().map(|(_, cell)| cell.as_str())))
    })
}

/// Writes a line of CSV; an error is the output's own, as a reader who has left.
fn line<'a>(out: &mut dyn Write, cells: impl Iterator<Item = &'a str>) -> Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(cells)?;
    Ok(out.write_all(&writer.into_inner()?)?)
}

/// Writes JSON. What is known at the end only stands after the rows.
pub(super) fn json(run: &Rows<'_>, samples: Option<u32>, out: &mut dyn Write) -> Result<RunEnd> {
    begin_json(run.system, out)?;
    let mut is_first = true;
    let mut separate = |out: &mut dyn Write| {
        let separator = if std::mem::take(&mut is_first) { "" } else { "," };
        writeln!(out, "{separator}")
    };
    let end = match samples {
        Some(samples) => run.each_sample(samples, &mut |row: SampleRow| {
            separate(out)?;
            json_value(out, &row)
        })?,
        None => run.each(&mut |row: EventRow, _| {
            separate(out)?;
            json_value(out, &row)
        })?,
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
