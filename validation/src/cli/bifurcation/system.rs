//! `bifurcation SYSTEM`: the returns to a section at each value of a parameter.

use super::{Arguments, Format, check_size, most_rows, told_start};
use crate::cli::note;
use crate::cli::shared::long_work;
use crate::cli::shared::outputs::Outputs;
use crate::cli::shared::picture::{Shown, place};
use crate::cli::shared::section::{is_told_by_model, tell_undecidable};
use crate::cli::shared::system_choice::ChosenSystem;
use crate::number::shortest;
use crate::picture::{self, Figure, Layer, Plot};
use anyhow::{Result, anyhow, bail};
use percuss::System;
use percuss::affine::{LeftOut, Return, ReturnDiagram, ReturnDiagramStep, Solver};
use percuss::dynamics::diagram::{Follow, values};
use percuss_programs::files::printed_column;
use std::io::Write;

/// Writes the diagram; whether every motion that is left out is so by the model.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    outputs: &Outputs<Format>,
    threads: Option<u16>,
) -> Result<bool> {
    let returns = returns(arguments, most_rows(outputs))?;
    let system = chosen.system()?;
    let shown = arguments.picture.shown(1)?;
    let shown = shown.unwrap_or_else(|| Shown::first_states(&system.states, 1));
    shown.observables(&chosen.file)?;
    // Flags that do not fit the system are told as such, before any value is.
    chosen.file.clone().set(&arguments.parameter, arguments.from.value, "--parameter")?;
    arguments.section.map(&Solver::new(&system)?)?;
    let diagram = diagram(arguments, returns)?;
    let values = values(arguments.from.value, arguments.to.value, arguments.steps);
    let bar = long_work::bar(u64::from(arguments.steps), "values");
    let seen = |count| bar.inc(count);
    let steps = long_work::pool(threads)?
        .install(|| steps(&diagram, chosen, &arguments.parameter, &values, seen));
    bar.finish_and_clear();
    let steps = steps?;
    let figure = || {
        let points = points(chosen, &arguments.parameter, &shown, &steps)?;
        Ok(drawing(arguments, &system.name, &shown, &diagram, &steps, points))
    };
    let data = |_, out: &mut dyn Write| write_csv(&system, &steps, out);
    outputs.data_and_figure(&arguments.picture, data, figure)?;
    tell_undecidable(steps.iter().map(|it| it.undecidable).sum());
    Ok(tell_left_out(&arguments.parameter, diagram.follow, &steps))
}

/// The steps of a diagram at some values of a parameter; `seen` is told of how many more are done.
pub(in crate::cli) fn steps(
    diagram: &ReturnDiagram,
    chosen: &ChosenSystem,
    parameter: &str,
    values: &[f64],
    seen: impl Fn(u64) + Sync + Send,
) -> Result<Vec<ReturnDiagramStep>> {
    let steps = diagram.steps(values, |value| chosen.system_at(parameter, value), seen);
    steps.map_err(|error| anyhow!("--parameter {parameter}: {error}"))
}

/// The number of returns that are shown at each value; refuses flags that do not fit, and more rows
/// than `most`.
pub(in crate::cli) fn returns(arguments: &Arguments, most: u64) -> Result<u32> {
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
    check_size(arguments, ("--returns", returns), most)?;
    Ok(returns)
}

/// The diagram that the flags ask for, with so many returns at each value.
pub(in crate::cli) fn diagram(arguments: &Arguments, returns: u32) -> Result<ReturnDiagram> {
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

/// The points of the picture: the values of the `--show` expressions at each return. A single
/// expression is drawn over the parameter. The expressions may contain the parameter, and are read
/// again at each of its values.
fn points(
    chosen: &ChosenSystem,
    parameter: &str,
    shown: &Shown,
    steps: &[ReturnDiagramStep],
) -> Result<Vec<[f64; 2]>> {
    let mut file = chosen.file.clone();
    let mut points = Vec::new();
    for step in steps {
        let observables = shown.observables_at(&mut file, parameter, step.value)?;
        let of = |it: &Return<f64>| place(&observables, step.value, it.time, &it.state);
        points.extend(step.points.iter().map(of));
    }
    Ok(points)
}

fn drawing(
    arguments: &Arguments,
    name: &str,
    shown: &Shown,
    diagram: &ReturnDiagram,
    steps: &[ReturnDiagramStep],
    points: Vec<[f64; 2]>,
) -> Figure {
    let parameter = &arguments.parameter;
    let axes = shown.axes(parameter);
    let left_out = match steps.iter().filter(|it| it.left_out.is_some()).count() {
        0 => String::new(),
        count => format!("; {count} values are left out"),
    };
    let layers = vec![Layer::cloud(points, picture::INK)];
    Figure {
        title: name.to_owned(),
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
