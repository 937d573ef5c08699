//! `validate`: every engine on every case against the truth.

use super::judged::{JudgedFlags, accepts};
use super::names::ENGINES;
use super::programs::ProgramFlags;
use super::{OUT_OF_BOUNDS, parse, say, work};
use crate::engine::{self, Engine, Wrong, hush_contained_panics};
use crate::power::{self, Finding, Standard};
use crate::report::{Report, ReportEvidence, RowPlace, event_pictures};
use crate::suite::{self, Suite};
use anyhow::{Result, bail};
use clap::Args;
use regex::Regex;

/// Hold every engine against the truth on every case
#[derive(Args)]
pub(super) struct Arguments {
    /// How much to run
    #[arg(long, value_enum, default_value_t = Suite::Quick)]
    suite: Suite,
    /// Only engines whose name matches; several are alternatives
    #[arg(short, long = "engine", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    engine: Vec<Regex>,
    #[command(flatten)]
    judged: JudgedFlags,
    #[command(flatten)]
    programs: ProgramFlags,
}

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    let judged = &arguments.judged;
    let baseline = judged.check()?;
    let _programs = arguments.programs.start()?;
    let engines = chosen_engines(&arguments.engine)?;
    let cases = judged.prepare(arguments.suite)?;
    let all = cases.all();
    let defaults = judged.defaults()?;
    hush_contained_panics();
    let pool = work::pool(threads)?;
    let wrong = wrong_engines(arguments);
    let bar =
        work::bar((suite::size(all.len(), &engines, arguments.suite) + wrong.len()) as u64, "rows");
    let rows =
        pool.install(|| suite::run(&all, &engines, arguments.suite, &defaults, &|| bar.inc(1)));
    let asked = suite::size(all.len(), &engines, arguments.suite);
    if rows.len() != asked {
        bail!("{} rows were made where {asked} were asked for", rows.len());
    }
    let examine = |(it, held): &(Wrong, Standard)| {
        let finding = power::examine(it, &cases.oscillator, *held, &defaults.bounds);
        bar.inc(1);
        finding
    };
    let findings: Vec<_> = pool.install(|| wrong.iter().map(examine).collect());
    bar.finish_and_clear();
    let mut evidence = ReportEvidence::gather(
        (&cases.oscillator, &cases.systems),
        &rows,
        &findings,
        judged.chosen.cases.is_none(),
    );
    evidence.folders = judged.folders();
    if judged.out.is_some() {
        evidence.events =
            pool.install(|| event_pictures(&cases.oscillator, &rows, arguments.suite));
    }
    let report = Report::new(arguments.suite, &engines, &rows);
    let asked = |it: &RowPlace<'_>| {
        accepts(&arguments.engine, it.engine)
            && judged.chosen.accepts(it.case)
            && arguments.suite.makes(it.tolerance, it.step)
    };
    if let Some(baseline) = &baseline {
        evidence.worse = judged.worse(baseline, &report, asked)?;
    }
    let code = judged.write(&report, &evidence, all.len())?;
    Ok(if unnoticed(&findings) { OUT_OF_BOUNDS } else { code })
}

/// Engines that are wrong on purpose, for the power of the gates; none where something else is
/// asked.
fn wrong_engines(arguments: &Arguments) -> Vec<(Wrong, Standard)> {
    let chosen = &arguments.judged.chosen;
    let everything =
        arguments.engine.is_empty() && chosen.case.is_empty() && chosen.cases.is_none();
    if everything { power::all() } else { Vec::new() }
}

/// Whether a wrong engine passes every bound of all cases together; said on stderr.
fn unnoticed(findings: &[Finding]) -> bool {
    let missed: Vec<_> = findings.iter().filter(|it| !it.caught()).collect();
    missed.iter().for_each(|it| say(&format!("no bound notices {}: {}", it.engine, it.fault)));
    !missed.is_empty()
}

fn chosen_engines(patterns: &[Regex]) -> Result<Vec<&'static dyn Engine>> {
    let engines = engine::select(patterns)?;
    ENGINES.check(patterns, engine::all().iter().map(|it| it.declaration().name))?;
    Ok(engines)
}
