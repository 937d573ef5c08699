//! `lyapunov SYSTEM`: the exponents of one motion, from its returns to a section.

use super::{Arguments, stationary};
use crate::cli::note;
use crate::cli::shared::drift;
use crate::cli::shared::long_work;
use crate::cli::shared::section::{RETURNS_PER_UPDATE, tell_no_return, tell_undecidable};
use crate::cli::shared::system_choice::ChosenSystem;
use crate::returns;
use anyhow::Result;
use percuss::affine::{Exponents, NoReturn, SectionMap, Solver, System};
use percuss::dynamics::batches::Stationarity;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Json<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    parameters: &'a BTreeMap<String, f64>,
    states: &'a [String],
    exponents_per_time: Vec<f64>,
    exponents_per_return: Vec<f64>,
    standard_error: Vec<f64>,
    mean_return_time: Option<f64>,
    batches: u64,
    /// Null where too few batches tell.
    stationary: Option<bool>,
    drift_per_return: BTreeMap<&'a str, f64>,
    drift_standard_error: BTreeMap<&'a str, f64>,
}

/// Writes the exponents; whether the motion was decided to its end.
pub(super) fn run(arguments: &Arguments, chosen: &ChosenSystem, returns: u64) -> Result<bool> {
    let system = chosen.system()?;
    let solver = Solver::<f64>::new(&system)?;
    let map = arguments.section.map(&solver)?;
    let found = exponents(&map, arguments.transient, returns)?;
    arguments.output.destination().json(&json(&system, found.as_ref().ok()))?;
    match found {
        Ok(found) => {
            tell_undecidable(found.undecidable);
            if let Stationarity::ChangesAfter(after) = found.stationarity {
                note(&format!(
                    "the motion changes on the way: the means of its batches differ before and \
                     after {after} of {returns} returns"
                ));
            }
            Ok(true)
        }
        Err((why, passed)) => Ok(tell_no_return(why, passed)),
    }
}

/// The exponents, or why the motion does not return as often, and how often it does.
fn exponents(
    map: &SectionMap<'_, f64>,
    transient: u64,
    returns: u64,
) -> Result<Result<Exponents, (NoReturn, u64)>> {
    let bar = long_work::share_bar();
    let found = returns::exponents(map, transient, returns, &mut |passed| {
        if passed.is_multiple_of(RETURNS_PER_UPDATE) {
            bar.show_share(passed as f64 / (transient + returns) as f64);
        }
    });
    bar.finish_and_clear();
    Ok(found?)
}

/// The JSON; lists are empty and numbers null where the motion does not return as often.
fn json<'a>(system: &'a System, found: Option<&Exponents>) -> Json<'a> {
    let drift = |of: fn(&Exponents) -> &Vec<f64>| {
        drift::by_name(system, found.map(of).map_or(&[], Vec::as_slice))
    };
    Json {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        system: &system.name,
        parameters: &system.parameters,
        states: &system.states,
        exponents_per_time: found.map(Exponents::per_time).unwrap_or_default(),
        exponents_per_return: found.map(|it| it.per_return.clone()).unwrap_or_default(),
        standard_error: found.map(|it| it.standard_error.clone()).unwrap_or_default(),
        mean_return_time: found.map(|it| it.mean_return_time),
        batches: found.map_or(0, |it| it.batches),
        stationary: found.and_then(|it| stationary(it.stationarity)),
        drift_per_return: drift(|it| &it.drift_per_return),
        drift_standard_error: drift(|it| &it.drift_standard_error),
    }
}
