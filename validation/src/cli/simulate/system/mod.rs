//! `simulate SYSTEM`: one run of a piecewise-affine system in f64, at equal steps or at its events.

mod csv;
mod drawn;
mod json;
mod plan;
mod returning;
mod rows;
mod section;
mod sink;

use super::{Arguments, Format};
use crate::cli::note;
use crate::cli::shared::long_work::{self, Bar};
use crate::cli::shared::output::Opened;
use crate::cli::shared::outputs::Outputs;
use crate::cli::shared::picture::{PictureFormat, Shown};
use crate::cli::shared::run_arrays::Arrays;
use crate::cli::shared::system_choice::ChosenSystem;
use crate::returns::CountedReturns;
use anyhow::{Result, bail};
use percuss::System;
use plan::PlannedRun;
use sink::{All, RunEnd, Sink};

/// Makes the run; whether it was decided to its end.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    outputs: &Outputs<Format>,
) -> Result<bool> {
    check_flags(arguments)?;
    let system = chosen.system()?;
    let shown = arguments.picture.shown(2)?;
    let shown = shown.unwrap_or_else(|| Shown::first_states(&system.states, 2));
    let observables = shown.observables(&chosen.file)?;
    let solver = system.solver::<f64>()?;
    let bar = long_work::run_bar(outputs.is_terminal());
    let plan = PlannedRun::new(&solver, arguments, bar.as_ref())?;
    let end = outputs.together(|opened| {
        let sinks = opened.iter_mut().map(|(format, out)| match PictureFormat::new(*format) {
            None => sink_of_rows(*format, &system, out),
            Some(format) => {
                let (flags, stops) = (&arguments.picture, Vec::new());
                let (shown, observables) = (&shown, &observables[..]);
                let drawn = drawn::Drawn { out, flags, format, shown, observables, stops };
                Ok(Box::new(drawn) as Box<dyn Sink + '_>)
            }
        });
        write(&plan, &mut All(sinks.collect::<Result<_>>()?))
    })?;
    bar.iter().for_each(Bar::finish_and_clear);
    end.notes.iter().for_each(|line| note(line));
    Ok(!end.undecided)
}

/// An output for rows.
fn sink_of_rows<'a>(
    format: Format,
    system: &'a System,
    out: &'a mut Opened,
) -> Result<Box<dyn Sink + 'a>> {
    let folder = out.folder();
    Ok(match format {
        Format::Json => Box::new(json::Json::new(out)),
        Format::Npy => Box::new(Arrays::npy(out, system, &folder)?),
        Format::Npz => Box::new(Arrays::npz(out, system, &folder)?),
        _ => Box::new(csv::Csv::new(out)),
    })
}

fn write(plan: &PlannedRun<'_>, sink: &mut dyn Sink) -> Result<RunEnd> {
    sink.begin(plan)?;
    let end = match &plan.returns {
        Some(CountedReturns::Events(returning)) => returning::rows(plan, returning, sink)?,
        _ => plan.rows(sink)?,
    };
    sink.finish(plan, &end)?;
    Ok(end)
}

/// Refuses what belongs to runs of the impact oscillator.
fn check_flags(arguments: &Arguments) -> Result<()> {
    if let Some(periods) = arguments.periods {
        bail!(
            "--periods {periods} is not accepted with SYSTEM: --returns is, and --until and \
             --events"
        );
    }
    if let Some(most) = arguments.max_periods {
        bail!(
            "--max-periods {most} is not accepted with SYSTEM: --events ends a run without it, \
             and --until is accepted"
        );
    }
    let counts_returns = arguments.returns.is_some() || arguments.transient.is_some();
    let section = arguments.section.as_ref().map(|it| format!("--section {it}"));
    let section = section.or_else(|| arguments.section_of_system.given());
    if let Some(flag) = section.filter(|_| !counts_returns) {
        bail!("{flag} has no effect here: it is accepted with --returns and with --transient");
    }
    Ok(())
}
