//! `events`: the events of a piecewise-affine system, with digits that are proved, or a picture of
//! its run.

mod draw;
mod ending;
mod progress;
mod rows;
mod samples;
mod sink;
mod write;

use super::help;
use super::shared::horizon::horizon;
use super::shared::long_work::{self, Bar};
use super::shared::outputs::{Outputs, OutputsFlags};
use super::shared::parse::{self, Typed};
use super::shared::picture::PictureFormat;
use super::shared::system_choice::SystemFlags;
use super::{DONE, OUT_OF_BOUNDS, note};
use crate::picture::MAX_STATES;
use anyhow::{Result, bail};
use clap::{ArgGroup, Args, ValueEnum};
use percuss::affine::PRECISION_BITS;
use percuss::{Proved, Solver, System};
use rows::{Limits, Rows};
use std::path::PathBuf;

/// The most bits that a run may take.
const MAX_BITS: u32 = PRECISION_BITS[PRECISION_BITS.len() - 1];

/// The number of events after which a run is stopped, where neither --events nor --max-events is
/// given.
const DEFAULT_MAX_EVENTS: usize = 1_000_000;

/// Print the events of a piecewise-affine system, every digit of them proved
///
/// Answers when the events of a system are, which they are, and what the state is
/// just after each. The system is a file of your own or a name of `percuss
/// systems`. The run is computed in 106 bits or more with enclosed errors, so it
/// needs no tolerance.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::EVENTS)]
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
    /// Rows K times in the system's unit of time, or in a forcing period, instead of at events
    #[arg(long, value_name = "K", value_parser = parse::whole::<u32>(1, u64::from(u32::MAX)), allow_hyphen_values = true)]
    samples: Option<u32>,
    /// Stops a run that has more events, with a last row `stopped` [default: 1000000, none with
    /// --events]
    #[arg(long, value_name = "N", value_parser = parse::whole::<usize>(1, 1_000_000_000), allow_hyphen_values = true)]
    max_events: Option<usize>,
    /// The most bits that a run may take: it begins with 106 and takes twice as many where these
    /// do not decide or have too few digits [default: 3392]
    #[arg(long, value_name = "B", value_parser = parse::whole::<u32>(u64::from(PRECISION_BITS[0]), u64::from(MAX_BITS)), allow_hyphen_values = true)]
    max_bits: Option<u32>,
    /// Runs back in time
    #[arg(long)]
    backward: bool,
    /// The states that a picture shows, 1 to 6, with commas; it has the plane of the first two
    #[arg(long, value_name = "NAMES", allow_hyphen_values = true)]
    states: Option<String>,
    #[command(flatten)]
    output: OutputsFlags<Format>,
    #[command(flatten)]
    flags: SystemFlags,
}

/// The output format of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Json,
    Png,
    Svg,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    let outputs = arguments.output.outputs(|_| Format::Csv)?;
    let pictures = outputs.pictures();
    check_effect(arguments, &outputs)?;
    let system = arguments.flags.system(&arguments.system)?.system()?;
    let start = system.start()?.time.to_f64();
    let limits = limits(arguments, &system, start)?;
    let shown = draw::shown(&system, arguments.states.as_deref())?;
    let bar = long_work::run_bar(outputs.is_terminal());
    let solver: Solver<Proved> =
        if arguments.backward { system.backward_solver()? } else { system.solver()? };
    let rows = Rows {
        system: &system,
        solver: &solver,
        digits: if arguments.digits.as_deref() == Some("25") { 25 } else { 17 },
        limits,
        most_bits: arguments.max_bits.unwrap_or(MAX_BITS),
        samples: arguments.samples,
        bar: bar.as_ref(),
    };
    let end = outputs.together(|opened| {
        let mut all = sink::All::new(opened, arguments.backward, &shown);
        rows.write(&mut all)
    })?;
    bar.iter().for_each(Bar::finish_and_clear);
    let all = system.states.len();
    if !pictures.is_empty() && shown.len() == MAX_STATES && all > MAX_STATES {
        note(&format!("{MAX_STATES} of {all} states are shown: --states chooses"));
    }
    end.notes.iter().for_each(|it| note(it));
    Ok(if end.undecided { OUT_OF_BOUNDS } else { DONE })
}

/// The limits of a run that begins at a time.
fn limits(arguments: &Arguments, system: &System, time: f64) -> Result<Limits> {
    let until = horizon(arguments.until.as_ref(), system, time, arguments.backward)?;
    let usual = arguments.events.is_none().then_some(DEFAULT_MAX_EVENTS);
    Ok(Limits { until, events: arguments.events, most: arguments.max_events.or(usual) })
}

/// Refuses flags that the run takes no notice of.
fn check_effect(arguments: &Arguments, outputs: &Outputs<Format>) -> Result<()> {
    let is_picture = |it: Format| PictureFormat::new(it).is_some();
    let has_pictures = outputs.any(is_picture);
    let has_data = outputs.any(|it| !is_picture(it));
    if let Some(samples) = arguments.samples.filter(|_| !has_data) {
        bail!("--samples {samples} has no effect on a picture: it is accepted with csv and json");
    }
    match (&arguments.digits, &arguments.states) {
        (Some(digits), _) if !has_data => {
            bail!("--digits {digits} has no effect on a picture: it is accepted with csv and json")
        }
        (_, Some(states)) if !has_pictures => {
            bail!("--states {states} has no effect here: it is accepted with png and svg")
        }
        _ => Ok(()),
    }
}
