//! Draws the sample, writes the rewritten sources and builds the test programs.

use crate::catalogue::Catalogue;
use crate::fault::Fault;
use crate::rewrite::{Edit, Rewritten, rewrite};
use crate::tree;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The module that the rewritten sources ask; the variable is read once.
const CHOICE_MODULE: &str = "//! Which fault is chosen.\n\
    use std::sync::LazyLock;\n\
    static CHOSEN: LazyLock<u32> = LazyLock::new(|| {\n\
        std::env::var(\"PERCUSS_FAULT\").ok().and_then(|it| it.parse().ok()).unwrap_or(0)\n\
    });\n\
    /// Whether this fault is the chosen one.\n\
    #[inline(always)]\n\
    pub fn is(number: u32) -> bool { *CHOSEN == number }\n";

/// The packages whose library gets the module, with the folder of their sources.
pub const LIBRARIES: [&str; 7] = [
    "src",
    "validation/engines/src",
    "validation/harness/src",
    "validation/bench/src",
    "validation/paper/src",
    "validation/pictures/src",
    "validation/src",
];

/// The package of the solver.
pub const SOLVER: &[&str] = &["percuss"];
/// The packages of the harness; the last one compiles all of them.
pub const VALIDATION: &[&str] = &[
    "percuss-engines",
    "percuss-pictures",
    "percuss-harness",
    "percuss-bench",
    "percuss-paper",
    "percuss-validation",
];
/// Everything that the solver can do is tested.
const FEATURES: [&str; 2] = ["--features", "lanes,parallel"];

/// A test program, or a module of one.
#[derive(Clone, Debug)]
pub struct Program {
    /// The name of the target.
    pub name: String,
    /// The module whose tests are run; `None` runs all tests.
    pub module: Option<String>,
    /// The program.
    pub path: PathBuf,
    /// The folder it is run in.
    pub folder: PathBuf,
}

/// Writes a sample of so many faults into the copy; faults that do not compile are replaced by the
/// next ones of the same shuffled list.
pub fn sample_that_compiles(
    catalogue: &Catalogue,
    scratch: &Path,
    count: usize,
    seed: u64,
) -> Result<Vec<Fault>> {
    let mut order: Vec<u32> = (1..=catalogue.faults.len() as u32).collect();
    order.sort_by_cached_key(|number| catalogue.faults[*number as usize - 1].place(seed));
    // Types reject a few per cent, which are met at the first build rather than one build after the
    // other.
    let spare = count / 10 + 1;
    loop {
        let drawn = &order[..order.len().min(count + spare)];
        let rewritten = write_sources(catalogue, scratch, drawn)?;
        let rejected = rejected(scratch, catalogue, drawn, &rewritten)?;
        if rejected.is_empty() {
            break;
        }
        eprintln!("{} faults do not compile and are left out", rejected.len());
        order.retain(|number| !rejected.contains(number));
    }
    let mut drawn = order;
    drawn.truncate(count);
    drawn.sort_unstable();
    write_sources(catalogue, scratch, &drawn)?;
    let fault = |number: &u32| catalogue.faults[*number as usize - 1].clone();
    Ok(drawn.iter().map(fault).collect())
}

fn write_sources(
    catalogue: &Catalogue,
    scratch: &Path,
    numbers: &[u32],
) -> Result<BTreeMap<String, Rewritten>> {
    let numbers: BTreeSet<_> = numbers.iter().collect();
    let mut all = BTreeMap::new();
    for (file, source) in &catalogue.sources {
        let edits: Vec<Edit> =
            source.edits.iter().filter(|edit| numbers.contains(&edit.number)).cloned().collect();
        let rewritten = rewrite(&source.text, &edits);
        tree::write(&scratch.join(file), rewritten.text.as_bytes())?;
        all.insert(file.clone(), rewritten);
    }
    for folder in LIBRARIES {
        let library = scratch.join(folder).join("lib.rs");
        let text = std::fs::read_to_string(&library).context("a library without lib.rs")?;
        const MODULE: &str = "\n#[doc(hidden)]\npub mod fault;\n";
        if !text.ends_with(MODULE) {
            tree::write(&library, format!("{text}{MODULE}").as_bytes())?;
        }
        tree::write(&scratch.join(folder).join("fault.rs"), CHOICE_MODULE.as_bytes())?;
    }
    Ok(all)
}

