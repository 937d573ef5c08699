//! Measures the limits of the same-attractor test and prints `attractors.toml`.
//!
//! `cargo run --release --example calibrate > attractors.toml` in this package.

use percuss_validation::case::embedded;
use percuss_validation::score::attractor::{Plan, calibrate};

/// Chaotic cases with one attractor each that every start near theirs reaches.
const CASES: [&str; 3] = ["chaos-from-rest", "fig7a-chaos", "fig7d-chaos"];
const PLAN: Plan = Plan { transient: 200, periods: 2000, reference_periods: 20_000 };

fn main() -> anyhow::Result<()> {
    println!(
        "# Limits of the same-attractor test: measured, see src/score/attractor/limits.rs for how."
    );
    println!("# Made by `cargo run --release --example calibrate`.");
    for case in embedded()?.into_iter().filter(|case| CASES.contains(&case.name.as_str())) {
        let calibrated = calibrate(&case, PLAN)?;
        println!(
            "\n[[attractors]]\n{}",
            toml::to_string(&calibrated)?
                .replace("[plan]", "[attractors.plan]")
                .replace("[limits]", "[attractors.limits]")
        );
    }
    Ok(())
}
