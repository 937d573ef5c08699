//! Counts the rows of systems by engines for docs/FINDINGS.md: `cargo maintain systems-table`.

use super::blocks;
use anyhow::{Context, Result};
use percuss_validation::case::embedded;
use percuss_validation::report::CaseNote;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The name of the page's block.
pub(crate) const BLOCK: &str = "systems by engine";

/// Put the table of systems by engines into docs/FINDINGS.md
///
/// It counts how many rows of each system each engine passes, passes but for expected failures,
/// and fails.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The report.json of a run
    report: PathBuf,
    /// The page to write
    page: PathBuf,
}

pub(crate) fn run(Arguments { report, page }: &Arguments) -> Result<()> {
    let table = table(&blocks::read_json(report)?, &systems()?)?;
    blocks::replace(page, &[(BLOCK, table)])
}

/// The system of each case inside the binary.
pub(crate) fn systems() -> Result<BTreeMap<String, String>> {
    let notes = embedded()?.into_iter().map(|it| CaseNote::new(&it, true));
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

    fn to_cell(self) -> String {
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
        let cells: Vec<_> = names.iter().map(|it| of(it).unwrap_or_default().to_cell()).collect();
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
