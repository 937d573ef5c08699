//! `check`: what was understood of a system's file, in equations.

mod equations;
mod written;
mod zeros;

use super::help;
use super::shared::output::Destination;
use super::shared::system_choice::{ChosenSystem, SystemFlags};
use anyhow::Result;
use clap::Args;
use equations::Equations;
use percuss::System;
use std::path::PathBuf;
use written::Written;

/// Print what a system's file was understood to mean, in equations
///
/// Answers whether a file is a system, and which one: its equations, guards,
/// resets and successors as they are written and with all numbers put in, and
/// what is zero by the model at the start and after each event.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::CHECK)]
pub(super) struct Arguments {
    /// A *.system.toml, or a name that `percuss systems` prints
    #[arg(value_name = "SYSTEM")]
    system: PathBuf,
    /// Where the text goes, - is stdout
    #[arg(long, value_name = "PATH")]
    output: Option<PathBuf>,
    #[command(flatten)]
    flags: SystemFlags,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let destination = Destination::new(arguments.output.as_deref());
    destination.check()?;
    let chosen = arguments.flags.system(&arguments.system)?;
    let system = chosen.file.system()?;
    // What a solver refuses is no system that runs.
    system.solver::<f64>()?;
    let text = text(&chosen, &system)?;
    destination.write(|out| Ok(out.write_all(text.as_bytes())?))
}

/// All that is understood, as text.
fn text(chosen: &ChosenSystem, system: &System) -> Result<String> {
    let written = Written::read(chosen.text())?;
    let equations = Equations { system, written: &written };
    let mut text = equations.head();
    for mode in 0..system.modes.len() {
        text.push('\n');
        text.push_str(&equations.mode(mode));
    }
    text.push('\n');
    text.push_str(&equations.start());
    Ok(text)
}
