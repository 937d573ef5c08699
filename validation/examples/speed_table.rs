//! Puts the figures of a `bench` into README.md.
//!
//! ```sh
//! cargo run --release -- bench --out target/bench
//! cargo run --release -p percuss-validation --example speed_table -- target/bench/bench.json README.md
//! ```

use anyhow::{Context, Result};
use comfy_table::{CellAlignment, Table, presets};
use percuss_validation::bench::lead::{Shortfall, times};
use percuss_validation::number::{brief, shortest};
use serde_json::Value;

const BEGIN: &str = "<!-- begin: bench -->\n";
const END: &str = "<!-- end: bench -->";

fn main() -> Result<()> {
    let usage = "takes the bench.json of a bench and the README.md to write";
    let [bench, readme]: [String; 2] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().ok().context(usage)?;
    let text = std::fs::read_to_string(&bench).with_context(|| bench.clone())?;
    let block = block(&serde_json::from_str(&text)?)?;
    let old = std::fs::read_to_string(&readme).with_context(|| readme.clone())?;
    let (before, rest) = old.split_once(BEGIN).context("README.md has no block of the bench")?;
    let (_, after) = rest.split_once(END).context("the block does not end")?;
    std::fs::write(&readme, format!("{before}{BEGIN}{block}{END}{after}"))?;
    Ok(())
}

fn block(bench: &Value) -> Result<String> {
    let word = |key: &str| bench[key].as_str().unwrap_or("unknown");
    let floor = |key: &str| bench["floor"][key].as_f64().unwrap_or(f64::NAN);
    let cases = bench["cases"].as_array().context("no cases")?;
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header([
        "case",
        "ns/switch",
        "floors",
        "evaluations",
        "ns/period",
        "state err",
        "least behind",
        "tol",
        "ns/period",
        "state err",
        "times",
    ]);
    for case in cases.iter().filter_map(|it| it["case"].as_str()) {
        table.add_row(cells(bench, case).with_context(|| format!("{case} has no times"))?);
    }
    for column in table.column_iter_mut().filter(|it| ![0, 6].contains(&it.index)) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    let lines: Vec<_> = table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    let short = cases.iter().filter_map(|case| shortfall(bench, case));
    let short: String = short.map(|it| format!("{it}\n")).collect();
    Ok(format!(
        "```text\npercuss {} at {}, {}, on {}, {} rounds\nfloor: {:.1} ns a sine, cosine and \
         exponential that wait for the last, {:.1} ns independent ones\n{}\n\n{short}```\n",
        word("percuss"),
        word("commit"),
        word("rustc"),
        word("cpu"),
        bench["rounds"],
        floor("chained_ns"),
        floor("independent_ns"),
        lines.join("\n")
    ))
}

/// The rows of a case in a table of the bench.
fn of<'a>(bench: &'a Value, table: &str, case: &str) -> impl Iterator<Item = &'a Value> {
    bench[table].as_array().into_iter().flatten().filter(move |it| it["case"] == case)
}

/// The adaptive engine that is least behind the exact solver, each at its most accurate.
fn least_behind<'a>(bench: &'a Value, case: &str) -> Option<&'a Value> {
    let best = |row: &&Value| row["adaptive"] == true && row["most_accurate"] == true;
    let rows = of(bench, "results", case).filter(best);
    rows.min_by(|a, b| ratio(a).total_cmp(&ratio(b)))
}

fn exact<'a>(bench: &'a Value, case: &str) -> Option<&'a Value> {
    of(bench, "results", case).find(|row| row["engine"] == "exact")
}

fn ratio(row: &Value) -> f64 {
    row["ratio_to_exact"].as_f64().unwrap_or(f64::INFINITY)
}

/// The exact solver on a case, and the engine that is least behind it.
fn cells(bench: &Value, case: &str) -> Option<[String; 11]> {
    let switch = of(bench, "switches", case).next()?;
    let (exact, next) = (exact(bench, case)?, least_behind(bench, case)?);
    let number = |row: &Value, key: &str| row[key].as_f64().unwrap_or(f64::NAN);
    Some([
        case.to_owned(),
        format!("{:.0}", number(switch, "ns_per_switch")),
        format!("{:.1}", number(switch, "floors_per_switch")),
        format!("{:.2}", number(switch, "evaluations_per_switch")),
        format!("{:.0}", number(exact, "ns_per_period")),
        brief(number(exact, "state_error_max")),
        next["engine"].as_str()?.to_owned(),
        shortest(number(next, "tolerance")),
        format!("{:.0}", number(next, "ns_per_period")),
        brief(number(next, "state_error_max")),
        times(ratio(next)),
    ])
}

/// What is missing on a case to the lead that is asked for.
fn shortfall<'a>(bench: &'a Value, entry: &'a Value) -> Option<Shortfall<'a>> {
    let case = entry["case"].as_str()?;
    let next = least_behind(bench, case)?;
    let it = Shortfall {
        case,
        engine: next["engine"].as_str()?,
        ratio: ratio(next),
        exact: exact(bench, case)?["ns_per_period"].as_f64()?,
        right_hand_sides: next["rhs_per_period"].as_f64()?,
        a_switch: entry["periods"].as_f64()? / entry["switches"].as_f64()?,
        floor: bench["floor"]["chained_ns"].as_f64()?,
    };
    Some(it).filter(Shortfall::is_one)
}
