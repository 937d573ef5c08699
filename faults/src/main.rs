//! Puts small faults into percuss, one at a time, and lists those that no test notices.
//!
//! The sources are copied, and a seeded sample of places in them is rewritten so that each place
//! asks at run time whether its fault is the chosen one. So one build serves all faults: the tests
//! are run once without a fault, which all must pass, and then with one fault after the other,
//! until the first test fails.

mod catalogue;
mod compile;
mod execute;
mod fault;
mod operators;
mod places;
mod record;
mod rewrite;
mod tree;
mod trial;

use anyhow::{Result, bail};
use clap::Parser;
use fault::Fault;
use std::path::PathBuf;

/// Puts small faults into percuss, one at a time, and lists those that no test notices.
#[derive(Parser)]
struct Arguments {
    /// Files and folders with the code that gets faults, relative to the root of the repository.
    #[arg(default_values_t = DEFAULT_TARGETS.map(str::to_owned))]
    targets: Vec<String>,
    /// How many faults are tried.
    #[arg(long, default_value_t = 150)]
    count: usize,
    /// The seed of the sample.
    #[arg(long, default_value_t = 15)]
    seed: u64,
    /// Lists every possible fault and tries none.
    #[arg(long)]
    list: bool,
    /// Tries these faults only, of the sample that `--count` and `--seed` draw.
    #[arg(long, value_delimiter = ',')]
    only: Vec<u32>,
    /// Asks the tests of the validation packages about a fault in the solver that the solver's own
    /// tests pass.
    #[arg(long)]
    thorough: bool,
    /// Leaves out test programs of these names, such as slow ones at a first look.
    #[arg(long, value_delimiter = ',')]
    skip: Vec<String>,
    /// How many times its time without a fault a test program may take.
    #[arg(long, default_value_t = 4.0)]
    patience: f64,
    /// The folder for the copied sources and for the table `faults.csv`.
    #[arg(long, default_value = "target/faults")]
    out: PathBuf,
}

const DEFAULT_TARGETS: [&str; 5] = [
    "src/crossing",
    "src/run/switch.rs",
    "src/model/entry.rs",
    "src/run/variation.rs",
    "validation/harness/src/score",
];

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let root = tree::root()?;
    let catalogue = catalogue::Catalogue::read(&root, &arguments.targets)?;
    if arguments.list {
        catalogue.faults.iter().for_each(|fault| println!("{fault}"));
        println!("{} faults", catalogue.faults.len());
        return Ok(());
    }
    let scratch = arguments.out.join("tree");
    tree::copy(&root, &scratch)?;
    let sample =
        compile::sample_that_compiles(&catalogue, &scratch, arguments.count, arguments.seed)?;
    let chosen: Vec<Fault> = sample
        .into_iter()
        .filter(|fault| arguments.only.is_empty() || arguments.only.contains(&fault.number))
        .collect();
    if chosen.is_empty() {
        bail!("no fault is chosen");
    }
    let table = arguments.out.join("faults.csv");
    let plan = trial::Plan {
        thorough: arguments.thorough,
        patience: arguments.patience,
        skip: arguments.skip,
    };
    let verdicts = trial::try_all(&scratch, &chosen, &plan, &table)?;
    record::summary(&verdicts);
    Ok(())
}
