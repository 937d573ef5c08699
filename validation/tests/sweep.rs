//! Sweeps: the arrays are the verb's, whatever the number of shards, threads and workers and
//! whatever happens to them.

use crate::support::{percuss, refused, run, stdout, text};
use serde_json::Value;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

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

#[test]
fn a_shard_that_was_cut_or_altered_or_is_of_another_sweep_is_named_and_redone() {
    let case = Case::drift(4);
    case.done("run", &[]);
    let expected = case.merged();
    let whole = fs::read(case.shard(2)).expect("read");
    let other = Case::new(&DRIFT.replace("SHARDS", "4").replace("0.02", "0.03"));
    other.done("run", &[]);
    let mut spoiled: Vec<(Vec<u8>, &str)> = vec![
        (Vec::new(), "truncated"),
        (whole[..whole.len() - 1].to_vec(), "checksum"),
        (whole[..whole.len() / 2].to_vec(), "checksum"),
        (b"not a shard".to_vec(), "truncated"),
        (fs::read(other.shard(2)).expect("read"), "another plan"),
        (fs::read(case.shard(1)).expect("read"), "wrong name"),
    ];
    // One bit at places all over the file.
    for place in (0..whole.len()).step_by(whole.len() / 20) {
        let mut altered = whole.clone();
        altered[place] ^= 1 << (place % 8);
        spoiled.push((altered, "checksum"));
    }
    for (bytes, why) in spoiled {
        fs::write(case.shard(2), &bytes).expect("written");
        let (code, status) = case.status();
        assert_eq!(code, Some(1));
        assert_eq!(status["damaged"][0]["shard"], 2, "{status}");
        let before = fs::read(case.path("merged.npz")).expect("read");
        let output = case.path("merged.npz");
        let (code, _, said) = case.run("merge", &["--output", &output]);
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains("shard 2 is damaged") && said.contains(why), "{said}");
        assert_eq!(fs::read(&output).expect("read"), before, "the old file stays");
        let said = case.done("run", &[]);
        assert!(said.contains("shard 2") && said.contains("again"), "{said}");
        assert_eq!(case.merged(), expected);
    }
}

#[test]
fn a_finished_shard_is_skipped_and_a_missing_one_is_named() {
    let case = Case::drift(4);
    let (code, status) = case.status();
    assert_eq!(code, Some(1));
    assert_eq!(status["missing"].as_array().map(Vec::len), Some(4));
    assert!(!Path::new(&case.path("out")).exists(), "status makes no folder");
    case.done("run", &["--shard", "1/4"]);
    let modified = |case: &Case| fs::metadata(case.shard(1)).and_then(|it| it.modified()).ok();
    let first = modified(&case);
    case.done("run", &["--shard", "1/4"]);
    assert_eq!(modified(&case), first);
    let (_, status) = case.status();
    assert_eq!(status["done"], serde_json::json!([1]));
    assert!(status["seconds_to_end"].as_f64().is_some_and(|it| it >= 0.0), "{status}");
    let output = case.path("merged.npz");
    let (code, _, said) = case.run("merge", &["--output", &output]);
    assert_eq!(code, Some(1));
    assert!(said.contains("shard 0 is missing") && said.contains("sweep run"), "{said}");
    assert!(!Path::new(&output).exists());
}

#[test]
fn engines_give_the_index_and_an_array_for_two_missing_shards_fits() {
    let case = Case::drift(4);
    let task = |variables: &[(&str, &str)]| {
        let words = case.command("run", &[]);
        let mut command = percuss(&words.iter().map(String::as_str).collect::<Vec<_>>());
        variables.iter().for_each(|(name, value)| {
            command.env(name, value);
        });
        let output = command.output().expect("run");
        (output.status.code(), text(&output.stderr))
    };
    let array = ("SLURM_ARRAY_TASK_COUNT", "2");
    assert_eq!(task(&[("SLURM_ARRAY_TASK_ID", "3"), array]).0, Some(0));
    assert_eq!(case.status().1["done"], serde_json::json!([3]));
    assert_eq!(task(&[("HQ_TASK_ID", "0")]).0, Some(0));
    assert_eq!(task(&[("PBS_ARRAY_INDEX", "1")]).0, Some(0));
    assert_eq!(task(&[("SGE_TASK_ID", "3")]).0, Some(0));
    assert_eq!(case.status().0, Some(0));
    let (code, said) = task(&[("SLURM_ARRAY_TASK_ID", "4")]);
    assert_eq!(code, Some(2));
    assert!(said.contains("SLURM_ARRAY_TASK_ID = 4") && said.contains("0 to 3"), "{said}");
}

