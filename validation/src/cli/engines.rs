//! `engines`: what can be run.

use super::help;
use super::shared::format::OutputFlags;
use super::shared::list::{self, Format};
use super::shared::programs::ProgramFlags;
use crate::engine::{self, Declaration, Location};
use crate::integrators;
use anyhow::Result;
use clap::Args;
use serde::Serialize;

/// List the engines that validate and bench run
///
/// Answers which ODE solvers percuss runs, in which versions, and who locates
/// their events.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::ENGINES)]
pub(super) struct Arguments {
    #[command(flatten)]
    programs: ProgramFlags,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

#[derive(Serialize)]
struct Line {
    name: &'static str,
    library: &'static str,
    version: String,
    method: &'static str,
    events: Location,
    available: bool,
}

#[derive(Serialize)]
struct List<'a> {
    schema: u32,
    percuss: &'static str,
    engines: &'a [Line],
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = arguments.output.format(Format::Csv)?;
    let _programs = arguments.programs.start()?;
    let line = |engine: &&'static dyn engine::Engine| {
        let Declaration { name, library, version, method, events, .. } = engine.declaration();
        Line { name, library, version, method, events, available: engine.available().is_ok() }
    };
    let lines: Vec<Line> = integrators::all().iter().map(line).collect();
    let list = List { schema: 1, percuss: env!("CARGO_PKG_VERSION"), engines: &lines };
    list::write(&arguments.output, format, &list, &lines)
}
