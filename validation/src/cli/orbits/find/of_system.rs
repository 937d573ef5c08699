//! `orbit SYSTEM`: periodic orbits of a section's return map, from the start of a system, or all
//! that are reached from a grid of starts.

use super::super::of_system::{PointJson, guess, points};
use super::{Arguments, OrbitFormat, StartGridFlags};
use crate::cli::shared::drift;
use crate::cli::shared::long_work;
use crate::cli::shared::output;
use crate::cli::shared::outputs::Outputs;
use crate::cli::shared::plane::plane;
use crate::cli::shared::system_choice::ChosenSystem;
use crate::cli::{DONE, OUT_OF_BOUNDS, note, say};
use anyhow::{Result, bail};
use percuss::affine::{NoOrbit, Orbit, SectionMap, Solver, System};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

const OPEN_ORDER: &str = "rounding leaves the order of two events of an orbit open: its multipliers \
                          are those of one side";

/// The JSON of `orbit SYSTEM`; if no orbit was found, the lists are empty and the numbers null.
#[derive(Serialize)]
struct OrbitJson<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    parameters: &'a BTreeMap<String, f64>,
    states: &'a [String],
    converged: bool,
    period: Option<usize>,
    time: Option<f64>,
    points: Vec<PointJson<'a>>,
    events: Vec<String>,
    multipliers: Vec<[f64; 2]>,
    stable: Option<bool>,
    drift_per_return: BTreeMap<&'a str, f64>,
    /// The smallest residual that was reached; null where there was none.
    residual: Option<f64>,
}

/// The JSON of `orbit SYSTEM --all`; no orbits where none was found.
#[derive(Serialize)]
struct OrbitsJson<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    parameters: &'a BTreeMap<String, f64>,
    states: &'a [String],
    orbits: Vec<ListedOrbit<'a>>,
}

/// An orbit of a list.
#[derive(Serialize)]
struct ListedOrbit<'a> {
    period: usize,
    time: f64,
    points: Vec<PointJson<'a>>,
    events: Vec<String>,
    multipliers: &'a [[f64; 2]],
    stable: bool,
    drift_per_return: BTreeMap<&'a str, f64>,
    residual: f64,
}

/// Finds and writes the orbit, or all of a grid.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    outputs: &Outputs<OrbitFormat>,
    threads: Option<u16>,
) -> Result<u8> {
    let system = chosen.system()?;
    let solver = Solver::<f64>::new(&system)?;
    let map = arguments.section.map(&solver)?;
    if arguments.all {
        return write_all(arguments, chosen, &map, outputs, threads);
    }
    arguments.starts.refuse_without_all()?;
    let found = orbit_after_transient(&map, arguments)?;
    let text = || found.as_ref().map(|it| table(&system, it)).unwrap_or_default();
    outputs.each(|format, out| match format {
        OrbitFormat::Json => output::json(out, &json(&system, &found)),
        OrbitFormat::Table => Ok(out.write_all(text().as_bytes())?),
    })?;
    Ok(match found {
        Ok(orbit) => {
            if !orbit.is_decided {
                note(OPEN_ORDER);
            }
            DONE
        }
        Err(why) => {
            say(&why.to_string());
            OUT_OF_BOUNDS
        }
    })
}

/// Finds and writes all orbits that are reached from a grid of starts.
fn write_all(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    map: &SectionMap<'_, f64>,
    outputs: &Outputs<OrbitFormat>,
    threads: Option<u16>,
) -> Result<u8> {
    if let Some(transient) = arguments.transient {
        bail!(
            "--transient {transient} is not accepted with --all, which begins at the starts \
             themselves, and where they settle"
        );
    }
    let StartGridFlags { axes, grid, window } = &arguments.starts;
    let (Some(grid), Some(window)) = (grid, window) else {
        bail!(
            "--all with SYSTEM needs a grid of starts: accepted are --grid and --window, such as \
             --grid 12x12 --window=-1,1,-1,1"
        );
    };
    let system = map.system();
    let plane = plane(system, axes.as_deref(), *grid, *window)?;
    chosen.note_replaced_by_grid(system, plane.axes);
    let bar = long_work::bar(plane.count() as u64, "starts");
    let seen = |count| bar.inc(count);
    let (start, period) = (system.start()?, arguments.period);
    let found = long_work::pool(threads)?.install(|| map.orbits(start, &plane, period, &seen))?;
    bar.finish_and_clear();
    let tables = || found.iter().map(|it| table(system, it)).collect::<Vec<_>>().join("\n");
    outputs.each(|format, out| match format {
        OrbitFormat::Json => output::json(out, &list(system, &found)),
        OrbitFormat::Table => Ok(out.write_all(tables().as_bytes())?),
    })?;
    if found.iter().any(|it| !it.is_decided) {
        note(OPEN_ORDER);
    }
    if found.is_empty() {
        say(&format!("no orbit of {period} returns was found from the starts of the grid"));
        return Ok(OUT_OF_BOUNDS);
    }
    Ok(DONE)
}

