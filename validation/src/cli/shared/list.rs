//! Lists of what there is: `engines` and `cases`.

use super::format::OutputFlags;
use anyhow::Result;
use clap::ValueEnum;
use serde::Serialize;

/// The output format of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Format {
    Csv,
    Json,
}

/// Writes a list: its lines as CSV, or all of it as JSON.
pub(in crate::cli) fn write(
    output: &OutputFlags<Format>,
    format: Format,
    list: &impl Serialize,
    lines: &[impl Serialize],
) -> Result<()> {
    match format {
        Format::Json => output.destination().json(list),
        Format::Csv => output.destination().write(|out| {
            let mut writer = csv::Writer::from_writer(Vec::new());
            lines.iter().try_for_each(|line| writer.serialize(line))?;
            Ok(out.write_all(&writer.into_inner()?)?)
        }),
    }
}
