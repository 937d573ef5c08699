//! `export`: what cases ask, as files for readers of any language.

use super::help;
use super::shared::judged::CaseFlags;
use super::shared::output::{Destination, make_folder, write_whole};
use super::shared::{compact, gradients};
use crate::engine::Task;
use anyhow::{Context, Result, anyhow};
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
    let differentiated = gradients::cases(&arguments.chosen, |_| true)?;
    let names: Vec<&str> = differentiated.iter().map(|it| it.name.as_str()).collect();
    let cases = arguments.chosen.open(None, &names)?;
    make_folder(&arguments.out)?;
    let cases = cases.prepare(None)?;
    let mut lines = Vec::new();
    for case in &cases.all {
        let asked = CaseFile::new(&case.case.name, &case.task, case.parameters());
        lines.push(write(&asked, &case.task, &arguments.out)?);
    }
    for case in &differentiated {
        let task = case.task().map_err(|failure| anyhow!("{}: {}", case.name, failure.reason))?;
        let asked = CaseFile::new(&case.name, &task, case.parameters());
        lines.push(write(&asked, &task, &arguments.out)?);
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
fn write(asked: &CaseFile<'_>, task: &Task, folder: &Path) -> Result<(String, String)> {
    let name = asked.case();
    write_whole(&folder.join(format!("{name}.json")), |out| {
        compact::write(asked, &mut *out).map_err(io::Error::from)?;
        Ok(writeln!(out)?)
    })
    .context("--out")?;
    for (ending, text) in asked.plain_files() {
        let path = folder.join(format!("{name}.{ending}"));
        write_whole(&path, |out| Ok(out.write_all(text.as_bytes())?)).context("--out")?;
    }
    let system = task.system.system();
    let [states, modes] = [system.states.len(), system.modes.len()].map(|it| it.to_string());
    let mut asks =
        format!("{}, {states} states, {modes} modes, time {:.6}", system.name, task.span);
    if let Some(names) = &task.gradients {
        let names: Vec<&str> = names.iter().map(|it| it.name.as_str()).collect();
        asks += &format!(", derivatives by {}", names.join(", "));
    }
    Ok((name.to_owned(), asks))
}
