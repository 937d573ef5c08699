//! The JSON that the program writes, held to the schemas of the repository.

use crate::support;
use crate::support::{run, stdout, text};
use serde_json::Value;
use std::path::Path;

mod bench;
mod system_file;

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

fn assert_valid(schema: &str, value: &Value) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas").join(schema);
    let schema = json(&std::fs::read_to_string(path).expect("read"));
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let errors: Vec<_> = validator
        .iter_errors(value)
        .take(5)
        .map(|error| format!("{error} at {}", error.instance_path))
        .collect();
    assert!(errors.is_empty(), "{errors:?}");
}

#[test]
fn simulate() {
    for more in [&["--samples", "8"][..], &["--phase", "no-contact"], &["--cycle", "100000000"]] {
        let arguments = [&["simulate", "--periods", "20", "--format", "json"], more].concat();
        let value = json(&stdout(&arguments));
        assert_valid("simulate.schema.json", &value);
        assert_eq!(value["percuss"], env!("CARGO_PKG_VERSION"));
        assert_eq!(value.get("undecidable"), None);
    }
}

/// A mass thrown up to where the gap closes to nothing, exactly: half of it by a speed of 1 against
/// a force of 1.
#[test]
fn simulate_counts_touches_that_rounding_does_not_decide() {
    let touch = "simulate --until 3 --a 0 --b=-1 --g 0 --p=-0.5 --y 1 --q 0 --format json";
    for more in ["", " --samples 4"] {
        let line = format!("{touch}{more}");
        let output = run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(0));
        let value = json(&text(&output.stdout));
        assert_valid("simulate.schema.json", &value);
        let count = value["undecidable"].as_u64().expect("a number");
        assert!(count > 0);
        let said = text(&output.stderr);
        assert!(said.contains(&format!("percuss: {count} touch")), "{said}");
    }
    // A little lower it passes below.
    let line = touch.replace("-0.5", "-0.5000001");
    let output = run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(json(&text(&output.stdout)).get("undecidable"), None);
    assert!(!text(&output.stderr).contains("touch"));
}

#[test]
fn the_instant_of_a_late_row_keeps_its_digits() {
    let late =
        json(&stdout(&["simulate", "--events", "9", "--cycle", "100000000", "--format", "json"]));
    let early = json(&stdout(&["simulate", "--events", "9", "--format", "json"]));
    let rows = |value: &Value| value["rows"].as_array().cloned().unwrap_or_default();
    assert_eq!(rows(&late).len(), 10);
    for (late, early) in rows(&late).iter().zip(rows(&early)) {
        for key in ["p", "y", "q", "v", "angle", "phase"] {
            assert_eq!(late[key], early[key]);
        }
        assert_eq!(
            late["cycle"].as_i64(),
            early["cycle"].as_i64().map(|cycle| cycle + 100_000_000)
        );
    }
}

#[test]
fn engines() {
    let value = json(&stdout(&["engines", "--format", "json"]));
    assert_valid("engines.schema.json", &value);
    let csv = stdout(&["engines"]);
    assert!(
        csv.starts_with("name,library,version,method,events,available\nexact,percuss,"),
        "{csv}"
    );
    assert_eq!(csv.lines().count(), 1 + value["engines"].as_array().map_or(0, Vec::len));
}

#[test]
fn systems() {
    let value = json(&stdout(&["systems", "--format", "json"]));
    assert_valid("systems.schema.json", &value);
    let csv = stdout(&["systems"]);
    assert!(
        csv.starts_with("name,states,modes,events,trouble,source\nbouncing-ball,x v,"),
        "{csv}"
    );
    assert_eq!(csv.lines().count(), 1 + value["systems"].as_array().map_or(0, Vec::len));
}

