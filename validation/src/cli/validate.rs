//! `validate`: every engine on every case against the truth.

use super::help;
use super::shared::gradients;
use super::shared::judged::{JudgedFlags, PreparedCases, accepts};
use super::shared::names::ENGINES;
use super::shared::programs::ProgramFlags;
use super::shared::{long_work, parse};
use super::{OUT_OF_BOUNDS, say};
use crate::case::{self, Defaults};
use crate::engine::{Engine, hush_contained_panics};
use crate::integrators;
use crate::integrators::WrongEngine;
use crate::power::{self, Finding, Standard};
use crate::report::{GradientEntry, Report, ReportEvidence, RowPlace, event_pictures};
use crate::suite::first_wrong::first_wrong_events;
use crate::suite::{self, Scored, Suite, SuiteScope};
use anyhow::{Result, bail};
use clap::Args;
use rayon::prelude::*;
use regex::Regex;

/// Hold every engine against the truth on every case
///
/// Answers which ODE solvers miss events, invent events or place them wrongly, on
/// which cases, at which tolerances and at what cost. Without flags all engines
/// run on all cases, in a minute on two cores; the summary at the end ranks them.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::VALIDATE)]
pub(super) struct Arguments {
    /// How much to run
    #[arg(long, value_enum, default_value_t = Suite::Quick)]
    suite: Suite,
    /// Only rows at this tolerance, one of the suite's; several are alternatives
    #[arg(long, value_name = "T", value_parser = parse::tolerance, allow_hyphen_values = true)]
    tolerance: Vec<parse::Typed<f64>>,
    /// Only engines whose name matches; several are alternatives
    #[arg(short, long = "engine", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    engine: Vec<Regex>,
    /// Also run engines that are wrong on purpose: each has to fail a bound
    #[arg(long)]
    power: bool,
    #[command(flatten)]
    judged: JudgedFlags,
    #[command(flatten)]
    programs: ProgramFlags,
}

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    let judged = &arguments.judged;
    judged.check()?;
    let scope = scope(arguments)?;
    let baseline = judged.baseline()?;
    let _programs = arguments.programs.start()?;
    let engines = chosen_engines(&arguments.engine)?;
    let wrong = WrongEngines::new(arguments)?;
    let probed = wrong.count() > 0 || suite::probes_any(&engines, &scope);
    let derivatives_of = gradients::names(&judged.chosen, &engines);
    let cases = judged.open(&derivatives_of)?.prepare(probed.then_some(arguments.suite))?;
    let all = &cases.all;
    let defaults = defaults(arguments)?;
    hush_contained_panics();
    let pool = long_work::pool(threads)?;
    let steps = suite::size(all.len(), &engines, &scope) + wrong.count();
    let bar = long_work::bar(steps as u64, "rows");
    // Together, so that no thread is idle while the last rows run.
    let (rows, findings) = pool.install(|| {
        rayon::join(
            || suite::run(all, &engines, &scope, &defaults, &|| bar.inc(1)),
            || wrong.examine(&cases, &defaults, &|| bar.inc(1)),
        )
    });
    let asked = suite::size(all.len(), &engines, &scope);
    if rows.len() != asked {
        bail!("{} rows were made where {asked} were asked for", rows.len());
    }
    bar.finish_and_clear();
    let mut evidence = pool.install(|| evidence(arguments, &cases, &rows, &findings));
    let gradients = pool.install(|| derivatives(arguments, &engines))?;
    let report = Report { gradients, ..Report::new(arguments.suite, &engines, &rows) };
    let asked = |it: &RowPlace<'_>| {
        accepts(&arguments.engine, it.engine)
            && judged.chosen.accepts(it.case)
            && scope.makes(it.tolerance, it.step)
    };
    if let Some(baseline) = &baseline {
        judged.compare(baseline, (&report, &mut evidence), asked)?;
    }
    let code = judged.write(&report, &evidence, all.len())?;
    Ok(if is_unnoticed(&findings) { OUT_OF_BOUNDS } else { code })
}

