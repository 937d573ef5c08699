//! Measures what the local judgement's limits are set from: `cargo maintain nulls`.

use anyhow::Result;
use percuss_validation::case::{defaults, embedded};
use percuss_validation::engine::{Accuracy, Engine};
use percuss_validation::integrators;
use percuss_validation::power::{Trial, Variant, set_limits, tallies, trial};
use percuss_validation::score::local::Defects;
use percuss_validation::suite::{Suite, SuiteScope, prepare};
use percuss_validation::truth::Library;
use rayon::prelude::*;
use regex::Regex;
use std::collections::BTreeMap;

/// Measure the largest defects of each engine, and how many wrong answers are caught
///
/// The limits of validation/classes.toml are three times the largest defects of
/// ode_solvers-dopri5, ode_solvers-dop853-time, ode_solvers-rk4, differential-equations-rkv655e,
/// differential-equations-radau5, differential-equations-kvaerno745, diffsol-esdirk34 and
/// differential-equations-bdf on every second case inside the binary, the first included.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Only engines whose name matches
    #[arg(short, long, value_name = "RE", default_value = "")]
    engine: Regex,
    /// Only cases whose name matches
    #[arg(short, long, value_name = "RE", default_value = "")]
    case: Regex,
    /// Makes wrong answers of each kind too
    #[arg(long)]
    power: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Arguments { engine: engines, case: cases, power } = arguments;
    let variants = if *power { &Variant::ALL[..] } else { &[] };
    let prepared = prepare(embedded()?, &Library::embedded()?, None)?;
    let classes = defaults()?.classes;
    let set_limits = set_limits(&prepared);
    let mut jobs: Vec<(usize, &'static dyn Engine, Accuracy)> = Vec::new();
    for (n, case) in prepared.iter().enumerate() {
        let chosen = integrators::all().iter().filter(|it| engines.is_match(it.declaration().name));
        for engine in chosen.filter(|_| cases.is_match(&case.case.name)) {
            let all = SuiteScope::from(Suite::Quick).accuracies(engine.declaration().stepping);
            jobs.extend(all.into_iter().map(|accuracy| (n, *engine, accuracy)));
        }
    }
    let one = |(n, engine, accuracy): (usize, &'static dyn Engine, Accuracy)| {
        Some((set_limits[n], trial(&prepared[n], (engine, accuracy), &classes, variants)?))
    };
    let found: Vec<(bool, Trial)> = jobs.into_par_iter().filter_map(one).collect();
    print_defects(&found);
    let trials: Vec<Trial> = found.into_iter().map(|it| it.1).collect();
    print_power(&trials, variants);
    Ok(())
}

/// The largest defects of each engine, on the cases that limits are set from and on the others.
fn print_defects(found: &[(bool, Trial)]) {
    let mut groups: BTreeMap<(&str, String, bool), Vec<&Trial>> = BTreeMap::new();
    for (sets_limits, it) in found {
        let key = (it.engine, format!("{:?}", it.accuracy), !sets_limits);
        groups.entry(key).or_default().push(it);
    }
    println!(
        "engine, accuracy, cases: condemned; largest location, time, state, sample, median delay"
    );
    for ((engine, accuracy, others), rows) in groups {
        let largest = |of: fn(&Defects) -> f64| {
            let each = rows.iter().map(|it| of(&it.right.defects)).filter(|it| !it.is_nan());
            each.fold(0.0, f64::max)
        };
        println!(
            "{engine:36} {accuracy:18} {:6} {:3} of {:3}  {:9.2e} {:9.2e} {:9.2e} {:9.2e} {:9.2e}",
            if others { "others" } else { "limits" },
            rows.iter().filter(|it| it.is_condemned).count(),
            rows.len(),
            largest(|it| Defects::spread(&it.location).max),
            largest(|it| Defects::spread(&it.time).max),
            largest(|it| Defects::spread(&it.state).max),
            largest(|it| Defects::spread(&it.sample).max),
            largest(|it| Defects::spread(&it.delay).median),
        );
    }
}

/// The share of spoiled answers that are caught, on rows whose right answer is not condemned.
fn print_power(trials: &[Trial], variants: &[Variant]) {
    println!("\nvariant: caught, spoiled, share; the first cases where it is not caught");
    for it in tallies(trials, variants) {
        let share = 100.0 * it.caught as f64 / it.spoiled.max(1) as f64;
        let names = it.missed_on.iter().take(8).map(String::as_str).collect::<Vec<_>>().join(" ");
        let (caught, spoiled) = (it.caught, it.spoiled);
        println!("{:44} {caught:5} {spoiled:5} {share:5.1} %  {names}", it.variant.words());
    }
}
