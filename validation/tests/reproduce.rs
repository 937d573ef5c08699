//! `reproduce`: what it writes, what it refuses, and that the documentation tells what it found.

use crate::support::{run, text};
use percuss_validation::reproduce::items;
use percuss_validation::reproduce::paper::Paper;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const REPRODUCED: &str = "reproduced";
const DIFFERS: &str = "differs";
const NOT_DETERMINED: &str = "not-determined";

/// Every claim of the checklist with its verdict. A verdict changes here by hand only, with the
/// reason in the commit: neither a changed program nor a regenerated page changes one without a
/// word.
const VERDICTS: &[(&str, &str)] = &[
    ("fig2", REPRODUCED),
    ("table1", REPRODUCED),
    ("table1-period", REPRODUCED),
    ("table1-closed", DIFFERS),
    ("fig3", REPRODUCED),
    ("fig4", REPRODUCED),
    ("fig5", REPRODUCED),
    ("fig6a", REPRODUCED),
    ("fig6b", REPRODUCED),
    ("fig7a-f", REPRODUCED),
    ("fig7a", REPRODUCED),
    ("fig7b", REPRODUCED),
    ("fig7c", REPRODUCED),
    ("fig7d", REPRODUCED),
    ("fig7e", REPRODUCED),
    ("fig7f", REPRODUCED),
    ("census-1.4", REPRODUCED),
    ("census-1.45", REPRODUCED),
    ("census-1.56", DIFFERS),
    ("census-1.58", REPRODUCED),
    ("census-1.60", REPRODUCED),
    ("census-1.70", REPRODUCED),
    ("fig8", REPRODUCED),
    ("fig9", REPRODUCED),
    ("fig10a", REPRODUCED),
    ("fig10b", REPRODUCED),
    ("false-12", REPRODUCED),
    ("omega-1.571", DIFFERS),
    ("subcritical-1.571", DIFFERS),
    ("omega-1.5757", REPRODUCED),
    ("omega-1.6395", DIFFERS),
    ("subcritical-1.6395", DIFFERS),
    ("red-emerges", REPRODUCED),
    ("five-emerges", REPRODUCED),
    ("fractal", NOT_DETERMINED),
];

/// Items that take seconds.
const QUICK_ITEMS: [&str; 6] = ["--only", "figure-2", "--only", "table-1", "--only", "figure-5"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("read")).expect("JSON")
}

fn reproduce(folder: &Path, more: &[&str]) -> std::process::Output {
    let folder = folder.to_str().expect("a name in UTF-8");
    run(&[&["reproduce", "--out", folder], more].concat())
}

fn by_id(claims: &Value) -> Vec<(String, Value)> {
    let claims = claims["claims"].as_array().expect("claims");
    claims.iter().map(|it| (it["id"].as_str().expect("id").to_owned(), it.clone())).collect()
}

#[test]
fn every_claim_has_one_item_and_the_papers_words() {
    let expected: BTreeSet<_> = VERDICTS.iter().map(|it| it.0).collect();
    let settled: Vec<_> = items().iter().flat_map(|item| item.claims).copied().collect();
    assert_eq!(settled.len(), expected.len());
    assert_eq!(settled.into_iter().collect::<BTreeSet<_>>(), expected);
    let paper = Paper::read().expect("read");
    assert_eq!(paper.ids().collect::<BTreeSet<_>>(), expected);
}

#[test]
fn pictures_data_and_claims_are_written_and_agree_for_any_number_of_threads() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    for (folder, threads) in folders.iter().zip(["1", "2"]) {
        let done = reproduce(folder.path(), &[&QUICK_ITEMS[..], &["--threads", threads]].concat());
        assert!(done.status.success(), "{}", text(&done.stderr));
        assert!(text(&done.stdout).contains("table1-closed  differs"));
    }
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        entries.map(|it| it.unwrap().file_name().into_string().unwrap()).collect()
    };
    let written = names(folders[0].path());
    assert_eq!(written, names(folders[1].path()));
    for name in [
        "claims.json",
        "figure-2.png",
        "figure-3.png",
        "figure-4.svg",
        "figure-5.png",
        "table-1.csv",
    ] {
        assert!(written.contains(name), "{name} in {written:?}");
    }
    for name in &written {
        let [one, two] =
            [0, 1].map(|k: usize| std::fs::read(folders[k].path().join(name)).unwrap());
        assert!(one == two, "{name} depends on the number of threads");
    }
}

/// What the documentation holds is what the program finds, for the claims that take seconds.
#[test]
fn the_documented_claims_are_what_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let done = reproduce(folder.path(), &QUICK_ITEMS);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let found = by_id(&json(&folder.path().join("claims.json")));
    assert_eq!(found.len(), 7);
    let documented = by_id(&json(&root().join("docs/claims.json")));
    for (id, claim) in found {
        let (_, told) = documented.iter().find(|it| it.0 == id).expect("documented");
        assert_eq!(claim["verdict"], told["verdict"], "{id}");
        assert_eq!(claim["computed"], told["computed"], "{id}");
    }
}

