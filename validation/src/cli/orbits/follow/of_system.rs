//! `continue SYSTEM`: a branch of orbits of a section's return map.

use super::super::of_system::{PointJson, guess, points};
use super::draw::{self, DrawnBifurcation, DrawnOrbit, DrawnPoints};
use super::{Arguments, Format};
use crate::cli::shared::long_work;
use crate::cli::shared::output;
use crate::cli::shared::outputs::Outputs;
use crate::cli::shared::picture::{Shown, place};
use crate::cli::shared::system_choice::ChosenSystem;
use crate::cli::{DONE, OUT_OF_BOUNDS, say};
use crate::picture::Figure;
use crate::returns::Guess;
use anyhow::{Result, anyhow, bail};
use percuss::affine::{
    NoOrbit, Orbit, Return, ReturnBifurcation, ReturnBranch, ReturnFamily, Solver, System,
    SystemError,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON of `continue SYSTEM`; if there is no orbit to begin with, the lists are empty.
#[derive(Serialize)]
pub(in crate::cli) struct FollowedJson<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    /// The varied parameter has no value.
    parameters: BTreeMap<String, f64>,
    states: &'a [String],
    period: Option<usize>,
    complete: bool,
    branch: Vec<BranchPointJson<'a>>,
    bifurcations: Vec<BifurcationJson<'a>>,
}

#[derive(Serialize)]
struct BranchPointJson<'a> {
    parameter: f64,
    time: f64,
    points: Vec<PointJson<'a>>,
    events: Vec<String>,
    multipliers: &'a [[f64; 2]],
    stable: bool,
}

#[derive(Serialize)]
struct BifurcationJson<'a> {
    r#type: &'static str,
    parameter: &'a str,
    value: f64,
    error: f64,
    event: Option<String>,
    period: usize,
    turns: bool,
}

/// Follows the branch and writes it.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    outputs: &Outputs<Format>,
) -> Result<u8> {
    let parameter = &arguments.parameter;
    let at = |value: f64| chosen.system_at(parameter, value);
    let first =
        at(arguments.from.value).map_err(|error| anyhow!("--from {}: {error}", arguments.from))?;
    let shown = arguments.picture.shown(1)?;
    let shown = shown.unwrap_or_else(|| Shown::first_states(&first.states, 1));
    shown.observables(&chosen.file)?;
    at(arguments.to.value).map_err(|error| anyhow!("--to {}: {error}", arguments.to))?;
    let bar = long_work::share_bar();
    let solver = Solver::<f64>::new(&first)?;
    let guess = guess(&arguments.section.map(&solver)?, arguments.transient)?;
    let branch = branch(arguments, guess, &at, &mut |share| bar.show_share(share));
    bar.finish_and_clear();
    let branch = branch?;
    let told = json(&first, parameter, branch.as_ref().ok());
    let figure = || drawing(arguments, chosen, &first, &shown, branch.as_ref().ok());
    outputs.data_and_figure(&arguments.picture, |_, out| output::json(out, &told), figure)?;
    for [from, to] in branch.iter().flat_map(unnamed_changes) {
        say(&format!(
            "--parameter {parameter}: between {from:?} and {to:?} a multiplier passes 1 and the \
             branch does not turn, as where a symmetric orbit gives way to two that are not. \
             Follow these from a start of their own."
        ));
    }
    let why = match branch {
        Ok(branch) if branch.is_complete() => return Ok(DONE),
        Ok(branch) => format!("--parameter {parameter}: {}", branch.ending),
        Err(why) => why.to_string(),
    };
    say(&why);
    Ok(OUT_OF_BOUNDS)
}

/// The values between which a branch changes its stability and nothing is listed.
fn unnamed_changes(branch: &ReturnBranch) -> Vec<[f64; 2]> {
    let ends = |place: usize| [place, place + 1].map(|n| branch.points[n].0);
    branch.unnamed_changes().into_iter().map(ends).collect()
}

