//! `orbit` and `continue` as users and scripts rely on them.

use crate::support::{refused, run, text};
use serde_json::Value;

/// Digits that do not depend on the platform: the last ones are those of its sine and exponential,
/// times the orbit's sensitivity.
const PLATFORM_TOLERANCE: f64 = 1e-10;

fn json(arguments: &[&str], code: i32) -> (Value, String) {
    let output = run(arguments);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    (serde_json::from_slice(&output.stdout).expect("JSON"), said)
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        value => value.as_f64().into_iter().collect(),
    }
}

fn assert_near(found: &Value, wanted: &[f64]) {
    let found = numbers(found);
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(wanted) {
        approx::assert_abs_diff_eq!(
            *found,
            *wanted,
            epsilon = PLATFORM_TOLERANCE * (1.0 + wanted.abs())
        );
    }
}

#[test]
fn the_period_four_orbit_of_fig_8a() {
    let (orbit, said) = json(&["orbit", "--xi", "0.1", "--period", "4"], 0);
    assert!(said.contains("a scan found") && said.lines().count() == 1, "{said}");
    assert_eq!((&orbit["converged"], &orbit["period"]), (&true.into(), &4.into()));
    assert_eq!(orbit["stable"], true);
    assert_eq!(orbit["phases"], serde_json::json!(["no-contact", "contact"]));
    let points = [
        [-2.670520740443525, 0.19433718494966795, 0.0],
        [-1.7529470408393668, 0.6431361354624957, 0.0],
        [0.8379496457368641, 0.37981647137126145, 0.8179496457368641],
        [-1.5738894602335283, -0.2544617655631597, 1.8478238727302735e-7],
    ];
    assert_near(&orbit["points"], points.as_flattened());
    let multipliers = [-0.70014783339004, 0.25015039081444, -0.70014783339004, -0.25015039081444];
    assert_near(&orbit["multipliers"], &[&multipliers[..], &[0.0, 0.0]].concat());
    assert_eq!(orbit["drift_per_period"], 0.0);
}

#[test]
fn a_guess_selects_an_orbit() {
    let guess = ["--p=-2.5563707", "--y", "0.27075504", "--q", "0"];
    let (orbit, said) = json(&[&["orbit", "--xi", "0.1", "--period", "8"], &guess[..]].concat(), 0);
    assert!(said.is_empty(), "{said}");
    // Asked for eight, it closes after four; unstable.
    assert_eq!((&orbit["period"], &orbit["stable"]), (&4.into(), &false.into()));
    assert_near(&orbit["multipliers"][0], &[4.66867213600676, 0.0]);
}

#[test]
fn table_1_settles_on_the_orbit_that_is_found() {
    let (orbit, _) = json(&["orbit", "--omega", "0.1", "--period", "2"], 0);
    assert_eq!((&orbit["period"], &orbit["stable"]), (&2.into(), &true.into()));
    assert_near(&orbit["drift_per_period"], &[13.910575676319503]);
    assert_near(&orbit["multipliers"][0], &[-0.607217754921749, 0.0]);
}

#[test]
fn the_fold_of_period_four() {
    let arguments = ["continue", "--xi", "0.1", "--parameter", "omega", "--period", "4"];
    let there = [&arguments[..], &["--from", "1.56", "--to", "1.6"]].concat();
    let (branch, said) = json(&there, 1);
    assert!(said.contains("turns and leaves the interval"), "{said}");
    let fold = &branch["bifurcations"][0];
    assert_eq!((&fold["type"], &fold["parameter"]), (&"fold".into(), &"omega".into()));
    assert_near(&fold["value"], &[1.575809226753988]);
    let down = [&arguments[..], &["--from", "1.56", "--to", "1.4"]].concat();
    let (branch, _) = json(&down, 0);
    assert_eq!(branch["complete"], true);
    let last = branch["branch"].as_array().and_then(|it| it.last()).expect("a branch");
    assert_eq!(last["parameter"], 1.4);
}

#[test]
fn the_doubled_branch_of_period_three() {
    let arguments =
        ["continue", "--xi", "0.1", "--parameter", "omega", "--period", "3", "--doubled"];
    let (branch, _) = json(&[&arguments[..], &["--from", "1.7", "--to", "1.6"]].concat(), 0);
    assert_near(&branch["bifurcations"][0]["value"], &[1.634783516162315]);
    let doubled = &branch["doubled"];
    assert_near(&doubled["at"], &[1.634783516162315]);
    assert_eq!((&doubled["criticality"], &doubled["period"]), (&"supercritical".into(), &6.into()));
    assert_eq!(doubled["complete"], true);
}

