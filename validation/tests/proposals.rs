//! A command that lacks flags is told values to begin with, and these are accepted.

use crate::support::{run, text};

/// Verbs of the dynamics that need flags.
const VERBS: [&str; 7] =
    ["poincare", "lyapunov", "bifurcation", "orbit", "continue", "attractors", "basins"];

/// Systems with what their sections need; the first is the impact oscillator.
const SYSTEMS: [&[&str]; 4] = [
    &[],
    &["rigid-impact-oscillator", "--set=d=0.7"],
    &["buck-converter", "--section=clock"],
    &["relay-feedback", "--section=switch-up"],
];

/// The words that the refusal of a command proposes.
fn proposed(words: &[&str]) -> Vec<String> {
    let refused = run(words);
    assert_eq!(refused.status.code(), Some(2), "{words:?}");
    let said = text(&refused.stderr);
    let (_, proposed) = said.split_once("; try ").unwrap_or_else(|| panic!("{words:?}: {said}"));
    proposed.split_whitespace().map(str::to_owned).collect()
}

/// Runs a command with what it is told to try.
fn try_it(words: &[&str]) -> Vec<String> {
    let proposed = proposed(words);
    let all: Vec<&str> = words.iter().copied().chain(proposed.iter().map(String::as_str)).collect();
    let tried = run(&all);
    assert!(matches!(tried.status.code(), Some(0 | 1)), "{all:?}: {}", text(&tried.stderr));
    assert!(!tried.stdout.is_empty(), "{all:?}");
    proposed
}

#[test]
fn what_is_proposed_is_accepted() {
    let folder = tempfile::tempdir().expect("a folder");
    let labels = folder.path().join("labels.npz");
    let labels = format!("--output={}", labels.display());
    for verb in VERBS {
        for system in SYSTEMS {
            let output: &[&str] = if verb == "basins" { &[&labels, "--format=table"] } else { &[] };
            try_it(&[&[verb], system, output].concat());
        }
    }
    for verb in ["simulate", "events", "gradient"] {
        try_it(&[verb, "bouncing-ball"]);
    }
}

#[test]
fn a_system_is_proposed_first() {
    assert_eq!(proposed(&["events"])[0], "bouncing-ball");
}

/// A range lies around the value that `--set` gives, and a window in the axes that are asked for
/// contains the motion: of x'' + 0.2 x' + x = cos 2 t without a stop, an amplitude of 0.33.
#[test]
fn values_are_those_of_the_system() {
    let varied = proposed(&[
        "continue",
        "rigid-impact-oscillator",
        "--set=zeta=0.5",
        "--parameter=zeta",
        "--period=1",
    ]);
    assert_eq!(varied, ["--from", "0.4", "--to", "0.6"]);
    let varied = proposed(&["continue", "--parameter=xi", "--xi=0.1", "--period=1"]);
    assert_eq!(varied, ["--from", "0.08", "--to", "0.12"]);
    let free = ["rigid-impact-oscillator", "--set=d=9", "--set=frequency=2", "--set=zeta=0.1"];
    let window = proposed(&[&["attractors", "--axes=v,x"], &free[..]].concat());
    let ends: Vec<f64> = window[3].split(',').map(|it| it.parse().expect("a number")).collect();
    let [slowest, fastest, least, most] = ends[..] else { panic!("{window:?}") };
    assert!(slowest < -0.66 && fastest > 0.66 && least < -0.33 && most > 0.33, "{window:?}");
    assert!(fastest < 4.0 && most < 2.0, "{window:?}");
}

/// A system that cannot be read has no values to propose.
#[test]
fn no_value_of_a_system_that_is_not_there() {
    let refused = run(&["poincare", "no-such-system"]);
    assert!(!text(&refused.stderr).contains("try"), "{}", text(&refused.stderr));
}
