//! `simulate SYSTEM`: one run of a piecewise-affine system in f64, at equal steps or at its events.

mod arrays;
mod csv;
mod json;
mod plan;
mod rows;
mod sink;

use super::{Arguments, Format};
use crate::cli::note;
use crate::cli::shared::long_work::{self, Bar};
use crate::cli::shared::system_choice::ChosenSystem;
use anyhow::{Result, bail};
use clap::ValueEnum;
use plan::PlannedRun;
use sink::{RunEnd, Sink};

/// Makes the run; whether it was decided to its end.
pub(super) fn run(arguments: &Arguments, chosen: &ChosenSystem, format: Format) -> Result<bool> {
    check_flags(arguments, format)?;
    let system = chosen.system()?;
    let solver = system.solver::<f64>()?;
    let destination = arguments.output.destination();
    let bar = long_work::run_bar(destination.is_terminal());
    let plan = PlannedRun::new(&solver, arguments, bar.as_ref())?;
    let folder = destination.folder();
    let mut end = RunEnd::default();
    destination.write(|out| {
        end = match format {
            Format::Json => write(&plan, &mut json::Json::new(out)),
            Format::Npy => write(&plan, &mut arrays::Arrays::npy(out, &folder)?),
            Format::Npz => write(&plan, &mut arrays::Arrays::npz(out, &folder)?),
            _ => write(&plan, &mut csv::Csv::new(out)),
        }?;
        Ok(())
    })?;
    bar.iter().for_each(Bar::finish_and_clear);
    end.notes.iter().for_each(|line| note(line));
    Ok(!end.undecided)
}

fn write(plan: &PlannedRun<'_>, sink: &mut dyn Sink) -> Result<RunEnd> {
    sink.begin(plan)?;
    let end = plan.rows(sink)?;
    sink.finish(plan, &end)?;
    Ok(end)
}

/// Refuses what belongs to runs of the impact oscillator.
fn check_flags(arguments: &Arguments, format: Format) -> Result<()> {
    if let Some(periods) = arguments.periods {
        bail!(
            "--periods {periods} is not accepted with SYSTEM: --returns is, of a forced system, \
             and --until and --events"
        );
    }
    if let Some(most) = arguments.max_periods {
        bail!(
            "--max-periods {most} is not accepted with SYSTEM: --events ends a run without it, \
             and --until is accepted"
        );
    }
    if matches!(format, Format::Png | Format::Svg) {
        let name = format.to_possible_value().map(|it| it.get_name().to_owned());
        bail!(
            "--format {} is not accepted with SYSTEM: csv, json, npy and npz are, and percuss \
             events draws a run of a system",
            name.unwrap_or_default()
        );
    }
    Ok(())
}
