//! `simulate`: one run, as a table of switches, a table of samples, or a picture.

mod csv;
mod json;
mod plan;
mod rows;

use super::model::ModelFlags;
use super::output::Destination;
use super::{parse, say};
use crate::picture;
use anyhow::{Result, bail};
use clap::{ArgGroup, Args, ValueEnum};
use plan::Plan;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Run the exact solver from one start
#[derive(Args)]
#[command(group(ArgGroup::new("length").required(true).args(["events", "periods", "until"])))]
pub(super) struct Arguments {
    /// Ends after this many switches
    #[arg(long, value_name = "N")]
    events: Option<u64>,
    /// Ends after this many forcing periods, at most 1000000000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=plan::MAX_PERIODS))]
    periods: Option<u64>,
    /// Ends at this time, at or after the start
    #[arg(long, value_name = "TAU", value_parser = parse::number, allow_hyphen_values = true)]
    until: Option<f64>,
    /// Rows K times a forcing period instead of at each switch
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// With --events: stops early after this many forcing periods
    #[arg(long, value_name = "M", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(1..=plan::MAX_PERIODS))]
    max_periods: u64,
    /// Where the result goes, - is stdout; its extension (csv, json, png, svg) is its format
    #[arg(long, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Format where --output has no extension
    #[arg(long, value_enum)]
    format: Option<Format>,
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

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = format(arguments.output.as_deref(), arguments.format)?;
    let problem = arguments.model.problem()?;
    let plan = Plan::new(problem, arguments)?;
    let destination = Destination::new(arguments.output.as_deref());
    let mut ending = None;
    destination.write(|out| {
        ending = match format {
            Format::Csv => write_rows(&plan, arguments.samples, &mut csv::Csv(out))?,
            Format::Json => write_rows(&plan, arguments.samples, &mut json::Json::new(out))?,
            Format::Png | Format::Svg => draw(&plan, format, out)?,
        };
        Ok(())
    })?;
    if let Some(line) = ending {
        say(&line);
    }
    Ok(())
}

/// The extension of --output, or --format where there is none.
fn format(output: Option<&Path>, stated: Option<Format>) -> Result<Format> {
    let extension = output.and_then(Path::extension).and_then(|extension| extension.to_str());
    let known = extension.and_then(|extension| Format::from_str(extension, true).ok());
    match (known, stated, extension) {
        (Some(known), Some(stated), Some(extension)) if known != stated => {
            let stated = format!("{stated:?}").to_lowercase();
            bail!(
                "--format {stated} contradicts the extension of --output, {extension}: accepted is one of them"
            )
        }
        (Some(format), ..) | (None, Some(format), _) => Ok(format),
        (None, None, Some(extension))
            if !output.is_some_and(|path| path.exists() && !path.is_file()) =>
        {
            bail!(
                "--output: extension {extension} is not accepted: csv, json, png, svg, or --format"
            )
        }
        (None, None, _) => Ok(Format::Csv),
    }
}

/// Writes the run's rows; what has to be said about its end.
fn write_rows(
    plan: &Plan,
    samples: Option<u32>,
    sink: &mut dyn rows::Sink,
) -> Result<Option<String>> {
    sink.begin(plan, samples.is_some())?;
    let ending = match samples {
        Some(per_period) => rows::samples(plan, per_period, sink)?,
        None => rows::switches(plan, sink)?,
    };
    sink.finish()?;
    Ok(ending)
}

fn draw(plan: &Plan, format: Format, out: &mut dyn Write) -> Result<Option<String>> {
    let (legs, ending) = plan.legs_for_picture()?;
    let motion = picture::Motion::of(&plan.problem, &legs, &plan.last_instant(&legs));
    let bytes = match format {
        Format::Svg => picture::svg(&motion)?.into_bytes(),
        _ => picture::png(&motion)?,
    };
    out.write_all(&bytes)?;
    Ok(ending)
}
