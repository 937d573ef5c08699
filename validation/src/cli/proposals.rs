//! Values to begin with for flags that a verb needs and that were not given.

use super::command;
use super::shared::model::ModelFlags;
use super::shared::system_choice::SystemFlags;
use crate::number::shortest;
use clap::error::{ContextKind, ContextValue};
use clap::{ArgMatches, FromArgMatches};
use percuss::{Ending, Parameter, Parameters, System};
use std::f64::consts::TAU;
use std::ffi::OsString;
use std::path::PathBuf;

/// The share of a parameter's value by which a first range goes to either side.
const RANGE: f64 = 0.2;
/// The share of a motion's extent by which a first window is wider on either side.
const MARGIN: f64 = 0.5;
/// The length of the motion that a window is proposed from, in forcing periods or time scales.
const LENGTH: u32 = 50;
const SAMPLES_PER_UNIT: u32 = 20;
/// The number of events and samples after which the motion ends, so that a proposal is quick.
const MAX_POINTS: usize = 4000;

/// A command line that lacks flags.
struct Given {
    verb: String,
    system: Option<System>,
    /// The impact oscillator's, which count without a system.
    oscillator: Parameters,
    parameter: Option<String>,
    axes: Option<String>,
}

/// The words that complete a command line for a first try, from the error that says which flags it
/// lacks; none where a value cannot be guessed for each of them.
pub(super) fn proposal(error: &clap::Error, words: &[OsString]) -> Option<String> {
    let Some(ContextValue::Strings(missing)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    let parsed = command().ignore_errors(true).try_get_matches_from(words).ok()?;
    let (verb, matches) = parsed.subcommand()?;
    let given = Given::new(verb, matches)?;
    let mut values: Vec<_> = missing.iter().map(|flag| given.value(flag)).collect::<Option<_>>()?;
    // The system stands first, where a reader looks for it.
    values.sort_by_key(|value| value.starts_with("--"));
    Some(values.join(" "))
}

impl Given {
    /// The command line as far as it goes; none where its system cannot be read.
    fn new(verb: &str, matches: &ArgMatches) -> Option<Self> {
        let path = matches.try_get_one::<PathBuf>("system").ok().flatten();
        let word = |name| matches.try_get_one::<String>(name).ok().flatten().cloned();
        let read = |path: &PathBuf| {
            let flags = SystemFlags::from_arg_matches(matches).ok()?;
            flags.system(path).ok()?.file.system().ok()
        };
        let system = match path {
            Some(path) => Some(read(path)?),
            None => None,
        };
        let (parameter, axes) = (word("parameter"), word("axes"));
        // Asking clap for flags that a verb has not is a panic.
        let has_model = matches.try_contains_id("problem").is_ok();
        let model = has_model.then(|| ModelFlags::from_arg_matches(matches).ok()?.problem().ok());
        let oscillator =
            model.flatten().map_or_else(Parameters::default, |it| *it.model.parameters());
        Some(Self { verb: verb.to_owned(), system, oscillator, parameter, axes })
    }

    /// A flag with a value, from the flag as clap writes it; of a group, the flag that serves.
    fn value(&self, missing: &str) -> Option<String> {
        let is = |flag: &str| missing.contains(flag);
        let of_system = self.system.is_some();
        let is_grid = matches!(self.verb.as_str(), "basins" | "attractors");
        Some(match missing {
            _ if is("--returns") && of_system && self.verb != "simulate" => "--returns 100".into(),
            _ if is("--periods") && !of_system => "--periods 100".into(),
            _ if is("--events") => "--events 20".into(),
            // A start whose motion has not settled goes on for longer.
            _ if is("--transient") && is_grid => "--transient 100".into(),
            _ if is("--transient") => "--transient 500".into(),
            _ if is("--grid") => "--grid 50x50".into(),
            _ if is("--window") => format!("--window {}", self.window()?),
            _ if is("--period") => "--period 1".into(),
            _ if is("--steps") => "--steps 200".into(),
            _ if is("--parameter") => format!("--parameter {}", self.varied()?.0),
            _ if is("--from") => format!("--from {}", shortest(self.range()?[0])),
            _ if is("--to") => format!("--to {}", shortest(self.range()?[1])),
            _ if is("--wrt") => format!("--wrt {}", self.varied()?.0),
            _ if is("--output") && is_grid => format!("--output {}.png", self.verb),
            "<SYSTEM>" => "bouncing-ball".into(),
            _ => return None,
        })
    }

    /// The parameter that is varied, or the first there is, with its value.
    fn varied(&self) -> Option<(String, f64)> {
        let Some(system) = &self.system else {
            if self.verb == "gradient" {
                // A parameter of the system that is proposed with it.
                return Some(("e".to_owned(), 0.5));
            }
            let name = self.parameter.as_deref().unwrap_or(Parameter::Omega.as_str());
            let value = name.parse::<Parameter>().ok()?.of(&self.oscillator);
            return Some((name.to_owned(), value));
        };
        let named = |it: &(&String, &f64)| self.parameter.as_ref().is_none_or(|name| name == it.0);
        let (name, value) = system.parameters.iter().find(named)?;
        Some((name.clone(), *value))
    }

    /// A range of the parameter on both sides of its value.
    fn range(&self) -> Option<[f64; 2]> {
        let (_, value) = self.varied()?;
        let half = if value == 0.0 { 1.0 } else { RANGE * value.abs() };
        Some([value - half, value + half].map(|end| rounded(end, half)))
    }

    /// A window around the motion that the system's start leads to.
    fn window(&self) -> Option<String> {
        let Some(system) = &self.system else { return Some("-3,1.2,-1.5,1.5".to_owned()) };
        let extents = extents(system)?;
        let names = self.axes.as_deref().map(|axes| axes.split(',').map(str::trim));
        let index = |name| system.states.iter().position(|it| it == name);
        let axes = names.map_or(Some(vec![0, 1]), |names| names.map(index).collect())?;
        let ends = axes.iter().map(|axis| extents.get(*axis).map(widened));
        let ends: Vec<[f64; 2]> = ends.collect::<Option<_>>()?;
        Some(ends.iter().flatten().map(|end| shortest(*end)).collect::<Vec<_>>().join(","))
    }
}

/// The least and the largest value of each state in the motion from the start, if it has one.
fn extents(system: &System) -> Option<Vec<[f64; 2]>> {
    let start = system.start().ok()?.time.to_f64();
    let unit = system.forcing.as_ref().map_or(system.time_scale, |it| TAU / it.omega.to_f64());
    let solver = system.solver::<f64>().ok()?;
    let end = start + f64::from(LENGTH) * unit;
    let samples = solver.run().until_with_samples(end, SAMPLES_PER_UNIT).ok()?;
    let mut extents = vec![[f64::INFINITY, f64::NEG_INFINITY]; system.states.len()];
    for event in samples.take(MAX_POINTS) {
        if event.ending().is_some_and(|it| !matches!(it, Ending::Horizon)) {
            break;
        }
        for ([least, most], value) in extents.iter_mut().zip(event.state()) {
            (*least, *most) = (least.min(*value), most.max(*value));
        }
    }
    extents.iter().all(|[least, most]| least <= most).then_some(extents)
}

/// An extent with its margin; one of a single value has a window around it, too.
fn widened([least, most]: &[f64; 2]) -> [f64; 2] {
    let margin = match MARGIN * (most - least) {
        0.0 => least.abs().max(1.0),
        margin => margin,
    };
    [least - margin, most + margin].map(|end| rounded(end, margin))
}

/// A value to a tenth of the first decimal place of a length.
fn rounded(value: f64, length: f64) -> f64 {
    let places = 1 - length.log10().floor() as i32;
    if places <= 0 {
        let step = 10_f64.powi(-places);
        return (value / step).round() * step;
    }
    format!("{value:.*}", places as usize).parse().unwrap_or(value)
}
