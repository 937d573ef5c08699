//! `orbit`, `poincare` and `lyapunov` of a SYSTEM with `drift`: they close without it, and tell it.

use crate::support::{number, refused, rows, run, stdout, text};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

/// A forced decay x, which settles on (cos t + sin t)/4, and the way s that it and a constant make:
/// from one return to the next x closes, and s gains the constant times 2 pi.
const WALKER: &str = r#"
schema = 1
name = "walker"
states = ["x", "s"]
drift = ["s"]
forcing = { omega = 1 }
[parameters]
A = 0.5
c = 0.25
[[mode]]
name = "on"
equations = ["x' = A*cos - x", "s' = x + c"]
watch = [{ name = "up", guard = "x > 0" }]
[start]
mode = "on"
x = 2
s = 0
"#;

/// The gain of s in a return.
const DRIFT_PER_RETURN: f64 = FRAC_PI_2;

/// Some tens of roundings of a way of at most 20.
const ROUNDING_TOLERANCE: f64 = 1e-13;

/// A decay over 2 pi by exp(-2 pi).
const DECAY_EXPONENT: f64 = -TAU;

fn assert_near(value: f64, known: f64) {
    assert!((value - known).abs() < ROUNDING_TOLERANCE, "{value} {known}");
}

fn run_json(arguments: &[&str], code: i32) -> Value {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Calls with the path of a system that has other words in the place of its key.
fn walking(key: &str, call: impl Fn(&str)) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("walker.system.toml");
    std::fs::write(&path, WALKER.replace("drift = [\"s\"]\n", key)).expect("written");
    call(Path::to_str(&path).expect("UTF-8"));
}

/// Without the key it is found that nothing depends on s.
#[test]
fn an_orbit_closes_without_its_drift() {
    for key in ["drift = [\"s\"]\n", ""] {
        walking(key, |path| {
            let orbit = run_json(&["orbit", path, "--period", "1", "--transient", "5"], 0);
            assert_eq!((&orbit["converged"], &orbit["stable"]), (&true.into(), &true.into()));
            assert_near(orbit["points"][0]["state"][0].as_f64().expect("x"), 0.25);
            assert_near(
                orbit["drift_per_return"]["s"].as_f64().expect("a drift"),
                DRIFT_PER_RETURN,
            );
            let multipliers = orbit["multipliers"].as_array().expect("multipliers");
            assert_eq!(multipliers.len(), 1, "{orbit}");
            assert_near(multipliers[0][0].as_f64().expect("a number"), DECAY_EXPONENT.exp());
            assert_eq!(orbit["events"], serde_json::json!(["up@on"]));
        });
    }
}

#[test]
fn an_orbit_with_a_state_that_is_told_to_be_no_drift_does_not_close() {
    walking("drift = []\n", |path| {
        let orbit = run_json(&["orbit", path, "--period", "1", "--transient", "5"], 1);
        assert_eq!(orbit["converged"], false);
        assert_eq!(orbit["drift_per_return"], serde_json::json!({}));
    });
}

#[test]
fn a_section_shows_the_drift_among_the_states() {
    walking("drift = [\"s\"]\n", |path| {
        let csv = stdout(&["poincare", path, "--transient", "6", "--returns", "4"]);
        assert_eq!(csv.lines().next(), Some("n,time,mode,x,s"));
        let returns = rows(&csv);
        for two in returns.windows(2) {
            assert_near(number(&two[1][3]), 0.25);
            assert_near(number(&two[1][4]) - number(&two[0][4]), DRIFT_PER_RETURN);
        }
        // What x has decayed from its start, 1.75 above the orbit, is gone into s, which begins at
        // 0, where that of the orbit would be: after 6 returns 6 gains.
        assert_near(number(&returns[3][4]), 9.0 * DRIFT_PER_RETURN + 1.75);
    });
}

#[test]
fn exponents_have_the_drift_and_its_error_by_name() {
    walking("drift = [\"s\"]\n", |path| {
        let found = run_json(&["lyapunov", path, "--transient", "10", "--returns", "64"], 0);
        assert_near(found["drift_per_return"]["s"].as_f64().expect("a drift"), DRIFT_PER_RETURN);
        // On an orbit all batches have the same drift.
        assert!(
            found["drift_standard_error"]["s"].as_f64().expect("an error") < ROUNDING_TOLERANCE
        );
        assert_near(found["exponents_per_return"][0].as_f64().expect("a number"), 0.0);
        assert_near(found["exponents_per_return"][1].as_f64().expect("a number"), DECAY_EXPONENT);
    });
    walking("drift = []\n", |path| {
        let found = run_json(&["lyapunov", path, "--transient", "10", "--returns", "64"], 0);
        for key in ["drift_per_return", "drift_standard_error"] {
            assert_eq!(found[key], serde_json::json!({}), "{key}");
        }
    });
}

/// In chaos the error of a drift is that of means: the two runs are of one motion, which their
/// roundings part, and five of their errors are more than chance makes.
#[test]
fn the_oscillators_drift_in_chaos_has_its_error() {
    let counts = ["--transient", "50"];
    let own = run_json(&[&["lyapunov", "--periods", "2000"][..], &counts].concat(), 0);
    let system = ["lyapunov", "percussive-oscillator", "--returns", "2000"];
    let found = run_json(&[&system[..], &counts].concat(), 0);
    let of_own = |key: &str| own[key].as_f64().expect("a number");
    let of_system = |key: &str| found[key]["v"].as_f64().expect("a number");
    let errors = of_own("drift_standard_error").hypot(of_system("drift_standard_error"));
    assert!(errors > 0.0);
    let apart = of_own("drift_per_period") - of_system("drift_per_return");
    assert!(apart.abs() < 5.0 * errors, "{apart} {errors}");
}

#[test]
fn a_state_on_which_something_depends_is_no_drift() {
    walking("drift = [\"x\"]\n", |path| {
        refused(&["orbit", path, "--period", "1"], &["x is no drift", "depends on it", ":5:"]);
    });
}