/// The faults that the compiler rejects: of each error the innermost place that holds it.
fn rejected(
    scratch: &Path,
    catalogue: &Catalogue,
    drawn: &[u32],
    files: &BTreeMap<String, Rewritten>,
) -> Result<BTreeSet<u32>> {
    let in_validation = |number: &u32| catalogue.faults[*number as usize - 1].is_in_validation();
    let last = if drawn.iter().any(in_validation) { VALIDATION } else { SOLVER };
    let mut arguments = vec!["test", "--no-run", "--lib", "--package", last[last.len() - 1]];
    if last == SOLVER {
        arguments.extend(FEATURES);
    }
    let messages = cargo(scratch, &arguments)?;
    let errors: Vec<&Value> = messages
        .iter()
        .filter(|it| it["reason"] == "compiler-message" && it["message"]["level"] == "error")
        .map(|it| &it["message"])
        .collect();
    let mut rejected = BTreeSet::new();
    for error in errors {
        let spans = error["spans"].as_array().map_or(&[][..], Vec::as_slice);
        for span in spans.iter().filter(|span| span["is_primary"] == true) {
            let Some(file) = span["file_name"].as_str().and_then(|it| files.get(it)) else {
                bail!("{}", error["rendered"].as_str().unwrap_or("an error"));
            };
            let [start, end] =
                ["byte_start", "byte_end"].map(|key| span[key].as_u64().unwrap_or(0) as usize);
            let holds = |range: &std::ops::Range<usize>| range.start <= start && end <= range.end;
            let meets = |range: &std::ops::Range<usize>| range.start < end && start < range.end;
            let place = file.places.iter().find(|(range, _)| holds(range));
            let place = place.or_else(|| file.places.iter().find(|(range, _)| meets(range)));
            let Some((_, numbers)) = place else {
                bail!("{}", error["rendered"].as_str().unwrap_or("an error"));
            };
            rejected.extend(numbers);
        }
    }
    Ok(rejected)
}

/// Builds the test programs of some packages.
pub fn programs(scratch: &Path, packages: &[&str]) -> Result<Vec<Program>> {
    let mut arguments = vec!["test", "--no-run"];
    arguments.extend(packages.iter().flat_map(|it| ["--package", it]));
    if packages == SOLVER {
        arguments.extend(FEATURES);
    }
    let messages = cargo(scratch, &arguments)?;
    let mut programs = Vec::new();
    for it in messages.iter().filter(|it| it["reason"] == "compiler-artifact") {
        let (Some(path), true) = (it["executable"].as_str(), it["profile"]["test"] == true) else {
            continue;
        };
        let manifest = PathBuf::from(it["manifest_path"].as_str().unwrap_or_default());
        let program = Program {
            name: it["target"]["name"].as_str().unwrap_or_default().to_owned(),
            module: None,
            path: path.into(),
            folder: manifest.parent().unwrap_or(scratch).to_owned(),
        };
        if it["target"]["kind"] == serde_json::json!(["test"]) {
            programs.extend(modules(program)?);
        } else {
            programs.push(program);
        }
    }
    if programs.is_empty() {
        bail!("{} has no test programs", packages.join(", "));
    }
    Ok(programs)
}

/// Runs cargo in the copy and returns its messages.
fn cargo(scratch: &Path, arguments: &[&str]) -> Result<Vec<Value>> {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(arguments)
        .args(["--message-format", "json"])
        // The copy would build over what was built of the repository itself: both have the same
        // names.
        .env("CARGO_TARGET_DIR", "../build")
        .current_dir(scratch)
        .stderr(Stdio::inherit())
        .output()
        .context("cargo")?;
    let lines = String::from_utf8(output.stdout)?;
    let messages: Vec<Value> =
        lines.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let explained = messages.iter().any(|it| it["message"]["level"] == "error");
    if !output.status.success() && !explained {
        bail!("cargo {} failed", arguments.join(" "));
    }
    Ok(messages)
}

/// The modules of a program that holds the tests of many files, so that the quickest ones can be
/// asked first; the program itself if it does not list its tests.
fn modules(program: Program) -> Result<Vec<Program>> {
    let list = Command::new(&program.path)
        .arg("--list")
        .current_dir(&program.folder)
        .stdin(Stdio::null())
        .output()
        .with_context(|| program.path.display().to_string())?;
    let list = String::from_utf8_lossy(&list.stdout).into_owned();
    let tests = list.lines().filter_map(|line| line.strip_suffix(": test"));
    let modules: BTreeSet<&str> =
        tests.filter_map(|test| test.split_once("::").map(|(module, _)| module)).collect();
    if modules.is_empty() {
        return Ok(vec![program]);
    }
    let one = |module: &str| Program {
        name: format!("{} {module}", program.name),
        module: Some(format!("{module}::")),
        ..program.clone()
    };
    Ok(modules.into_iter().map(one).collect())
}
