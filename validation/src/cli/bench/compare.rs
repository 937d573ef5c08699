//! `bench compare OLD NEW`: two binaries, or two recorded versions.

use super::super::help;
use super::{DONE, OUT_OF_BOUNDS};
use crate::bench::compare::binaries::{Common, Pair, RESTARTS, TimeQuotient, common, quotients};
use crate::bench::compare::recorded::changes;
use crate::bench::compare::verdict::{WorkloadVerdict, is_doubtful};
use crate::bench::history::{self, History, HistoryRecord};
use crate::cli::note;
use crate::cli::shared::long_work;
use crate::cli::shared::names::{Selection, nearest_names};
use crate::cli::shared::output::{Destination, reader_left};
use crate::cli::shared::parse;
use crate::number::shortest;
use anyhow::{Result, anyhow, bail};
use clap::Args;
use regex::Regex;
use std::path::{Path, PathBuf};

/// Compare the speed of two versions: exit 1 where it is slower by 2 % twice in a row
#[derive(Args)]
#[command(after_long_help = help::BENCH_COMPARE)]
pub(in super::super) struct Arguments {
    /// A built percuss, or a recorded version: its number or its commit's first seven digits or
    /// more
    #[arg(value_name = "OLD")]
    old: String,
    /// The version that is held against it, named in the same ways
    #[arg(value_name = "NEW")]
    new: String,
    /// Only workloads whose name matches; several are alternatives
    #[arg(short, long = "bench", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    bench: Vec<Regex>,
    /// The history, for recorded versions [default: benches/history.jsonl]
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Slows NEW down on purpose by this share, 0 to 1: whether a regression would be noticed
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share, allow_hyphen_values = true)]
    slowdown: f64,
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|it: &f64| (0.0..=1.0).contains(it));
    share.ok_or_else(|| "accepted is a number, 0 to 1".to_owned())
}

pub(super) fn run(arguments: &Arguments) -> Result<u8> {
    let [old, new] = [&arguments.old, &arguments.new].map(|side| binary(side));
    let (lines, verdicts) = match (old, new) {
        (Some(_), Some(_)) if arguments.history.is_some() => {
            bail!("--history has no effect on two binaries: it is accepted with recorded versions")
        }
        (Some(old), Some(new)) => against(arguments, &old, &new)?,
        (None, None) if arguments.slowdown > 0.0 => {
            let share = arguments.slowdown;
            bail!(
                "--slowdown {share} has no effect on recorded versions: accepted are two binaries"
            )
        }
        (None, None) => record_comparison(arguments)?,
        (old, _) => {
            let file = if old.is_some() { &arguments.old } else { &arguments.new };
            bail!(
                "{file} is a file and the other is none: accepted are two binaries or two recorded versions"
            )
        }
    };
    let text = lines.join("\n") + "\n";
    let printed = Destination::Stdout.write(|out| Ok(out.write_all(text.as_bytes())?));
    printed.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })?;
    Ok(if verdicts.contains(&WorkloadVerdict::Fail) { OUT_OF_BOUNDS } else { DONE })
}

/// The file that a side names.
fn binary(side: &str) -> Option<PathBuf> {
    let path = Path::new(side).canonicalize().ok()?;
    path.is_file().then_some(path)
}

type Said = (Vec<String>, Vec<WorkloadVerdict>);

