//! `export`: what a case asks, as files.

use crate::support::{percuss, refused, run, text};
use percuss_validation::case::embedded;
use percuss_validation::gradients;
use serde_json::Value;
use std::fs;
use std::path::Path;

#[test]
fn what_is_exported_is_as_its_schema_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let output = run(&["export", "--out", &out]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let (cases, differentiated) =
        (embedded().expect("read"), gradients::embedded(|_| true).expect("read"));
    let own = cases.iter().map(|it| it.name.as_str());
    let names: Vec<&str> = own.chain(differentiated.iter().map(|it| it.name.as_str())).collect();
    assert_eq!(text(&output.stdout).lines().count(), names.len());
    let schema = schema();
    let read = |name: &str, ending: &str| {
        fs::read_to_string(folder.path().join(format!("{name}.{ending}"))).expect("written")
    };
    for name in &names {
        let case: Value = serde_json::from_str(&read(name, "json")).expect("JSON");
        assert!(schema.is_valid(&case), "{name}: {:?}", schema.validate(&case).err());
        assert_eq!(case["case"], **name);
        let asked = differentiated.iter().find(|it| it.name == **name);
        let by = |it: &Value| it["wrt"].as_str().map(str::to_owned);
        let given = case["gradients"]["by"].as_array().map(|it| it.iter().filter_map(by).collect());
        assert_eq!(given, asked.map(|it| it.names()), "{name}");
        agree(&case, &read(name, "rows.csv"), &read(name, "start.csv"));
        let times: Vec<f64> = read(name, "sample-times.csv")
            .lines()
            .skip(1)
            .map(|it| it.parse().expect("a time"))
            .collect();
        assert_eq!(serde_json::json!(times), case["sample_times"], "{name}");
        assert_eq!(times.last(), case["horizon"].as_f64().as_ref(), "{name}");
    }
    let files = fs::read_dir(folder.path()).expect("read").count();
    assert_eq!(files, 5 * names.len());
    let equations = read("ball-geometric", "txt");
    assert!(
        equations.contains("  x' = v\n") && equations.contains("x rises through 0"),
        "{equations}"
    );
}

/// The schema of a case, whose modes are those of the protocol's requests.
fn schema() -> jsonschema::Validator {
    let read = |name: &str| -> Value {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas").join(name);
        serde_json::from_str(&fs::read_to_string(path).expect("read")).expect("JSON")
    };
    let request = jsonschema::Resource::from_contents(read("program-request.schema.json"));
    jsonschema::options()
        .with_resource("json-schema:///program-request.schema.json", request.expect("a schema"))
        .build(&read("case.schema.json"))
        .expect("a schema")
}

/// CSV and JSON say the same.
fn agree(case: &Value, rows: &str, start: &str) {
    let list = |value: &Value| value.as_array().cloned().expect("a list");
    let numbers = |cells: &[&str]| -> Vec<Value> {
        cells.iter().map(|it| it.parse::<f64>().expect("a number").into()).collect()
    };
    let mut lines = rows.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    for mode in list(&case["modes"]) {
        for (i, state) in list(&case["states"]).iter().enumerate() {
            let line = lines.next().expect("a rate");
            assert_eq!(
                (mode["name"].as_str(), "rate", state.as_str()),
                (Some(line[0]), line[2], Some(line[3]))
            );
            let row =
                [list(&mode["A"][i]), list(&mode["B"][i]), vec![mode["c"][i].clone()]].concat();
            assert_eq!(numbers(&line[4..]), row);
        }
        for event in list(&mode["events"]) {
            let line = lines.next().expect("a guard");
            assert_eq!(
                (event["name"].as_str(), event["direction"].as_str()),
                (Some(line[1]), Some(line[3]))
            );
            assert_eq!(numbers(&line[4..]), list(&event["guard"]));
            for row in event["reset"].as_array().unwrap_or(&Vec::new()) {
                let line = lines.next().expect("a reset");
                assert_eq!((line[2], numbers(&line[4..])), ("reset", list(row)));
            }
            for successor in list(&event["successors"]) {
                let line = lines.next().expect("a successor");
                let next = successor["mode"].as_u64().expect("a place") as usize;
                assert_eq!(
                    (line[2], Some(line[3])),
                    ("successor", case["modes"][next]["name"].as_str())
                );
                let row = numbers(&line[4..]);
                match successor["when"].as_array() {
                    Some(when) => assert_eq!(row, *when),
                    None => assert_eq!(row.last(), Some(&1.0.into())),
                }
            }
        }
    }
    assert_eq!(lines.next(), None);
    let line: Vec<&str> = start.lines().nth(1).expect("a start").split(',').collect();
    let mode = case["start"]["mode"].as_u64().expect("a place") as usize;
    assert_eq!(Some(line[0]), case["modes"][mode]["name"].as_str());
    let own = [&case["horizon"], &case["parameters"]["omega"], &case["parameters"]["phi"]];
    assert_eq!(numbers(&line[1..4]), own.map(Clone::clone));
    assert_eq!(line[4] == "1", case["backward"] == true);
    assert_eq!(numbers(&line[5..]), list(&case["start"]["state"]));
}

#[test]
fn export_writes_into_the_folder_that_it_is_told() {
    refused(&["export"], &["--out"]);
    refused(&["export", "--out", "/proc/nowhere"], &["--out /proc/nowhere", "accepted is"]);
    refused(&["export", "--out", "x", "-c", "qqqqq"], &["--case qqqqq"]);
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = percuss(&["export", "--out", "new/asked", "-c", "^small-b$"]);
    assert!(command.current_dir(folder.path()).output().expect("it runs").status.success());
    assert!(folder.path().join("new/asked/small-b.json").exists());
}