#[test]
fn an_edited_plan_is_refused_and_an_edited_comment_is_not() {
    let case = Case::drift(4);
    case.done("run", &["--shard", "0/4"]);
    let plan = fs::read_to_string(&case.plan).expect("read");
    fs::write(&case.plan, format!("# a comment\n{plan}")).expect("written");
    case.done("run", &["--shard", "1/4"]);
    fs::write(&case.plan, plan.replace("periods = 40", "periods = 41")).expect("written");
    for step in ["run", "status"] {
        case.refused(step, &[], &["--out", "another plan", "accepted"]);
    }
    let output = case.path("merged.npz");
    case.refused("merge", &["--output", &output], &["--out", "another plan", "accepted"]);
}

#[test]
fn another_program_is_refused() {
    let case = Case::drift(4);
    case.done("run", &["--shard", "0/4"]);
    let path = case.folder.path().join("out/sweep.json");
    let text = fs::read_to_string(&path).expect("read");
    for (from, to) in [
        (format!("\"percuss\": \"{}\"", env!("CARGO_PKG_VERSION")), "\"percuss\": \"9.9.9\""),
        ("\"commit\": \"".to_owned(), "\"commit\": \"0"),
        ("\"arithmetic\": \"".to_owned(), "\"arithmetic\": \"un"),
    ] {
        if text.contains(&from) {
            fs::write(&path, text.replace(&from, to)).expect("written");
            case.refused("run", &[], &["--out", "the same program", "accepted"]);
        }
    }
}

/// Two runs of all shards at once, and a third one that is told one shard: each shard is there
/// once, and the arrays are those of one run.
#[test]
fn workers_at_the_same_time_lose_and_double_nothing() {
    let alone = Case::drift(4);
    alone.done("run", &[]);
    let case = Case::drift(4);
    let start = |more: &[&str]| {
        let mut command = std::process::Command::new(percuss(&[]).get_program());
        command.args(case.command("run", more)).stderr(std::process::Stdio::null());
        command.spawn().expect("started")
    };
    let workers = [start(&[]), start(&[]), start(&["--shard", "2/4"])];
    for mut worker in workers {
        assert!(worker.wait().expect("ended").success());
    }
    assert_eq!(case.merged(), alone.merged());
    let names = fs::read_dir(case.path("out")).expect("read");
    let names: Vec<String> =
        names.map(|it| it.expect("an entry").file_name().to_string_lossy().into()).collect();
    assert!(names.iter().all(|it| !it.ends_with(".tmp") && !it.ends_with(".lock")), "{names:?}");
}

