//! The GitHub Action: its steps are run here as the service would run them.

use crate::support::{run, text};
use serde_yaml_ng::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the repository")
}

fn action() -> Value {
    let file = fs::read_to_string(root().join("action.yml")).expect("read");
    serde_yaml_ng::from_str(&file).expect("YAML")
}

/// A key's text; a number or a truth value as it is written.
fn word(value: &Value) -> String {
    match value {
        Value::Bool(it) => it.to_string(),
        Value::Number(it) => it.to_string(),
        other => other.as_str().unwrap_or_else(|| panic!("{other:?} is no text")).to_owned(),
    }
}

/// A run of the action in a folder.
struct Run<'a> {
    folder: &'a Path,
    inputs: BTreeMap<String, String>,
    outputs: BTreeMap<String, String>,
}

impl<'a> Run<'a> {
    /// The inputs that are given, and what stands for the others.
    fn new(folder: &'a Path, given: &[(&str, &str)]) -> Self {
        let action = action();
        let inputs = action["inputs"].as_mapping().expect("inputs");
        let mut inputs: BTreeMap<String, String> =
            inputs.iter().map(|(name, it)| (word(name), word(&it["default"]))).collect();
        for (name, value) in given {
            let old = inputs.insert((*name).to_owned(), (*value).to_owned());
            assert!(old.is_some(), "{name} is no input");
        }
        Self { folder, inputs, outputs: BTreeMap::new() }
    }

    /// The value of what stands between `${{` and `}}`.
    fn value(&self, name: &str) -> String {
        match name.split_once('.') {
            Some(("inputs", name)) => self.inputs[name].clone(),
            Some(("github", "action_path")) => root().display().to_string(),
            Some(("steps", output)) => self.outputs.get(output).cloned().unwrap_or_default(),
            _ => panic!("{name} is not known"),
        }
    }

    fn filled(&self, text: &str) -> String {
        let mut parts = text.split("${{");
        let mut whole = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (name, rest) = part.split_once("}}").expect("it ends");
            whole += &(self.value(name.trim()) + rest);
        }
        whole
    }

    /// Whether a step's condition holds: inputs that are not empty, one of them or another.
    fn is_on(&self, condition: &str) -> bool {
        let is_given = |it: &str| {
            let name = it.trim().strip_suffix(" != ''").expect("a comparison with nothing");
            !self.value(name).is_empty()
        };
        condition.split("||").any(is_given)
    }

    /// Runs all steps, but that which builds where the program is there already.
    fn all(&mut self, built: bool) -> Output {
        let action = action();
        assert_eq!(action["runs"]["using"].as_str(), Some("composite"));
        let mut last = None;
        for step in action["runs"]["steps"].as_sequence().expect("steps") {
            let id = word(&step["id"]);
            if built && id == "build" {
                let program = assert_cmd::cargo::cargo_bin("percuss").display().to_string();
                self.outputs.insert("build.outputs.percuss".to_owned(), program);
                continue;
            }
            if step.get("if").and_then(Value::as_str).is_some_and(|it| !self.is_on(it)) {
                continue;
            }
            let output = self.step(step, &id);
            let done = output.status.success();
            last = Some(output);
            if !done {
                break;
            }
        }
        last.expect("a step was run")
    }

    fn step(&mut self, step: &Value, id: &str) -> Output {
        assert_eq!(step["shell"].as_str(), Some("bash"));
        let written = self.folder.join("github-output");
        fs::write(&written, "").expect("written");
        let mut command = Command::new("bash");
        let script = self.filled(step["run"].as_str().expect("a script"));
        command.args(["--noprofile", "--norc", "-eo", "pipefail", "-c", &script]);
        command.env("GITHUB_ACTIONS", "true").env("GITHUB_OUTPUT", &written);
        command.env("GITHUB_ACTION_PATH", root()).env("GITHUB_WORKSPACE", self.folder);
        let place = step
            .get("working-directory")
            .and_then(Value::as_str)
            .map(|it| PathBuf::from(self.filled(it)));
        command.current_dir(place.as_deref().unwrap_or(self.folder));
        for (name, value) in step.get("env").and_then(Value::as_mapping).into_iter().flatten() {
            command.env(word(name), self.filled(&word(value)));
        }
        let output = command.output().expect("bash runs");
        for line in fs::read_to_string(&written).expect("read").lines() {
            let (name, value) = line.split_once('=').expect("NAME=VALUE");
            self.outputs.insert(format!("{id}.outputs.{name}"), value.to_owned());
        }
        output
    }

    /// An output of the whole action.
    fn output(&self, name: &str) -> String {
        self.filled(&word(&action()["outputs"][name]["value"]))
    }
}