#[test]
fn the_documented_claims_are_all_and_to_the_schema() {
    let documented = json(&root().join("docs/claims.json"));
    let schema = json(&Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/claims.schema.json"));
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let errors: Vec<_> = validator.iter_errors(&documented).map(|it| it.to_string()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    let told = by_id(&documented);
    let told: BTreeSet<_> =
        told.iter().map(|it| (it.0.as_str(), it.1["verdict"].as_str().expect("a word"))).collect();
    assert_eq!(told, VERDICTS.iter().copied().collect());
}

/// Like `the_documented_claims_are_what_is_found`, for every claim: minutes, so `.ci/run` asks for
/// it.
#[test]
#[ignore = "computes every figure of the paper"]
fn every_verdict_is_the_documented_one() {
    let folder = tempfile::tempdir().unwrap();
    let done = reproduce(folder.path(), &[]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let found = by_id(&json(&folder.path().join("claims.json")));
    let found: BTreeSet<_> =
        found.iter().map(|it| (it.0.as_str(), it.1["verdict"].as_str().expect("a word"))).collect();
    assert_eq!(found, VERDICTS.iter().copied().collect());
}

/// The table in docs/REPRODUCTION.md is made from docs/claims.json: `PERCUSS_SPLICE=1 cargo test
/// --test harness reproduce::` writes it anew.
#[test]
fn the_page_tells_the_documented_claims() {
    const BEGIN: &str = "<!-- begin: claims -->\n";
    const END: &str = "<!-- end -->";
    let path = root().join("docs/REPRODUCTION.md");
    let page = std::fs::read_to_string(&path).expect("read");
    let (before, rest) = page.split_once(BEGIN).expect("the block begins");
    let (_, after) = rest.split_once(END).expect("the block ends");
    let word = |claim: &Value, key: &str| claim[key].as_str().unwrap().replace('|', "\\|");
    let mut block = "| claim | the paper | we find | verdict |\n|---|---|---|---|\n".to_owned();
    let claims = by_id(&json(&root().join("docs/claims.json")));
    for (id, claim) in &claims {
        let [paper, computed] = ["paper", "computed"].map(|key| word(claim, key));
        let verdict = claim["verdict"].as_str().unwrap();
        let verdict =
            if verdict == "reproduced" { verdict.to_owned() } else { format!("**{verdict}**") };
        block += &format!("| `{id}` | {paper} | {computed} | {verdict} |\n");
    }
    block += "\n### Evidence where we differ, or cannot tell\n";
    for (id, claim) in claims.iter().filter(|it| it.1["verdict"] != "reproduced") {
        block += &format!("\n**`{id}`**. {}\n\n", word(claim, "note"));
        for it in claim["evidence"].as_array().unwrap() {
            block += &format!("- {}: {}\n", word(it, "method"), word(it, "finding"));
        }
    }
    let spliced = format!("{before}{BEGIN}{block}{END}{after}");
    if std::env::var_os("PERCUSS_SPLICE").is_some() {
        std::fs::write(&path, &spliced).expect("written");
    } else {
        assert!(
            page == spliced,
            "PERCUSS_SPLICE=1 cargo test --test harness reproduce:: makes them equal"
        );
    }
}

#[test]
fn what_is_not_accepted_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let unknown = reproduce(folder.path(), &["--only", "fig99"]);
    assert_eq!(unknown.status.code(), Some(2));
    let said = text(&unknown.stderr);
    assert!(said.contains("--only fig99") && said.contains("table1-closed"), "{said}");
    assert_eq!(said.lines().count(), 1);
    let nowhere = run(&["reproduce"]);
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(text(&nowhere.stderr).contains("--out"));
    let file = folder.path().join("a-file");
    std::fs::write(&file, "").unwrap();
    let onto_a_file = reproduce(&file, &QUICK_ITEMS);
    assert_eq!(onto_a_file.status.code(), Some(2));
    assert!(text(&onto_a_file.stderr).contains("accepted is a writable folder"));
    assert_eq!(run(&["reproduce", "--out", "x", "--xi", "0.1"]).status.code(), Some(2));
}

/// An item is taken up where an interrupted run of the same program has finished it, and only then.
#[test]
fn interrupted_work_is_taken_up() {
    let folder = tempfile::tempdir().unwrap();
    let unfinished = folder.path().join(".unfinished");
    std::fs::create_dir(&unfinished).unwrap();
    // Another program's work is computed again.
    let kept = r#"{"key":"another","claims":[],"files":[]}"#;
    std::fs::write(unfinished.join("figure-5.json"), kept).unwrap();
    let done = reproduce(folder.path(), &["--only", "fig5"]);
    assert!(done.status.success());
    assert_eq!(by_id(&json(&folder.path().join("claims.json"))).len(), 1);
    assert!(!unfinished.exists(), "nothing is left to take up");
}
