//! The example of an engine in a crate of its own: what its author gets from the whole program.
//!
//! This test is a program of its own as well. Called with a verb it is the example, whose output is
//! then that of a process and can be read.

#![allow(clippy::expect_used, clippy::panic, reason = "a panic is a failed test")]

#[path = "../examples/engine.rs"]
mod engine;

use percuss_validation::engine::{
    Accuracy, Declaration, Engine, Failure, Limits, Outcome, Stepping, Task,
};
use percuss_validation::integrators;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, ExitCode, Output};

fn main() -> ExitCode {
    match std::env::args().nth(1).as_deref() {
        Some("validate" | "engines" | "bench") => return engine::main(),
        Some("absent") => {
            let arguments = std::iter::once("percuss".into()).chain(std::env::args_os().skip(2));
            return percuss_validation::cli::run_with(&[&Absent], arguments);
        }
        Some("negated") => {
            let arguments = std::iter::once("percuss".into()).chain(std::env::args_os().skip(2));
            return percuss_validation::cli::run_with(&[&Negated], arguments);
        }
        // A test runner asks what tests there are.
        Some("--list") => return ExitCode::SUCCESS,
        _ => {}
    }
    names_that_mislead_are_refused();
    the_report_is_whole();
    it_is_an_engine_of_every_verb();
    its_accuracy_is_held_to_a_baseline();
    an_engine_that_is_not_installed_is_unavailable();
    a_wrong_derivative_is_named_and_decides_nothing();
    a_case_of_derivatives_alone_is_chosen_where_they_are_asked_for();
    the_pages_show_what_it_does();
    ExitCode::SUCCESS
}

/// An engine that needs what is not there.
struct Absent;

impl Engine for Absent {
    fn declaration(&self) -> Declaration {
        Declaration { name: "absent", ..engine::Heun.declaration() }
    }

    fn available(&self) -> Result<(), String> {
        Err("it needs a library that is not installed".to_owned())
    }

    fn run(&self, _: &Task, _: Accuracy, _: &Limits) -> Result<Outcome, Failure> {
        panic!("an engine that is not there is not run");
    }
}

/// The exact solver as a peer, whose derivatives have the other sign.
struct Negated;

impl Negated {
    fn exact() -> &'static dyn Engine {
        let exact = integrators::all().iter().find(|it| it.declaration().name == "exact");
        *exact.expect("it is always there")
    }
}

impl Engine for Negated {
    fn declaration(&self) -> Declaration {
        let stepping = Stepping::Adaptive;
        Declaration { name: "negated", stepping, ..engine::Heun.declaration() }
    }

    fn differentiates(&self) -> bool {
        true
    }

    fn run(&self, task: &Task, _: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let mut outcome = Self::exact().run(task, Accuracy::Exact, limits)?;
        for by in outcome.gradients.iter_mut().flatten() {
            by.end.iter_mut().for_each(|it| *it = -*it);
            for event in &mut by.events {
                event.time = event.time.map(|it| -it);
                event.state.iter_mut().for_each(|it| it.iter_mut().for_each(|it| *it = -*it));
            }
        }
        Ok(outcome)
    }
}

/// The verb names the rule that is wrong; exact derivatives beside it are right, and both exit 0.
fn a_wrong_derivative_is_named_and_decides_nothing() {
    let folder = std::env::temp_dir().join(format!("percuss-negated-{}", std::process::id()));
    let out = folder.to_str().expect("a path in Unicode");
    let cases = "^(ball-geometric|ball-first-impacts)$";
    let engines = "^(exact|negated)$";
    let asked = ["negated", "validate", "-e", engines, "-c", cases, "--out", out];
    let output = example(&asked);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}{}", text(&output.stderr));
    assert!(said.contains("sign: ball-first-impacts by g"), "{said}");
    let report = std::fs::read_to_string(folder.join("report.json")).expect("it was written");
    let page = std::fs::read_to_string(folder.join("report.html")).expect("it was written");
    assert!(page.contains("Derivatives through events"), "{page}");
    std::fs::remove_dir_all(&folder).expect("it was made here");
    let report: Value = serde_json::from_str(&report).expect("it is JSON");
    let rows = report["gradients"].as_array().expect("there are rows");
    assert_eq!(rows.len(), 2 * 2 * 3, "{rows:?}");
    for row in rows {
        let is_exact = row["engine"] == "exact";
        assert_eq!(row["verdict"] == "right", is_exact, "{row}");
        assert_eq!(row["missing_term"] == "sign", !is_exact, "{row}");
    }
}

/// A name that no case of the suite has is one of derivatives, where an engine answers these.
fn a_case_of_derivatives_alone_is_chosen_where_they_are_asked_for() {
    let chosen = |engine| {
        let output = example(&["negated", "validate", "-e", engine, "-c", "^ball-first-impacts$"]);
        (output.status.code(), text(&output.stdout) + &text(&output.stderr))
    };
    let (code, said) = chosen("^negated$");
    assert!(code == Some(0) && said.contains("sign: ball-first-impacts by g"), "{said}");
    assert!(said.contains("0 rows"), "{said}");
    let (code, said) = chosen("^exact$");
    assert!(code == Some(2) && said.contains("matches no case"), "{said}");
}

