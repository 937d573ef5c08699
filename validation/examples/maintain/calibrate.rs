//! Measures the limits of the same-attractor test: `cargo maintain calibrate`.

use percuss_validation::case::embedded;
use percuss_validation::score::attractor::{ComparisonPlan, NULL_RUNS, calibrate};

/// Chaotic cases with one attractor each that every start near theirs reaches.
const CASES: [&str; 3] = ["chaos-from-rest", "fig7a-chaos", "fig7d-chaos"];
const PLAN: ComparisonPlan =
    ComparisonPlan { transient: 200, periods: 2000, reference_periods: 20_000 };

/// Measure the limits of the same-attractor test, and print attractors.toml
#[derive(clap::Args)]
pub(crate) struct Arguments {}

pub(crate) fn run(Arguments {}: &Arguments) -> anyhow::Result<()> {
    println!(
        "# Limits of the same-attractor test: measured, see src/score/attractor/calibration.rs for how.\n\
         # Made by `cargo maintain calibrate`.\n\
         # Level: one more run of the exact solver exceeds any limit of its case with a probability of\n\
         # 1 in {}, because no distance of {NULL_RUNS} runs a case exceeds its limit.",
        NULL_RUNS + 1
    );
    for case in embedded()?.into_iter().filter(|case| CASES.contains(&case.name.as_str())) {
        let found = calibrate((&case.name, case.of_oscillator()?), PLAN, NULL_RUNS)?;
        println!(
            "\n# The largest of {NULL_RUNS} runs: {}, {:.2} standard deviations above its mean.\n\
             [[attractors]]\n{}",
            found.farthest,
            found.z,
            toml::to_string(&found.calibrated)?
                .replace("[plan]", "[attractors.plan]")
                .replace("[limits]", "[attractors.limits]")
        );
    }
    Ok(())
}
