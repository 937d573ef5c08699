//! The report of a `validate`, and the formats it is written in.
//!
//! Add a format by implementing [`Exporter`] and naming it in [`exporters`].

mod csv;
mod json;
mod row;
mod table;

pub use row::{Report, Row, Summary};
pub use table::table;

use std::io::{self, Write};

/// A format of the report.
pub trait Exporter: Sync {
    /// The file it is written to.
    fn file_name(&self) -> &'static str;

    /// Writes the report.
    ///
    /// # Errors
    /// What the writer says.
    fn write(&self, report: &Report, out: &mut dyn Write) -> io::Result<()>;
}

/// All formats.
#[must_use]
pub fn exporters() -> &'static [&'static dyn Exporter] {
    &[&json::Json, &csv::Csv]
}
