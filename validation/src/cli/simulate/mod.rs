//! `simulate`: one run, as a table of switches, a table of samples, or a picture.

mod csv;
mod json;
mod plan;
mod rows;

use super::format::OutputFlags;
use super::model::ModelFlags;
use super::{parse, say};
use crate::picture;
use anyhow::Result;
use clap::{ArgGroup, Args, ValueEnum};
use plan::{Ending, Plan};
use std::io::Write;

/// Run the exact solver from one start
#[derive(Args)]
#[command(group(ArgGroup::new("length").required(true).args(["events", "periods", "until"])))]
pub(super) struct Arguments {
    /// Ends after this many switches
    #[arg(long, value_name = "N")]
    events: Option<u64>,
    /// Ends after this many forcing periods, at most 1000000000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=parse::MAX_PERIODS))]
    periods: Option<u64>,
    /// Ends at this time, at or after the start
    #[arg(long, value_name = "TAU", value_parser = parse::number, allow_hyphen_values = true)]
    until: Option<f64>,
    /// Rows K times a forcing period instead of at each switch
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// With --events: stops early after this many forcing periods
    #[arg(long, value_name = "M", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(1..=parse::MAX_PERIODS))]
    max_periods: u64,
    #[command(flatten)]
    output: OutputFlags<Format>,
    #[command(flatten)]
    model: ModelFlags,
}

/// What a run is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Json,
    Png,
    Svg,
}

/// Makes the run; whether it was decided to its end.
pub(super) fn run(arguments: &Arguments) -> Result<bool> {
    let format = arguments.output.format(Format::Csv)?;
    let problem = arguments.model.problem()?;
    let plan = Plan::new(problem, arguments)?;
    let destination = arguments.output.destination();
    let mut ending = Ending::default();
    destination.write(|out| {
        ending = match format {
            Format::Csv => write_rows(&plan, arguments.samples, &mut csv::Csv(out))?,
            Format::Json => write_rows(&plan, arguments.samples, &mut json::Json::new(out))?,
            Format::Png | Format::Svg => draw(&plan, format, out)?,
        };
        Ok(())
    })?;
    ending.lines().for_each(|line| say(&line));
    Ok(!ending.undecided)
}

/// Writes the run's rows; what has to be said about its end.
fn write_rows(plan: &Plan, samples: Option<u32>, sink: &mut dyn rows::Sink) -> Result<Ending> {
    sink.begin(plan, samples.is_some())?;
    let ending = match samples {
        Some(per_period) => rows::samples(plan, per_period, sink)?,
        None => rows::switches(plan, sink)?,
    };
    sink.finish(&ending)?;
    Ok(ending)
}

fn draw(plan: &Plan, format: Format, out: &mut dyn Write) -> Result<Ending> {
    let (legs, ending) = plan.legs_for_picture()?;
    let motion = picture::Motion::of(&plan.problem, &legs, &plan.last_instant(&legs));
    let bytes = match format {
        Format::Svg => picture::svg(&motion)?.into_bytes(),
        _ => picture::png(&motion)?,
    };
    out.write_all(&bytes)?;
    Ok(ending)
}
