//! The rows of `gradient` as CSV and as JSON, each written as soon as it is known.

use super::rows::{GradientRow, Rows, RunEnd};
use crate::cli::shared::output::json_value;
use anyhow::Result;
use percuss::{Events, Proved};
use percuss_programs::files::printed_column;
use std::io::Write;

/// The columns before those of the states.
const COLUMNS: [&str; 6] = ["n", "event", "mode", "wrt", "side", "dtime"];

pub(super) fn csv(
    rows: &Rows<'_>,
    events: Events<'_, Proved>,
    out: &mut dyn Write,
) -> Result<RunEnd> {
    let states = rows.system.states.iter().map(|it| format!("d{}", printed_column(it)));
    line(out, COLUMNS.map(str::to_owned).into_iter().chain(states))?;
    rows.each(events, &mut |row: GradientRow<'_>| {
        let first = [&row.n.to_string(), row.event, row.mode, row.wrt, row.side];
        let cells = std::iter::once(row.dtime).chain(row.dstate.into_iter().map(|it| it.1));
        let first = first.map(str::to_owned).into_iter();
        line(out, first.chain(cells.map(Option::unwrap_or_default)))
    })
}

/// Writes a line of CSV; an error is the output's own, as a reader who has left.
fn line(out: &mut dyn Write, cells: impl Iterator<Item = String>) -> Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(cells)?;
    Ok(out.write_all(&writer.into_inner()?)?)
}

/// Writes JSON. How the run ends stands after the rows, because it is known then.
pub(super) fn json(
    rows: &Rows<'_>,
    events: Events<'_, Proved>,
    out: &mut dyn Write,
) -> Result<RunEnd> {
    write!(out, "{{\"schema\":1,\"percuss\":\"{}\",\"rows\":[", env!("CARGO_PKG_VERSION"))?;
    let mut separator = "";
    let end = rows.each(events, &mut |row: GradientRow<'_>| {
        writeln!(out, "{separator}")?;
        separator = ",";
        json_value(out, &row)
    })?;
    write!(out, "],\"ending\":")?;
    json_value(out, &end.ending)?;
    writeln!(out, "}}")?;
    Ok(end)
}
