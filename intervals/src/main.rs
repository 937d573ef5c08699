//! `percuss-intervals [SWITCHES] [SEED] [REGIME]` prints a table of proofs, one row per regime. It
//! exits with 1 if an event is contradicted, or if of those that the solver decided more than one
//! in ten thousand are open.

use percuss_intervals::regimes::{Chance, REGIMES, Regime};
use percuss_intervals::tally::{HEADER, Tally};
use std::process::ExitCode;
use std::thread;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default| arguments.next().map_or(Some(default), |text| text.parse().ok());
    let (Some(switches), Some(seed)) = (number(20_000), number(1)) else {
        eprintln!("usage: percuss-intervals [SWITCHES] [SEED] [REGIME]");
        return ExitCode::from(2);
    };
    let only = arguments.next().unwrap_or_default();
    let tallies = tally_all(switches, seed, &only);
    println!("{HEADER}");
    let mut total = Tally::default();
    for (regime, tally) in &tallies {
        println!("{}", tally.row(regime.name));
        for example in &tally.examples {
            eprintln!("{}: {example}", regime.name);
        }
        total.add(tally);
    }
    println!("{}", total.row("all"));
    if total.holds() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Every regime of that name on two threads: the same numbers on any machine.
fn tally_all(switches: u64, seed: u64, only: &str) -> Vec<(&'static Regime, Tally)> {
    let chosen: Vec<_> =
        REGIMES.iter().enumerate().filter(|(_, it)| it.name.contains(only)).collect();
    let half = |parity: usize| -> Vec<_> {
        let mine = chosen.iter().filter(|(number, _)| number % 2 == parity);
        let tally = |(number, regime): &(usize, &'static Regime)| {
            let mut chance = Chance::new(seed.wrapping_add(*number as u64 * 1_000_003));
            let wanted = (regime.share * switches as f64) as u64;
            (*number, *regime, Tally::new(regime, wanted, &mut chance))
        };
        mine.map(tally).collect()
    };
    let (mut done, others) = thread::scope(|scope| {
        let other = scope.spawn(|| half(1));
        (half(0), other.join().unwrap_or_default())
    });
    done.extend(others);
    done.sort_by_key(|(number, ..)| *number);
    done.into_iter().map(|(_, regime, tally)| (regime, tally)).collect()
}