/// Refuses flags that do not fit a system.
pub(in crate::cli) fn check(arguments: &Arguments, chosen: &ChosenSystem) -> Result<()> {
    if arguments.doubled {
        bail!("--doubled is not accepted with SYSTEM, whose branch is that of one orbit");
    }
    for (flag, end) in [("--from", &arguments.from), ("--to", &arguments.to)] {
        if !end.value.is_finite() {
            bail!("{flag} {end} is not accepted: a finite number is");
        }
    }
    arguments.system.check_varied(&arguments.parameter)?;
    let system = chosen.system()?;
    chosen.file.clone().set(&arguments.parameter, arguments.from.value, "--parameter")?;
    arguments.section.map(&Solver::new(&system)?).map(drop)
}

/// The branch of the orbit near a guess, in the systems of the parameter's values.
pub(in crate::cli) fn branch(
    arguments: &Arguments,
    guess: Guess,
    at: &dyn Fn(f64) -> Result<System, SystemError>,
    told: &mut dyn FnMut(f64),
) -> Result<Result<ReturnBranch, NoOrbit>> {
    let (section, longest) = arguments.section.section()?;
    let family = ReturnFamily::new(section, longest, at);
    let ends = [arguments.from.value, arguments.to.value];
    Ok(guess.and_then(|it| ReturnBranch::follow(&family, &it, arguments.period, ends, told)))
}

/// What is shown of all points of the orbits, over the parameter, on which it may depend itself.
fn drawing(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    system: &System,
    shown: &Shown,
    branch: Option<&ReturnBranch>,
) -> Result<Figure> {
    let mut file = chosen.file.clone();
    let mut points = |value: f64, orbit: &Orbit| -> Result<Vec<f64>> {
        let observables = shown.observables_at(&mut file, &arguments.parameter, value)?;
        let of = |it: &Return<f64>| place(&observables, value, it.time, &it.state)[1];
        Ok(orbit.points.iter().map(of).collect())
    };
    let (mut orbits, mut found) = (Vec::new(), Vec::new());
    for (value, orbit) in branch.iter().flat_map(|it| &it.points) {
        let (value, is_stable) = (*value, orbit.is_stable());
        let at = DrawnPoints { value, points: points(value, orbit)? };
        orbits.push(DrawnOrbit { at, is_stable });
    }
    for it in branch.iter().flat_map(|it| &it.bifurcations) {
        let event = it.event.map(|event| format!(" {}", event.name(system))).unwrap_or_default();
        let name = format!("{}{event}", it.kind.as_str());
        let at = DrawnPoints { value: it.value, points: points(it.value, &it.orbit)? };
        found.push(DrawnBifurcation { name, at });
    }
    let caption = format!(
        "orbits of period {} in returns to {}, followed from {} to {}",
        arguments.period,
        arguments.section.text(),
        arguments.from,
        arguments.to
    );
    let axes = shown.axes(&arguments.parameter);
    Ok(draw::figure(system.name.clone(), caption, axes, &[orbits], &found))
}

/// The JSON of a branch, or of none.
pub(in crate::cli) fn json<'a>(
    system: &'a System,
    parameter: &'a str,
    branch: Option<&'a ReturnBranch>,
) -> FollowedJson<'a> {
    let mut parameters = system.parameters.clone();
    parameters.insert(parameter.to_owned(), f64::NAN);
    let points = branch.map(|it| it.points.as_slice()).unwrap_or_default();
    let found = branch.map(|it| it.bifurcations.as_slice()).unwrap_or_default();
    FollowedJson {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        system: &system.name,
        parameters,
        states: &system.states,
        period: points.first().map(|it| it.1.period()),
        complete: branch.is_some_and(ReturnBranch::is_complete),
        branch: points.iter().map(|(value, orbit)| point(system, *value, orbit)).collect(),
        bifurcations: found.iter().map(|it| bifurcation(system, parameter, it)).collect(),
    }
}

fn point<'a>(system: &'a System, parameter: f64, orbit: &'a Orbit) -> BranchPointJson<'a> {
    BranchPointJson {
        parameter,
        time: orbit.time,
        points: points(system, orbit),
        events: orbit.event_names(system),
        multipliers: &orbit.multipliers,
        stable: orbit.is_stable(),
    }
}

fn bifurcation<'a>(
    system: &System,
    parameter: &'a str,
    found: &ReturnBifurcation,
) -> BifurcationJson<'a> {
    BifurcationJson {
        r#type: found.kind.as_str(),
        parameter,
        value: found.value,
        error: found.error,
        event: found.event.map(|it| it.name(system)),
        period: found.orbit.period(),
        turns: found.turns,
    }
}
