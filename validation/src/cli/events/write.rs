//! The rows of `events` as CSV and as JSON.

use super::rows::{Rows, RunEnd};
use anyhow::Result;
use serde::Serialize;
use std::io::{self, Write};

/// Writes CSV, a row as soon as it is known.
pub(super) fn csv(rows: &Rows<'_>, until: f64, out: &mut dyn Write) -> Result<RunEnd> {
    let mut writer = csv::Writer::from_writer(out);
    let states = rows.system.states.iter().map(String::as_str);
    writer.write_record(["n", "time", "event", "mode"].into_iter().chain(states))?;
    let end = rows.each(until, &mut |row, _| {
        let n = row.n.to_string();
        let first = [n.as_str(), &row.time, &row.event, &row.mode];
        let cells = row.state.iter().map(|(_, cell)| cell.as_str());
        Ok(writer.write_record(first.into_iter().chain(cells))?)
    })?;
    writer.flush()?;
    Ok(end)
}

/// Writes JSON. What is known at the end only stands after the rows.
pub(super) fn json(rows: &Rows<'_>, until: f64, out: &mut dyn Write) -> Result<RunEnd> {
    let system = rows.system;
    write!(out, "{{\"schema\":1,\"percuss\":\"{}\",\"system\":", env!("CARGO_PKG_VERSION"))?;
    value(out, &system.name)?;
    write!(out, ",\"parameters\":")?;
    value(out, &system.parameters)?;
    write!(out, ",\"rows\":[")?;
    let end = rows.each(until, &mut |row, _| {
        writeln!(out, "{}", if row.n == 0 { "" } else { "," })?;
        value(out, &row)
    })?;
    write!(out, "],\"accumulation\":")?;
    value(out, &end.accumulation)?;
    writeln!(out, "}}")?;
    Ok(end)
}

fn value(out: &mut dyn Write, value: &impl Serialize) -> Result<()> {
    Ok(serde_json::to_writer(out, value).map_err(io::Error::from)?)
}
