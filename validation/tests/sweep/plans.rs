//! Plans: what is refused, and what of a plan or of the program may not change under a sweep.

use super::{Case, DRIFT};
use std::fs;
use std::path::Path;

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
        (
            "parameter = \"b\"",
            "parameter = \"p\"",
            &["axis p is not accepted", "accepted are a, b"],
        ),
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
