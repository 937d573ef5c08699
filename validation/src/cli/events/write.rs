//! The rows of `events` as CSV and as JSON.

use super::rows::{Rows, RunEnd};
use crate::cli::shared::output::json_value;
use anyhow::Result;
use std::io::Write;

/// Writes CSV, a row as soon as it is known.
pub(super) fn csv(rows: &Rows<'_>, until: f64, out: &mut dyn Write) -> Result<RunEnd> {
    let states = rows.system.states.iter().map(String::as_str);
    line(out, ["n", "time", "event", "mode"].into_iter().chain(states))?;
    rows.each(until, &mut |row, _| {
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
pub(super) fn json(rows: &Rows<'_>, until: f64, out: &mut dyn Write) -> Result<RunEnd> {
    let system = rows.system;
    write!(out, "{{\"schema\":1,\"percuss\":\"{}\",\"system\":", env!("CARGO_PKG_VERSION"))?;
    json_value(out, &system.name)?;
    write!(out, ",\"parameters\":")?;
    json_value(out, &system.parameters)?;
    write!(out, ",\"rows\":[")?;
    let end = rows.each(until, &mut |row, _| {
        writeln!(out, "{}", if row.n == 0 { "" } else { "," })?;
        json_value(out, &row)
    })?;
    write!(out, "],\"accumulation\":")?;
    json_value(out, &end.accumulation)?;
    writeln!(out, "}}")?;
    Ok(end)
}
