//! The heading of a table: what its rows were made from.

use crate::case::{Case, FileError, Horizon, OscillatorCase};
use std::collections::BTreeMap;

/// The table must have been made from the very values of the case.
pub(super) fn check_heading(
    case: &Case,
    file: &str,
    heading: &BTreeMap<String, String>,
) -> Result<(), FileError> {
    let numbers = match &case.oscillator {
        Some(own) => numbers_of_oscillator(own),
        None => numbers_of_system(case),
    };
    for (name, value) in numbers {
        let stated = heading.get(&name);
        if stated.and_then(|it| it.parse::<f64>().ok()) != Some(value) {
            let stated = stated.map_or("missing", String::as_str);
            let what = format!("was made for {name} = {stated}, the case has {value:?}");
            return Err(FileError::new(file, what));
        }
    }
    let words = [
        ("case", case.name.as_str()),
        ("system", case.system.name.as_str()),
        ("horizon.backward", if case.backward { "true" } else { "false" }),
    ];
    for (name, value) in words.into_iter().filter(|_| case.oscillator.is_none()) {
        let stated = heading.get(name).map_or("missing", String::as_str);
        if stated != value {
            let what = format!("was made for {name} = {stated}, the case has {value}");
            return Err(FileError::new(file, what));
        }
    }
    Ok(())
}

fn numbers_of_system(case: &Case) -> Vec<(String, f64)> {
    let parameters = case.system.parameters.iter();
    let parameters = parameters.map(|(name, value)| (format!("parameters.{name}"), *value));
    let horizon = [
        ("horizon.until".to_owned(), case.until),
        ("horizon.samples".to_owned(), f64::from(case.samples)),
    ];
    parameters.chain(horizon).collect()
}

fn numbers_of_oscillator(case: &OscillatorCase) -> Vec<(String, f64)> {
    let (model, start) = (case.parameters(), case.problem.start);
    let numbers = [
        ("a", model.a),
        ("b", model.b),
        ("xi", model.xi),
        ("omega", model.omega),
        ("g", model.g),
        ("phi", model.phi),
        ("start.tau", start.tau),
        ("start.p", start.p),
        ("start.y", start.y),
        ("start.v", start.v),
        ("start.cycle", start.cycle as f64),
        match case.horizon {
            Horizon::Periods(periods) => ("horizon.periods", f64::from(periods)),
            Horizon::Until(tau) => ("horizon.until", tau),
        },
    ];
    let numbers = numbers.into_iter().chain(start.q.map(|q| ("start.q", q)));
    numbers.map(|(name, value)| (name.to_owned(), value)).collect()
}