#[test]
fn events_of_a_system() {
    let ball = ["events", "bouncing-ball", "--format", "json"];
    let value = json(&stdout(&[&ball[..], &["--events", "3"]].concat()));
    assert_valid("events.schema.json", &value);
    assert_eq!(value["rows"][3]["state"]["v"], "0.18750000000000000");
    assert!(value["accumulation"].is_null());
    let output = run(&[&ball[..], &["--until", "9"]].concat());
    let value = json(&text(&output.stdout));
    assert_valid("events.schema.json", &value);
    assert!(value["accumulation"]["latest"].as_str().is_some_and(|it| it.starts_with('3')));
    let value = json(&stdout(&[&ball[..], &["--until", "1", "--samples", "2"]].concat()));
    assert_valid("events.schema.json", &value);
    assert_eq!(value["rows"][1]["state"]["x"], "0.50000000000000000");
    let output =
        run(&["events", "relay-feedback", "--until", "9", "--max-events", "2", "--format", "json"]);
    let value = json(&text(&output.stdout));
    assert_valid("events.schema.json", &value);
    assert_eq!(value["rows"][3]["event"], "stopped");
}

#[test]
fn gradients_of_a_system() {
    let ball = ["gradient", "bouncing-ball", "--format", "json", "--wrt"];
    let value = json(&stdout(&[&ball[..], &["g,e", "--until", "2"]].concat()));
    assert_valid("gradient.schema.json", &value);
    assert_eq!((&value["ending"], &value["rows"][2]["wrt"]), (&"end".into(), &"g".into()));
    assert_eq!(value["rows"][2]["dtime"], "-0.75000000000000000");
    let output = run(&[&ball[..], &["start.x", "--events", "2"]].concat());
    let value = json(&text(&output.stdout));
    assert_valid("gradient.schema.json", &value);
    assert!(value["ending"].is_null() && value["rows"][1]["dtime"].is_null());
}

#[test]
fn a_run_of_a_system() {
    let ball = ["simulate", "bouncing-ball", "--format", "json"];
    let value = json(&stdout(&[&ball[..], &["--events", "3"]].concat()));
    assert_valid("simulate-system.schema.json", &value);
    assert_eq!(value["rows"][3]["state"]["v"], 0.1875);
    assert!(value["accumulation"].is_null() && value.get("undecidable").is_none());
    let value = json(&text(&run(&[&ball[..], &["--until", "9"]].concat()).stdout));
    assert_valid("simulate-system.schema.json", &value);
    let [earliest, latest] =
        ["earliest", "latest"].map(|it| value["accumulation"][it].as_f64().expect("a number"));
    assert!(earliest <= 3.0 && 3.0 <= latest && latest - earliest < 1e-6, "{earliest} {latest}");
    let value = json(&stdout(&[&ball[..], &["--until", "1", "--samples", "2"]].concat()));
    assert_valid("simulate-system.schema.json", &value);
    assert_eq!(value["rows"][1]["state"]["x"], 0.5);
}

#[test]
fn cases() {
    let value = json(&stdout(&["cases", "--format", "json"]));
    assert_valid("cases.schema.json", &value);
    let all = percuss_validation::case::embedded().expect("the cases are read");
    let listed = value["cases"].as_array().cloned().unwrap_or_default();
    let names: Vec<_> = listed.iter().map(|it| it["name"].as_str().unwrap_or_default()).collect();
    let mut embedded: Vec<_> = all.iter().map(|it| it.name.as_str()).collect();
    embedded.sort_unstable();
    assert_eq!(names, embedded, "every case once, in the order of names");
    let of = |name: &str| listed.iter().find(|it| it["name"] == name).cloned().expect("listed");
    // Table 1 of the paper is 79 events up to tau = 1268 at omega = 0.1.
    let table1 = of("table1-from-rest");
    assert_eq!(table1["events"], 79);
    let periods = table1["periods"].as_f64().expect("a number");
    assert!((periods - 1268.0 * 0.1 / std::f64::consts::TAU).abs() < 1e-12, "{periods}");
    assert_eq!(table1["table"], "reference_data/events/table1-from-rest.csv");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for case in &listed {
        let table = case["table"].as_str().expect("a name");
        let rows = std::fs::read_to_string(root.join(table)).expect("the table is there");
        let rows = rows.lines().filter(|line| !line.starts_with('#')).count();
        // The header, the start and the end are no events.
        assert_eq!(case["events"].as_u64(), Some(rows as u64 - 3), "{}", case["name"]);
    }
    let csv = stdout(&["cases"]);
    assert!(csv.starts_with("name,regime,system,events,periods,table,why\n"), "{csv}");
    assert_eq!(csv::Reader::from_reader(csv.as_bytes()).records().count(), listed.len());
}

