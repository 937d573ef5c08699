//! `bench record`: lines of this version, appended to the history.

use super::output::{Destination, reader_left, write_whole};
use super::{cases_by_default, courses, work};
use crate::bench::contestant::enter;
use crate::bench::course::Course;
use crate::bench::floor::{self, Cost, Floors};
use crate::bench::history::{self, Figures, History, Record};
use crate::bench::{instructions, workload};
use crate::engine::{Accuracy, Failure, exact};
use anyhow::{Context, Result, anyhow};
use clap::Args;
use std::path::{Path, PathBuf};

/// Append this version to the history
#[derive(Args)]
pub(in super::super) struct Arguments {
    /// The history
    #[arg(long, value_name = "FILE", default_value = history::FILE)]
    history: PathBuf,
    /// Interleaved rounds
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u16).range(1..=1000))]
    rounds: u16,
    /// Counts instructions too; valgrind has to be installed
    #[arg(long)]
    instructions: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let before = raw(&arguments.history)?;
    History::read(&arguments.history).map_err(|what| anyhow!("--history {what}"))?;
    let courses = courses(&cases_by_default()?)?;
    let records = records(arguments, &courses)?;
    let text = History { records: records.clone() }.text().map_err(|what| anyhow!(what))?;
    let gap = if before.is_empty() || before.ends_with('\n') { "" } else { "\n" };
    let whole = format!("{before}{gap}{text}");
    write_whole(&arguments.history, |out| Ok(out.write_all(whole.as_bytes())?))
        .context("--history")?;
    let shown = Destination::Stdout.write(|out| {
        writeln!(out, "bench,best_ns,median_ns,floors,evaluations_per_switch,instructions")?;
        for it in &records {
            let instructions = it.instructions.map(|it| it.to_string()).unwrap_or_default();
            let Record { bench, best_ns, median_ns, floors, evaluations_per_switch, .. } = it;
            writeln!(out, "{bench},{best_ns:.1},{median_ns:.1},{floors:.3},{evaluations_per_switch:.4},{instructions}")?;
        }
        Ok(())
    });
    shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })
}

/// What the file holds, untouched: old lines stay as they were written.
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

fn records(arguments: &Arguments, courses: &[Course]) -> Result<Vec<Record>> {
    let rounds = usize::from(arguments.rounds);
    let workloads = workload::all(courses);
    let counted = if arguments.instructions { courses.len() as u64 } else { 0 };
    let bar = work::bar(floor::size(workloads.len(), rounds) + counted, "turns");
    let floors = floor::floors(&workloads, rounds, &|| bar.inc(1))?;
    let record = |(course, cost): (&Course, &Result<Cost, Failure>)| {
        let cost = cost.as_ref().map_err(Clone::clone)?;
        let instructions = if arguments.instructions {
            let count = instructions::per_unit(&cost.name).context("--instructions")?;
            bar.inc(1);
            Some(count)
        } else {
            None
        };
        Ok(Record::of_this(&cost.name, figures(course, cost, &floors, instructions)?))
    };
    let records = courses.iter().zip(&floors.switches).map(record).collect();
    bar.finish_and_clear();
    records
}

fn figures(
    course: &Course,
    cost: &Cost,
    floors: &Floors,
    instructions: Option<f64>,
) -> Result<Figures, Failure> {
    let mut heat = enter(exact(), course, Accuracy::Exact)?;
    heat.call()?;
    Ok(Figures {
        instructions,
        best_ns: cost.series.best(),
        median_ns: cost.series.typical(),
        floor_ns: floors.chained.typical(),
        floors: cost.series.ratio_to(&floors.chained),
        evaluations_per_switch: cost.evaluations,
        state_error_max: heat.score()?.state_error,
    })
}
