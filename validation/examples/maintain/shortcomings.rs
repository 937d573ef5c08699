//! Makes the expected failures anew: `cargo maintain shortcomings`.
//!
//! Every bound that fails in one of the reports becomes a row of its engine's defect, with a range
//! around the figure that was measured; rows that no report has stay as they are, and so do figures
//! of probes that were not asked for. An engine has one defect on the oscillator and one on other
//! systems. Reasons are people's: those of the present file are kept, a new defect gets an empty
//! one, which the program refuses to read.

use super::blocks;
use anyhow::{Context, Result, ensure};
use percuss_validation::case::embedded;
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A figure may differ by this factor on another processor: a step that is accepted here is refused
/// there.
const PLATFORM_FACTOR: f64 = 3.0;
/// Quantities that are counts.
const COUNTED_QUANTITIES: [&str; 6] = [
    "events_missed",
    "events_spurious",
    "events_wrong_mode",
    "phase_word",
    "restarts_failed",
    "runs_failed",
];

/// Quantities that are measured by probes, which a report may have been made without.
const PROBED_QUANTITIES: [&str; 4] =
    ["restart_error", "restarts_failed", "valid_gain", "attractor_distance"];

/// Case, setting (a step is negative), quantity and statistic.
type Key = (String, String, String, String);

/// Engine, case and setting.
type RowKey = (String, String, String);

/// The rows of the reports, each with the quantities that were measured.
type Reported = BTreeMap<RowKey, BTreeSet<String>>;

/// An engine and a group of its rows: those of the oscillator, or of other systems the events, the
/// errors and the runs without a result. Each group has a reason of its own.
type RowGroup = (String, &'static str);

/// The rows of each group, with the range of each.
type Defects = BTreeMap<RowGroup, BTreeMap<Key, (f64, f64)>>;

/// Print the file of expected failures anew, from reports of the full suite
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The present file: another than that of the engines in Rust is programs/shortcomings.toml
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/shortcomings.toml"))]
    file: PathBuf,
    /// The report.json of each run
    #[arg(required = true)]
    reports: Vec<PathBuf>,
}

pub(crate) fn run(Arguments { file, reports }: &Arguments) -> Result<()> {
    let mut defects = Defects::new();
    let mut reported = Reported::new();
    let systems = embedded()?.into_iter().filter(|case| case.oscillator.is_none());
    let systems: BTreeSet<String> = systems.map(|case| case.name).collect();
    for path in reports {
        let report: Value = blocks::read_json(path)?;
        // `quick` has no rows at other tolerances, and measures fewer restarts: what it does not
        // show would be dropped.
        ensure!(report["suite"] == "full", "{} is no report of the full suite", path.display());
        for row in report["results"].as_array().context("a report has results")? {
            let bounds = row["bounds"].as_array().into_iter().flatten();
            let quantities = bounds.filter_map(|it| it["quantity"].as_str().map(str::to_owned));
            reported.entry(place(row)?).or_default().extend(quantities);
            collect(row, &systems, &mut defects)?;
        }
    }
    let whys = present(file, &systems, &reported, &mut defects)?;
    println!(
        "# Expected failures of engines on the cases inside the binary, row by row: case, tolerance (or"
    );
    println!(
        "# negative step), quantity, statistic, least and largest value of the figure that is out of bounds."
    );
    println!("# Made by `cargo maintain shortcomings REPORT`; the reasons are people's.");
    for (group, rows) in defects {
        let (why, engine) = (whys.get(&group).cloned().unwrap_or_default(), group.0);
        println!("\n[[defects]]\nengine = {engine:?}\nwhy = {why:?}\nrows = [");
        for ((case, setting, quantity, statistic), (at_least, at_most)) in rows {
            println!(
                "    [{case:?}, {setting}, {quantity:?}, {statistic:?}, {at_least}, {at_most}],"
            );
        }
        println!("]");
    }
    Ok(())
}