/// A converter's orbit and the flags of its curve of flips.
const CONVERTER: [&str; 12] = [
    "continue",
    "buck-converter",
    "--section",
    "clock",
    "--transient",
    "200",
    "--from",
    "24",
    "--to",
    "25",
    "--period",
    "1",
];

#[test]
fn the_curve_of_a_converters_flips() {
    let flags = ["--parameter", "Vin", "--second", "R", "--second-range", "21.5,22.5"];
    let told = |threads: &str| {
        let output = run(&[&CONVERTER[..], &flags, &["--threads", threads]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let csv = told("1");
    assert_eq!(csv, told("2"));
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("curve,type,parameter,second,error,event"));
    let rows: Vec<Vec<&str>> = lines.map(|it| it.split(',').collect()).collect();
    assert!(rows.iter().all(|it| it[..2] == ["0", "flip"] && it[5].is_empty()), "{csv}");
    let mut ends = [rows[0][3], rows[rows.len() - 1][3]];
    ends.sort_unstable();
    assert_eq!(ends, ["21.5", "22.5"]);
    // The branch's own flip is a place of the curve.
    let (branch, _) = json(&[&CONVERTER[..], &["--parameter", "Vin"]].concat(), 0);
    let own = branch["bifurcations"][0]["value"].to_string();
    assert!(rows.iter().any(|it| it[2] == own && it[3] == "22"), "{own} {csv}");
}

#[test]
fn a_second_parameter_is_refused_where_it_does_not_fit() {
    let with = |more: &[&'static str]| [&CONVERTER[..], &["--parameter", "Vin"], more].concat();
    refused(&with(&["--second", "R"]), &["--second R", "--second-range LO,HI"]);
    refused(&with(&["--second-range", "1,2"]), &["--second-range 1,2", "--second NAME"]);
    let range = |name: &'static str, range: &'static str| {
        with(&["--second", name, "--second-range", range])
    };
    refused(&range("mass", "1,2"), &["--second", "mass", "gain"]);
    refused(&range("Vin", "1,2"), &["--second Vin", "another"]);
    refused(&range("R", "23,30"), &["--second-range 23,30", "22"]);
    refused(&range("L", "0,1"), &["--second-range 0,1"]);
    let set = ["--second", "R", "--second-range", "20,30", "--format", "csv", "--show", "v"];
    refused(&with(&set), &["--show v"]);
    refused(&with(&["--format", "csv"]), &["--format csv", "--second"]);
}

#[test]
fn bad_input_is_one_line() {
    refused(&["orbit"], &["--period"]);
    refused(&["orbit", "--period", "0"], &["--period", "0", "1 to 10000"]);
    refused(&["orbit", "--period", "-1"], &["--period", "-1", "1 to 10000"]);
    refused(&["orbit", "--period", "2", "--p", "nan"], &["--p nan"]);
    refused(&["orbit", "--period", "2", "--output", "orbit.csv"], &["--output", "csv", "json"]);
    let follow = ["continue", "--period", "1", "--parameter"];
    let with = |more: &[&'static str]| [&follow[..], more].concat();
    refused(&with(&["mass", "--from", "1", "--to", "2"]), &["--parameter", "mass", "omega"]);
    refused(&with(&["xi", "--from", "0.1", "--to", "0"]), &["--to 0 is", "1e-8 <= xi"]);
    refused(&with(&["xi", "--from", "-1", "--to", "0.1"]), &["--from", "-1", "1e-8"]);
    refused(&with(&["xi", "--from", "0.1", "--to", "nan"]), &["--to nan"]);
}

#[test]
fn an_orbit_that_is_not_reached_is_exit_1_with_a_reason() {
    let (orbit, said) = json(&["orbit", "--period", "3", "--b=-0.1", "--p=-1"], 1);
    assert!(said.contains("no orbit") && said.lines().count() == 1, "{said}");
    assert_eq!((&orbit["converged"], &orbit["points"]), (&false.into(), &serde_json::json!([])));
}
