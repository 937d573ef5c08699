//! `export`: what cases ask, as files for readers of any language.

use super::help;
use super::shared::compact;
use super::shared::judged::CaseFlags;
use super::shared::output::{Destination, make_folder, write_whole};
use crate::suite::PreparedCase;
use anyhow::{Context, Result};
use clap::Args;
use percuss_programs::files::CaseFile;
use std::io;
use std::path::{Path, PathBuf};

/// Write what the cases ask, as JSON and CSV for any language
///
/// Answers what a solver has to solve: for each case its modes as matrices,
/// guards, resets, start, horizon and the times of samples, as JSON, as CSV and
/// as equations to read. `percuss score` judges the answers.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::EXPORT)]
pub(super) struct Arguments {
    /// The folder that the files are written into
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    chosen: CaseFlags,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let cases = arguments.chosen.open(None, &[])?;
    make_folder(&arguments.out)?;
    let cases = cases.prepare(None)?;
    let mut lines = Vec::new();
    for case in &cases.all {
        lines.push(write(case, &arguments.out)?);
    }
    let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or_default();
    Destination::Stdout.write(|out| {
        for (name, asks) in &lines {
            writeln!(out, "{name:width$}  {asks}")?;
        }
        Ok(())
    })
}

/// Writes the files of a case, and says what it asks.
fn write(case: &PreparedCase, folder: &Path) -> Result<(String, String)> {
    let (name, task) = (case.case.name.as_str(), &case.task);
    let asked = CaseFile::new(name, task, case.parameters());
    write_whole(&folder.join(format!("{name}.json")), |out| {
        compact::write(&asked, &mut *out).map_err(io::Error::from)?;
        Ok(writeln!(out)?)
    })
    .context("--out")?;
    for (ending, text) in asked.plain_files() {
        let path = folder.join(format!("{name}.{ending}"));
        write_whole(&path, |out| Ok(out.write_all(text.as_bytes())?)).context("--out")?;
    }
    let system = task.system.system();
    let [states, modes] = [system.states.len(), system.modes.len()].map(|it| it.to_string());
    let asks = format!("{}, {states} states, {modes} modes, time {:.6}", system.name, task.span);
    Ok((name.to_owned(), asks))
}
