//! `report.json`.

use super::{Exporter, Report, ReportEvidence};
use std::io::{self, Write};

pub(super) struct Json;

impl Exporter for Json {
    fn file_name(&self) -> &'static str {
        "report.json"
    }

    fn write(&self, report: &Report, _: &ReportEvidence, out: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *out, report)?;
        out.write_all(b"\n")
    }
}
