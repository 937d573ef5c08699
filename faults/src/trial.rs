//! Tries one fault after the other.

use crate::compile::{LIBRARIES, Program, SOLVER, VALIDATION, programs};
use crate::execute::{OscillatorOutcome, run};
use crate::fault::Fault;
use crate::record::{Table, Verdict};
use anyhow::{Result, bail};
use std::path::Path;
use std::time::Duration;

/// How faults are tried.
pub struct Plan {
    /// Whether the validation packages are asked about faults in the solver.
    pub thorough: bool,
    /// How many times its time without a fault a test program may take.
    pub patience: f64,
    /// Test programs that are left out.
    pub skip: Vec<String>,
}

/// Seconds that a test program may take beside its multiple, however short it is.
const MIN_SECONDS: f64 = 20.0;

/// A test program and how long it may take.
struct Timed {
    program: Program,
    /// Seconds of the processor's time.
    limit: u64,
}

/// Tries all of these faults and writes the table, a line as soon as it is known.
pub fn try_all(
    scratch: &Path,
    faults: &[Fault],
    plan: &Plan,
    table: &Path,
) -> Result<Vec<(Fault, Verdict)>> {
    let in_solver = |fault: &Fault| !fault.is_in_validation();
    let solver =
        if faults.iter().any(in_solver) { time_programs(scratch, SOLVER, plan)? } else { vec![] };
    let asks_validation = plan.thorough || !faults.iter().all(in_solver);
    let validation =
        if asks_validation { time_programs(scratch, VALIDATION, plan)? } else { vec![] };
    let mut table = Table::create(table)?;
    let mut verdicts = Vec::new();
    for fault in faults {
        let asked: Vec<&Timed> = match (in_solver(fault), plan.thorough) {
            (true, true) => solver.iter().chain(&validation).collect(),
            (true, false) => solver.iter().collect(),
            (false, _) => validation.iter().collect(),
        };
        let verdict = try_one(fault, &asked)?;
        forget_seeds(scratch)?;
        eprintln!("{}/{} {fault}: {verdict}", verdicts.len() + 1, faults.len());
        table.add(fault, &verdict)?;
        verdicts.push((fault.clone(), verdict));
    }
    Ok(verdicts)
}

fn try_one(fault: &Fault, programs: &[&Timed]) -> Result<Verdict> {
    for Timed { program, limit } in programs {
        let by = |test: &str| format!("{} {test}", program.name).trim_end().to_owned();
        match run(program, fault.number, Some(*limit))? {
            OscillatorOutcome::Passed(_) => {}
            OscillatorOutcome::Failed(test) => return Ok(Verdict::Caught(by(&test))),
            OscillatorOutcome::Crashed => return Ok(Verdict::Crash(by(""))),
            OscillatorOutcome::TimedOut => return Ok(Verdict::Timeout(by(""))),
        }
    }
    Ok(Verdict::Survived)
}

/// The test programs of some packages, quickest first. All have to pass without a fault.
fn time_programs(scratch: &Path, packages: &[&str], plan: &Plan) -> Result<Vec<Timed>> {
    let mut timed = Vec::new();
    let asked = |program: &Program| !plan.skip.contains(&program.name);
    for program in programs(scratch, packages)?.into_iter().filter(asked) {
        match run(&program, 0, None)? {
            OscillatorOutcome::Passed(took) => {
                eprintln!("without a fault: {} {:.2} s", program.name, took.as_secs_f64());
                timed.push((took, program));
            }
            other => bail!("{} fails without a fault: {other:?}", program.name),
        }
    }
    timed.sort_by_key(|(took, _)| *took);
    let with_limit = |(took, program): (Duration, Program)| Timed {
        program,
        limit: (took.as_secs_f64() * plan.patience + MIN_SECONDS) as u64,
    };
    Ok(timed.into_iter().map(with_limit).collect())
}

/// Removes the seeds that failed property tests have left for the next run.
fn forget_seeds(folder: &Path) -> Result<()> {
    for part in LIBRARIES.into_iter().chain(["", "tests", "validation", "validation/tests"]) {
        for entry in std::fs::read_dir(folder.join(part))? {
            let path = entry?.path();
            if path.to_string_lossy().ends_with("proptest-regressions") {
                if path.is_dir() {
                    std::fs::remove_dir_all(path)?;
                } else {
                    std::fs::remove_file(path)?;
                }
            }
        }
    }
    Ok(())
}
