//! Sweeps: the arrays are the verb's, whatever the number of shards, threads and workers and
//! whatever happens to them.

use crate::support::{refused, run, stdout, text};
use serde_json::Value;
use std::fs;
use std::io::Read;
use std::path::PathBuf;
use tempfile::TempDir;

mod plans;
mod shards;
mod systems;

const DRIFT: &str = r#"
[sweep]
verb = "lyapunov"
shards = SHARDS
[fixed]
transient = 20
periods = 40
xi = 0.02
[[axis]]
parameter = "omega"
from = 0.6
to = 1.9
steps = 5
[[axis]]
parameter = "b"
from = 0.3
to = 0.05
steps = 4
"#;

/// A folder with a plan.
struct Case {
    folder: TempDir,
    plan: PathBuf,
}

impl Case {
    fn new(plan: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("plan.toml");
        fs::write(&path, plan).expect("written");
        Self { folder, plan: path }
    }

    fn drift(shards: u32) -> Self {
        Self::new(&DRIFT.replace("SHARDS", &shards.to_string()))
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    /// A command of the sweep in this folder.
    fn command(&self, step: &str, more: &[&str]) -> Vec<String> {
        let (plan, out) = (self.plan.display().to_string(), self.path("out"));
        let words = ["sweep", step, "--plan", &plan, "--out", &out];
        words.iter().chain(more).map(|it| (*it).to_owned()).collect()
    }

    fn run(&self, step: &str, more: &[&str]) -> (Option<i32>, String, String) {
        let words = self.command(step, more);
        let output = run(&words.iter().map(String::as_str).collect::<Vec<_>>());
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    }

    /// A step that succeeds; what it says.
    fn done(&self, step: &str, more: &[&str]) -> String {
        let (code, _, said) = self.run(step, more);
        assert_eq!(code, Some(0), "{step} {more:?}: {said}");
        said
    }

    /// The merged file.
    fn merged(&self) -> Vec<u8> {
        let output = self.path("merged.npz");
        self.done("merge", &["--output", &output]);
        fs::read(output).expect("read")
    }

    fn status(&self) -> (Option<i32>, Value) {
        let (code, out, _) = self.run("status", &[]);
        (code, serde_json::from_str(&out).expect("JSON"))
    }

    fn shard(&self, shard: u32) -> PathBuf {
        self.folder.path().join("out").join(format!("{shard:05}.shard"))
    }

    fn refused(&self, step: &str, more: &[&str], wanted: &[&str]) {
        let words = self.command(step, more);
        refused(&words.iter().map(String::as_str).collect::<Vec<_>>(), wanted);
    }
}

/// An array of a `.npz` file: its shape and its bytes.
fn array(file: &[u8], name: &str) -> (Vec<usize>, Vec<u8>) {
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(file)).expect("a zip");
    let mut bytes = Vec::new();
    archive.by_name(&format!("{name}.npy")).expect(name).read_to_end(&mut bytes).expect("read");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let head = text(&bytes[10..10 + length]);
    let shape = head.split_once("'shape': ").expect("a shape").1;
    let shape = shape[1..shape.find(')').expect("a tuple")].split(',');
    let shape = shape.filter_map(|it| it.trim().parse().ok()).collect();
    (shape, bytes.split_off(10 + length))
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    let number = |it: &[u8]| f64::from_le_bytes(it.try_into().expect("eight bytes"));
    bytes.chunks(8).map(number).collect()
}

#[test]
fn a_drift_map_is_the_verb_at_every_point() {
    let case = Case::drift(3);
    case.done("run", &[]);
    let merged = case.merged();
    let (shape, omega) = array(&merged, "omega");
    let (_, b) = array(&merged, "b");
    assert_eq!(shape, [5]);
    let (omega, b) = (numbers(&omega), numbers(&b));
    assert_eq!((omega[4], b[0], b[3]), (1.9, 0.3, 0.05));
    let (shape, drift) = array(&merged, "drift_per_period");
    assert_eq!(shape, [5, 4]);
    let (shape, exponents) = array(&merged, "exponents_per_period");
    assert_eq!(shape, [5, 4, 3]);
    let (drift, exponents) = (numbers(&drift), numbers(&exponents));
    for (i, omega) in omega.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            let (omega, b) = (format!("--omega={omega}"), format!("--b={b}"));
            let more = [&omega[..], &b];
            let fixed = ["lyapunov", "--transient=20", "--periods=40", "--xi=0.02", "--quiet"];
            let json = stdout(&[&fixed[..], &more].concat());
            let json: Value = serde_json::from_str(&json).expect("JSON");
            let at = 4 * i + j;
            assert_eq!(json["drift_per_period"].as_f64(), Some(drift[at]), "{more:?}");
            for (k, exponent) in exponents[3 * at..3 * at + 3].iter().enumerate() {
                // JSON has null where an exponent is minus infinity.
                let finite = Some(*exponent).filter(|it| it.is_finite());
                assert_eq!(json["exponents_per_period"][k].as_f64(), finite, "{more:?}");
            }
        }
    }
}