#[test]
fn a_case_without_a_table_is_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let case =
        "[case]\nname = \"mine\"\nregime = \"chaos\"\nwhy = \"a test\"\n[horizon]\nperiods = 3\n";
    std::fs::write(folder.path().join("mine.toml"), case).expect("written");
    let cases = folder.path().display().to_string();
    let value = json(&stdout(&["cases", "--cases", &cases, "--format", "json"]));
    assert_valid("cases.schema.json", &value);
    let run = support::rows(&stdout(&["simulate", "--periods", "3"]));
    // Neither the start nor the end is an event.
    assert_eq!(value["cases"][0]["events"].as_u64(), Some(run.len() as u64 - 2));
    assert_eq!(value["cases"][0]["table"], "");
    assert_eq!(value["cases"][0]["periods"], 3.0);
}

#[test]
fn lyapunov() {
    for more in [&["--omega", "1.4"][..], &["--b", "-0.1"], &["--b", "1.5"], &["--periods", "1"]] {
        let usual = ["lyapunov", "--transient", "20", "--periods", "40"];
        let arguments = if more[0] == "--periods" {
            [&usual[..3], more].concat()
        } else {
            [&usual[..], more].concat()
        };
        let output = run(&arguments);
        assert!(output.status.success(), "{arguments:?}");
        let value = json(&text(&output.stdout));
        assert_valid("lyapunov.schema.json", &value);
    }
}

#[test]
fn attractors() {
    let usual = ["attractors", "--grid", "6x5", "--window", "-1,1,-1,1", "--transient", "40"];
    let regimes =
        [&["--xi", "0.1", "--omega", "1.6"][..], &["--omega", "0.1"], &["--b=-0.1"], &["--b=1.5"]];
    for more in regimes {
        let text = stdout(&[&usual[..], more].concat());
        let value = json(&text);
        assert_valid("attractors.schema.json", &value);
        // One line a point.
        let points = value["attractors"].as_array().expect("a list").iter();
        let points: usize = points.map(|it| it["points"].as_array().map_or(0, Vec::len)).sum();
        let is_point = |line: &&str| {
            let line = line.trim().trim_end_matches(',');
            line.starts_with('[') && line.ends_with(']') && line.matches(", ").count() == 2
        };
        assert!(text.lines().filter(is_point).count() >= points, "{text}");
        let shares = value["attractors"].as_array().expect("a list").iter();
        let shares: f64 = shares.map(|it| it["fraction"].as_f64().expect("a share")).sum();
        let all = shares + value["unresolved"].as_f64().expect("a share");
        assert!((all - 1.0).abs() < 1e-12, "{all}");
    }
}

#[test]
fn ranking() {
    let text = stdout(&["validate", "-c", "^no-gap$", "-e", "exact|dopri5$", "--format", "json"]);
    assert_valid("ranking.schema.json", &json(&text));
}

#[test]
fn report() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    stdout(&["validate", "-c", "^graze", "-c", "table1", "--out", &out]);
    let report = json(&std::fs::read_to_string(folder.path().join("report.json")).expect("read"));
    assert_valid("report.schema.json", &report);
    let results = report["results"].as_array().cloned().unwrap_or_default();
    let csv = std::fs::read_to_string(folder.path().join("errors.csv")).expect("read");
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let columns: Vec<_> = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    let rows: Vec<_> = reader.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), results.len());
    let column = |name: &str| columns.iter().position(|column| column == name).expect("the column");
    for (row, result) in rows.iter().zip(&results) {
        assert_eq!(result["case"], row[column("case")]);
        let error = result["state_error"]["max"].as_f64();
        // What is `null` in one is `nan` in the other.
        let flat = row[column("state_error_max")].parse().ok().filter(|it: &f64| it.is_finite());
        assert_eq!(error, flat);
        assert_eq!(result["events_missed"].as_u64(), row[column("events_missed")].parse().ok());
    }
}

