//! `validate`: every engine on every case against the truth.

use super::names::{CASES, ENGINES};
use super::output::{Destination, reader_left};
use super::{DONE, OUT_OF_BOUNDS, parse, reports, work};
use crate::case::{self, Case};
use crate::engine::{self, Engine, Wrong, hush_contained_panics};
use crate::power::{self, Finding};
use crate::report::{Baseline, Evidence, Report, table};
use crate::suite::{self, Prepared, Scored, Status, Suite};
use crate::truth::Library;
use anyhow::{Context, Result, anyhow};
use clap::Args;
use regex::Regex;
use std::path::{Path, PathBuf};

/// Hold every engine against the truth on every case
#[derive(Args)]
pub(super) struct Arguments {
    /// How much to run
    #[arg(long, value_enum, default_value_t = Suite::Quick)]
    suite: Suite,
    /// Only engines whose name matches; several are alternatives
    #[arg(short, long = "engine", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    engine: Vec<Regex>,
    /// Only cases whose name matches; several are alternatives
    #[arg(short, long = "case", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    case: Vec<Regex>,
    /// Writes report.html, report.json, errors.csv, junit.xml and pictures into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// An engine that is not installed is a failure
    #[arg(long)]
    require: bool,
    /// Fails on accuracy that is worse than in this report
    #[arg(long, value_name = "report.json")]
    baseline: Option<PathBuf>,
    /// Reads the cases from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    cases: Option<PathBuf>,
    /// Reads the reference data from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    reference: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    let baseline = arguments.baseline.as_deref().map(read_baseline).transpose()?;
    let engines = chosen_engines(&arguments.engine)?;
    let cases = prepared_cases(arguments)?;
    if let Some(folder) = &arguments.out {
        std::fs::create_dir_all(folder).map_err(|error| {
            anyhow!(
                "--out {} cannot be made ({error}); accepted is a writable folder",
                folder.display()
            )
        })?;
    }
    let defaults = case::defaults()?;
    hush_contained_panics();
    let pool = work::pool(threads)?;
    let wrong = wrong_engines(arguments);
    let bar = work::bar(
        (suite::size(cases.len(), &engines, arguments.suite) + wrong.len()) as u64,
        "rows",
    );
    let rows =
        pool.install(|| suite::run(&cases, &engines, arguments.suite, &defaults, &|| bar.inc(1)));
    let examine = |it: &Wrong| {
        let finding = power::examine(it, &cases, power::AS_EXACT, &defaults.bounds);
        bar.inc(1);
        finding
    };
    let findings: Vec<_> = pool.install(|| wrong.iter().map(examine).collect());
    bar.finish_and_clear();
    let evidence = Evidence::gather(&cases, &rows, &findings, arguments.cases.is_none());
    let code = finish(arguments, &engines, &rows, &evidence, baseline.as_ref())?;
    Ok(if unnoticed(&findings) { OUT_OF_BOUNDS } else { code })
}

/// Engines that are wrong on purpose, for the power of the gates; none where something else is asked.
fn wrong_engines(arguments: &Arguments) -> &'static [Wrong] {
    let everything =
        arguments.engine.is_empty() && arguments.case.is_empty() && arguments.cases.is_none();
    if everything { engine::wrong() } else { &[] }
}

/// Whether a wrong engine passes every bound of all cases together; said on stderr.
fn unnoticed(findings: &[Finding]) -> bool {
    let missed: Vec<_> = findings.iter().filter(|it| !it.caught()).collect();
    missed.iter().for_each(|it| eprintln!("no bound notices {}: {}", it.engine, it.fault));
    !missed.is_empty()
}

fn finish(
    arguments: &Arguments,
    engines: &[&'static dyn Engine],
    rows: &[Scored],
    evidence: &Evidence,
    baseline: Option<&Baseline>,
) -> Result<u8> {
    let declarations: Vec<_> = engines.iter().map(|engine| engine.declaration()).collect();
    let report = Report::new(arguments.suite, &declarations, rows);
    if let Some(folder) = &arguments.out {
        reports::write(&report, evidence, folder)?;
    }
    reports::annotate(&report, evidence, arguments.require);
    let shown =
        Destination::Stdout.write(|out| Ok(out.write_all(table(&report, evidence).as_bytes())?));
    // A reader that leaves early does not turn a failure into a success.
    shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })?;
    let summary = report.summary;
    let absent = |row: &Scored| matches!(row.status, Status::Unavailable);
    let worse = baseline.map(|it| it.worse(&report)).unwrap_or_default();
    worse.iter().for_each(|line| eprintln!("worse than the baseline: {line}"));
    let lacking = arguments.require && rows.iter().any(absent);
    let out_of_bounds = summary.fail + summary.error > 0 || lacking || !worse.is_empty();
    Ok(if out_of_bounds { OUT_OF_BOUNDS } else { DONE })
}

fn read_baseline(path: &Path) -> Result<Baseline> {
    let accepted = "accepted is a report.json of this program";
    let text = std::fs::read_to_string(path)
        .map_err(|error| anyhow!("--baseline {}: {error}; {accepted}", path.display()))?;
    Baseline::read(&text)
        .map_err(|error| anyhow!("--baseline {}: {error}; {accepted}", path.display()))
}

fn chosen_engines(patterns: &[Regex]) -> Result<Vec<&'static dyn Engine>> {
    let engines = engine::select(patterns)?;
    ENGINES.check(patterns, engine::all().iter().map(|it| it.declaration().name))?;
    Ok(engines)
}

fn prepared_cases(arguments: &Arguments) -> Result<Vec<Prepared>> {
    let all = match &arguments.cases {
        Some(folder) => case::from_directory(folder).context("--cases")?,
        None => case::embedded()?,
    };
    CASES.check(&arguments.case, all.iter().map(|it| it.name.as_str()))?;
    let wanted = |case: &Case| {
        arguments.case.is_empty() || arguments.case.iter().any(|it| it.is_match(&case.name))
    };
    let cases: Vec<_> = all.into_iter().filter(wanted).collect();
    let library = match &arguments.reference {
        Some(folder) => Library::from_directory(folder).context("--reference")?,
        // Cases of a user's own may come before their tables.
        None if arguments.cases.is_some() => Library::embedded()?.replaying(),
        None => Library::embedded()?,
    };
    for case in cases.iter().filter(|case| library.is_replayed(case)) {
        eprintln!(
            "{}: without tables: its truth is the exact solver's run made again in 106 bits",
            case.name
        );
    }
    Ok(suite::prepare(cases, &library, arguments.suite)?)
}
