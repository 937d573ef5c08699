//! `systems`: the piecewise-affine systems inside the program.

use super::help;
use super::shared::format::OutputFlags;
use super::shared::list::{self, Format};
use super::shared::system_choice::event_names;
use crate::systems::SYSTEMS;
use anyhow::Result;
use clap::Args;
use percuss::affine::System;
use serde::Serialize;

/// List the piecewise-affine systems inside the program
///
/// Answers which systems come with the program. Each name may be given to
/// `percuss events`.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::SYSTEMS)]
pub(super) struct Arguments {
    #[command(flatten)]
    output: OutputFlags<Format>,
}

/// One system; lists are joined by spaces.
#[derive(Serialize)]
struct Line {
    name: &'static str,
    states: String,
    modes: String,
    events: String,
    trouble: String,
    source: String,
}

#[derive(Serialize)]
struct List<'a> {
    schema: u32,
    percuss: &'static str,
    systems: &'a [Line],
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = arguments.output.format(Format::Csv)?;
    let lines: Vec<Line> =
        SYSTEMS.iter().map(|(name, text)| line(name, text)).collect::<Result<_>>()?;
    let list = List { schema: 1, percuss: env!("CARGO_PKG_VERSION"), systems: &lines };
    list::write(&arguments.output, format, &list, &lines)
}

fn line(name: &'static str, text: &str) -> Result<Line> {
    let system = System::parse(name, text)?;
    let events = event_names(&system);
    let modes: Vec<&str> = system.modes.iter().map(|it| it.name.as_str()).collect();
    Ok(Line {
        name,
        states: system.states.join(" "),
        modes: modes.join(" "),
        events: events.join(" "),
        trouble: system.trouble.join(" "),
        source: system.source,
    })
}
