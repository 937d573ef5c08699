//! docs/FINDINGS.md: its commands choose rows that exist, and its programs are as it describes.

use crate::maintain::{blocks, systems_table};
use percuss_validation::case::embedded;
use percuss_validation::integrators::all;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The most lines of a program that the page shows, which it promises.
const MAX_LINES: usize = 40;
/// The libraries as crates, of which a program uses one.
const LIBRARIES: [&str; 3] = ["diffsol", "ode_solvers", "differential_equations"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The engine and the case of each command of the page.
fn commands(page: &str) -> Vec<(String, String)> {
    let page = page.replace("\\\n", " ");
    let commands = page.lines().filter(|line| line.starts_with("cargo run --release -- validate "));
    let named = |line: &str, flag: &str| {
        let (_, rest) = line.split_once(&format!("{flag} '^"))?;
        Some(rest.split_once("$'")?.0.to_owned())
    };
    let both = |line: &str| named(line, "-e").zip(named(line, "-c"));
    commands.map(|line| both(line).unwrap_or_else(|| panic!("{line}"))).collect()
}

#[test]
fn every_command_chooses_rows_that_exist() {
    let commands = commands(&read("docs/FINDINGS.md"));
    let engines: BTreeSet<_> = all().iter().map(|it| it.declaration().name.to_owned()).collect();
    let cases = embedded().unwrap();
    let cases: BTreeSet<String> = cases.into_iter().map(|it| it.name).collect();
    for (engine, case) in &commands {
        assert!(engines.contains(engine), "no engine {engine}");
        assert!(cases.contains(case), "no case {case}");
    }
    let shown: BTreeSet<_> = commands.into_iter().map(|it| it.0).collect();
    assert_eq!(shown, engines, "each engine has a finding");
}

#[test]
fn every_engine_is_shown_with_its_librarys_version() {
    let page = read("docs/FINDINGS.md");
    for engine in all().iter().map(|it| it.declaration()).filter(|it| it.library != "percuss") {
        let title = format!("\n### {} ({} {})\n", engine.name, engine.library, engine.version);
        assert!(page.contains(&title), "{title}");
    }
}

#[test]
fn every_program_is_short_shown_and_of_one_library() {
    let page = read("docs/FINDINGS.md") + &read("docs/GRADIENT_FINDINGS.md");
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let folder = root().join("docs/findings/examples");
    let mut programs = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = read(&path);
        assert!(text.lines().count() <= MAX_LINES, "{name} has over {MAX_LINES} lines");
        assert!(page.contains(&format!("--example {name}`")), "{name} is on neither page");
        let used = LIBRARIES.iter().filter(|it| text.contains(&format!("use {it}::"))).count();
        assert!(used == 1 && !text.contains("percuss"), "{name} is not of one library alone");
        programs += 1;
    }
    assert_eq!(page.matches("--release --example ").count(), programs + 1, "a program is missing");
}

#[test]
fn the_programs_are_of_the_libraries_that_the_engines_use() {
    let pins = |path: &str| -> BTreeSet<String> {
        let table: toml::Table = read(path).parse().unwrap();
        let group = ["dependencies", "dev-dependencies"];
        let found = group.iter().filter_map(|name| table.get(*name)?.as_table()).flatten();
        let version = |value: &toml::Value| -> String {
            let value = value.get("version").unwrap_or(value);
            value.as_str().unwrap_or_default().to_owned()
        };
        found
            .filter(|(name, _)| LIBRARIES.contains(&name.replace('-', "_").as_str()))
            .map(|(name, value)| format!("{name} {}", version(value)))
            .collect()
    };
    let (here, there) = (pins("validation/engines/Cargo.toml"), pins("docs/findings/Cargo.toml"));
    assert_eq!(here.len(), LIBRARIES.len());
    assert_eq!(here, there);
}

/// The cells of each line of the page's table of systems by engines.
fn by_engine(page: &str) -> Vec<Vec<String>> {
    let (_, rest) = page.split_once("<!-- begin: systems by engine -->").expect("the table");
    let (table, _) = rest.split_once("<!-- end: systems by engine -->").expect("an end");
    let lines = table.lines().filter_map(|it| it.strip_prefix("| ")?.strip_suffix(" |"));
    lines.map(|line| line.split(" | ").map(str::to_owned).collect()).collect()
}

#[test]
fn the_table_of_systems_has_every_engine_and_every_system_with_all_their_rows() {
    let lines = by_engine(&read("docs/FINDINGS.md"));
    let [head, _, body @ ..] = lines.as_slice() else { panic!("no table") };
    let systems = systems_table::systems().expect("read");
    let named: BTreeSet<_> = systems.values().map(String::as_str).collect();
    assert_eq!(head[1..].iter().map(String::as_str).collect::<BTreeSet<_>>(), named);
    let engines: BTreeSet<_> = all().iter().map(|it| it.declaration().name.to_owned()).collect();
    assert_eq!(body.iter().map(|line| line[0].clone()).collect::<BTreeSet<_>>(), engines);
    for line in body {
        for (system, cell) in head.iter().zip(line).skip(1).filter(|it| it.1 != "\u{2013}") {
            let cases = systems.values().filter(|it| *it == system).count();
            let (counts, rows) = cell.split_once(" of ").expect("rows");
            let rows: usize = rows.parse().expect("a number");
            let counted: usize = counts.split('/').map(|it| it.parse::<usize>().unwrap()).sum();
            // The quick suite has three settings of an integrator, and the exact solver none.
            let settings = if line[0] == "exact" { 1 } else { 3 };
            assert_eq!(rows, settings * cases, "{} on {system}", line[0]);
            assert!(counted <= rows, "{} on {system}: {cell}", line[0]);
        }
    }
}

#[test]
fn rows_are_counted_by_system_and_verdict() {
    let row = |case: &str, verdict: &str| json!({"case": case, "engine": "e", "verdict": verdict});
    let verdicts = ["pass", "pass", "known", "error", "fail", "undecidable", "not-run"];
    let mut rows: Vec<_> = verdicts.iter().map(|it| row("chaos-from-rest", it)).collect();
    rows.push(row("ball-cut-short", "not-run"));
    let systems = systems_table::systems().expect("read");
    let report = json!({"percuss": "1", "commit": null, "suite": "quick", "results": rows});
    let table = systems_table::table(&report, &systems).expect("made");
    let page = "a<!-- begin: systems by engine -->\nold<!-- end: systems by engine -->b";
    let lines = by_engine(&blocks::replaced(page, systems_table::BLOCK, &table).expect("spliced"));
    assert_eq!(lines[0], ["engine", "oscillator", "bouncing-ball"]);
    assert_eq!(lines[2], ["e", "2/1/2 of 7", "\u{2013}"]);
    let unknown = json!({"results": [row("nosuch", "pass")]});
    assert!(systems_table::table(&unknown, &systems).is_err());
}
