//! What the project says of itself is what its program says.

use crate::support;
use percuss_validation::case::embedded;
use percuss_validation::integrators::all;
use percuss_validation::suite::{Suite, SuiteScope, size};
use std::path::{Path, PathBuf};

/// The page of the suite's results.
const RESULTS: &str = "docs/RESULTS.md";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn the_service_runs_what_the_project_shows() {
    assert_eq!(read("CI.yml"), read(".github/workflows/ci.yml"));
}

#[test]
fn ci_runs_the_readmes_commands() {
    let readme = read("README.md");
    assert!(
        readme.contains("\ncargo run --release -- validate ") && readme.contains("\ncargo test\n")
    );
    let ci = read(".ci/run");
    assert!(ci.contains("cargo run --release --locked -- validate --suite quick"));
    assert!(ci.contains("\ncargo test --locked\n"));
}

/// A block between `<!-- begin: cargo run --release -- ARGS -->` and `<!-- end -->` holds, fenced,
/// what ARGS print. `PERCUSS_SPLICE=1 cargo test --test harness project::` writes them anew.
///
/// The last digits of an integrator's error are those of one platform's sine.
#[test]
#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
fn the_blocks_of_the_results_are_what_their_commands_print() {
    const BEGIN: &str = "<!-- begin: cargo run --release -- ";
    const END: &str = "<!-- end -->";
    let results = read(RESULTS);
    let mut spliced = String::new();
    let mut rest = results.as_str();
    let mut blocks = 0;
    while let Some((before, block)) = rest.split_once(BEGIN) {
        let (command, block) = block.split_once(" -->\n").expect("the command's line ends");
        let (_, after) = block.split_once(END).expect("the block ends");
        let arguments: Vec<&str> = command.split(' ').map(|word| word.trim_matches('\'')).collect();
        let printed = support::run(&arguments);
        let printed = support::text(&printed.stdout);
        spliced +=
            &format!("{before}{BEGIN}{command} -->\n```text\n{}\n```\n{END}", printed.trim_end());
        rest = after;
        blocks += 1;
    }
    spliced += rest;
    assert!(blocks > 0, "{RESULTS} has no block");
    if std::env::var_os("PERCUSS_SPLICE").is_some() {
        std::fs::write(root().join(RESULTS), &spliced).expect("the page can be written");
    } else {
        assert_eq!(
            results, spliced,
            "PERCUSS_SPLICE=1 cargo test --test harness project:: makes them equal"
        );
    }
}

/// The block of the bench is written by the commands that docs/LONG_TESTS.md names; times are not
/// asserted. It must be of the cases that are timed today.
#[test]
fn the_speed_table_is_of_todays_cases() {
    let page = read("docs/SPEED.md");
    let (_, block) = page.split_once("<!-- begin: bench -->\n```text\n").expect("a block");
    let (block, _) = block.split_once("```\n<!-- end: bench -->").expect("it ends");
    let lines: Vec<_> = block.lines().collect();
    assert!(lines[0].starts_with("percuss ") && lines[0].contains(" at "), "{}", lines[0]);
    assert!(lines[1].starts_with("floor: "), "{}", lines[1]);
    // Below a blank line are those whose lead is too little.
    let table = lines[3..].iter().take_while(|line| !line.is_empty());
    let cases: Vec<_> = table.filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(cases, percuss_validation::bench::cases::DEFAULT_CASES);
}

/// The summary is written by the command that docs/LONG_TESTS.md names. It must be of a run that
/// was clean, of today's engines and of as many rows as the suite has today.
#[test]
fn the_summary_is_of_todays_suite() {
    let results = read(RESULTS);
    let (_, block) = results.split_once("<!-- begin: summary -->\n```text\n").expect("a block");
    let (block, _) = block.split_once("```\n<!-- end: summary -->").expect("it ends");
    assert!(block.starts_with("percuss ") && block.contains(", suite quick, "), "{block}");
    let cases = embedded().expect("the cases are read");
    let rows = size(cases.len(), all(), &Suite::Quick.into());
    assert!(block.contains(&format!("\n{rows} rows: ")), "{rows}");
    assert!(block.contains(" 0 fail, 0 error") && block.contains("\npower: "), "{block}");
    let widest = block.lines().map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| widest <= 100), "{widest:?}: {block}");
    let (_, details) = results.split_once("<!-- begin: details -->\n```text\n").expect("a block");
    let (details, _) = details.split_once("```\n<!-- end: details -->").expect("it ends");
    assert!(details.contains("\nnot run: ") && details.contains("\nrank (#): "), "{details}");
    for engine in all() {
        let name = engine.declaration().name;
        assert!(details.contains(&format!(" {name} ")), "{name}");
    }
}

