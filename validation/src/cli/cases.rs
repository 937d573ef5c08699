//! `cases`: what engines are held to.

use super::help;
use super::shared::format::OutputFlags;
use super::shared::list::{self, Format};
use crate::case::{Case, FileError, embedded, from_directory};
use crate::report::CaseNote;
use crate::truth::Library;
use anyhow::{Context, Result};
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;

/// List the cases that validate and bench run
///
/// Answers what engines are asked, and why each case is there. The names are what
/// -c of `validate`, `bench` and `export` selects from.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::CASES)]
pub(super) struct Arguments {
    /// Reads the cases from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    cases: Option<PathBuf>,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

#[derive(Serialize)]
struct Line {
    name: String,
    regime: String,
    system: String,
    events: usize,
    periods: f64,
    table: String,
    why: String,
}

#[derive(Serialize)]
struct List<'a> {
    schema: u32,
    percuss: &'static str,
    cases: &'a [Line],
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = arguments.output.format(Format::Csv)?;
    let (cases, library) = match &arguments.cases {
        Some(folder) => {
            let cases = from_directory(folder).context("--cases")?;
            (cases, Library::embedded()?.replaying())
        }
        None => (embedded()?, Library::embedded()?),
    };
    let mut lines: Vec<Line> =
        cases.iter().map(|it| line(it, &library)).collect::<Result<_, _>>()?;
    lines.sort_by(|a, b| a.name.cmp(&b.name));
    let list = List { schema: 1, percuss: env!("CARGO_PKG_VERSION"), cases: &lines };
    list::write(&arguments.output, format, &list, &lines)
}

fn line(case: &Case, library: &Library) -> Result<Line, FileError> {
    let note = CaseNote::new(case, true);
    Ok(Line {
        name: note.name,
        regime: case.kind(" "),
        system: note.system,
        events: library.truth(case)?.events.len(),
        periods: case.periods(),
        table: library.table(&case.name).unwrap_or_default(),
        why: note.why,
    })
}
