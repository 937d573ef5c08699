//! Sweeps of a SYSTEM: the arrays are those of the verb with the system at every point.

use super::{Case, array, numbers};
use crate::support::{number, rows, run, stdout};
use serde_json::Value;
use std::fs;

/// An impact oscillator whose modes are told by the start's place.
const RIG: &str = include_str!("../../../src/affine/gallery/impact_oscillator.system.toml");

/// A plan over two parameters of the rig, of which `[fixed]` sets a third.
fn plan(verb: &str, fixed: &str, shards: u32) -> String {
    format!(
        r#"
[sweep]
verb = "{verb}"
system = "rig.system.toml"
shards = {shards}
[fixed]
set = {{ damping = 0.12 }}
{fixed}
[[axis]]
parameter = "frequency"
from = 2.5
to = 3.0
steps = 3
[[axis]]
parameter = "stop"
from = 0.1
to = 0.3
steps = 2
"#
    )
}

fn case(verb: &str, fixed: &str, shards: u32) -> Case {
    let case = Case::new(&plan(verb, fixed, shards));
    fs::write(case.folder.path().join("rig.system.toml"), RIG).expect("written");
    case
}

/// The points of the plan, as flags of the verb with the system.
fn points(case: &Case) -> Vec<Vec<String>> {
    let system = case.path("rig.system.toml");
    let mut points = Vec::new();
    for frequency in [2.5, 2.75, 3.0] {
        for stop in [0.1, 0.3] {
            let set = [("damping", 0.12), ("frequency", frequency), ("stop", stop)];
            let set = set.map(|(name, value)| format!("--set={name}={value}"));
            points.push([std::slice::from_ref(&system), &set[..]].concat());
        }
    }
    points
}

/// The verb with the system at a point.
fn verb_alone(verb: &str, point: &[String], flags: &str) -> Vec<String> {
    let flags = flags.split_whitespace().map(str::to_owned);
    std::iter::once(verb.to_owned()).chain(point.iter().cloned()).chain(flags).collect()
}

fn json(words: &[String]) -> Value {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    serde_json::from_slice(&run(&words).stdout).expect("JSON")
}

/// The share of an array that belongs to one of six points.
fn share<T>(all: &[T], point: usize) -> &[T] {
    let length = all.len() / 6;
    &all[length * point..length * (point + 1)]
}

/// A number as JSON has it: none where it is not finite.
fn json_number(number: f64) -> Option<f64> {
    Some(number).filter(|it| it.is_finite())
}

fn integers(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks(4).map(|it| i32::from_le_bytes(it.try_into().expect("four bytes"))).collect()
}

#[test]
fn exponents_are_those_of_the_verb_at_every_point_and_for_every_number_of_shards() {
    let fixed = "transient = 20\nreturns = 60";
    let whole = case("lyapunov", fixed, 1);
    whole.done("run", &["--threads", "1"]);
    let merged = whole.merged();
    for shards in [2, 6] {
        let other = case("lyapunov", fixed, shards);
        for shard in (0..shards).rev() {
            other.done("run", &["--shard", &format!("{shard}/{shards}"), "--threads", "2"]);
        }
        assert!(other.merged() == merged, "{shards} shards");
    }
    let (shape, exponents) = array(&merged, "exponents_per_return");
    assert_eq!(shape, [3, 2, 2]);
    assert_eq!(array(&merged, "drift_per_return").0, [3, 2, 0]);
    assert_eq!(array(&merged, "states").0, [2]);
    let (exponents, mean) = (numbers(&exponents), numbers(&array(&merged, "mean_return_time").1));
    // Of one of the six motions impacts accumulate.
    let left_out = integers(&array(&merged, "left_out").1);
    assert_eq!(left_out.iter().filter(|it| **it == -1).count(), 5);
    for (at, point) in points(&whole).iter().enumerate() {
        let json = json(&verb_alone("lyapunov", point, "--transient=20 --returns=60 --quiet"));
        assert_eq!(json["mean_return_time"].as_f64(), json_number(mean[at]), "{point:?}");
        for (k, exponent) in share(&exponents, at).iter().enumerate() {
            assert_eq!(
                json["exponents_per_return"][k].as_f64(),
                json_number(*exponent),
                "{point:?}"
            );
        }
        let has_returned = json["mean_return_time"].is_number();
        assert_eq!(left_out[at] == -1, has_returned, "{point:?}");
    }
}

