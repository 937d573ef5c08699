//! `bench`: how fast, and how accurate at that.

mod compare;
mod history;
mod record;

use super::help;
use super::shared::names::{CASES, Selection};
use super::shared::output::{Destination, make_folder, reader_left, write_whole};
use super::shared::programs::ProgramFlags;
use super::shared::{long_work, parse};
use super::{DONE, OUT_OF_BOUNDS};
use crate::bench::compare::worker::serve;
use crate::bench::contest::{self, SettingResult, contest};
use crate::bench::contestant::Contestant;
use crate::bench::report::{CaseEntry, Measurement};
use crate::bench::timed_case::TimedCase;
use crate::bench::{Bench, cases, contestants, damping, floor, length, pictures};
use crate::bench::{table, workload};
use crate::case::{Case, embedded};
use crate::engine::{Declaration, REFERENCE, Stepping, hush_contained_panics};
use crate::provenance;
use crate::truth::Library;
use anyhow::{Context, Result, bail};
use clap::{Args, Subcommand};
use regex::Regex;
use std::io;
use std::path::{Path, PathBuf};

/// Time every engine against the exact solver in interleaved rounds
///
/// Answers how much longer a solver takes than the exact solver, at its most
/// accurate setting and at equal errors. A wrong answer has no time.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::BENCH)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    other: Option<Other>,
    /// Only engines whose name matches, beside the exact solver; several are alternatives
    #[arg(short, long = "engine", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    engine: Vec<Regex>,
    /// Only cases whose name matches, of all that validate has; several are alternatives
    #[arg(short, long = "case", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    case: Vec<Regex>,
    #[command(flatten)]
    programs: ProgramFlags,
    /// Writes bench.json and pictures into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Interleaved rounds
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = parse::whole::<u16>(1, 1000), allow_hyphen_values = true)]
    rounds: u16,
    /// Runs of 1e7 and 1e8 forcing periods too
    #[arg(long)]
    long: bool,
}

/// The subcommands of `bench`.
#[derive(Subcommand)]
enum Other {
    Record(record::Arguments),
    Compare(compare::Arguments),
    History(history::Arguments),
    /// Answer `names` and `best NAME UNITS BATCHES` on stdin with times, for compare
    Worker,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    match &arguments.other {
        None => time_engines(arguments),
        Some(Other::Record(record)) => record::run(record).map(|()| DONE),
        Some(Other::Compare(compare)) => compare::run(compare),
        Some(Other::History(history)) => history::run(history).map(|()| DONE),
        Some(Other::Worker) => worker().map(|()| DONE),
    }
}

fn time_engines(arguments: &Arguments) -> Result<u8> {
    if arguments.long && !arguments.case.is_empty() {
        bail!("--long has no effect with --case: long runs are of no case");
    }
    let _programs = arguments.programs.start()?;
    let all = contestants();
    let contestants = chosen_engines(&all, &arguments.engine)?;
    let timed_cases = timed(&arguments.case)?;
    if let Some(folder) = &arguments.out {
        make_folder(folder)?;
    }
    hush_contained_panics();
    // One thread, this pool's, so that its own time is that of the ensembles too.
    let bench =
        long_work::pool(Some(1))?.install(|| measured(arguments, &contestants, &timed_cases))?;
    if let Some(folder) = &arguments.out {
        write(&bench, folder)?;
    }
    let text = table(&bench);
    let shown = Destination::Stdout.write(|out| Ok(out.write_all(text.as_bytes())?));
    shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })?;
    Ok(DONE)
}

/// Serves one side of a comparison of two binaries.
fn worker() -> Result<()> {
    let timed_cases = usual_cases()?;
    let workloads = workload::all(&timed_cases);
    serve(&provenance::this(), &workloads, io::stdin().lock(), io::stdout().lock())
        .context("worker")
}

