//! `continue SYSTEM --second NAME`: the bifurcations of a branch, followed in two parameters.

use super::super::of_system::guess;
use super::draw_curves::{self, event};
use super::of_system::branch;
use super::{Arguments, Format, Second};
use crate::cli::shared::long_work;
use crate::cli::shared::output;
use crate::cli::shared::outputs::Outputs;
use crate::cli::shared::parse::Typed;
use crate::cli::shared::system_choice::ChosenSystem;
use crate::cli::{DONE, OUT_OF_BOUNDS, say};
use crate::number::shortest;
use anyhow::{Result, anyhow, bail};
use percuss::affine::{
    BifurcationCurve, BifurcationPoint, CurveEnding, NoOrbit, ReturnBranch, ReturnPlane, Solver,
    System, SystemError,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;

/// The JSON of curves; if there is no orbit to begin with, they are none.
#[derive(Serialize)]
struct CurvesJson<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    /// The varied parameters have no value.
    parameters: BTreeMap<String, f64>,
    parameter: &'a str,
    second: &'a str,
    /// Whether the branch was followed to its end.
    complete: bool,
    curves: Vec<CurveJson>,
}

#[derive(Serialize)]
struct CurveJson {
    curve: usize,
    r#type: &'static str,
    event: Option<String>,
    period: Option<usize>,
    endings: [&'static str; 2],
    points: Vec<PlaceJson>,
}

#[derive(Serialize)]
struct PlaceJson {
    parameter: f64,
    second: f64,
    error: f64,
}

/// Both parameters, and the windows in which they vary.
struct Plane<'a> {
    chosen: &'a ChosenSystem,
    names: [&'a str; 2],
    window: [[f64; 2]; 2],
}

impl Plane<'_> {
    fn at(&self, values: [f64; 2]) -> Result<System, SystemError> {
        let mut file = self.chosen.file.clone();
        for (name, value) in self.names.iter().zip(values) {
            file.set(name, value, &format!("{name} = {value}"))?;
        }
        file.system()
    }
}

/// Follows the branch and the curves of its bifurcations, and writes these.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    second: &Second<'_>,
    outputs: &Outputs<Format>,
) -> Result<u8> {
    arguments.picture.refuse_show_of_curves()?;
    let Second { name, range } = *second;
    let names = [arguments.parameter.as_str(), name];
    let window = [[arguments.from.value, arguments.to.value], range.value];
    let plane = Plane { chosen, names, window };
    let (first, own) = begun(arguments, &plane, range)?;
    let bar = long_work::share_bar();
    let solver = Solver::<f64>::new(&first)?;
    let guess = guess(&arguments.section.map(&solver)?, arguments.transient)?;
    let at = |value: f64| plane.at([value, own]);
    // Curves take longer than the branch.
    let branch = branch(arguments, guess, &at, &mut |share| bar.show_share(0.1 * share))?;
    let curves = match &branch {
        Ok(branch) => {
            let told = &mut |share| bar.show_share(0.1 + 0.9 * share);
            curves(arguments, &plane, branch, own, told)?
        }
        Err(_) => Vec::new(),
    };
    bar.finish_and_clear();
    let data = |format, out: &mut dyn Write| match format {
        Format::Csv => csv(&first, &curves, out),
        _ => output::json(out, &json(&first, names, branch.as_ref().ok(), &curves)),
    };
    let figure = || Ok(draw_curves::figure(&first, arguments, names, window, &curves));
    outputs.data_and_figure(&arguments.picture, data, figure)?;
    let notes = notes(&first, names, &branch, &curves);
    notes.iter().for_each(|it| say(it));
    Ok(if notes.is_empty() { DONE } else { OUT_OF_BOUNDS })
}

