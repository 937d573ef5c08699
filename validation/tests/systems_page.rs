//! docs/SYSTEMS.md has a section for every system, its examples print what they show, its pictures
//! are those that its commands make, and what it says to be known is so.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness systems_page::` writes output and pictures anew.

use crate::support::transcripts;
use crate::support::{number, rows, stdout};
use percuss_validation::systems::SYSTEMS;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// A picture on the page, in bytes.
const MAX_BYTES: u64 = 60_000;

fn page() -> PathBuf {
    transcripts::page("SYSTEMS.md")
}

#[test]
fn every_system_has_a_section() {
    let text = transcripts::read(&page());
    let headings = text.lines().filter_map(|line| line.strip_prefix("## `")?.strip_suffix('`'));
    let headings: Vec<&str> = headings.collect();
    let names: Vec<&str> = SYSTEMS.iter().map(|(name, _)| *name).collect();
    assert_eq!(headings.iter().collect::<BTreeSet<_>>(), names.iter().collect::<BTreeSet<_>>());
    assert_eq!(headings.len(), names.len(), "a section each");
    for name in names {
        let section = text.split(&format!("\n## `{name}`\n")).nth(1).expect("its section");
        let section = section.split("\n## ").next().unwrap_or_default();
        let file = format!("](../validation/systems/{name}.system.toml)");
        let wanted =
            [&file, "**What it is for.**", "**Source.**", "**What is known.**", "](systems/"];
        for wanted in wanted {
            assert!(section.contains(wanted), "{name}: {wanted} is not there");
        }
    }
}

#[test]
fn examples_print_what_they_show_and_make_the_pictures() {
    let root = tempfile::tempdir().expect("a folder");
    let folder = root.path().join("docs");
    std::fs::create_dir_all(folder.join("systems")).expect("made");
    let cases = root.path().join("validation/cases/systems");
    std::fs::create_dir_all(&cases).expect("made");
    for case in std::fs::read_dir(transcripts::page("../validation/cases/systems")).expect("read") {
        let case = case.expect("an entry");
        std::fs::copy(case.path(), cases.join(case.file_name())).expect("copied");
    }
    transcripts::hold(&page(), &folder, "systems_page::");
    let made = folder.join("systems");
    let shown = transcripts::hold_pictures(&page(), "systems", &made);
    assert!(shown.len() >= SYSTEMS.len(), "{shown:?}");
    for name in &shown {
        let bytes = std::fs::metadata(made.join(name)).expect("it is made").len();
        assert!(bytes <= MAX_BYTES, "{name} has {bytes} bytes");
    }
    let kept = std::fs::read_dir(transcripts::page("systems")).expect("the pictures");
    let kept = kept.filter_map(|it| it.ok()?.file_name().into_string().ok());
    assert_eq!(kept.collect::<BTreeSet<_>>(), shown);
}

/// The rows of a run.
fn run(arguments: &str) -> Vec<Vec<String>> {
    let words: Vec<&str> = arguments.split_whitespace().collect();
    rows(&stdout(&[&["events"], &words[..]].concat()))
}

/// The times of a run's rows but those of its start and its end.
fn times(rows: &[Vec<String>]) -> Vec<f64> {
    rows[1..rows.len() - 1].iter().map(|row| number(&row[1])).collect()
}

/// On the limit cycle the output at a switching is what is left of a square wave of half-period T,
/// which is the sum of its steps: 1 - 2 (s(T) - s(2 T) + s(3 T) - ...), where 1 - s is the answer
/// of the three equal poles to a step. It is C (I + e^AT)^-1 A^-1 (e^AT - I) B, written out.
#[test]
fn the_relays_half_period_solves_its_equation() {
    let step = |t: f64| 1.0 - (-t).exp() * (1.0 + t + 0.5 * t * t);
    let output = |half: f64| {
        let switchings = (1..200).map(|n| {
            let sign = if n % 2 == 1 { 1.0 } else { -1.0 };
            2.0 * sign * (1.0 - step(f64::from(n) * half))
        });
        1.0 - switchings.sum::<f64>()
    };
    for (delta, known) in [("1e-2", 1.919_201), ("1e-4", 1.840_734), ("1e-6", 1.839_883)] {
        let times = times(&run(&format!("relay-feedback --until 40 --set delta={delta}")));
        let half = times[times.len() - 1] - times[times.len() - 2];
        assert!((half - known).abs() < 1e-6, "{delta}: {half}");
        assert!((output(half) - number(delta)).abs() < 1e-7, "{delta}: {}", output(half));
    }
}

#[test]
fn what_else_is_known_is_met() {
    // Spheres keep their momentum, elastic or not.
    for e in ["1", "0.5", "0.9"] {
        let rows = run(&format!("spheres-in-a-row --until 3 --set e={e}"));
        let last = rows.last().expect("an end");
        let momentum: f64 = last[7..10].iter().map(|cell| number(cell)).sum();
        assert!(momentum.abs() < 1e-15, "{e}: {momentum}");
    }
    // Den Hartog: with A < Fs the mass never moves.
    let held = run("dry-friction-oscillator --until 60 --set A=0.9");
    assert_eq!((held.len(), held[1][2].as_str()), (2, "end"));
    // At rest on the belt until the springs pull harder than the friction holds.
    let belt = run("two-masses-on-a-belt --events 1");
    assert_eq!(belt[1][1..3], ["1.1250000000000000", "second-slips-behind"]);
}

/// Period doubling on the way to chaos: how many ticks of the clock it takes the converter to
/// repeat itself.
#[test]
fn the_converter_doubles_its_period() {
    for (supply, period) in [("24", 1), ("25", 2)] {
        let rows = run(&format!("buck-converter --until 0.2999 --set Vin={supply}"));
        let ticks: Vec<f64> =
            rows.iter().filter(|row| row[2] == "clock").map(|row| number(&row[4])).collect();
        let last = &ticks[ticks.len() - 9..];
        let repeats =
            |after: usize| last.windows(after + 1).all(|it| (it[0] - it[after]).abs() < 1e-9);
        assert!(repeats(period) && (period == 1 || !repeats(1)), "{supply}: {last:?}");
    }
}
