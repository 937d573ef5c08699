//! `continue SYSTEM`: a branch of orbits of a section's return map.

use super::super::of_system::{PointJson, guess, points};
use super::Arguments;
use crate::cli::shared::long_work;
use crate::cli::shared::system_choice::ChosenSystem;
use crate::cli::{DONE, OUT_OF_BOUNDS, say};
use anyhow::{Result, anyhow, bail};
use percuss::affine::{
    NoOrbit, Orbit, ReturnBifurcation, ReturnBranch, ReturnFamily, Solver, System, SystemError,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON of `continue SYSTEM`; if there is no orbit to begin with, the lists are empty.
#[derive(Serialize)]
struct FollowedJson<'a> {
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
pub(super) fn run(arguments: &Arguments, chosen: &ChosenSystem) -> Result<u8> {
    let parameter = &arguments.parameter;
    check(arguments, chosen)?;
    let at = |value: f64| -> Result<System, SystemError> {
        let mut file = chosen.file.clone();
        file.set(parameter, value, "--parameter")?;
        file.system()
    };
    let first =
        at(arguments.from.value).map_err(|error| anyhow!("--from {}: {error}", arguments.from))?;
    at(arguments.to.value).map_err(|error| anyhow!("--to {}: {error}", arguments.to))?;
    let bar = long_work::share_bar();
    let branch = branch(arguments, &first, &at, &mut |share| bar.show_share(share));
    bar.finish_and_clear();
    let branch = branch?;
    let json = json(&first, parameter, branch.as_ref().ok());
    arguments.output.destination().json(&json)?;
    let why = match branch {
        Ok(branch) if branch.is_complete() => return Ok(DONE),
        Ok(branch) => format!("--parameter {parameter}: {}", branch.ending),
        Err(why) => why.to_string(),
    };
    say(&why);
    Ok(OUT_OF_BOUNDS)
}

/// Refuses flags that do not fit a system.
fn check(arguments: &Arguments, chosen: &ChosenSystem) -> Result<()> {
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

fn branch(
    arguments: &Arguments,
    first: &System,
    at: &dyn Fn(f64) -> Result<System, SystemError>,
    told: &mut dyn FnMut(f64),
) -> Result<Result<ReturnBranch, NoOrbit>> {
    let solver = Solver::<f64>::new(first)?;
    let guess = guess(&arguments.section.map(&solver)?, arguments.transient)?;
    let (section, longest) = arguments.section.section()?;
    let family = ReturnFamily::new(section, longest, at);
    let ends = [arguments.from.value, arguments.to.value];
    Ok(guess.and_then(|it| ReturnBranch::follow(&family, &it, arguments.period, ends, told)))
}

fn json<'a>(
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
