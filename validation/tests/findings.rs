//! docs/FINDINGS.md: its commands choose rows that exist, and its programs are as it describes.

use percuss_validation::case::Cases;
use percuss_validation::engine::all;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What the page promises of each program.
const MOST_LINES: usize = 40;
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
    let cases = Cases::embedded().unwrap();
    let cases: BTreeSet<String> = cases.names().map(str::to_owned).collect();
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
    let page = read("docs/FINDINGS.md");
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let folder = root().join("docs/findings/examples");
    let mut programs = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = read(&path);
        assert!(text.lines().count() <= MOST_LINES, "{name} has over {MOST_LINES} lines");
        assert!(page.contains(&format!("--example {name}`")), "{name} is not on the page");
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
