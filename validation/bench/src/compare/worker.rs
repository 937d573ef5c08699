//! A process that answers with times: both sides of a comparison of two binaries are one.
//!
//! It greets with a line, then answers lines:
//!
//! | asked | answered |
//! |---|---|
//! | | `percuss-bench 1 VERSION COMMIT` |
//! | `names` | `names NAME NAME ...` |
//! | `best NAME UNITS BATCHES` | `ns X`: processor time of the best batch of that many units, ns |
//! | `run NAME UNITS` | `ran X`: evaluations; no clock is read, which valgrind would not have |
//! | anything else | `error WHAT` |
//!
//! It ends with its input. The process stays alive, so that two of them can take turns within
//! milliseconds.

use crate::clock::Stopwatch;
use crate::provenance::Build;
use crate::workload::Workload;
use std::io::{self, BufRead, Write};

/// The protocol's name and number, first words of the greeting.
pub const GREETING: &str = "percuss-bench 1";

/// The most units of work that one request may ask for.
const MAX_UNITS: u64 = 1_000_000_000;
/// The most batches that one request may ask for.
const MAX_BATCHES: u64 = 1_000_000;

/// Answers until the input ends, as the program that was built so.
///
/// # Errors
/// What input or output say.
pub fn serve(
    build: &Build,
    workloads: &[Box<dyn Workload + '_>],
    input: impl BufRead,
    mut output: impl Write,
) -> io::Result<()> {
    let commit = build.commit.as_deref().unwrap_or("unknown");
    writeln!(output, "{GREETING} {} {commit}", build.percuss)?;
    output.flush()?;
    for line in input.lines() {
        writeln!(output, "{}", answer(workloads, &line?))?;
        output.flush()?;
    }
    Ok(())
}

fn answer(workloads: &[Box<dyn Workload + '_>], line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let found = match words.as_slice() {
        ["names"] => {
            let names: Vec<_> = workloads.iter().map(|it| it.name()).collect();
            Ok(format!("names {}", names.join(" ")))
        }
        ["best", name, units, batches] => best(workloads, name, units, batches),
        ["run", name, units] => ran(workloads, name, units),
        _ => Err("accepted are: names, best NAME UNITS BATCHES, run NAME UNITS".to_owned()),
    };
    found.unwrap_or_else(|what| format!("error {what}"))
}

type Workloads<'a, 'b> = &'a [Box<dyn Workload + 'b>];

fn best(
    workloads: Workloads<'_, '_>,
    name: &str,
    units: &str,
    batches: &str,
) -> Result<String, String> {
    let workload = named(workloads, name)?;
    let (units, batches) = (count(units, MAX_UNITS)?, count(batches, MAX_BATCHES)?);
    let mut best = f64::INFINITY;
    for _ in 0..batches {
        let watch = Stopwatch::start();
        workload.run(units).map_err(|failure| failure.reason)?;
        best = best.min(watch.nanoseconds());
    }
    Ok(format!("ns {best}"))
}

fn ran(workloads: Workloads<'_, '_>, name: &str, units: &str) -> Result<String, String> {
    let evaluations = named(workloads, name)?.run(count(units, MAX_UNITS)?);
    evaluations.map(|it| format!("ran {it}")).map_err(|failure| failure.reason)
}

fn named<'a>(workloads: Workloads<'a, 'a>, name: &str) -> Result<&'a dyn Workload, String> {
    let workload = workloads.iter().find(|it| it.name() == name);
    workload.map(AsRef::as_ref).ok_or_else(|| format!("{name}: there is no such workload"))
}

fn count(text: &str, most: u64) -> Result<u64, String> {
    let count = text.parse().ok().filter(|it| (1..=most).contains(it));
    count.ok_or_else(|| format!("{text}: accepted is 1 to {most}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Failure;

    struct Idle;

    impl Workload for Idle {
        fn name(&self) -> String {
            "idle".to_owned()
        }

        fn run(&self, units: u64) -> Result<u64, Failure> {
            if units == 13 { Err(Failure::new("unlucky")) } else { Ok(units) }
        }
    }

    #[test]
    fn every_line_is_answered() {
        let asked = "names\nbest idle 7 2\nrun idle 7\nbest idle 13 1\nbest idle 0 1\nbest idle 1 x\nbest no 1 1\nstray\n\n";
        let mut said = Vec::new();
        let workloads: [Box<dyn Workload>; 1] = [Box::new(Idle)];
        let build = Build::new("", "rustc", "any");
        let served = serve(&build, &workloads, asked.as_bytes(), &mut said);
        let said = String::from_utf8(said).unwrap_or_default();
        assert!(served.is_ok(), "{served:?}");
        let lines: Vec<_> = said.lines().collect();
        assert_eq!(lines.len(), 10, "{said}");
        assert!(lines[0].starts_with(GREETING));
        assert_eq!(lines[1], "names idle");
        let time = lines[2].strip_prefix("ns ").and_then(|it| it.parse::<f64>().ok());
        assert!(time.is_some_and(|it| it >= 0.0), "{said}");
        assert_eq!(lines[3..5], ["ran 7", "error unlucky"]);
        assert!(lines[5..].iter().all(|line| line.starts_with("error ")), "{said}");
    }
}