/// stdout as JSON of a run that ends with `code`; what it says on stderr is not looked at.
fn json_of(arguments: &[&str], code: i32) -> Value {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    json(&text(&output.stdout))
}

#[test]
fn orbit() {
    let found = json_of(&["orbit", "--period", "4", "--xi", "0.1"], 0);
    assert_valid("orbit.schema.json", &found);
    assert_eq!(found["points"].as_array().map(Vec::len), Some(4));
    assert_eq!(found["multipliers"].as_array().map(Vec::len), Some(3));
    let none = json_of(&["orbit", "--period", "2", "--b=-0.1"], 1);
    assert_valid("orbit.schema.json", &none);
    assert_eq!(none["converged"], false);
}

#[test]
fn orbit_of_a_system() {
    let relay = ["orbit", "relay-feedback", "--section", "switch-up", "--period"];
    let found = json_of(&[&relay[..], &["2"]].concat(), 0);
    assert_valid("orbit-system.schema.json", &found);
    assert_eq!((&found["period"], &found["stable"]), (&1.into(), &true.into()));
    assert_eq!(found["events"], serde_json::json!(["switch-down@up", "switch-up@down"]));
    // Impacts that accumulate have no orbit.
    let ball = ["orbit", "bouncing-ball", "--section", "impact", "--period", "1"];
    let none = json_of(&[&ball[..], &["--transient", "90"]].concat(), 1);
    assert_valid("orbit-system.schema.json", &none);
    assert_eq!(none["converged"], false);
    let all = ["--all", "--grid", "3x3", "--window=-1,1,-1,1", "--axes", "x1,x3"];
    let found = json_of(&[&relay[..], &["1"], &all[..]].concat(), 0);
    assert_valid("orbit-system.schema.json", &found);
    assert_eq!(found["orbits"].as_array().map(Vec::len), Some(1));
    let ball = [&ball[..], &["--all", "--grid", "2x2", "--window", "0,1,-1,1"]].concat();
    let none = json_of(&ball, 1);
    assert_valid("orbit-system.schema.json", &none);
    assert_eq!(none["orbits"], serde_json::json!([]));
}

#[test]
fn branch_of_a_system() {
    let stop = ["continue", "rigid-impact-oscillator", "--transient", "300", "--period", "1"];
    let to_the_stop = ["--parameter", "A", "--from", "0.5", "--to", "0.6"];
    let found = json_of(&[&stop[..], &to_the_stop].concat(), 0);
    assert_valid("continue-system.schema.json", &found);
    assert_eq!((&found["complete"], &found["period"]), (&true.into(), &1.into()));
    let buck = ["continue", "buck-converter", "--section", "clock", "--transient", "200"];
    let doubles = ["--parameter", "Vin", "--from", "24", "--to", "25", "--period", "1"];
    let found = json_of(&[&buck[..], &doubles].concat(), 0);
    assert_valid("continue-system.schema.json", &found);
    assert_eq!(found["bifurcations"][0]["type"], "flip");
    let second = ["--second", "R", "--second-range", "21.9,22.1", "--format", "json"];
    let curves = json_of(&[&buck[..], &doubles, &second].concat(), 0);
    assert_valid("continue-second.schema.json", &curves);
    assert_eq!(curves["curves"][0]["endings"], serde_json::json!(["left", "left"]));
    // Impacts that accumulate have no orbit.
    let ball = ["continue", "bouncing-ball", "--section", "impact", "--transient", "90"];
    let varied = ["--parameter", "g", "--from", "1", "--to", "2", "--period", "1"];
    let none = json_of(&[&ball[..], &varied].concat(), 1);
    assert_valid("continue-system.schema.json", &none);
    assert_eq!(none["complete"], false);
}

