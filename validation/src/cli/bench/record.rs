//! `bench record`: lines of this version, appended to the history.

use super::super::help;
use super::usual_cases;
use crate::bench::contestant::enter;
use crate::bench::floor::{self, Floors};
use crate::bench::history::{self, Figures, History, HistoryRecord};
use crate::bench::rounds::RoundTimes;
use crate::bench::timed_case::TimedCase;
use crate::bench::{instructions, workload};
use crate::cli::shared::output::{Destination, check_file, reader_left, write_whole};
use crate::cli::shared::{long_work, parse};
use crate::engine::{Accuracy, Failure};
use crate::integrators::exact;
use crate::provenance;
use anyhow::{Context, Result, anyhow};
use clap::Args;
use std::path::{Path, PathBuf};

/// Time this version and append it to the history
#[derive(Args)]
#[command(after_long_help = help::BENCH_RECORD)]
pub(in super::super) struct Arguments {
    /// The history
    #[arg(long, value_name = "FILE", default_value = history::FILE)]
    history: PathBuf,
    /// Interleaved rounds, twice
    #[arg(long, value_name = "N", default_value_t = 150, value_parser = parse::whole::<u16>(1, 1000), allow_hyphen_values = true)]
    rounds: u16,
    /// Counts instructions too; valgrind has to be installed
    #[arg(long)]
    instructions: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    // Told before the minutes of work.
    check_file("--history", &arguments.history)?;
    let before = raw(&arguments.history)?;
    History::read(&arguments.history).map_err(|what| anyhow!("--history {what}"))?;
    let timed_cases = usual_cases()?;
    let records = records(arguments, &timed_cases)?;
    let text = History { records: records.clone() }.text().map_err(|what| anyhow!(what))?;
    let gap = if before.is_empty() || before.ends_with('\n') { "" } else { "\n" };
    let whole = format!("{before}{gap}{text}");
    write_whole(&arguments.history, |out| Ok(out.write_all(whole.as_bytes())?))
        .context("--history")?;
    let shown = Destination::Stdout.write(|out| {
        writeln!(out, "bench,best_ns,median_ns,floors,floors_again,evaluations_per_switch,instructions")?;
        for it in &records {
            let instructions = it.instructions.map(|it| it.to_string()).unwrap_or_default();
            let HistoryRecord { bench, best_ns, median_ns, floors, floors_again, .. } = it;
            let evaluations = it.evaluations_per_switch;
            writeln!(out, "{bench},{best_ns:.1},{median_ns:.1},{floors:.3},{floors_again:.3},{evaluations:.4},{instructions}")?;
        }
        Ok(())
    });
    shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })
}

/// The bytes of the file: old lines stay as they were written.
fn raw(path: &Path) -> Result<String> {
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(text),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(String::new()),
        Err(error) => Err(anyhow!(
            "--history {}: cannot be read ({error}); accepted is a history that bench record wrote",
            path.display()
        )),
    }
}

fn records(arguments: &Arguments, timed_cases: &[TimedCase]) -> Result<Vec<HistoryRecord>> {
    let rounds = usize::from(arguments.rounds);
    let workloads = workload::all(timed_cases);
    let counted = if arguments.instructions { timed_cases.len() as u64 } else { 0 };
    let bar = long_work::bar(2 * floor::size(workloads.len(), rounds) + counted, "turns");
    let half = || floor::floors(&workloads, rounds, &|| bar.inc(1));
    let halves = [half()?, half()?];
    let record = |(i, case): (usize, &TimedCase)| {
        let name = workloads[i].name();
        let instructions = if arguments.instructions {
            let count = instructions::per_unit(&name).context("--instructions")?;
            bar.inc(1);
            Some(count)
        } else {
            None
        };
        let figures = Figures { instructions, ..figures(case, &halves, i)? };
        Ok(HistoryRecord::new(provenance::this(), &name, figures))
    };
    let records = timed_cases.iter().enumerate().map(record).collect();
    bar.finish_and_clear();
    records
}

/// What both halves of the rounds say of a workload.
fn figures(case: &TimedCase, halves: &[Floors; 2], i: usize) -> Result<Figures, Failure> {
    let mut timed = enter(exact(), case, Accuracy::Exact)?;
    timed.call()?;
    let cost = |half: &Floors| {
        let cost = half.events.get(i).cloned();
        cost.unwrap_or_else(|| Err(Failure::new("not timed")))
    };
    let [first, second] = [cost(&halves[0])?, cost(&halves[1])?];
    let floor = |half: &Floors| half.chained.best();
    let rounds = [first.series.0.clone(), second.series.0.clone()].concat();
    let whole = RoundTimes(rounds);
    Ok(Figures {
        instructions: None,
        best_ns: whole.best(),
        median_ns: whole.median(),
        floor_ns: floor(&halves[0]).min(floor(&halves[1])),
        floors: first.series.best() / floor(&halves[0]),
        floors_again: second.series.best() / floor(&halves[1]),
        evaluations_per_switch: first.evaluations,
        state_error_max: timed.score()?.state_error,
    })
}