/// Answers by hand: the ball falls once, and then the run is given up.
fn answers(folder: &Path) {
    let answers = folder.join("my answers");
    fs::create_dir(&answers).expect("made");
    let events = "time,event,mode,x,v\n1.5,impact,flight,0,0.75\n1.6,undecided,flight,0.065,0.55\n";
    fs::write(answers.join("ball-geometric.events.csv"), events).expect("written");
    fs::write(answers.join("ball-geometric.samples.csv"), "time,x,v\n").expect("written");
}

const CASE: &str = "^ball-(geometric|cut-short)$";

fn judges(built: bool) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut exported = Run::new(folder.path(), &[("export", "what is asked"), ("case", CASE)]);
    let output = exported.all(built);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(folder.path().join("what is asked/ball-geometric.rows.csv").exists());
    answers(folder.path());
    let given =
        [("answers", "my answers"), ("name", "by-hand"), ("library", "a pencil"), ("case", CASE)];
    let mut judged = Run::new(folder.path(), &given);
    let output = judged.all(built);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("::error") && text(&output.stdout).contains("by-hand"), "{said}");
    let report = folder.path().join(judged.output("report"));
    let json = fs::read_to_string(report.join("report.json")).expect("a report");
    assert!(json.contains("\"a pencil\""));
    // Nothing is worse than the same answers, but what fails is a failure still.
    let baseline = report.join("report.json").display().to_string();
    let worse =
        [&given[..], &[("baseline", &baseline), ("out", "again"), ("require", "true")]].concat();
    let output = Run::new(folder.path(), &worse).all(built);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(folder.path().join("again/report.html").exists());
}

#[test]
fn exports_and_judges() {
    judges(true);
}

/// The same with the step that builds, which takes minutes.
#[test]
#[ignore = "builds the program anew"]
fn builds_exports_and_judges() {
    judges(false);
}

#[test]
fn runs_programs() {
    let folder = tempfile::tempdir().expect("a folder");
    let programs = "[[program]]\nname = \"absent\"\ncommand = [\"no-such-command\"]\n";
    fs::write(folder.path().join("programs.toml"), programs).expect("written");
    let given = [("programs", "programs.toml"), ("engine", "^absent"), ("case", CASE)];
    let output = Run::new(folder.path(), &given).all(true);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let required = [&given[..], &[("require", "true")]].concat();
    let output = Run::new(folder.path(), &required).all(true);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
}

#[test]
fn contradictions_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    for (given, wanted) in [
        (vec![("answers", "a"), ("programs", "b")], "accepted is one of them"),
        (vec![("answers", "a"), ("require", "yes")], "require yes: accepted are true and false"),
    ] {
        let output = Run::new(folder.path(), &given).all(true);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains(wanted), "{}", text(&output.stderr));
    }
}

/// The page names every input, and the flags that they stand for are there.
#[test]
fn the_page_names_every_input() {
    let page = fs::read_to_string(root().join("docs/SCORE_YOUR_INTEGRATOR.md")).expect("read");
    let action = action();
    for name in action["inputs"].as_mapping().expect("inputs").keys().map(word) {
        assert!(page.contains(&format!("`{name}`")), "{name}");
    }
    assert!(run(&["score", "--help"]).status.success());
}