fn list<'a>(system: &'a System, found: &'a [Orbit]) -> OrbitsJson<'a> {
    let listed = |orbit: &'a Orbit| ListedOrbit {
        period: orbit.period(),
        time: orbit.time,
        points: points(system, orbit),
        events: orbit.event_names(system),
        multipliers: &orbit.multipliers,
        stable: orbit.is_stable(),
        drift_per_return: drift::by_name(system, &orbit.drift_per_return),
        residual: orbit.residual,
    };
    OrbitsJson {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        system: &system.name,
        parameters: &system.parameters,
        states: &system.states,
        orbits: found.iter().map(listed).collect(),
    }
}

/// The orbit that is reached from the return after the transient.
fn orbit_after_transient(
    map: &SectionMap<'_, f64>,
    arguments: &Arguments,
) -> Result<Result<Orbit, NoOrbit>> {
    let guess = guess(map, arguments.transient)?;
    Ok(guess.and_then(|it| map.orbit(&it, arguments.period)))
}

fn json<'a>(system: &'a System, found: &'a Result<Orbit, NoOrbit>) -> OrbitJson<'a> {
    let orbit = found.as_ref().ok();
    let residual = match found {
        Ok(orbit) => Some(orbit.residual),
        Err(NoOrbit::Stalled(residual) | NoOrbit::NoDerivative(residual)) => Some(*residual),
        Err(_) => None,
    };
    OrbitJson {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        system: &system.name,
        parameters: &system.parameters,
        states: &system.states,
        converged: orbit.is_some(),
        period: orbit.map(Orbit::period),
        time: orbit.map(|it| it.time),
        points: orbit.map(|it| points(system, it)).unwrap_or_default(),
        events: orbit.map(|it| it.event_names(system)).unwrap_or_default(),
        multipliers: orbit.map(|it| it.multipliers.clone()).unwrap_or_default(),
        stable: orbit.map(Orbit::is_stable),
        drift_per_return: drift::by_name(
            system,
            orbit.map_or(&[], |it| it.drift_per_return.as_slice()),
        ),
        residual,
    }
}

/// The orbit for people, a line each for what it is, its multipliers, events and points.
fn table(system: &System, orbit: &Orbit) -> String {
    let mut text = String::new();
    let stable = if orbit.is_stable() { "stable" } else { "unstable" };
    let (period, time, residual) = (orbit.period(), orbit.time, orbit.residual);
    let _ = writeln!(text, "period {period}, time {time:.6}, {stable}, residual {residual:.1e}");
    let number = |[re, im]: &[f64; 2]| match *im == 0.0 {
        true => format!("{re:.6}"),
        false => format!("{re:.6}{im:+.6}i"),
    };
    let multipliers: Vec<_> = orbit.multipliers.iter().map(number).collect();
    let _ = writeln!(text, "multipliers {}", multipliers.join(", "));
    let drift = drift::by_name(system, &orbit.drift_per_return);
    if !drift.is_empty() {
        let drift: Vec<_> = drift.iter().map(|(name, it)| format!("{name} {it:.6}")).collect();
        let _ = writeln!(text, "drift per return {}", drift.join(", "));
    }
    let _ = writeln!(text, "events {}", orbit.event_names(system).join(", "));
    for point in &orbit.points {
        let states = system.states.iter().zip(&point.state);
        let state: Vec<_> = states.map(|(name, value)| format!("{name} {value:.6}")).collect();
        let _ = writeln!(text, "{}: {}", system.modes[point.mode].name, state.join(", "));
    }
    text
}