/// The system at the first value, and its own value of the second parameter; refuses values that
/// do not fit it.
fn begun(
    arguments: &Arguments,
    plane: &Plane<'_>,
    range: &Typed<[f64; 2]>,
) -> Result<(System, f64)> {
    let Arguments { from, to, .. } = arguments;
    let [parameter, second] = plane.names;
    if parameter == second {
        bail!("--second {second} is not accepted: another parameter than that of --parameter is");
    }
    if from.value == to.value {
        bail!("--to {to} is not accepted with --second: another value than that of --from is");
    }
    let [low, high] = range.value;
    // The name first, because an unknown one has no value.
    plane.chosen.file.clone().set(second, low, "--second")?;
    let mut file = plane.chosen.file.clone();
    file.set(parameter, from.value, "--parameter")?;
    let first = file.system().map_err(|error| anyhow!("--from {from}: {error}"))?;
    let own = first.parameters.get(second).copied().unwrap_or(f64::NAN);
    if !(low..=high).contains(&own) {
        bail!(
            "--second-range {range} is not accepted: the system's own value of {second} is in it, \
             {}",
            shortest(own)
        );
    }
    plane.at([to.value, own]).map_err(|error| anyhow!("--to {to}: {error}"))?;
    for end in range.value {
        let error = |error| anyhow!("--second-range {range}: {error}");
        plane.at([from.value, end]).map_err(error)?;
    }
    Ok((first, own))
}

fn curves(
    arguments: &Arguments,
    plane: &Plane<'_>,
    branch: &ReturnBranch,
    own: f64,
    told: &mut dyn FnMut(f64),
) -> Result<Vec<BifurcationCurve>> {
    let (section, longest) = arguments.section.section()?;
    let at = |values: [f64; 2]| plane.at(values);
    let maps = ReturnPlane::new(section, longest, plane.window, &at);
    Ok(BifurcationCurve::all(&maps, branch, own, told))
}

fn csv(system: &System, curves: &[BifurcationCurve], out: &mut dyn Write) -> Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["curve", "type", "parameter", "second", "error", "event"])?;
    for (n, curve) in curves.iter().enumerate() {
        let event = event(system, curve).unwrap_or_default();
        for BifurcationPoint { values: [parameter, second], error, .. } in &curve.points {
            let numbers = [parameter, second, error].map(|it| shortest(*it));
            let [parameter, second, error] = &numbers;
            let cells =
                [&n.to_string(), curve.kind.as_str(), parameter, second, error, event.as_str()];
            writer.write_record(cells)?;
        }
    }
    Ok(out.write_all(&writer.into_inner()?)?)
}

fn json<'a>(
    system: &'a System,
    [parameter, second]: [&'a str; 2],
    branch: Option<&ReturnBranch>,
    curves: &[BifurcationCurve],
) -> CurvesJson<'a> {
    let mut parameters = system.parameters.clone();
    parameters.extend([parameter, second].map(|it| (it.to_owned(), f64::NAN)));
    let place = |it: &BifurcationPoint| {
        let [parameter, second] = it.values;
        PlaceJson { parameter, second, error: it.error }
    };
    let curve = |(curve, it): (usize, &BifurcationCurve)| CurveJson {
        curve,
        r#type: it.kind.as_str(),
        event: event(system, it),
        period: it.points.first().map(|it| it.orbit.period()),
        endings: it.endings.map(CurveEnding::as_str),
        points: it.points.iter().map(place).collect(),
    };
    CurvesJson {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        system: &system.name,
        parameters,
        parameter,
        second,
        complete: branch.is_some_and(ReturnBranch::is_complete),
        curves: curves.iter().enumerate().map(curve).collect(),
    }
}

/// What is said of a branch that is incomplete, and of curves that end within the window.
fn notes(
    system: &System,
    [parameter, second]: [&str; 2],
    branch: &Result<ReturnBranch, NoOrbit>,
    curves: &[BifurcationCurve],
) -> Vec<String> {
    let why = match branch {
        Ok(branch) if branch.is_complete() => None,
        Ok(branch) => Some(format!("--parameter {parameter}: {}", branch.ending)),
        Err(why) => Some(why.to_string()),
    };
    let of_curve = |(n, curve): (usize, &BifurcationCurve)| {
        let event = event(system, curve).map(|it| format!(" of {it}")).unwrap_or_default();
        let name = format!("curve {n}, {}{event}", curve.kind);
        let ends = [curve.points.first(), curve.points.last()];
        let note = |(ending, end): (CurveEnding, Option<&BifurcationPoint>)| {
            let [value, other] = end?.values.map(shortest);
            let what = match ending {
                CurveEnding::Lost => "ends",
                CurveEnding::Long => "has too many places, and is given up",
                CurveEnding::Left | CurveEnding::Closed => return None,
            };
            Some(format!("{name}: {what} at {parameter} = {value}, {second} = {other}"))
        };
        curve.endings.into_iter().zip(ends).filter_map(note).collect::<Vec<_>>()
    };
    why.into_iter().chain(curves.iter().enumerate().flat_map(of_curve)).collect()
}