fn against(arguments: &Arguments, old: &Path, new: &Path) -> Result<Said> {
    let pair = Pair { old, new, burden: arguments.slowdown };
    let Common { shared, lost, versions } = common(&pair)?;
    lost.iter().for_each(|bench| note(&format!("{bench}: only in {}", arguments.old)));
    let benches = chosen_benches(arguments, shared.into_iter())?;
    let bar = long_work::bar(u64::from(RESTARTS) * benches.len() as u64, "turns");
    let first = quotients(&pair, &benches, &|| bar.inc(1))?;
    let doubtful: Vec<String> =
        first.iter().filter(|it| is_doubtful(it.value)).map(|it| it.bench.clone()).collect();
    bar.inc_length(u64::from(RESTARTS) * doubtful.len() as u64);
    let second = quotients(&pair, &doubtful, &|| bar.inc(1))?;
    bar.finish_and_clear();
    let mut lines = vec![format!("old {}", versions[0]), format!("new {}", versions[1])];
    let mut verdicts = Vec::new();
    lines.push("bench,quotient,lives_apart,again,verdict".to_owned());
    for TimeQuotient { bench, value, spread } in first {
        let again = second.iter().find(|it| it.bench == bench).map(|it| it.value);
        let values: Vec<f64> = std::iter::once(value).chain(again).collect();
        let verdict = WorkloadVerdict::new(&values);
        let again = again.map(|it| format!("{it:.4}")).unwrap_or_default();
        lines.push(format!("{bench},{value:.4},{spread:.4},{again},{}", verdict.word()));
        verdicts.push(verdict);
    }
    Ok((lines, verdicts))
}

fn record_comparison(arguments: &Arguments) -> Result<Said> {
    let file = arguments.history.as_deref().unwrap_or(Path::new(history::FILE));
    let history = History::read(file).map_err(|what| anyhow!("--history {what}"))?;
    let [old, new] = [&arguments.old, &arguments.new].map(|side| version(file, &history, side));
    let (old, new) = (old?, new?);
    let both = old.iter().filter(|it| new.iter().any(|other| other.bench == it.bench));
    let benches = chosen_benches(arguments, both.map(|it| it.bench.clone()))?;
    let mut lines = vec!["bench,figure,old,new,quotient,verdict".to_owned()];
    let mut verdicts = Vec::new();
    let side = |all: &[&HistoryRecord], bench: &str| {
        all.iter().find(|it| it.bench == bench).map(|it| (*it).clone())
    };
    for bench in &benches {
        let Some((old, new)) = side(&old, bench).zip(side(&new, bench)) else { continue };
        if old.cpu != new.cpu {
            note(&format!("{bench}: recorded on {} and on {}", old.cpu, new.cpu));
        }
        for it in changes(&old, &new) {
            let [before, after] = it.figures.map(shortest);
            let (quotient, word) = (it.quotient(), it.verdict.word());
            lines.push(format!("{bench},{},{before},{after},{quotient:.4},{word}", it.figure));
            verdicts.push(it.verdict);
        }
    }
    Ok((lines, verdicts))
}

fn version<'a>(file: &Path, history: &'a History, side: &str) -> Result<Vec<&'a HistoryRecord>> {
    let found = history.version(side);
    if found.is_empty() {
        let names = history.versions();
        let known = match nearest_names(side, names.iter().map(String::as_str)) {
            _ if names.is_empty() => "none is recorded".to_owned(),
            near if near.is_empty() => names.join(", "),
            near => format!("the nearest are {}", near.join(", ")),
        };
        bail!(
            "{side} is neither a file nor a version of {}: accepted are built binaries or recorded versions ({known})",
            file.display()
        );
    }
    Ok(found)
}

fn chosen_benches(
    arguments: &Arguments,
    benches: impl Iterator<Item = String>,
) -> Result<Vec<String>> {
    let wanted = |name: &String| {
        arguments.bench.is_empty() || arguments.bench.iter().any(|it| it.is_match(name))
    };
    let all: Vec<String> = benches.collect();
    let listed = format!("accepted are {}", all.join(", "));
    let selection = Selection { flag: "--bench", what: "workload of both", listed: &listed };
    selection.check(&arguments.bench, all.iter().map(String::as_str))?;
    let chosen: Vec<String> = all.iter().filter(|it| wanted(it)).cloned().collect();
    if chosen.is_empty() {
        bail!("{} and {} have no workload in common", arguments.old, arguments.new);
    }
    Ok(chosen)
}