fn measured(
    arguments: &Arguments,
    contestants: &[&dyn Contestant],
    timed_cases: &[TimedCase],
) -> Result<Bench> {
    let rounds = usize::from(arguments.rounds);
    // Length and xi are of no case: they belong to the whole.
    let whole = arguments.case.is_empty();
    let bar = bar(arguments, contestants, timed_cases.len(), whole);
    let done = || bar.inc(1);
    // First, while the process holds nothing: its peak is then the run's own.
    let length = if whole { length::lengths(arguments.long, &done)? } else { Vec::new() };
    let floors = floor::floors(&[], FLOOR_ROUNDS * rounds, &done)?;
    let contest = |it: &TimedCase| (it.entry(), contest(it, contestants, rounds, &done));
    let contests: Vec<(CaseEntry, Vec<SettingResult>)> = timed_cases.iter().map(contest).collect();
    let damping = if whole { damping::over_xi(contestants, rounds, &done)? } else { Vec::new() };
    bar.finish_and_clear();
    let measured = Measurement { contests: &contests, floors: &floors, length, damping: &damping };
    Ok(Bench::new(provenance::this(), rounds, measured))
}

/// The floor takes milliseconds a round.
const FLOOR_ROUNDS: usize = 5;

fn bar(
    arguments: &Arguments,
    contestants: &[&dyn Contestant],
    timed_cases: usize,
    whole: bool,
) -> long_work::Bar {
    let rounds = usize::from(arguments.rounds);
    let mut size = timed_cases as u64 * contest::size(contestants, rounds)
        + floor::size(0, FLOOR_ROUNDS * rounds);
    if whole {
        size += length::size(arguments.long) + damping::size(contestants, rounds);
    }
    long_work::bar(size, "turns")
}

/// The exact solver is what all are held against: it always runs.
fn chosen_engines<'a>(
    all: &'a [Box<dyn Contestant>],
    patterns: &[Regex],
) -> Result<Vec<&'a dyn Contestant>> {
    let matches = |it: &dyn Contestant| {
        patterns.is_empty()
            || patterns.iter().any(|pattern| pattern.is_match(it.declaration().name))
    };
    let listed = "percuss engines lists those of validate, and exact-lanes is one of bench";
    let selection = Selection { flag: "--engine", what: "engine", listed };
    selection.check(patterns, all.iter().map(|it| it.declaration().name))?;
    let is_unit = |it: &dyn Contestant| {
        let Declaration { name, stepping, .. } = it.declaration();
        name == REFERENCE && stepping == Stepping::Exact
    };
    Ok(all.iter().map(AsRef::as_ref).filter(|it| is_unit(*it) || matches(*it)).collect())
}

/// The cases that are named, or the oscillator's usual ones, those of the lists first.
fn timed(patterns: &[Regex]) -> Result<Vec<TimedCase>> {
    let mut all = embedded()?;
    CASES.check(patterns, all.iter().map(|it| it.name.as_str()))?;
    all.retain(|it| match patterns {
        [] => cases::DEFAULT_CASES.contains(&it.name.as_str()),
        _ => patterns.iter().any(|pattern| pattern.is_match(&it.name)),
    });
    let listed = || cases::DEFAULT_CASES.iter().chain(&cases::SYSTEMS);
    let place = |case: &Case| listed().position(|it| *it == case.name);
    all.sort_by_key(|it| (it.oscillator.is_none(), place(it).unwrap_or(usize::MAX)));
    let library = Library::embedded()?;
    Ok(all.iter().map(|it| TimedCase::new(it, &library)).collect::<Result<_, _>>()?)
}

/// The cases that are timed where none are named, and that versions are compared by.
fn usual_cases() -> Result<Vec<TimedCase>> {
    timed(&[])
}

fn write(bench: &Bench, folder: &Path) -> Result<()> {
    Destination::new(Some(&folder.join("bench.json"))).json(bench).context("--out")?;
    for (name, bytes) in pictures(bench)? {
        write_whole(&folder.join(name), |out| Ok(out.write_all(&bytes)?)).context("--out")?;
    }
    Ok(())
}
