//! What the verbs of the oscillator say of motions that escape, have not settled, or are not
//! recognised.

use crate::support::{number, refused, rows, run, stdout, text};
use serde_json::Value;
use std::path::Path;

/// An orbit of period 240, which chaos of thousands of periods precedes.
const LONG_ORBIT: [&str; 10] =
    ["--a", "0.42", "--b", "0.18", "--xi", "0.08", "--g", "0.05", "--omega", "0.74"];

/// Values of b on both sides of zero, below which the mass never returns.
const ESCAPES_COMMAND: &str = "bifurcation --a 0.42 --xi 0.08 --g 0.05 --omega 0.9 --parameter b \
                       --from -0.05 --to 0.5 --steps 400 --transient 300 --periods 60";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// stdout and stderr of a run that succeeds.
fn said(arguments: &[&str]) -> (String, String) {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    (text(&output.stdout), text(&output.stderr))
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn values_that_escape_are_left_out_and_counted() {
    for how in ["--carry", "--reset"] {
        let (csv, told) = said(&[&words(ESCAPES_COMMAND)[..], &[how]].concat());
        let shown = rows(&csv);
        // 37 of the 400 values are below zero.
        assert_eq!(shown.len(), (400 - 37) * 60, "{how}");
        assert!(shown.iter().all(|row| number(&row[0]) > 0.0 && number(&row[2]).abs() < 600.0));
        assert!(told.contains("37 of 400 values escape and are left out (first: b = -0.05,"));
        assert_eq!(told.lines().count(), 1, "{told}");
        assert_eq!(told.contains("starts from the last that did not"), how == "--carry");
    }
    let all = ESCAPES_COMMAND.replace("--to 0.5", "--to -0.01");
    let (csv, told) = said(&words(&all));
    assert_eq!(csv, "parameter,n,p,y,q,drift_per_period,drift_standard_error\n");
    assert!(told.contains("400 of 400 values escape"), "{told}");
    // A picture of nothing is one.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("none.png");
    said(&[&words(&all)[..], &["--output", path.to_str().expect("a path")]].concat());
    assert!(path.is_file());
}

#[test]
fn the_drift_of_a_diagram_has_its_error() {
    let line = "bifurcation --omega 0.9 --a 0.42 --parameter b --from 0.2 --to 0.2 --steps 1 \
                --transient 100 --periods 256";
    let row = rows(&stdout(&words(line))).remove(0);
    let run = "lyapunov --omega 0.9 --a 0.42 --b 0.2 --transient 100 --periods 256";
    let found = json(&said(&words(run)).0);
    let [drift, error] = [5, 6].map(|column| number(&row[column]));
    // Two runs of one chaos.
    let other = found["drift_per_period"].as_f64().expect("a drift");
    let others = found["drift_standard_error"].as_f64().expect("an error");
    assert!(error > 0.0 && others > 0.0 && error < 10.0 * others && others < 10.0 * error);
    assert!((drift - other).abs() < 6.0 * (error + others), "{drift} {other}");
}

#[test]
fn a_run_over_the_end_of_a_transient_is_told() {
    let lyapunov = |transient: &str, periods: &str| {
        let length = ["--transient", transient, "--periods", periods];
        let (shown, told) = said(&[&["lyapunov"], &LONG_ORBIT[..], &length].concat());
        (json(&shown), told)
    };
    let (over, told) = lyapunov("500", "64000");
    assert_eq!(over["stationary"], false);
    let (_, proposed) = told.split_once("--transient ").expect("a transient is proposed");
    let proposed: u64 = proposed.split(' ').next().and_then(|it| it.parse().ok()).expect("it");
    assert!((28_000..=40_000).contains(&proposed), "{told}");
    let (settled, told) = lyapunov(&proposed.to_string(), "24000");
    assert_eq!((&settled["stationary"], told.as_str()), (&true.into(), ""));
    let exponent = settled["exponents_per_period"][0].as_f64().expect("a number");
    assert!((exponent + 0.004_213_44).abs() < 1e-6, "{exponent}");
    let (short, told) = lyapunov("500", "31");
    assert_eq!((&short["stationary"], &short["batches"]), (&Value::Null, &4.into()));
    assert!(told.contains("from 32 forcing periods on"), "{told}");
}

fn surveyed(more: &[&str]) -> Value {
    let survey = ["attractors", "--grid", "3x2", "--window", "-1,1,-1,1", "--transient", "200"];
    json(&stdout(&[&survey[..], &LONG_ORBIT, more].concat()))
}

#[test]
fn an_orbit_of_a_long_period_is_found() {
    let found = surveyed(&[]);
    let orbit = &found["attractors"][0];
    assert_eq!((&orbit["kind"], &orbit["period"]), (&"periodic".into(), &240.into()));
    assert_eq!((&orbit["fraction"], &orbit["drift_standard_error"]), (&1.0.into(), &Value::Null));
    let exponent = orbit["lyapunov_per_period"].as_f64().expect("a number");
    assert!((exponent + 0.004_213_44).abs() < 1e-6, "{exponent}");
    assert_eq!(found["unresolved_examples"], serde_json::json!([]));
}

#[test]
fn starts_that_are_not_recognised_are_described() {
    let found = surveyed(&["--max-period", "239"]);
    assert_eq!(found["unresolved"], 1.0);
    let examples = found["unresolved_examples"].as_array().expect("a list");
    let first: Vec<_> = examples.iter().map(|it| &it["point"]).collect();
    // The first, the middle and the last of the six cells' centres.
    let cell = |p: f64, y: f64| (p, y);
    let centres = [cell(-2.0 / 3.0, -0.5), cell(2.0 / 3.0, -0.5), cell(2.0 / 3.0, 0.5)];
    for (point, (p, y)) in first.iter().zip(centres) {
        let near = |i: usize, x: f64| (point[i].as_f64().expect("a number") - x).abs() < 1e-12;
        assert!(near(0, p) && near(1, y), "{point}");
    }
    assert_eq!(examples.len(), 3);
    for it in examples {
        assert_eq!(it["recurrence"], Value::Null);
    }
    // Chaos that has not ended after 3,000 periods.
    let chaotic = |it: &Value| it["lyapunov_per_period"].as_f64().is_some_and(|it| it > 0.01);
    assert!(examples.iter().any(chaotic), "{examples:?}");
    let survey = ["attractors", "--grid", "3x2", "--window", "-1,1,-1,1", "--transient", "200"];
    let more = ["--max-period", "239", "--format", "table"];
    let table = stdout(&[&survey[..], &LONG_ORBIT, &more].concat());
    assert_eq!(table.matches("unresolved: p = ").count(), 3, "{table}");
    assert!(table.contains("does not repeat within 239 periods"), "{table}");
}

/// Next to a flip an orbit of period six attracts too slowly to be recognised.
#[test]
fn a_start_that_repeats_but_is_not_seen_to_attract_says_so() {
    let line = "attractors --xi 0.1 --omega 1.57 --grid 20x20 --window -3,1.2,-1.5,1.5 \
                --transient 400";
    let found = json(&stdout(&words(line)));
    let share = found["unresolved"].as_f64().expect("a share");
    assert!(share > 0.01 && share < 0.1, "{share}");
    let examples = found["unresolved_examples"].as_array().expect("a list");
    assert!(examples.iter().any(|it| it["recurrence"].as_u64().is_some_and(|it| it % 6 == 0)));
}

#[test]
fn all_orbits_of_a_scan_are_listed() {
    let orbit = ["orbit", "--xi", "0.1", "--omega", "1.6", "--period", "6"];
    let (shown, told) = said(&[&orbit[..], &["--all"]].concat());
    assert_eq!(told, "");
    let found = json(&shown);
    let orbits = found["orbits"].as_array().expect("a list");
    let six = orbits.iter().filter(|it| it["period"] == 6).count();
    assert!(six == 3 && orbits.iter().filter(|it| it["stable"] == true).count() >= 1);
    let (one, told) = said(&orbit);
    assert!(told.contains("3 orbits of period 6") && told.contains("--all"), "{told}");
    assert_eq!(json(&one)["points"], orbits[0]["points"]);
    let (table, told) = said(&[&orbit[..], &["--format", "table"]].concat());
    assert_eq!((table.lines().count(), told.as_str()), (1 + orbits.len(), ""));
    assert!(table.lines().all(|line| line.len() <= 100), "{table}");
    refused(&[&orbit[..], &["--all", "--p", "0.1"]].concat(), &["--all", "guess"]);
    let none = run(&["orbit", "--b=-0.1", "--period", "2", "--all"]);
    assert_eq!(none.status.code(), Some(1));
    assert_eq!(json(&text(&none.stdout))["orbits"], serde_json::json!([]));
}

#[test]
fn the_flag_of_what_varies_is_refused() {
    let wanted = ["--omega 5", "--parameter omega"];
    let bifurcation = "bifurcation --parameter omega --omega 5 --from 1 --to 2 --steps 2 \
                       --transient 1 --periods 1";
    refused(&words(bifurcation), &wanted);
    refused(&words("continue --parameter omega --omega 5 --from 1 --to 2 --period 1"), &wanted);
}

#[test]
fn a_flag_without_its_value_is_named() {
    let wanted = ["'--periods' for '--omega", "1e-6 <= omega <= 1e6"];
    refused(&["simulate", "--omega", "--periods", "3"], &wanted);
    refused(&["simulate", "--periods", "3", "--a", "--b", "1"], &["'--b' for '--a"]);
    refused(&["poincare", "--transient", "--periods", "3"], &["'--periods' for '--transient"]);
}

#[test]
fn exponents_and_multiples_of_pi_are_numbers() {
    let run = |more: &[&str]| stdout(&[&["simulate"], more].concat());
    assert_eq!(run(&["--periods", "3e0"]), run(&["--periods", "3"]));
    let quarter = format!("{:?}", 0.25 * std::f64::consts::PI);
    for phi in ["pi/4", "0.25*pi", "0.25pi"] {
        assert_eq!(
            run(&["--events", "9", "--phi", phi]),
            run(&["--events", "9", "--phi", &quarter])
        );
    }
    assert_eq!(
        run(&["--events", "5", "--phi=-pi/4"]),
        run(&["--events", "5", "--phi", &format!("-{quarter}")])
    );
    let late = ["--cycle", "1e6", "--events", "3"];
    assert_eq!(run(&late), run(&["--cycle", "1000000", "--events", "3"]));
    refused(&["simulate", "--periods", "1e10"], &["1e10", "0 to 1000000000"]);
    refused(&["simulate", "--periods", "1", "--phi", "pi*2"], &["pi*2", "phi"]);
}

#[test]
fn a_system_in_the_place_of_a_problem_is_told_its_verb() {
    let systems = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems");
    let file = systems.join("bouncing-ball.system.toml").display().to_string();
    for system in [file.as_str(), "bouncing-ball"] {
        let verb = format!("percuss events {system}");
        refused(&["simulate", "--periods", "1", "--problem", system], &["--problem", &verb]);
    }
}

/// In contact for ever, between q = 0.09 and 0.11: it does not rest.
#[test]
fn a_mass_that_oscillates_in_contact_is_not_said_to_rest() {
    let line = "simulate --periods 3 --a 0.01 --b 0.1 --p 0.12 --q 0.1 --samples 8";
    let (shown, told) = said(&words(line));
    let q: Vec<f64> = rows(&shown).iter().map(|row| number(&row[4])).collect();
    let range = q.iter().fold((1.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    assert!(range.1 - range.0 > 0.01, "{range:?}");
    assert!(told.contains("stays on the slider for ever") && !told.contains("rest"), "{told}");
}
