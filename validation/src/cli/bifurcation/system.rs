//! `bifurcation SYSTEM`: the returns to a section at each value of a parameter.

use super::{Arguments, Format, check_size, told_start};
use crate::cli::note;
use crate::cli::shared::long_work;
use crate::cli::shared::section::{is_told_by_model, tell_undecidable};
use crate::cli::shared::system_choice::ChosenSystem;
use crate::number::shortest;
use crate::picture::{self, Figure, Layer, Plot};
use anyhow::{Result, anyhow, bail};
use percuss::System;
use percuss::affine::{LeftOut, ReturnDiagram, ReturnDiagramStep, Solver};
use percuss::dynamics::diagram::{Follow, values};
use percuss_programs::files::printed_column;
use std::io::Write;

/// Writes the diagram; whether every motion that is left out is so by the model.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    format: Format,
    threads: Option<u16>,
) -> Result<bool> {
    let returns = returns(arguments, format)?;
    let system = chosen.system()?;
    // Flags that do not fit the system are told as such, before any value is.
    chosen.file.clone().set(&arguments.parameter, arguments.from.value, "--parameter")?;
    arguments.section.map(&Solver::new(&system)?)?;
    let diagram = diagram(arguments, returns)?;
    let values = values(arguments.from.value, arguments.to.value, arguments.steps);
    let bar = long_work::bar(u64::from(arguments.steps), "values");
    let steps = long_work::pool(threads)?.install(|| {
        let at = |value: f64| {
            let mut file = chosen.file.clone();
            file.set(&arguments.parameter, value, "--parameter")?;
            file.system()
        };
        diagram.steps(&values, at, || bar.inc(1))
    });
    bar.finish_and_clear();
    let steps = steps.map_err(|error| anyhow!("--parameter {}: {error}", arguments.parameter))?;
    let drawing = || drawing(arguments, &system, &diagram, &steps);
    arguments.output.destination().write(|out| match format {
        Format::Csv => write_csv(&system, &steps, out),
        Format::Png => Ok(out.write_all(&picture::png(&drawing())?)?),
        Format::Svg => Ok(out.write_all(picture::svg(&drawing()).as_bytes())?),
    })?;
    tell_undecidable(steps.iter().map(|it| it.undecidable).sum());
    Ok(tell_left_out(&arguments.parameter, diagram.follow, &steps))
}

/// The number of returns that are shown at each value; refuses flags that do not fit.
fn returns(arguments: &Arguments, format: Format) -> Result<u32> {
    if let Some(periods) = arguments.periods {
        bail!("--periods {periods} is not accepted with SYSTEM: --returns is");
    }
    let returns = arguments.returns.unwrap_or(1);
    for (flag, end) in [("--from", &arguments.from), ("--to", &arguments.to)] {
        if !end.value.is_finite() {
            bail!("{flag} {end} is not accepted: a finite number is");
        }
    }
    arguments.check_steps()?;
    arguments.system.check_varied(&arguments.parameter)?;
    check_size(arguments, returns, format.most_rows())?;
    Ok(returns)
}

fn diagram(arguments: &Arguments, returns: u32) -> Result<ReturnDiagram> {
    let (section, longest) = arguments.section.section()?;
    let (transient, follow) = (arguments.transient, arguments.follow());
    Ok(ReturnDiagram { section, longest, transient, returns, follow })
}

fn write_csv(system: &System, steps: &[ReturnDiagramStep], out: &mut dyn Write) -> Result<()> {
    let columns: Vec<_> = system.states.iter().map(|it| printed_column(it)).collect();
    writeln!(out, "parameter,n,mode,{}", columns.join(","))?;
    for step in steps {
        let value = shortest(step.value);
        for (n, point) in step.points.iter().enumerate() {
            let state: Vec<_> = point.state.iter().map(|it| shortest(*it)).collect();
            let mode = &system.modes[point.mode].name;
            writeln!(out, "{value},{n},{mode},{}", state.join(","))?;
        }
    }
    Ok(())
}

/// The first state over the parameter.
fn drawing(
    arguments: &Arguments,
    system: &System,
    diagram: &ReturnDiagram,
    steps: &[ReturnDiagramStep],
) -> Figure {
    let points = |step: &ReturnDiagramStep| {
        let point = |state: &Vec<f64>| state.first().map(|it| [step.value, *it]);
        step.points.iter().filter_map(|it| point(&it.state)).collect::<Vec<_>>()
    };
    let parameter = &arguments.parameter;
    let axes = [parameter.clone(), system.states.first().cloned().unwrap_or_default()];
    let left_out = match steps.iter().filter(|it| it.left_out.is_some()).count() {
        0 => String::new(),
        count => format!("; {count} values are left out"),
    };
    let layers = vec![Layer::cloud(steps.iter().flat_map(points).collect(), picture::INK)];
    Figure {
        title: system.name.clone(),
        caption: format!(
            "{} values of {parameter}, {} returns to {} each after {}; {}{left_out}",
            steps.len(),
            diagram.returns,
            arguments.section.text(),
            diagram.transient,
            told_start(diagram.follow)
        ),
        columns: 1,
        panel: (1200, 800),
        plots: vec![Plot { title: String::new(), axes, window: None, layers }],
    }
}

/// One line where values are left out; whether the model says so for each, and not the arithmetic.
fn tell_left_out(parameter: &str, follow: Follow, steps: &[ReturnDiagramStep]) -> bool {
    let left_out = || steps.iter().filter_map(|it| Some((it.value, it.left_out?)));
    let Some((value, why)) = left_out().next() else { return true };
    let next = match follow {
        Follow::Carry => "; the next value starts from the last that is not",
        Follow::Reset => "",
    };
    note(&format!(
        "{} of {} values are left out (first: {parameter} = {}, {why}){next}",
        left_out().count(),
        steps.len(),
        shortest(value)
    ));
    left_out().all(|(_, why)| match why {
        LeftOut::NoReturn(why) => is_told_by_model(why),
        LeftOut::Escapes => true,
    })
}