#[test]
fn the_bytes_are_the_same_for_every_number_of_shards_and_threads_and_every_order() {
    let whole = Case::drift(1);
    whole.done("run", &["--threads", "1"]);
    let expected = whole.merged();
    for shards in [2, 7, 20] {
        let case = Case::drift(shards);
        for shard in (0..shards).rev() {
            let threads = if shard % 2 == 0 { "1" } else { "2" };
            let shard = format!("{shard}/{shards}");
            case.done("run", &["--shard", &shard, "--threads", threads]);
        }
        assert_eq!(case.status().0, Some(0));
        assert_eq!(case.merged(), expected, "{shards} shards");
    }
}

/// 257 x 300 starts are two blocks.
#[test]
fn labels_of_a_grid_in_blocks_are_those_of_the_verb() {
    let fixed = "--xi=2 --b=0.3 --grid=257x300 --window=-0.5,0.5,-0.5,0.5 --transient=10";
    let fixed: Vec<&str> = fixed.split(' ').collect();
    let case = Case::new(
        r#"
[sweep]
verb = "basins"
shards = 4
[fixed]
xi = 2.0
b = 0.3
grid = "257x300"
window = [-0.5, 0.5, -0.5, 0.5]
transient = 10
[[axis]]
parameter = "omega"
from = 1.9
to = 2.0
steps = 2
"#,
    );
    for shard in ["3/4", "0/4", "2/4", "1/4"] {
        case.done("run", &["--shard", shard]);
    }
    let merged = case.merged();
    let (shape, labels) = array(&merged, "labels");
    assert_eq!(shape, [2, 300, 257]);
    let (_, meta) = array(&merged, "meta");
    for (place, omega) in ["--omega=1.9", "--omega=2"].iter().enumerate() {
        let output = case.path("verb.npz");
        let more = [*omega, "--output", &output];
        let json = stdout(&[&["basins"], &fixed[..], &more].concat());
        let verb = fs::read(&output).expect("read");
        let (_, expected) = array(&verb, "labels");
        assert_eq!(labels[place * expected.len()..][..expected.len()], expected, "{omega}");
        let meta = &meta[place * meta.len() / 2..][..meta.len() / 2];
        let meta: Value = serde_json::from_slice(meta).expect("JSON with spaces after it");
        assert_eq!(meta, serde_json::from_str::<Value>(&json).expect("JSON"), "{omega}");
        for axis in ["p", "y"] {
            assert_eq!(array(&merged, axis), array(&verb, axis));
        }
    }
}

/// The last axis in the place of the verb's own parameter gives the rows of the verb.
#[test]
fn a_diagram_along_an_axis_is_the_verb() {
    let case = Case::new(
        r#"
[sweep]
verb = "bifurcation"
shards = 2
[fixed]
reset = true
transient = 10
periods = 3
[[axis]]
parameter = "xi"
from = 0.05
to = 0.1
steps = 2
[[axis]]
parameter = "omega"
from = 0.7
to = 0.9
steps = 3
"#,
    );
    case.done("run", &[]);
    let merged = case.merged();
    let (shape, p) = array(&merged, "p");
    assert_eq!(shape, [2, 3, 3]);
    let flags = "bifurcation --xi=0.1 --reset --parameter=omega --from=0.7 --to=0.9 --steps=3 \
                 --transient=10 --periods=3";
    let csv = stdout(&flags.split_whitespace().collect::<Vec<_>>());
    let expected: Vec<f64> =
        crate::support::rows(&csv).iter().map(|row| crate::support::number(&row[2])).collect();
    assert_eq!(numbers(&p)[9..], expected);
}

#[test]
fn branches_are_padded_to_the_longest() {
    let case = Case::new(
        r#"
[sweep]
verb = "continue"
shards = 2
[fixed]
parameter = "omega"
from = 1.36
to = 1.4
period = 1
[[axis]]
parameter = "xi"
from = 0.01
to = 0.1
steps = 2
"#,
    );
    case.done("run", &[]);
    let merged = case.merged();
    let (shape, values) = array(&merged, "parameter");
    let (_, meta) = array(&merged, "meta");
    let values = numbers(&values);
    let longest = values.len() / 2;
    assert_eq!(shape, [2, longest]);
    for (place, xi) in ["--xi=0.01", "--xi=0.1"].iter().enumerate() {
        let flags = ["continue", "--parameter=omega", "--from=1.36", "--to=1.4", "--period=1"];
        let output = run(&[&flags[..], &[*xi, "--quiet"]].concat());
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let meta = &meta[place * meta.len() / 2..][..meta.len() / 2];
        assert_eq!(serde_json::from_slice::<Value>(meta).expect("JSON"), json);
        let branch = json["branch"].as_array().expect("a list");
        let row = &values[place * longest..][..longest];
        for (value, point) in row.iter().zip(branch) {
            assert_eq!(Some(*value), point["parameter"].as_f64());
        }
        assert!(row[branch.len()..].iter().all(|it| it.is_nan()));
    }
}
