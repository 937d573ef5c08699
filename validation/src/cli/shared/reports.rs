//! What `validate` leaves behind besides its table: files, and annotations under the CI service.

use super::output::write_whole;
use crate::report::{Report, ReportEvidence, annotations, exporters, pictures, under_the_service};
use anyhow::{Context, Result};
use std::io::{self, Write};
use std::path::Path;

/// Every format of the report, and the pictures, into a folder.
pub(in crate::cli) fn write(
    report: &Report,
    evidence: &ReportEvidence,
    folder: &Path,
) -> Result<()> {
    for exporter in exporters() {
        let path = folder.join(exporter.file_name());
        write_whole(&path, |out| Ok(exporter.write(report, evidence, out)?)).context("--out")?;
    }
    for (name, bytes) in pictures(report, evidence)? {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)
                .with_context(|| format!("--out: {} cannot be made", parent.display()))?;
        }
        write_whole(&path, |out| Ok(out.write_all(&bytes)?)).context("--out")?;
    }
    Ok(())
}

/// Writes annotations to stderr, which the service reads as well: stdout holds the table and
/// nothing else.
pub(in crate::cli) fn annotate(report: &Report, evidence: &ReportEvidence, require: bool) {
    if under_the_service() {
        for line in annotations(report, evidence, require) {
            // Where stderr is closed there is no one to tell.
            let _ = writeln!(io::stderr(), "{line}");
        }
    }
}