/// A file that was made from a report of the quick suite lacks what that suite does not ask for:
/// the tolerances between its three, and most restarts.
#[test]
fn the_expected_failures_are_those_of_the_full_suite() {
    let file: toml::Table = toml::from_str(&read("validation/shortcomings.toml")).expect("TOML");
    let cases = embedded().expect("the cases are read");
    let systems = cases.iter().filter(|case| case.oscillator.is_none());
    let systems: Vec<&str> = systems.map(|case| case.name.as_str()).collect();
    let defects = file["defects"].as_array().expect("defects").iter();
    let rows: Vec<_> = defects.flat_map(|it| it["rows"].as_array().expect("rows")).collect();
    let of_system = |row: &toml::Value| row[0].as_str().is_some_and(|it| systems.contains(&it));
    for tolerance in SuiteScope::from(Suite::Full).tolerances() {
        let at_it = |row: &toml::Value| row[1].as_float() == Some(*tolerance);
        let count =
            |system: bool| rows.iter().filter(|it| at_it(it) && of_system(it) == system).count();
        assert!(count(true) > 20 && count(false) > 20, "{tolerance:e}");
    }
    assert!(rows.iter().any(|row| row[2].as_str() == Some("restart_error")));
}

/// How a comment begins in sources of this kind.
fn comment_marks(extension: &str) -> &'static [&'static str] {
    match extension {
        "rs" | "js" | "cpp" => &["//"],
        "c" | "h" | "java" => &["//", "*", "/*"],
        "py" | "sh" | "jl" | "R" | "toml" | "yml" | "yaml" => &["#"],
        "m" => &["%"],
        _ => &[],
    }
}

/// Sources of all packages, those outside the workspace too, with how their comments begin.
fn sources(folder: &Path, found: &mut Vec<(PathBuf, &'static [&'static str])>) {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    for path in entries.map(|entry| entry.expect("the entry is readable").path()) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            sources(&path, found);
            continue;
        }
        let extension = path.extension().and_then(|it| it.to_str()).unwrap_or_default();
        let marks = comment_marks(extension);
        if !marks.is_empty() {
            found.push((path, marks));
        }
    }
}

/// Formatters keep code within this width and leave comments alone.
#[test]
fn comments_are_at_most_100_columns_wide() {
    const MAX_COLUMNS: usize = 100;
    let mut found = Vec::new();
    sources(&root(), &mut found);
    assert!(!found.is_empty(), "no sources are found");
    let mut wide = Vec::new();
    for (path, marks) in found {
        let text = std::fs::read_to_string(&path).expect("the source is text");
        let lines = text.lines().enumerate().filter(|(_, line)| {
            let begins = |mark: &&str| line.trim_start().starts_with(mark);
            marks.iter().any(begins) && line.chars().count() > MAX_COLUMNS
        });
        wide.extend(lines.map(|(n, _)| format!("{}:{}", path.display(), n + 1)));
    }
    assert!(wide.is_empty(), "{wide:#?}");
}

/// A file of tests that its program does not name would not run, and nobody would know.
#[test]
fn every_file_of_tests_is_in_its_program() {
    for package in ["", "validation"] {
        let folder = root().join(package).join("tests");
        let manifest = read(Path::new(package).join("Cargo.toml").to_str().expect("a path"));
        let program =
            std::fs::read_to_string(folder.join("main.rs")).expect("the program is there");
        for entry in std::fs::read_dir(&folder).expect("the folder is there") {
            let name = entry.expect("the entry is readable").file_name();
            let name = name.to_string_lossy();
            let Some(stem) = name.strip_suffix(".rs").filter(|stem| *stem != "main") else {
                continue;
            };
            let own = manifest.contains(&format!("path = \"tests/{name}\""));
            let part = program.lines().any(|line| line == format!("mod {stem};"));
            assert!(own || part, "{package} tests/{name}: main.rs does not name it");
        }
    }
}