#[test]
fn labels_and_attractors_are_those_of_the_verbs() {
    let fixed = "grid = \"6x5\"\nwindow = [-1.0, 0.05, -1.0, 1.0]\ntransient = 60";
    let flags = "--grid=6x5 --window=-1,0.05,-1,1 --transient=60 --quiet --format=json";
    let (basins, attractors) = (case("basins", fixed, 2), case("attractors", fixed, 3));
    basins.done("run", &[]);
    attractors.done("run", &[]);
    let (basins_merged, merged) = (basins.merged(), attractors.merged());
    let (shape, labels) = array(&basins_merged, "labels");
    assert_eq!(shape, [3, 2, 5, 6]);
    assert_eq!(array(&basins_merged, "x").0, [6]);
    let (_, meta) = array(&basins_merged, "meta");
    let fraction = numbers(&array(&merged, "fraction").1);
    let exponent = numbers(&array(&merged, "lyapunov_per_return").1);
    let state = numbers(&array(&merged, "state").1);
    let mut seen = 0;
    for (at, point) in points(&basins).iter().enumerate() {
        let output = basins.path("verb.npz");
        let flags = format!("{flags} --output={output}");
        let json = json(&verb_alone("basins", point, &flags));
        let verb = fs::read(&output).expect("read");
        assert_eq!(share(&labels, at), array(&verb, "labels").1, "{point:?}");
        let meta: Value = serde_json::from_slice(share(&meta, at)).expect("JSON");
        assert_eq!(meta, json, "{point:?}");
        let listed = json["attractors"].as_array().expect("a list");
        seen += listed.len();
        for (k, attractor) in listed.iter().enumerate() {
            assert_eq!(attractor["fraction"].as_f64(), Some(share(&fraction, at)[k]), "{point:?}");
            let per_return = attractor["lyapunov_per_return"].as_f64();
            assert_eq!(per_return, json_number(share(&exponent, at)[k]), "{point:?}");
            let x = attractor["points"][0]["state"][0].as_f64();
            assert_eq!(x, Some(share(&state, at)[2 * k]), "{point:?}");
        }
        let more = share(&fraction, at)[listed.len()..].iter();
        assert!(more.copied().all(f64::is_nan), "{point:?}");
    }
    assert!(seen >= 5, "{seen} attractors");
}

/// Each point has a whole diagram, or the last axis is the diagram's parameter.
#[test]
fn diagrams_are_those_of_the_verb_whole_or_along_an_axis() {
    let own = "parameter = \"restitution\"\nfrom = 0.6\nto = 0.8\nsteps = 4\n";
    let whole = case("bifurcation", &format!("{own}transient = 10\nreturns = 3"), 4);
    whole.done("run", &[]);
    let merged = whole.merged();
    let (shape, state) = array(&merged, "state");
    assert_eq!(shape, [3, 2, 4, 3, 2]);
    assert_eq!(array(&merged, "parameter").0, [3, 2, 4]);
    let state = numbers(&state);
    let flags =
        "--parameter=restitution --from=0.6 --to=0.8 --steps=4 --transient=10 --returns=3 --quiet";
    for (at, point) in points(&whole).iter().enumerate() {
        let words = verb_alone("bifurcation", point, flags);
        let csv = stdout(&words.iter().map(String::as_str).collect::<Vec<_>>());
        let expected = rows(&csv).into_iter().flat_map(|row| [number(&row[3]), number(&row[4])]);
        // Rows of values that are left out are not written.
        let found = share(&state, at).iter().copied().filter(|it| !it.is_nan());
        assert_eq!(found.collect::<Vec<_>>(), expected.collect::<Vec<_>>(), "{point:?}");
    }
    let along = case("bifurcation", "reset = true\ntransient = 10\nreturns = 3", 2);
    along.done("run", &[]);
    let merged = along.merged();
    let (shape, along_axis) = array(&merged, "state");
    assert_eq!(shape, [3, 2, 3, 2]);
    let left_out = integers(&array(&merged, "left_out").1);
    assert_eq!(left_out, [-1; 6]);
    let flags = "--parameter=stop --from=0.1 --to=0.3 --steps=2 --transient=10 --returns=3 --reset";
    let words = verb_alone("bifurcation", &points(&along)[0][..3], flags);
    let csv = stdout(&words.iter().map(String::as_str).collect::<Vec<_>>());
    let expected = rows(&csv).into_iter().flat_map(|row| [number(&row[3]), number(&row[4])]);
    assert_eq!(numbers(&along_axis)[..12], expected.collect::<Vec<_>>());
}

