//! Measures what the local judgement's limits are set from, on the cases inside the binary: the
//! largest defects of each engine, and how many wrong answers of each kind are caught.
//!
//! ```sh
//! cargo run --release -p percuss-validation --example nulls -- [ENGINE] [CASE] [power]
//! ```
//!
//! ENGINE and CASE are regular expressions on names; wrong answers are made with `power` alone. The
//! limits of `validation/classes.toml` are three times the largest defects of `ode_solvers-dopri5`,
//! `ode_solvers-dop853-time`, `ode_solvers-rk4`, `differential-equations-rkv655e`,
//! `differential-equations-radau5`, `differential-equations-kvaerno745`, `diffsol-esdirk34` and
//! `differential-equations-bdf` on every second case, the first included.

use anyhow::Result;
use percuss_validation::case::{ClassBounds, defaults, embedded};
use percuss_validation::engine::{Accuracy, Engine, Outcome, answer};
use percuss_validation::integrators;
use percuss_validation::power::Variant;
use percuss_validation::score::local::{Allowance, Defects, LocalJudgement};
use percuss_validation::suite::{PreparedCase, Suite, SuiteScope, prepare};
use percuss_validation::truth::Library;
use rayon::prelude::*;
use regex::Regex;
use std::collections::BTreeMap;

/// What was found of one engine at one accuracy on one case.
struct Measured {
    engine: &'static str,
    accuracy: Accuracy,
    case: String,
    /// Whether the case is one of those that limits are set from.
    sets_limits: bool,
    right: LocalJudgement,
    is_condemned: bool,
    /// For each variant whether it is caught; none where it spoils nothing.
    caught: Vec<Option<bool>>,
}

fn main() -> Result<()> {
    let mut patterns = std::env::args().skip(1);
    let engines = Regex::new(&patterns.next().unwrap_or_default())?;
    let cases = Regex::new(&patterns.next().unwrap_or_default())?;
    let variants =
        if patterns.next().is_some_and(|it| it == "power") { &Variant::ALL[..] } else { &[] };
    let prepared = prepare(embedded()?, &Library::embedded()?, None)?;
    let classes = defaults()?.classes;
    let mut jobs: Vec<(usize, &'static dyn Engine, Accuracy)> = Vec::new();
    for (n, case) in prepared.iter().enumerate() {
        let chosen = integrators::all().iter().filter(|it| engines.is_match(it.declaration().name));
        for engine in chosen.filter(|_| cases.is_match(&case.case.name)) {
            let all = SuiteScope::from(Suite::Quick).accuracies(engine.declaration().stepping);
            jobs.extend(all.into_iter().map(|accuracy| (n, *engine, accuracy)));
        }
    }
    let one = |(n, engine, accuracy): (usize, &'static dyn Engine, Accuracy)| {
        measured((&prepared[n], n % 2 == 0), (engine, accuracy), &classes, variants)
    };
    let found: Vec<Measured> = jobs.into_par_iter().filter_map(one).collect();
    print_defects(&found);
    print_power(&found, variants);
    Ok(())
}

fn measured(
    (case, sets_limits): (&PreparedCase, bool),
    (engine, accuracy): (&'static dyn Engine, Accuracy),
    classes: &[ClassBounds],
    variants: &[Variant],
) -> Option<Measured> {
    let declaration = engine.declaration();
    let class =
        ClassBounds::of(classes, declaration.class_and_order(), declaration.stepping, accuracy)?;
    let is_affordable = case.least_work(engine, accuracy) <= Suite::Quick.budget();
    if !is_affordable || engine.takes(&case.task).is_err() {
        return None;
    }
    let limits = Suite::Quick.limits(&case.case);
    let right = answer(engine, &case.task, accuracy, &limits).ok()?;
    let tolerance = declaration.stepping.unit(accuracy);
    let allowance = Allowance::of(class, tolerance);
    let judge = |answer: &Outcome| case.local.judge(&case.task, answer, allowance).ok();
    let caught = |variant: &Variant| {
        let wrong = variant.of(&case.task, &right, tolerance)?;
        Some(judge(&wrong)?.is_wrong(&allowance))
    };
    let found = judge(&right)?;
    Some(Measured {
        engine: declaration.name,
        accuracy,
        case: case.case.name.clone(),
        sets_limits,
        is_condemned: found.is_wrong(&allowance),
        caught: variants.iter().map(caught).collect(),
        right: found,
    })
}

/// The largest defects of each engine, on the cases that limits are set from and on the others.
fn print_defects(found: &[Measured]) {
    let mut groups: BTreeMap<(&str, String, bool), Vec<&Measured>> = BTreeMap::new();
    for it in found {
        let key = (it.engine, format!("{:?}", it.accuracy), !it.sets_limits);
        groups.entry(key).or_default().push(it);
    }
    println!(
        "engine, accuracy, cases: condemned; largest location, time, state, sample, sample median"
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
            largest(|it| Defects::spread(&it.sample).median),
        );
    }
}

/// The share of spoiled answers that are caught, on rows whose right answer is not condemned.
fn print_power(found: &[Measured], variants: &[Variant]) {
    println!("\nvariant: caught, spoiled, share; the first cases where it is not caught");
    for (n, variant) in variants.iter().enumerate() {
        let spoiled = found.iter().filter(|it| !it.is_condemned && it.caught[n].is_some());
        let (caught, missed): (Vec<_>, Vec<_>) = spoiled.partition(|it| it.caught[n] == Some(true));
        let all = caught.len() + missed.len();
        let share = 100.0 * caught.len() as f64 / all.max(1) as f64;
        let mut names: Vec<_> = missed.iter().map(|it| it.case.as_str()).collect();
        names.dedup();
        names.truncate(8);
        println!(
            "{:44} {:5} {all:5} {share:5.1} %  {}",
            variant.words(),
            caught.len(),
            names.join(" ")
        );
    }
}