/// Its rows are `unavailable`, which is no failure unless every engine is required.
fn an_engine_that_is_not_installed_is_unavailable() {
    let asked = ["absent", "validate", "-e", "^(exact|absent)$", "-c", "^impact-into-progression$"];
    let output = example(&asked);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}{}", text(&output.stderr));
    assert!(said.contains("3 unavailable") && said.contains("0 error"), "{said}");
    let required = example(&[&asked[..], &["--require"]].concat());
    assert_eq!(required.status.code(), Some(1), "{}", text(&required.stdout));
}

fn example(arguments: &[&str]) -> Output {
    let program = std::env::current_exe().expect("this test");
    Command::new(program).args(arguments).output().expect("it runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

const VALIDATE_COMMAND: [&str; 5] =
    ["validate", "-e", "^(exact|heun)$", "-c", "^impact-into-progression$"];

fn scored(out: &Path, more: &[&str]) -> (Option<i32>, String) {
    let out = out.display().to_string();
    let output = example(&[&VALIDATE_COMMAND[..], &["--out", &out], more].concat());
    (output.status.code(), text(&output.stdout) + &text(&output.stderr))
}

fn read(file: &Path) -> String {
    std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// Table, HTML, JSON, CSV and JUnit hold the engine's rows.
fn the_report_is_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, said) = scored(folder.path(), &[]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("heun"), "{said}");
    for name in ["report.html", "errors.csv", "junit.xml"] {
        assert!(read(&folder.path().join(name)).contains("heun"), "{name}");
    }
    let report: Value =
        serde_json::from_str(&read(&folder.path().join("report.json"))).expect("JSON");
    let engines = report["engines"].as_array().expect("engines");
    assert!(
        engines.iter().any(|it| it["name"] == "heun" && it["version"] == "1.0.0"),
        "{engines:?}"
    );
    let rows = report["results"].as_array().expect("rows");
    let own: Vec<_> = rows.iter().filter(|row| row["engine"] == "heun").collect();
    assert!(own.len() > 1 && own.iter().all(|row| row["status"] == "ok"), "{own:?}");
}

fn it_is_an_engine_of_every_verb() {
    let listed = text(&example(&["engines", "--format", "csv"]).stdout);
    assert!(listed.lines().any(|line| line.starts_with("heun,an example,1.0.0,")), "{listed}");
    assert_eq!(listed.lines().count(), 2 + integrators::all().len());
    let timed = example(&["bench", "-e", "^heun$", "-c", "^impact-into", "--rounds", "1"]);
    assert!(text(&timed.stdout).contains("heun"), "{}", text(&timed.stderr));
}

/// A baseline in which the engine was ten times as accurate.
fn its_accuracy_is_held_to_a_baseline() {
    let folder = tempfile::tempdir().expect("a folder");
    scored(folder.path(), &[]);
    let file = folder.path().join("report.json");
    let mut report: Value = serde_json::from_str(&read(&file)).expect("JSON");
    let baseline = folder.path().join("baseline.json");
    let path = baseline.display().to_string();
    std::fs::write(&baseline, report.to_string()).expect("written");
    let (code, said) = scored(folder.path(), &["--baseline", &path]);
    assert_eq!(code, Some(0), "{said}");
    let rows = report["results"].as_array_mut().expect("rows");
    for row in rows.iter_mut().filter(|row| row["engine"] == "heun") {
        for statistic in ["median", "q99", "max"] {
            let error = &mut row["state_error"][statistic];
            *error = error.as_f64().map_or(Value::Null, |it| Value::from(0.1 * it));
        }
    }
    std::fs::write(&baseline, report.to_string()).expect("written");
    let (code, said) = scored(folder.path(), &["--baseline", &path]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("heun"), "{said}");
}

fn names_that_mislead_are_refused() {
    // This process has not asked for any engine yet, so that only the names can be at fault.
    let refused =
        integrators::add(&[integrators::exact()]).expect_err("the reference is there already");
    assert!(refused.reason.contains("\"exact\""), "{refused}");
    assert_eq!(integrators::add(&[]), Ok(()));
    let late = integrators::add(&[]).expect_err("once only");
    assert!(late.reason.contains("before any engine"), "{late}");
}

/// The transcript of CONTRIBUTING.md, and the code of docs/AUTHORS.md.
fn the_pages_show_what_it_does() {
    const COMMAND: &str = "$ cargo run --release -p percuss-validation --example engine -- ";
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let page = read(&root.join("CONTRIBUTING.md"));
    let (before, rest) = page.split_once(COMMAND).expect("a transcript");
    let (arguments, rest) = rest.split_once('\n').expect("its command ends");
    let (shown, after) = rest.split_once("```").expect("it ends");
    let words: Vec<_> = arguments.split(' ').map(|it| it.trim_matches('\'')).collect();
    let output = example(&words);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    if std::env::var_os("PERCUSS_SPLICE").is_some() {
        let page = format!("{before}{COMMAND}{arguments}\n{printed}```{after}");
        std::fs::write(root.join("CONTRIBUTING.md"), page).expect("CONTRIBUTING.md is written");
    } else if cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        // The last digits of an error are those of one platform's sine.
        assert_eq!(printed, shown, "PERCUSS_SPLICE=1 cargo test --test own_engine");
    }
    let page = read(&root.join("docs/AUTHORS.md"));
    let (_, code) = page.split_once("```rust\n").expect("code");
    let (code, _) = code.split_once("```").expect("it ends");
    assert!(read(&root.join("validation/examples/engine.rs")).contains(code), "{code}");
}
