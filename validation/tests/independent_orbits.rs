//! Orbits and bifurcations of systems, held to those of a program of its own
//! (`reference_data/orbits.py`): Taylor series in 40 digits, and differences.

use crate::support::{run, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Twelve digits of points and multipliers, relative to the largest of each.
const ORBIT_TOLERANCE: f64 = 1e-12;
/// Eight digits of a bifurcation's value.
const VALUE_TOLERANCE: f64 = 1e-8;
/// A branch is followed this share of the way to a bifurcation beyond it.
const OVERSHOOT_SHARE: f64 = 0.02;

type Row = BTreeMap<String, String>;

/// The rows of a table, each as its columns' names and cells.
fn table(name: &str) -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference_data").join(name);
    let mut reader = csv::Reader::from_path(path).expect("a table");
    reader.deserialize().collect::<Result<_, _>>().expect("rows")
}

fn numbers(cells: &str) -> Vec<f64> {
    cells.split_whitespace().map(|it| it.parse().expect("a number")).collect()
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|it| it.as_f64().expect("a number")).collect()
}

/// The names of a system's states.
fn states(system: &str) -> Vec<String> {
    let listed = text(&run(&["systems"]).stdout);
    let row = listed.lines().find(|it| it.starts_with(&format!("{system},"))).expect("a system");
    row.split(',').nth(1).expect("states").split(' ').map(str::to_owned).collect()
}

/// The answer of a verb for the system, the parameters but for one, the section, the period and the
/// state of a row.
fn answer(verb: &str, row: &Row, but: &str, more: &[String]) -> Value {
    let section = if row["section"] == "strobe" { "strobe:0" } else { &row["section"] };
    let mut flags = vec![verb, &row["system"], "--period", &row["period"], "--section", section];
    let own = |it: &&str| !it.starts_with(&format!("{but}="));
    for set in row["set"].split_whitespace().filter(own) {
        flags.extend(["--set", set]);
    }
    let names = states(&row["system"]);
    let start = names.iter().zip(row["state"].split_whitespace());
    let start: Vec<_> = start.map(|(name, value)| format!("{name}={value}")).collect();
    flags.extend(["--mode", &row["mode"]]);
    flags.extend(start.iter().flat_map(|it| ["--at", it]));
    flags.extend(more.iter().map(String::as_str));
    let output = run(&flags);
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{flags:?}: {error}, {}", text(&output.stderr)))
}

fn assert_near(found: &[f64], known: &[f64], what: &str) {
    assert_eq!(found.len(), known.len(), "{what}: {found:?} {known:?}");
    let size = known.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    for (found, known) in found.iter().zip(known) {
        assert!((found - known).abs() <= ORBIT_TOLERANCE * size, "{what}: {found} for {known}");
    }
}

#[test]
fn orbits_and_multipliers_are_confirmed_to_twelve_digits() {
    let rows = table("orbits.csv");
    assert!(rows.len() >= 10);
    for row in &rows {
        let what = format!("{} {}", row["system"], row["set"]);
        let found = answer("orbit", row, "", &[]);
        assert_eq!(found["converged"], true, "{what}");
        // An orbit of several points may begin with another one.
        let state = numbers(&row["state"]);
        let points = found["points"].as_array().expect("points").iter();
        let apart =
            |it: &&Value| list(&it["state"]).iter().zip(&state).map(|(a, b)| (a - b).abs()).sum();
        let point = points.min_by(|a, b| f64::total_cmp(&apart(a), &apart(b))).expect("a point");
        assert_eq!(point["mode"], row["mode"].as_str(), "{what}");
        assert_near(&list(&point["state"]), &state, &what);
        let time = found["time"].as_f64().expect("a time");
        assert_near(&[time], &numbers(&row["time"]), &what);
        // The two of a complex pair come in either order.
        let pair = |it: Vec<f64>| [it[0], it[1].abs()];
        let known = row["multipliers"].split("; ").flat_map(|it| pair(numbers(it)));
        let own = found["multipliers"].as_array().expect("multipliers").iter();
        let own = own.flat_map(|it| pair(list(it)));
        let (mut known, mut own): (Vec<_>, Vec<_>) = (known.collect(), own.collect());
        // A direction that a section removes has the multiplier 0 here, and none there.
        let length = known.len().max(own.len());
        known.resize(length, 0.0);
        own.resize(length, 0.0);
        assert_near(&own, &known, &what);
    }
}

#[test]
fn bifurcations_are_confirmed_to_eight_digits_and_within_their_errors() {
    let rows = table("bifurcations.csv");
    assert!(rows.len() >= 5);
    for row in &rows {
        let (name, known) = (&row["parameter"], numbers(&row["value"])[0]);
        let own = row["set"].split_whitespace().find_map(|it| it.strip_prefix(&format!("{name}=")));
        let from = numbers(own.expect("the parameter's value"))[0];
        let to = known + OVERSHOOT_SHARE * (known - from);
        let way = [format!("--parameter={name}"), format!("--from={from}"), format!("--to={to}")];
        let found = answer("continue", row, name, &way);
        let all = found["bifurcations"].as_array().expect("bifurcations");
        let first = all.iter().find(|it| it["type"] == row["type"].as_str());
        let first = first.unwrap_or_else(|| panic!("{row:?}: {all:?}"));
        let [value, error] = ["value", "error"].map(|it| first[it].as_f64().expect("a number"));
        assert!((value - known).abs() <= error, "{row:?}: {value} +- {error}");
        assert!(error <= VALUE_TOLERANCE * known.abs(), "{row:?}: {value} +- {error}");
    }
}
