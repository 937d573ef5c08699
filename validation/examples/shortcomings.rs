//! Writes `shortcomings.toml` anew from a `report.json` of the full suite.
//!
//! `cargo run --release --example shortcomings -- REPORT...` prints the file: every bound that
//! fails in one of the reports becomes a row of its engine's defect, with a floor and a ceiling
//! around the figure that was measured. Reasons are people's: those of the present file are kept, a
//! new defect gets an empty one, which the program refuses to read.

use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::collections::BTreeMap;

/// A figure may differ by this factor on another processor: a step that is accepted here is refused
/// there.
const FACTOR: f64 = 3.0;
/// Quantities that are counts.
const COUNTS: [&str; 5] =
    ["events_missed", "events_spurious", "phase_word", "restarts_failed", "runs_failed"];

/// Case, setting (a step is negative), quantity and statistic.
type Key = (String, String, String, String);

fn main() -> Result<()> {
    let mut defects: BTreeMap<String, BTreeMap<Key, (f64, f64)>> = BTreeMap::new();
    let reports: Vec<String> = std::env::args().skip(1).collect();
    if reports.is_empty() {
        bail!("name one report.json or more");
    }
    for path in reports {
        let text = std::fs::read_to_string(&path).with_context(|| path.clone())?;
        let report: Value = serde_json::from_str(&text).with_context(|| path.clone())?;
        for row in report["results"].as_array().context("a report has results")? {
            collect(row, &mut defects)?;
        }
    }
    let whys = reasons()?;
    println!(
        "# Known shortcomings of engines on the cases inside the binary, row by row: case, tolerance (or"
    );
    println!(
        "# negative step), quantity, statistic, floor and ceiling of the figure that is out of bounds."
    );
    println!(
        "# Made by `cargo run --release --example shortcomings -- REPORT`; the reasons are people's."
    );
    for (engine, rows) in defects {
        let why = whys.get(&engine).cloned().unwrap_or_default();
        println!("\n[[defects]]\nengine = {engine:?}\nwhy = {why:?}\nrows = [");
        for ((case, setting, quantity, statistic), (floor, ceiling)) in rows {
            println!("    [{case:?}, {setting}, {quantity:?}, {statistic:?}, {floor}, {ceiling}],");
        }
        println!("]");
    }
    Ok(())
}

fn collect(row: &Value, defects: &mut BTreeMap<String, BTreeMap<Key, (f64, f64)>>) -> Result<()> {
    let text = |value: &Value| value.as_str().map(str::to_owned).context("a string");
    for bound in row["bounds"].as_array().context("a row has bounds")? {
        let failing = matches!(bound["verdict"].as_str(), Some("fail" | "known"));
        let Some(value) = bound["value"].as_f64().filter(|_| failing) else { continue };
        let limit = bound["limit"].as_f64().context("a bound has a limit")?;
        let setting = match (row["tolerance"].as_f64(), row["step"].as_f64()) {
            (Some(tolerance), _) => float(tolerance),
            (None, Some(step)) => float(-step),
            _ => continue,
        };
        let quantity = text(&bound["quantity"])?;
        let key = (text(&row["case"])?, setting, quantity.clone(), text(&bound["statistic"])?);
        let own = defects.entry(text(&row["engine"])?).or_default();
        let most = if quantity == "events_missed" { row["events_expected"].as_f64() } else { None };
        own.insert(key, range(&quantity, value, limit, most));
    }
    Ok(())
}

/// Floor and ceiling around a figure. One that cannot exceed `most` stays below it by half of what
/// there is to it, because a ceiling above it would bound nothing.
fn range(quantity: &str, value: f64, limit: f64, most: Option<f64>) -> (f64, f64) {
    if ["phase_word", "runs_failed"].contains(&quantity) {
        (1.0, 1.0)
    } else if COUNTS.contains(&quantity) {
        let halfway = most.map_or(f64::INFINITY, |most| (0.5 * (value + most)).floor());
        ((value / 2.0).ceil(), (2.0 * value).min(halfway.max(value)))
    } else {
        let digits = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
        (digits(value / FACTOR).max(limit), digits(value * FACTOR))
    }
}

/// A number as TOML takes it for a float.
fn float(value: f64) -> String {
    format!("{value:e}")
}

/// The reasons of the present file, by engine.
fn reasons() -> Result<BTreeMap<String, String>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/shortcomings.toml");
    let file: toml::Table = std::fs::read_to_string(path).context(path)?.parse()?;
    let defects = file.get("defects").and_then(toml::Value::as_array).cloned().unwrap_or_default();
    let reason = |it: &toml::Value| {
        Some((it.get("engine")?.as_str()?.to_owned(), it.get("why")?.as_str()?.to_owned()))
    };
    Ok(defects.iter().filter_map(reason).collect())
}
