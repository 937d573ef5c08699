//! Random piecewise-affine systems without libFuzzer: a hundred thousand (`RUNS`) from the number
//! `SEED` on, each against 106 bits and at the crest of a guard. Prints the first fault of each
//! kind; with `SHOW`, the text of that system.

use percuss_fuzz::systems::{Met, check, system};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    if let Some(seed) = number("SHOW") {
        print!("{}", system(seed));
        return ExitCode::SUCCESS;
    }
    let (first, runs) = (number("SEED").unwrap_or(0), number("RUNS").unwrap_or(100_000));
    let (mut met, mut faults) = (Met::default(), BTreeMap::<String, (u64, u64, String)>::new());
    let mut slowest = (0.0, 0);
    std::panic::set_hook(Box::new(|_| {}));
    for seed in first..first + runs {
        let before = Instant::now();
        let checked = catch_unwind(AssertUnwindSafe(|| check(seed, &mut met)));
        let spent = before.elapsed().as_secs_f64();
        if spent > slowest.0 {
            slowest = (spent, seed);
        }
        if let Err(fault) = checked.unwrap_or_else(|_| Err("panic".to_owned())) {
            let line = fault.lines().next().unwrap_or_default();
            let kind = line.chars().filter(|it| !it.is_ascii_digit() && *it != '.').collect();
            faults.entry(kind).or_insert((0, seed, line.to_owned())).0 += 1;
        }
    }
    println!("{runs} systems, {met:?}, slowest {:.2} s (seed {})", slowest.0, slowest.1);
    for (count, seed, line) in faults.values() {
        println!("{count} x, first at seed {seed}: {line}");
    }
    if faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