#[test]
fn branches_are_those_of_the_verb() {
    let own = "parameter = \"restitution\"\nfrom = 0.7\nto = 0.8\nperiod = 1\ntransient = 200";
    let case = case("continue", own, 2);
    case.done("run", &[]);
    let merged = case.merged();
    let (_, meta) = array(&merged, "meta");
    let time = numbers(&array(&merged, "time").1);
    let flags = "--parameter=restitution --from=0.7 --to=0.8 --period=1 --transient=200 --quiet";
    for (at, point) in points(&case).iter().enumerate() {
        let json = json(&verb_alone("continue", point, flags));
        let meta: Value = serde_json::from_slice(share(&meta, at)).expect("JSON");
        assert_eq!(meta, json, "{point:?}");
        let branch = json["branch"].as_array().expect("a list");
        for (k, place) in branch.iter().enumerate() {
            assert_eq!(place["time"].as_f64(), Some(share(&time, at)[k]), "{point:?}");
        }
        assert!(share(&time, at)[branch.len()..].iter().all(|it| it.is_nan()), "{point:?}");
    }
}

/// A system counts by what is in its file, and its name is enough where it has one.
#[test]
fn an_edited_system_is_another_plan() {
    let case = case("lyapunov", "transient = 5\nreturns = 20", 2);
    case.done("run", &[]);
    let path = case.folder.path().join("rig.system.toml");
    fs::write(&path, RIG.replace("damping*v", "2*damping*v")).expect("written");
    case.refused("run", &[], &["another plan"]);
    let named = plan("lyapunov", "transient = 5\nreturns = 20", 2)
        .replace("rig.system.toml", "dry-friction-oscillator")
        .replace("set = { damping = 0.12 }", "set = [\"A=1.5\"]\nat = { x = 0.25 }");
    let named = named.replace("\"frequency\"", "\"mu\"").replace("\"stop\"", "\"v0\"");
    let case = Case::new(&named);
    case.refused("run", &[], &["mu", "is no parameter"]);
}

/// What is wrong with a plan of a system, and what is said of it.
#[test]
fn plans_of_systems_that_are_refused() {
    let rows: &[(&str, &str, &[&str])] = &[
        (
            "rig.system.toml",
            "rig2.system.toml",
            &["rig2.system.toml", "a name that percuss systems"],
        ),
        ("\"stop\"", "\"stopp\"", &["\"stopp\" is no parameter"]),
        ("damping = 0.12", "stop = 0.12", &["stop is both an axis and in [fixed] set"]),
        ("damping = 0.12", "damp = 0.12", &["\"damp\" is no parameter"]),
        ("returns = 60", "periods = 60", &["--periods 60 is not accepted with SYSTEM"]),
        ("returns = 60", "returns = 60\nxi = 0.1", &["--xi", "the impact oscillator's"]),
        ("returns = 60", "returns = 60\nsection = \"bump\"", &["--section", "bump"]),
        ("returns = 60", "returns = 60\nstart = \"no.toml\"", &["[fixed] start", "no.toml"]),
        ("to = 0.3", "to = inf", &["stop", "to = inf", "finite"]),
        ("system = \"rig.system.toml\"\n", "", &["axis frequency is not accepted", "with system"]),
    ];
    for (from, to, wanted) in rows {
        let text = plan("lyapunov", "transient = 20\nreturns = 60", 2);
        assert!(text.contains(from), "{from}");
        let case = Case::new(&text.replacen(from, to, 1));
        fs::write(case.folder.path().join("rig.system.toml"), RIG).expect("written");
        let wanted: Vec<&str> = wanted.iter().chain(&["--plan"]).copied().collect();
        case.refused("run", &[], &wanted);
    }
}
