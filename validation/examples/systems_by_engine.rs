//! Puts the table of systems by engines into docs/FINDINGS.md: how many rows of each system each
//! engine passes, passes but for expected failures, and fails.
//!
//! ```sh
//! cargo run --release -- validate --out target/quick
//! cargo run --release -p percuss-validation --example systems_by_engine -- \
//!   target/quick/report.json docs/FINDINGS.md
//! ```

use anyhow::{Context, Result};
use percuss_validation::case::embedded;
use percuss_validation::report::CaseNote;
use serde_json::Value;
use std::collections::BTreeMap;

const BEGIN: &str = "<!-- begin: systems by engine -->\n";
const END: &str = "<!-- end: systems by engine -->";

fn main() -> Result<()> {
    let usage = "takes the report.json of a run and the page to write";
    let [report, page]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().ok().context(usage)?;
    let text = std::fs::read_to_string(&report).with_context(|| report.clone())?;
    let table = table(&serde_json::from_str(&text)?, &systems()?)?;
    let old = std::fs::read_to_string(&page).with_context(|| page.clone())?;
    std::fs::write(&page, spliced(&old, &table)?).with_context(|| page.clone())
}

/// A page with another table between the marks.
pub(crate) fn spliced(old: &str, table: &str) -> Result<String> {
    let (before, rest) = old.split_once(BEGIN).context("the page has no table of the systems")?;
    let (_, after) = rest.split_once(END).context("the table does not end")?;
    Ok(format!("{before}{BEGIN}{table}{END}{after}"))
}

/// The system of each case inside the binary.
pub(crate) fn systems() -> Result<BTreeMap<String, String>> {
    let notes = embedded()?.into_iter().map(|it| CaseNote::of(&it, true));
    Ok(notes.map(|it| (it.name, it.system)).collect())
}

/// How the rows of an engine on the cases of a system came out.
#[derive(Clone, Copy, Default)]
struct Outcomes {
    pass: usize,
    known: usize,
    fail: usize,
    ran: usize,
    rows: usize,
}

impl Outcomes {
    fn add(&mut self, verdict: &str) {
        self.rows += 1;
        self.ran += usize::from(!matches!(verdict, "not-run" | "unavailable"));
        match verdict {
            "pass" => self.pass += 1,
            "known" => self.known += 1,
            "fail" | "error" => self.fail += 1,
            _ => {}
        }
    }

    fn shown(self) -> String {
        let Self { pass, known, fail, ran, rows } = self;
        if ran == 0 { "\u{2013}".to_owned() } else { format!("{pass}/{known}/{fail} of {rows}") }
    }
}

/// The table, below a line that says what was run where.
pub(crate) fn table(report: &Value, systems: &BTreeMap<String, String>) -> Result<String> {
    let text = |value: &Value| value.as_str().unwrap_or("unknown").to_owned();
    let rows = report["results"].as_array().context("the report has no results")?;
    let mut counted: BTreeMap<(String, String), Outcomes> = BTreeMap::new();
    let (mut names, mut engines): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    for row in rows {
        let (case, engine) = (text(&row["case"]), text(&row["engine"]));
        let unknown = || format!("the case {case} is not inside the program");
        let system = systems.get(&case).with_context(unknown)?;
        for (known, name) in [(&mut names, system), (&mut engines, &engine)] {
            if !known.contains(name) {
                known.push(name.clone());
            }
        }
        counted.entry((system.clone(), engine)).or_default().add(&text(&row["verdict"]));
    }
    let line = |engine: &String| {
        let of = |system: &String| counted.get(&(system.clone(), engine.clone())).copied();
        let cells: Vec<_> = names.iter().map(|it| of(it).unwrap_or_default().shown()).collect();
        format!("| {engine} | {} |\n", cells.join(" | "))
    };
    let [percuss, commit, suite] = ["percuss", "commit", "suite"].map(|key| text(&report[key]));
    Ok(format!(
        "{} rows of the suite {suite}; percuss {percuss} at {commit}.\n\n\
         | engine | {} |\n| --- |{}\n{}",
        rows.len(),
        names.join(" | "),
        " --: |".repeat(names.len()),
        engines.iter().map(line).collect::<String>(),
    ))
}