#[test]
fn exponents_of_a_system() {
    let of = |system: &str, section: &str| {
        let words = ["lyapunov", system, "--section", section, "--transient", "30", "--returns"];
        let value = json_of(&[&words[..], &["60"]].concat(), 0);
        assert_valid("lyapunov-system.schema.json", &value);
        value
    };
    let relay = of("relay-feedback", "switch-up");
    // One of a motion without forcing is zero, to the roundings of sixty returns.
    let first = relay["exponents_per_time"][0].as_f64().expect("a number");
    assert!(first.abs() < 1e-12, "{first}");
    let ball = of("bouncing-ball", "impact");
    assert_eq!(ball["mean_return_time"], Value::Null);
}

#[test]
fn attractors_of_a_system() {
    let words = ["attractors", "rigid-impact-oscillator", "--set", "zeta=0.2", "--transient", "50"];
    let grid = ["--grid", "4x3", "--window", "-1,0.4,-1,1", "--format", "json"];
    let found = json_of(&[&words[..], &grid].concat(), 0);
    assert_valid("attractors-system.schema.json", &found);
    // One of four columns lies beyond the stop.
    assert_eq!(found["inadmissible"], 0.25);
    assert_eq!(found["unresolved"], 0.0, "{found}");
    let balls = ["attractors", "bouncing-ball", "--section", "impact", "--transient", "50"];
    let found = json_of(&[&balls[..], &grid].concat(), 0);
    assert_valid("attractors-system.schema.json", &found);
}

#[test]
fn follow() {
    let interval = ["continue", "--parameter", "omega", "--xi", "0.1", "--from", "1.6"];
    let six = [&interval[..], &["--to", "1.56", "--period", "6", "--doubled"]].concat();
    let branch = json_of(&six, 0);
    assert_valid("continue.schema.json", &branch);
    assert_eq!(branch["complete"], true);
    assert_eq!(branch["doubled"]["criticality"], "supercritical");
    let five = [&interval[..], &["--to", "1.7", "--period", "5"]].concat();
    let turned = json_of(&five, 1);
    assert_valid("continue.schema.json", &turned);
    assert_eq!(turned["complete"], false);
    let none = ["continue", "--parameter", "b", "--from=-0.2", "--to=-0.1", "--period", "1"];
    let none = json_of(&none, 1);
    assert_valid("continue.schema.json", &none);
    assert_eq!(none["branch"].as_array().map(Vec::len), Some(0));
}

#[test]
fn sweep_status() {
    let folder = tempfile::tempdir().expect("a folder");
    let plan = folder.path().join("plan.toml");
    let plan_text = "[sweep]\nverb = \"lyapunov\"\nshards = 3\n[fixed]\ntransient = 1\nperiods = 2\n\
                [[axis]]\nparameter = \"b\"\nfrom = 0.1\nto = 0.2\nsteps = 5\n";
    std::fs::write(&plan, plan_text).expect("written");
    let (plan, out) = (plan.display().to_string(), folder.path().join("out"));
    let words = |step: &'static str| ["sweep", step, "--plan", &plan, "--out"].map(str::to_owned);
    let status = |code: i32| {
        let words = [&words("status")[..], &[out.display().to_string()]].concat();
        let output = run(&words.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(code));
        let value = json(&text(&output.stdout));
        assert_valid("sweep-status.schema.json", &value);
        value
    };
    assert_eq!(status(1)["seconds_to_end"], Value::Null);
    let words = [&words("run")[..], &[out.display().to_string()]].concat();
    stdout(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(status(0)["complete"], true);
    std::fs::write(out.join("00001.shard"), "x").expect("written");
    assert_eq!(status(1)["damaged"][0]["shard"], 1);
}