/// The verdicts on derivatives through events. They decide neither ranks nor the exit code: an
/// engine that handles events rightly is not worse for a derivative that it offers besides.
fn derivatives(
    arguments: &Arguments,
    engines: &[&'static dyn Engine],
) -> Result<Vec<GradientEntry>> {
    let tolerances: Vec<f64> = arguments.tolerance.iter().map(|it| it.value).collect();
    gradients::judged(&arguments.judged.chosen, engines, &tolerances)
}

/// Everything that the report shows beside its rows.
fn evidence(
    arguments: &Arguments,
    cases: &PreparedCases,
    rows: &[Scored],
    findings: &[Finding],
) -> ReportEvidence {
    let judged = &arguments.judged;
    let embedded = judged.chosen.cases.is_none();
    let evidence = ReportEvidence::gather(&cases.all, rows, findings, embedded);
    let events = match judged.out {
        Some(_) => event_pictures(&first_wrong_events(&cases.all, rows)),
        None => evidence.events,
    };
    let (folders, replayed) = (judged.folders(), cases.replayed.clone());
    ReportEvidence { folders, replayed, events, ..evidence }
}

/// The suite at the tolerances that were chosen.
fn scope(arguments: &Arguments) -> Result<SuiteScope> {
    let all = SuiteScope::from(arguments.suite);
    let is_other = |it: &&parse::Typed<f64>| !all.tolerances().contains(&it.value);
    if let Some(other) = arguments.tolerance.iter().find(is_other) {
        let shown: Vec<_> = all.tolerances().iter().map(|it| format!("{it:e}")).collect();
        bail!("--tolerance {other}: accepted is a tolerance of the suite: {}", shown.join(", "));
    }
    Ok(all.at(arguments.tolerance.iter().map(|it| it.value).collect()))
}

/// Engines that are wrong on purpose, for the power of the gates; none where that is not asked.
#[derive(Default)]
struct WrongEngines(Vec<(WrongEngine, Standard)>);

impl WrongEngines {
    fn new(arguments: &Arguments) -> Result<Self> {
        if !arguments.power {
            return Ok(Self::default());
        }
        let chosen = &arguments.judged.chosen;
        if !chosen.case.is_empty() || chosen.cases.is_some() {
            bail!(
                "--power: accepted is all cases, without --case and --cases: each gate needs its own"
            );
        }
        Ok(Self(power::all()))
    }

    fn count(&self) -> usize {
        self.0.len()
    }

    /// Runs the wrong engines against all gates.
    fn examine(
        &self,
        cases: &PreparedCases,
        defaults: &Defaults,
        done: &(impl Fn() + Sync),
    ) -> Vec<Finding> {
        let one = |(it, held): &(WrongEngine, Standard)| {
            let finding = power::examine(it, &cases.all, *held, defaults);
            done();
            finding
        };
        self.0.par_iter().map(one).collect()
    }
}

/// Whether a wrong engine passes every bound of all cases together; said on stderr.
fn is_unnoticed(findings: &[Finding]) -> bool {
    let missed: Vec<_> = findings.iter().filter(|it| !it.is_caught()).collect();
    missed.iter().for_each(|it| say(&format!("no bound notices {}: {}", it.engine, it.fault)));
    !missed.is_empty()
}

/// The bounds and expected failures that apply: these were seen on the cases inside the binary.
fn defaults(arguments: &Arguments) -> Result<Defaults> {
    if arguments.judged.chosen.cases.is_some() {
        return Ok(case::bounds_alone()?);
    }
    let mut defaults = case::defaults()?;
    defaults.shortcomings.extend(arguments.programs.shortcomings()?);
    Ok(defaults)
}

fn chosen_engines(patterns: &[Regex]) -> Result<Vec<&'static dyn Engine>> {
    let engines = integrators::select(patterns)?;
    ENGINES.check(patterns, integrators::all().iter().map(|it| it.declaration().name))?;
    Ok(engines)
}
