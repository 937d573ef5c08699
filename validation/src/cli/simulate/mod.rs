//! `simulate`: one run, as a table of events, a table of samples, arrays or a picture; of the
//! impact oscillator, or of any piecewise-affine system.

mod csv;
mod drawn;
mod json;
mod plan;
mod rows;
mod system;

use super::help;
use super::note;
use super::shared::long_work;
use super::shared::model::ModelFlags;
use super::shared::output::Opened;
use super::shared::outputs::{Outputs, OutputsFlags};
use super::shared::parse::{self, MAX_PERIODS, SectionChoice, Typed};
use super::shared::picture::{PictureFlags, PictureFormat};
use super::shared::section::{ReturnFlags, without_system};
use super::shared::system_choice::SystemChoice;
use anyhow::{Result, bail};
use clap::{ArgGroup, Args, ValueEnum};
use plan::{PlannedRun, RunEnding};

/// Run the exact solver from one start: of the impact oscillator, or of a SYSTEM
///
/// Answers what one motion does: the state just after each event, or samples, or
/// a picture. Between events the motion is a closed form, and each event is
/// proved to be the first. A SYSTEM runs in f64: `percuss events` has its digits
/// proved, at tens of times the cost.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::SIMULATE)]
#[command(group(ArgGroup::new("length").required(true).args(["events", "periods", "until", "returns"])))]
pub(super) struct Arguments {
    /// Ends after this many events
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(0, u64::MAX), allow_hyphen_values = true)]
    events: Option<u64>,
    /// Ends after this many forcing periods, at most 1000000000
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    periods: Option<u64>,
    /// Ends at this time, at or after the start
    #[arg(long, value_name = "TAU", value_parser = parse::time, allow_hyphen_values = true)]
    until: Option<Typed<f64>>,
    /// With SYSTEM: ends after this many returns to --section, the start not counted
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    returns: Option<u64>,
    /// With SYSTEM: leaves out this many returns to --section before the first row
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    transient: Option<u64>,
    /// With SYSTEM: strobe[:ANGLE] at a forcing angle omega t mod 2 pi, or EVENT or EVENT@MODE,
    /// just after it [default: the forcing's angle at the start]
    #[arg(long, value_name = "SECTION", value_parser = parse::section, allow_hyphen_values = true)]
    section: Option<Typed<SectionChoice>>,
    /// Rows K times a forcing period instead of at each event; of a SYSTEM without forcing K times
    /// in its unit of time
    #[arg(long, value_name = "K", value_parser = parse::whole::<u32>(1, 4_294_967_295), allow_hyphen_values = true)]
    samples: Option<u32>,
    /// With --events: stops early after this many forcing periods [default: 1000000]
    #[arg(long, value_name = "M", value_parser = parse::whole::<u64>(1, MAX_PERIODS), allow_hyphen_values = true)]
    max_periods: Option<u64>,
    #[command(flatten)]
    output: OutputsFlags<Format>,
    #[command(flatten)]
    picture: PictureFlags,
    #[command(flatten)]
    section_of_system: ReturnFlags,
    #[command(flatten)]
    system: SystemChoice,
    #[command(flatten)]
    model: ModelFlags,
}

/// The output format of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Json,
    Png,
    Svg,
    Npy,
    Npz,
}

/// Makes the run; whether it was decided to its end.
pub(super) fn run(arguments: &Arguments) -> Result<bool> {
    let outputs = arguments.output.outputs(|_| Format::Csv)?;
    arguments.picture.check(&outputs.pictures())?;
    match arguments.system.chosen(&arguments.model)? {
        Some(system) => system::run(arguments, &system, &outputs),
        None => run_oscillator(arguments, &outputs),
    }
}

fn run_oscillator(arguments: &Arguments, outputs: &Outputs<Format>) -> Result<bool> {
    check_effect(arguments, outputs)?;
    let bar = long_work::run_bar(outputs.is_terminal());
    let plan = PlannedRun::new(arguments.model.problem()?, arguments, bar)?;
    let ending = outputs.together(|opened| {
        let sinks = opened.iter_mut().map(|(format, out)| sink(arguments, *format, out));
        write_rows(&plan, arguments.samples, &mut rows::All(sinks.collect()))
    })?;
    drop(plan);
    ending.lines().for_each(|line| note(&line));
    Ok(!ending.undecided)
}

/// An output of a run.
fn sink<'a>(
    arguments: &'a Arguments,
    format: Format,
    out: &'a mut Opened,
) -> Box<dyn rows::Sink + 'a> {
    match (PictureFormat::new(format), format) {
        (Some(format), _) => {
            let flags = &arguments.picture;
            Box::new(drawn::Drawn { out, flags, format, segments: Vec::new() })
        }
        (None, Format::Json) => Box::new(json::Json::new(out)),
        _ => Box::new(csv::Csv(out)),
    }
}

/// Refuses flags that the run takes no notice of, and what belongs to runs of a SYSTEM.
fn check_effect(arguments: &Arguments, outputs: &Outputs<Format>) -> Result<()> {
    let counts = [("--returns", arguments.returns), ("--transient", arguments.transient)];
    if let Some((flag, count)) = counts.iter().find_map(|(flag, count)| Some((flag, (*count)?))) {
        bail!("{flag} {count} is not accepted without SYSTEM: --periods is, and --cycle");
    }
    if let Some(section) = &arguments.section {
        bail!("{}", without_system("--section", section));
    }
    arguments.section_of_system.refuse()?;
    if outputs.any(|it| matches!(it, Format::Npy | Format::Npz)) {
        bail!("arrays are not accepted without SYSTEM: csv, json, png and svg are");
    }
    if let (Some(most), None) = (arguments.max_periods, arguments.events) {
        bail!("--max-periods {most} has no effect here: it is accepted with --events");
    }
    if let Some(rows) =
        arguments.samples.filter(|_| outputs.formats().all(|it| PictureFormat::new(it).is_some()))
    {
        bail!("--samples {rows} has no effect on a picture: it is accepted with csv and json");
    }
    arguments.picture.refuse_show()?;
    arguments.picture.refuse_range()
}

/// Writes the run's rows; what has to be said about its end.
fn write_rows(
    plan: &PlannedRun,
    samples: Option<u32>,
    sink: &mut dyn rows::Sink,
) -> Result<RunEnding> {
    sink.begin(plan, samples.is_some())?;
    let ending = match samples {
        Some(per_period) => rows::samples(plan, per_period, sink)?,
        None => rows::events(plan, sink)?,
    };
    sink.finish(plan, &ending)?;
    Ok(ending)
}
