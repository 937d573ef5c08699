//! The commands of docs/RIG.md, run as they stand there, and the numbers that the page takes from
//! them.

use crate::support::{number, percuss, rows, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/RIG.md");
    std::fs::read_to_string(path).expect("docs/RIG.md is there")
}

/// The fenced blocks in a language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let opening = format!("\n```{language}\n");
    let parts = page.split(&opening).skip(1);
    parts.filter_map(|part| part.split_once("\n```").map(|(block, _)| block.to_owned())).collect()
}

/// Runs a command in a folder, with what it prints in the file that it is sent to; its exit code.
fn run(command: &str, folder: &Path) -> Option<i32> {
    let command = command.replace("\\\n", " ");
    let (command, file) = match command.split_once(" > ") {
        Some((command, file)) => (command.to_owned(), Some(file.trim().to_owned())),
        None => (command, None),
    };
    let words: Vec<_> = command.split_whitespace().collect();
    let (program, arguments) = words.split_first().expect("a command");
    assert_eq!(*program, "percuss", "{command}");
    let output = percuss(arguments).current_dir(folder).output().expect("it runs");
    assert!(file.is_some() || output.stdout.is_empty(), "{command}: {}", text(&output.stdout));
    if let Some(file) = file {
        std::fs::write(folder.join(file), &output.stdout).expect("written");
    }
    output.status.code()
}

/// Drift per period against the parameter, which is kept as its row has it.
fn drift(folder: &Path, name: &str) -> BTreeMap<String, f64> {
    let csv = std::fs::read_to_string(folder.join(name)).expect("the scan is there");
    // The last column is the standard error of the one before it.
    let last = |row: &Vec<String>| row.iter().rev().nth(1).map(|it| number(it)).expect("a drift");
    rows(&csv).iter().map(|row| (row[0].clone(), last(row))).collect()
}

fn fastest(drift: &BTreeMap<String, f64>) -> (f64, f64) {
    let best = drift.iter().max_by(|a, b| a.1.total_cmp(b.1)).expect("a value");
    (number(best.0), *best.1)
}

fn json(folder: &Path, name: &str) -> Value {
    let text = std::fs::read_to_string(folder.join(name)).expect("the file is there");
    serde_json::from_str(&text).expect("JSON")
}

/// The page holds this text.
fn says(page: &str, wanted: &str) {
    let flat = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains(wanted), "docs/RIG.md does not say: {wanted}");
}

#[test]
fn the_pages_commands_give_the_pages_numbers() {
    let (page, folder) = (page(), tempfile::tempdir().expect("a folder"));
    let folder = folder.path();
    let [rig] = &blocks(&page, "toml")[..] else { panic!("one rig") };
    std::fs::write(folder.join("rig.toml"), rig).expect("written");
    let codes: Vec<_> = blocks(&page, "sh").iter().map(|it| run(it, folder)).collect();
    // The last one follows a branch that turns back.
    assert_eq!(codes, [Some(0), Some(0), Some(0), Some(1)]);
    scans(&page, folder);
    attractors(&page, folder);
    let branch = json(folder, "branch.json");
    let [fold] = &branch["bifurcations"].as_array().expect("bifurcations")[..] else {
        panic!("one bifurcation: {branch}")
    };
    assert_eq!(fold["type"], "fold");
    says(&page, &format!("a fold at b = {:.4}", fold["value"].as_f64().expect("a value")));
}

/// What the page reads off the two scans.
fn scans(page: &str, folder: &Path) {
    let (cold, ramped) = (drift(folder, "cold.csv"), drift(folder, "ramped.csv"));
    let (b, rate) = fastest(&ramped);
    says(page, &format!("the best value of the scan is b = {b:.3}, with a drift of {rate:.2}"));
    let (b, rate) = fastest(&cold);
    says(page, &format!("from rest it is b = {b:.3}, with {rate:.2}"));
    let apart: Vec<f64> = cold
        .iter()
        .filter(|(b, rate)| (ramped[*b] - **rate).abs() > 1.0)
        .map(|(b, _)| number(b))
        .collect();
    let (first, last) = (apart.first().expect("apart"), apart.last().expect("apart"));
    says(page, &format!("From b = {first:.3} to {last:.2} the two differ"));
    let at = |scan: &BTreeMap<String, f64>| {
        *scan.iter().find(|(b, _)| (number(b) - 0.3).abs() < 1e-9).expect("b = 0.3").1
    };
    let (slow, fast) = (at(&cold), at(&ramped));
    assert_eq!((fast / slow).floor(), 17.0);
    says(page, &format!("a drift of {slow:.3}, a seventeenth of the {fast:.3}"));
    let moving = cold.iter().filter(|(_, rate)| **rate > 0.0).map(|(b, _)| number(b));
    let still = cold.keys().map(|b| number(b)).find(|b| moving.clone().all(|it| it < *b));
    says(page, &format!("(b from {:.3} on)", still.expect("it stops")));
}

/// The page's table of attractors.
fn attractors(page: &str, folder: &Path) {
    let found = json(folder, "attractors.json");
    for it in found["attractors"].as_array().expect("attractors") {
        let drift = it["drift_per_period"].as_f64().expect("a drift");
        let row = format!(
            "| {} | {} | {:.1} % | {drift:.3} |",
            it["id"],
            it["period"],
            100.0 * it["fraction"].as_f64().expect("a share"),
        );
        says(page, &row);
        // Drifts of d/k = 400/5e4 m, omega/(2 pi) sqrt(k/m) times a second.
        let frequency = 0.4 / std::f64::consts::TAU * (5e4_f64 / 2.0).sqrt();
        let speed = 1e3 * drift * frequency * 400.0 / 5e4;
        let shown = if speed < 100.0 { format!("{speed:.1}") } else { format!("{speed:.0}") };
        says(page, &format!("{row} {shown} mm/s |"));
    }
    assert_eq!(found["attractors"].as_array().map(Vec::len), Some(2));
    assert_eq!(found["unresolved"], 0.0);
    // The starting point of the continuation is that of the fast orbit.
    let start = &found["attractors"][0]["points"][0];
    let [p, y, q] = [0, 1, 2].map(|k| start[k].as_f64().expect("a number"));
    says(page, &format!("--p {p:.2} --y {y:.4} --q {q:.0}"));
    assert!((std::fs::metadata(folder.join("basins.png")).expect("drawn").len()) > 0);
}