/// What is wrong with a plan, and what is said of it.
#[test]
fn plans_that_are_refused() {
    let rows: &[(&str, &str, &[&str])] = &[
        ("verb = \"lyapunov\"", "verb = \"simulate\"", &["verb = \"simulate\"", "accepted are"]),
        ("shards = 4", "shards = 0", &["shards = 0", "1 to 100000"]),
        ("shards = 4", "shards = 21", &["shards = 21", "1 to 20"]),
        ("shards = 4", "shards = \"four\"", &["line 4", "shards", "four", "an integer"]),
        ("shards = 4", "shards = 4\nshard = 5", &["shard", "line 5"]),
        ("shards = 4\n", "", &["line 2", "[sweep]", "shards"]),
        ("transient = 20\n", "", &["--transient"]),
        ("transient = 20", "transient = -1", &["--transient", "-1", "accepted"]),
        ("transient = 20", "transient = 20\noutput = \"x\"", &["output is not accepted"]),
        ("transient = 20", "transient = 20\nsteps = 3", &["--steps"]),
        ("transient = 20", "transiant = 20", &["--transiant", "tip", "--transient"]),
        ("transient = 20", "transient = 20\nreset = false", &["reset = false", "lyapunov"]),
        ("transient = 20", "transient = false", &["transient = false", "lyapunov"]),
        ("transient = 20", "transient = 20\nomega = 1.0", &["omega", "both an axis"]),
        ("transient = 20", "transient = 20\nproblem = \"no.toml\"", &["problem", "no.toml"]),
        ("transient = 20", "transient = 1979-05-27", &["transient is not accepted"]),
        ("parameter = \"b\"", "parameter = \"omega\"", &["both axes are omega"]),
        ("parameter = \"b\"", "parameter = \"p\"", &["line"]),
        ("steps = 5", "steps = 0", &["omega", "steps = 0"]),
        ("steps = 5", "steps = 5.5", &["line 13", "steps = 5.5", "an integer"]),
        ("from = 0.6", "from = \"0.6\"", &["line 11", "from = \"0.6\"", "a number"]),
        ("from = 0.6", "from = nan", &["omega", "from = NaN", "finite"]),
        ("to = 0.05", "to = -inf", &["b", "to = -inf", "finite"]),
        ("steps = 5", "steps = 1", &["omega", "no effect"]),
        ("steps = 5", "steps = 4294967295", &["points", "at most"]),
        ("to = 1.9", "to = -1.0", &["omega", "1e-6 <= omega <= 1e6"]),
    ];
    for (from, to, wanted) in rows {
        let plan = DRIFT.replace("SHARDS", "4");
        assert!(plan.contains(from), "{from}");
        let case = Case::new(&plan.replacen(from, to, 1));
        let wanted: Vec<&str> = wanted.iter().chain(&["--plan", "plan.toml"]).copied().collect();
        case.refused("run", &[], &wanted);
        assert!(!Path::new(&case.path("out")).exists(), "nothing was begun");
    }
    let (axes, none) = (DRIFT.find("[[axis]]").expect("axes"), &["there are 0 [[axis]]"]);
    Case::new(&DRIFT[..axes].replace("SHARDS", "4")).refused("run", &[], none);
    let case = Case::drift(4);
    case.refused("run", &["--shard", "0/5"], &["--shard 0/5", "0/4 to 3/4"]);
    case.refused("merge", &["--output", "a.csv"], &["--output a.csv", ".npz"]);
}

/// Neither the memory nor the patience for it are tried first.
#[test]
fn a_plan_of_too_many_blocks_is_refused() {
    let case = Case::new(
        r#"
[sweep]
verb = "basins"
shards = 1000
[fixed]
grid = "4000x4000"
window = [-0.5, 0.5, -0.5, 0.5]
transient = 10
[[axis]]
parameter = "omega"
from = 1.0
to = 2.0
steps = 4000
[[axis]]
parameter = "b"
from = 0.1
to = 0.2
steps = 4000
"#,
    );
    case.refused("run", &[], &["blocks of starts", "accepted are at most 16777216"]);
}

#[test]
fn what_a_killed_worker_has_left_is_removed() {
    let case = Case::drift(4);
    case.done("run", &["--shard", "0/4"]);
    let left = ["00002.lock", ".percuss-00002-abcdef.tmp", ".percuss-00003-abcdef.tmp"];
    let left = left.map(|name| case.folder.path().join("out").join(name));
    left.iter().for_each(|path| fs::write(path, "").expect("written"));
    case.done("run", &["--shard", "2/4"]);
    // Another shard's may be another worker's, which is at it.
    assert_eq!(left.map(|path| path.exists()), [false, false, true]);
}

/// A problem file counts by its contents.
#[test]
fn an_edited_problem_file_is_another_plan() {
    let plan = DRIFT.replace("SHARDS", "4").replace("xi = 0.02", "problem = \"problem.toml\"");
    let case = Case::new(&plan);
    let problem = case.folder.path().join("problem.toml");
    fs::write(&problem, "[parameters]\nxi = 0.02\n").expect("written");
    case.done("run", &[]);
    let expected = Case::drift(2);
    expected.done("run", &[]);
    assert_eq!(case.merged(), expected.merged());
    fs::write(&problem, "[parameters]\nxi = 0.03\n").expect("written");
    case.refused("run", &[], &["another plan"]);
}
