//! Prints the case in each file named (a libFuzzer artifact) and what the check says; without
//! names, checks a million random cases (`RUNS`, from the draws of `SEED`) and prints one of each
//! kind of fault.

use percuss_fuzz::{Case, Tally, check, check_counted};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

fn main() {
    let names: Vec<_> = std::env::args().skip(1).collect();
    for name in &names {
        match std::fs::read(name) {
            Ok(bytes) => {
                let case = Case::decode(&bytes);
                println!("{case:?}\n{:?}", check(&case));
            }
            Err(error) => eprintln!("{name}: {error}"),
        }
    }
    if names.is_empty() {
        random();
    }
}

fn random() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(2 * number("SEED").unwrap_or(0) + 1);
    let mut tally = Tally::default();
    let mut faults = BTreeMap::<String, (u64, String)>::new();
    let mut slowest = (0.0, String::new());
    std::panic::set_hook(Box::new(|_| {}));
    let current = Arc::new(Mutex::new((Instant::now(), Case::decode(&[]))));
    let watched = Arc::clone(&current);
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            if let Ok(current) = watched.lock()
                && current.0.elapsed() > Duration::from_secs(60)
            {
                println!("hang: {:?}", current.1);
                std::process::exit(1);
            }
        }
    });
    let runs = number("RUNS").unwrap_or(1_000_000);
    for run in 0..runs {
        if run > 0 && run % 100_000 == 0 {
            println!("{run} cases, {} kinds of fault, {tally:?}", faults.len());
        }
        let bytes: Vec<u8> = (0..160)
            .map(|_| {
                seed ^= seed << 13;
                seed ^= seed >> 7;
                seed ^= seed << 17;
                (seed >> 32) as u8
            })
            .collect();
        let case = Case::decode(&bytes);
        let before = Instant::now();
        if let Ok(mut current) = current.lock() {
            *current = (before, case.clone());
        }
        let verdict = catch_unwind(AssertUnwindSafe(|| check_counted(&case, &mut tally)))
            .unwrap_or_else(|_| Err("panic".to_owned()));
        let spent = before.elapsed().as_secs_f64();
        if spent > slowest.0 {
            slowest = (spent, format!("{case:?}"));
        }
        if let Err(fault) = verdict {
            let kind: String = fault
                .split_inclusive(|c: char| c == ',')
                .next()
                .unwrap_or_default()
                .chars()
                .filter(|c| !c.is_ascii_digit() && *c != '.')
                .collect();
            let entry = faults.entry(kind).or_insert_with(|| {
                let first = format!("{fault}\n  {case:?}");
                println!("case {run}: {first}");
                (0, first)
            });
            entry.0 += 1;
        }
    }
    for (kind, (count, first)) in faults {
        println!("{count} x {kind}\n  {first}");
    }
    println!("{runs} cases, {tally:?}");
    println!("slowest: {} s {}", slowest.0, slowest.1);
}