/// The group of an engine's row.
fn group(engine: &str, case: &str, quantity: &str, systems: &BTreeSet<String>) -> RowGroup {
    let events = ["events_missed", "events_spurious", "events_wrong_mode", "location"];
    let group = match quantity {
        _ if !systems.contains(case) => "",
        "runs_failed" => "runs",
        quantity if events.contains(&quantity) => "events",
        _ => "errors",
    };
    (engine.to_owned(), group)
}

/// A row's engine, case and setting (a step is negative, the exact solver has none).
fn place(row: &Value) -> Result<RowKey> {
    let text = |key: &str| row[key].as_str().map(str::to_owned).context("a row has names");
    let setting = match (row["tolerance"].as_f64(), row["step"].as_f64()) {
        (Some(tolerance), _) => float(tolerance),
        (None, Some(step)) => float(-step),
        (None, None) => String::new(),
    };
    Ok((text("engine")?, text("case")?, setting))
}

fn collect(row: &Value, systems: &BTreeSet<String>, defects: &mut Defects) -> Result<()> {
    let text = |value: &Value| value.as_str().map(str::to_owned).context("a string");
    for bound in row["bounds"].as_array().context("a row has bounds")? {
        let failing = matches!(bound["verdict"].as_str(), Some("fail" | "known"));
        let Some(value) = bound["value"].as_f64().filter(|_| failing) else { continue };
        let limit = bound["limit"].as_f64().context("a bound has a limit")?;
        let (engine, case, setting) = place(row)?;
        if setting.is_empty() {
            continue;
        }
        let quantity = text(&bound["quantity"])?;
        let group = group(&engine, &case, &quantity, systems);
        let key = (case, setting, quantity.clone(), text(&bound["statistic"])?);
        let own = defects.entry(group).or_default();
        own.insert(key, range(&quantity, value, limit));
    }
    Ok(())
}

/// The range around a figure.
fn range(quantity: &str, value: f64, limit: f64) -> (f64, f64) {
    if ["phase_word", "runs_failed"].contains(&quantity) {
        (1.0, 1.0)
    } else if COUNTED_QUANTITIES.contains(&quantity) {
        ((value / 2.0).ceil(), 2.0 * value)
    } else {
        let digits = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
        (digits(value / PLATFORM_FACTOR).max(limit), digits(value * PLATFORM_FACTOR))
    }
}

/// A number as TOML takes it for a float.
fn float(value: f64) -> String {
    format!("{value:e}")
}

/// The reasons of the present file; its rows that no report has are kept.
fn present(
    path: &Path,
    systems: &BTreeSet<String>,
    reported: &Reported,
    defects: &mut Defects,
) -> Result<BTreeMap<RowGroup, String>> {
    let file: PresentFile =
        toml::from_str(&blocks::read(path)?).with_context(|| path.display().to_string())?;
    let mut reasons = BTreeMap::new();
    for PresentDefect { engine, why, rows } in file.defects {
        for (case, setting, quantity, statistic, at_least, at_most) in rows {
            let group = group(&engine, &case, &quantity, systems);
            reasons.entry(group.clone()).or_insert_with(|| why.clone());
            let place = (engine.clone(), case, float(setting));
            let measured = reported.get(&place);
            let is_measured = |it: &BTreeSet<String>| {
                !PROBED_QUANTITIES.contains(&&*quantity) || it.contains(&quantity)
            };
            if !measured.is_some_and(is_measured) {
                let key = (place.1, place.2, quantity, statistic);
                defects.entry(group).or_default().insert(key, (at_least, at_most));
            }
        }
    }
    Ok(reasons)
}

/// The file as it is.
#[derive(Deserialize)]
struct PresentFile {
    #[serde(default)]
    defects: Vec<PresentDefect>,
}

#[derive(Deserialize)]
struct PresentDefect {
    engine: String,
    why: String,
    rows: Vec<(String, f64, String, String, f64, f64)>,
}
