//! Instructions, counted by valgrind: a count repeats where no time does.
//!
//! A worker of this very program is run twice with different amounts of work: the difference is the
//! work's alone. Valgrind shows a processor without the widest vectors; programs that ask what
//! there is count what they do there.

use crate::engine::Failure;
use std::io::Write;
use std::process::{Command, Stdio};

/// The units of work in the shorter of the two runs that are counted.
const FEW_UNITS: u64 = 2_000;
/// The units of work in the longer run; what both do besides cancels in the difference.
const MANY_UNITS: u64 = 22_000;

/// Instructions per unit of a workload.
///
/// # Errors
/// Valgrind is not installed, or gives no count.
pub fn per_unit(bench: &str) -> Result<f64, Failure> {
    let (little, much) = (count(bench, FEW_UNITS)?, count(bench, MANY_UNITS)?);
    if much <= little {
        return Err(Failure::new(format!("valgrind counts {little} and, for more work, {much}")));
    }
    Ok((much - little) as f64 / (MANY_UNITS - FEW_UNITS) as f64)
}

fn count(bench: &str, units: u64) -> Result<u64, Failure> {
    let failed = |what: &str| Failure::new(format!("valgrind {what}"));
    let this = std::env::current_exe().map_err(Failure::new)?;
    let child = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(this)
        .args(["bench", "worker"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = child.map_err(|error| failed(&format!("cannot be run ({error})")))?;
    if let Some(mut input) = child.stdin.take() {
        writeln!(input, "run {bench} {units}").map_err(Failure::new)?;
    }
    let output = child.wait_with_output().map_err(Failure::new)?;
    let [answered, said] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    if !answered.lines().any(|line| line.starts_with("ran ")) {
        return Err(failed("does not run the workload"));
    }
    let collected = said.lines().find_map(|line| line.split_once("Collected :"));
    let collected = collected.and_then(|(_, count)| count.trim().parse().ok());
    collected.ok_or_else(|| failed("gives no count"))
}
