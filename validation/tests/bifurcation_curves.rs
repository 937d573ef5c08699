//! `continue SYSTEM --second` beside closed forms: every place of a curve is where they say.

use crate::support::{number, rows, run, text};
use std::f64::consts::PI;

/// A forced decay, whose orbit has the amplitude A/(1 + w^2)^(1/2), and a level that it passes.
const LEVEL: &str = r#"
schema = 1
name = "level"
states = ["x"]
forcing = { omega = "w" }
[parameters]
A = 0.6
h = 0.5
w = 1.0
[[mode]]
name = "on"
equations = ["x' = A*cos - x"]
watch = [{ name = "above", guard = "x > h" }]
[start]
mode = "on"
x = 0
"#;

/// The rows of a curve that is followed to both ends of its window.
fn curve(arguments: &[&str], type_and_event: [&str; 2], known: impl Fn(f64) -> f64) {
    let output = run(&[&["continue"][..], arguments].concat());
    let said = text(&output.stderr);
    assert_eq!((output.status.code(), said.as_str()), (Some(0), ""), "{arguments:?}");
    let places = rows(&text(&output.stdout));
    assert!(places.len() > 10, "{arguments:?}: {} places", places.len());
    for place in &places {
        assert_eq!([&place[0], &place[1], &place[5]], ["0", type_and_event[0], type_and_event[1]]);
        let [parameter, second, error] = [2, 3, 4].map(|it| number(&place[it]));
        let known = known(second);
        assert!((parameter - known).abs() <= error, "{place:?}: {known}");
        // The error's bound is a claim too: a part in 1e10 of a parameter near 1.
        assert!(error < 1e-10, "{place:?}");
    }
}

/// A mass with dry friction begins to stop where A V/F is (U^2 + frequency^-4)^(1/2): Den Hartog,
/// Trans. ASME 53 (1931) 107. There it slips again in the instant of its stop.
#[test]
fn the_curve_of_a_corner_is_den_hartogs() {
    let start = ["dry-friction-oscillator", "--mode", "right", "--at", "t=0", "--transient", "100"];
    let branch = ["--parameter", "A", "--from", "1.3", "--to", "1.222", "--period", "1"];
    let second = ["--set", "frequency=0.8", "--second", "frequency", "--second-range", "0.8,0.82"];
    curve(&[&start[..], &branch, &second].concat(), ["corner", "stop@left"], |frequency| {
        let (v, angle) = (1.0 / (1.0 - frequency * frequency), PI / frequency);
        let u = angle.sin() / (frequency * (1.0 + angle.cos()));
        u.hypot(frequency.powi(-2)) / v
    });
}

/// A watched level is passed from an amplitude on that is the level.
#[test]
fn the_curves_of_an_event_that_is_gained_and_lost_are_where_a_level_is_reached() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("level.system.toml");
    std::fs::write(&path, LEVEL).expect("written");
    let start = [path.to_str().expect("UTF-8"), "--transient", "5", "--parameter", "A"];
    let amplitude = |level: f64, w: f64| level * w.hypot(1.0);
    // A curve soon leaves these windows: each of its places takes some tenths of a second.
    let up = ["--from", "0.6", "--to", "0.712", "--period", "1", "--second", "w"];
    let flags = [&start[..], &up, &["--second-range", "1,1.1"]].concat();
    curve(&flags, ["event-gained", "above@on"], |w| amplitude(0.5, w));
    let down = ["--from", "0.72", "--to", "0.6", "--period", "1", "--second", "h"];
    let flags = [&start[..], &down, &["--second-range", "0.5,0.6"]].concat();
    curve(&flags, ["event-lost", "above@on"], |h| amplitude(h, 1.0));
}

/// At p = 0 every motion of x' = p x + cos t is periodic: the branch goes on, unstable.
#[test]
fn a_multiplier_that_passes_one_without_a_turn_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("line.system.toml");
    let system = "schema = 1\nname = \"line\"\nstates = [\"x\"]\nforcing = { omega = 1 }\n\
                  [parameters]\np = -1\n[[mode]]\nname = \"on\"\n\
                  equations = [\"x' = p*x + cos\"]\n[start]\nmode = \"on\"\nx = 0\n";
    std::fs::write(&path, system).expect("it is written");
    let path = path.to_str().expect("a name");
    let ends = ["--parameter", "p", "--from", "-1", "--to", "0.97", "--period", "1"];
    let output = run(&[&["continue", path, "--transient", "20"][..], &ends].concat());
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(text(&output.stdout).contains("\"bifurcations\": []"));
    assert_eq!(said.lines().count(), 1, "{said}");
    let between = said.split_once(": between ").expect(&said).1;
    let [from, to] = [0, 2].map(|n| number(between.split(' ').nth(n).expect("a number")));
    assert!(from < 0.0 && to > 0.0, "{said}");
}
