//! `events`: the events of a piecewise-affine system, with digits that are proved.

mod digits;
mod rows;

use super::format::OutputFlags;
use super::list::Format;
use super::parse::{self, Typed};
use super::{DONE, OUT_OF_BOUNDS, names, note};
use crate::systems::{SYSTEMS, named};
use anyhow::{Context, Result, anyhow, bail};
use clap::{ArgGroup, Args};
use percuss::affine::{Solver, SystemFile};
use rows::Rows;
use std::path::{Path, PathBuf};

/// The horizon of --events, in the system's units of time.
const LONGEST: f64 = 1e9;

/// Print the events of a piecewise-affine system, computed in 106 bits with enclosed errors
#[derive(Args)]
#[command(group(ArgGroup::new("length").required(true).args(["until", "events"])))]
pub(super) struct Arguments {
    /// A *.system.toml, or a name that `percuss systems` prints
    #[arg(value_name = "SYSTEM")]
    system: PathBuf,
    /// Ends at this time
    #[arg(long, value_name = "T", value_parser = parse::time, allow_hyphen_values = true)]
    until: Option<Typed<f64>>,
    /// Ends after this many events
    #[arg(long, value_name = "N", value_parser = parse::whole::<usize>(1, 1_000_000_000), allow_hyphen_values = true)]
    events: Option<usize>,
    /// The most significant digits of a number, 17 or 25 [default: 17]
    #[arg(long, value_name = "D", value_parser = ["17", "25"])]
    digits: Option<String>,
    /// A file whose [start] replaces the system's, and whose [parameters] replace some
    #[arg(long, value_name = "FILE.toml")]
    start: Option<PathBuf>,
    /// Replaces the value of a parameter
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
    /// Runs back in time
    #[arg(long)]
    backward: bool,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    let format = arguments.output.format(Format::Csv)?;
    let mut file = read(&arguments.system)?;
    if let Some(path) = &arguments.start {
        let text = text(path).context("--start")?;
        file.replace_from(&path.display().to_string(), &text, false).context("--start")?;
    }
    for given in &arguments.set {
        let parsed = given.split_once('=').and_then(|(name, value)| {
            Some((name.trim(), value.trim().parse::<f64>().ok().filter(|it| it.is_finite())?))
        });
        let Some((name, value)) = parsed else {
            bail!("--set {given} is not accepted: NAME=VALUE with a finite number is");
        };
        file.set(name, value, "--set")?;
    }
    let system = file.system()?;
    let Some(start) = &system.start else {
        bail!("{} has no [start]: accepted is one in the file, or --start FILE.toml", system.name);
    };
    let time = start.time.to_f64().value();
    let direction = if arguments.backward { -1.0 } else { 1.0 };
    let ahead = |until: f64| direction * (until - time);
    let until = match &arguments.until {
        Some(until) if ahead(until.value) >= 0.0 && until.value.is_finite() => until.value,
        Some(until) => {
            let side = if arguments.backward { "before" } else { "after" };
            bail!("--until {until} is not accepted: a time at or {side} the start at {time} is");
        }
        None => time + direction * LONGEST * system.time_scale,
    };
    let solver = if arguments.backward { Solver::backward(&system) } else { Solver::new(&system) }?;
    let digits = if arguments.digits.as_deref() == Some("25") { 25 } else { 17 };
    let rows = Rows { system: &system, solver: &solver, digits, most: arguments.events };
    let Some(listed) = rows.listed(until) else {
        bail!("{}: its start is not decided", system.name)
    };
    rows.write(&listed, &arguments.output, format)?;
    listed.notes.iter().for_each(|it| note(it));
    Ok(if listed.decided { DONE } else { OUT_OF_BOUNDS })
}

/// The system of this path, or of this name.
fn read(system: &Path) -> Result<SystemFile> {
    let name = system.display().to_string();
    if let Some(text) = named(&name).filter(|_| !system.is_file()) {
        return Ok(SystemFile::read(&name, text)?);
    }
    let text = text(system).map_err(|error| {
        let near = names::nearest(&name, SYSTEMS.iter().map(|(name, _)| *name));
        let near = match near.is_empty() {
            true => String::new(),
            false => format!("; the nearest names are {}", near.join(", ")),
        };
        anyhow!("{error}, or a name that percuss systems lists{near}")
    })?;
    Ok(SystemFile::read(&name, &text)?)
}

fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|error| {
        anyhow!("{}: cannot be read ({error}); accepted is a readable file", path.display())
    })
}
