//! The JSON of `bench`, held to its schemas.

use super::{assert_valid, json};
use crate::support::stdout;
use serde_json::Value;

#[test]
fn bench() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let cases = ["-c", "^impact-into", "-c", "^never-returns$"];
    let chosen = [
        "bench",
        "-e",
        "^(ode_solvers-dop|differential-equations-rkv655e)",
        "--rounds",
        "2",
        "--out",
        &out,
    ];
    stdout(&[&chosen[..], &cases].concat());
    let bench = json(&std::fs::read_to_string(folder.path().join("bench.json")).expect("read"));
    assert_valid("bench.schema.json", &bench);
    let rows = bench["results"].as_array().cloned().unwrap_or_default();
    let of = |case: &str, engine: &str| {
        let own = rows.iter().filter(move |row| row["case"] == case && row["engine"] == engine);
        own.cloned().collect::<Vec<_>>()
    };
    // The exact solver is there unasked, and the unit.
    let exact = of("impact-into-progression", "exact");
    assert_eq!(exact.len(), 1);
    assert_eq!(exact[0]["ratio_to_exact"], 1.0);
    assert_eq!(exact[0]["tolerance"], Value::Null);
    // A decade of tolerance a row; one of them is its most accurate.
    let decades = of("impact-into-progression", "ode_solvers-dopri5");
    assert_eq!(decades.len(), 12);
    assert_eq!(decades.iter().filter(|row| row["most_accurate"] == true).count(), 1);
    // The same work-precision curve on every row of an engine; the exact solver is its own unit at
    // any error.
    for key in ["ratio_at_1e-6", "ratio_at_1e-9", "ratio_at_comparable_error"] {
        assert!(decades.iter().all(|row| row[key] == decades[0][key]), "{key}");
        assert_eq!(exact[0][key], 1.0);
    }
    // Dearer at a smaller error, and at most what the settings around it take.
    let ratio = |key: &str| decades[0][key].as_f64().expect("its curve reaches it");
    assert!(ratio("ratio_at_1e-6") <= ratio("ratio_at_1e-9"));
    let accurate = decades.iter().filter(|row| row["state_error_max"].as_f64() <= Some(1e-9));
    let least = accurate.filter_map(|row| row["ratio_to_exact"].as_f64()).reduce(f64::min);
    assert!(Some(ratio("ratio_at_1e-9")) <= least);
    // What the harness adds can be told of every engine that is right somewhere; its search for
    // events is most of what it adds.
    let share = |row: &Value| row["harness_share"].as_f64();
    assert!(
        rows.iter().filter(|row| row["ns_per_period"].is_number()).all(|it| share(it).is_some())
    );
    // Net ratios are the gross ones without that share; the exact solver is the unit of both.
    for row in rows.iter().filter(|row| row["ns_per_period"].is_number()) {
        let number = |key: &str| row[key].as_f64().expect("a number");
        let is_unit = row["engine"] == "exact";
        let taken_off = if is_unit { 0.0 } else { number("harness_share").max(0.0) };
        let net = number("ratio_to_exact") * (1.0 - taken_off);
        assert!((number("net_ratio_to_exact") / net - 1.0).abs() < 1e-12, "{row}");
        assert!(row["harness_share_spread"].is_number(), "{row}");
    }
    for key in ["net_ratio_at_1e-6", "net_ratio_at_1e-9", "net_ratio_at_comparable_error"] {
        assert_eq!(exact[0][key], 1.0);
        let gross = &key["net_".len()..];
        assert!(decades[0][key].as_f64() <= decades[0][gross].as_f64(), "{key}");
    }
    // One time of an event: that of the run.
    let event = bench["events"][0].clone();
    let (entry, number) = (&bench["cases"][0], |it: &Value| it.as_f64().expect("a number"));
    assert_eq!(event["case"], entry["case"]);
    let ns =
        number(&exact[0]["ns_per_period"]) * number(&entry["periods"]) / number(&entry["events"]);
    assert_eq!(number(&event["ns_per_event"]), ns);
    // What is wrong, or dearer than a second, has no time and says why.
    for row in &rows {
        let timed = row["ns_per_period"].is_number();
        assert_eq!(timed, row["why"].is_null(), "{row}");
        assert_eq!(timed, row["ratio_to_exact"].is_number(), "{row}");
        assert!(timed || row["most_accurate"] == false, "{row}");
        assert!(row["state_error_max"].as_f64().is_none_or(|error| error <= 1e-3), "{row}");
    }
    assert!(rows.iter().any(|row| row["why"].is_string()));
    // Each case has its picture; cost against length and xi belongs to the whole.
    for case in ["impact-into-progression", "never-returns"] {
        for ending in ["png", "svg"] {
            for times in ["", "-gross"] {
                let name = format!("work-precision-{case}{times}.{ending}");
                assert!(folder.path().join(name).is_file());
            }
        }
    }
    assert!(!folder.path().join("length.png").exists());
}

#[test]
fn bench_record() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("history.jsonl");
    let history = path.display().to_string();
    let record = ["bench", "record", "--rounds", "1", "--history", &history];
    let table = stdout(&record);
    stdout(&record);
    let text = std::fs::read_to_string(&path).expect("read");
    let lines: Vec<Value> = text.lines().map(json).collect();
    lines.iter().for_each(|line| assert_valid("bench-record.schema.json", line));
    // Appended to, and one row per workload each time.
    assert_eq!(lines.len(), 2 * (table.lines().count() - 1));
    assert!(lines.iter().all(|line| line["percuss"] == env!("CARGO_PKG_VERSION")));
    let picture = folder.path().join("history.png").display().to_string();
    stdout(&["bench", "history", "--history", &history, "--output", &picture]);
    let svg = stdout(&["bench", "history", "--history", &history]);
    assert!(svg.contains("switches/chaos-from-rest"), "{svg}");
}
