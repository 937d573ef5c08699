//! Runs a test program until its first failure.

use crate::compile::Program;
use anyhow::{Context, Result};
use std::io::{BufRead, BufReader};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// What became of a test program.
#[derive(Clone, Debug, PartialEq)]
pub enum OscillatorOutcome {
    /// All its tests passed, after so long.
    Passed(Duration),
    /// This test failed.
    Failed(String),
    /// It ended by itself without a failed test: out of memory, or of its stack.
    Crashed,
    /// It was stopped after its time.
    TimedOut,
}

/// The signals by which a limit of the processor's time ends a program: SIGKILL and SIGXCPU.
const SIGKILL: i32 = 9;
const SIGXCPU: i32 = 24;

/// Memory that a test program may address, in KiB: a fault may make a run collect phases without
/// end.
const MEMORY_KIB: &str = "16000000";

/// Runs the program with this fault; 0 is none. It may take so many seconds of the processor's
/// time, which does not depend on what else the machine does.
pub fn run(program: &Program, fault: u32, limit: Option<u64>) -> Result<OscillatorOutcome> {
    let started = Instant::now();
    let mut child = start(program, fault, limit)?;
    let output = child.stdout.take().context("no output")?;
    let mut lines = BufReader::new(output).lines().map_while(Result::ok);
    if let Some(test) = lines.find_map(|line| failed_test(&line)) {
        stop(&mut child)?;
        return Ok(OscillatorOutcome::Failed(test));
    }
    let status = child.wait()?;
    Ok(match status.signal() {
        _ if status.success() => OscillatorOutcome::Passed(started.elapsed()),
        Some(SIGKILL | SIGXCPU) => OscillatorOutcome::TimedOut,
        _ => OscillatorOutcome::Crashed,
    })
}

fn start(program: &Program, fault: u32, limit: Option<u64>) -> Result<Child> {
    let time = limit.map_or("unlimited".to_owned(), |seconds| seconds.to_string());
    Command::new("sh")
        .arg("-c")
        .arg(format!("ulimit -v {MEMORY_KIB}; ulimit -t {time}; exec \"$0\" \"$@\""))
        .arg(&program.path)
        .args(&program.module)
        .env("PERCUSS_FAULT", fault.to_string())
        .env("CARGO_MANIFEST_DIR", &program.folder)
        // The same cases every time, and none made smaller: a failure is enough.
        .env("PROPTEST_RNG_SEED", "15")
        .env("PROPTEST_MAX_SHRINK_ITERS", "0")
        .current_dir(&program.folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        // Of its own group, so that what it has started is stopped with it.
        .process_group(0)
        .spawn()
        .with_context(|| program.path.display().to_string())
}

fn failed_test(line: &str) -> Option<String> {
    let name = line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?;
    Some(name.split(" - should panic").next().unwrap_or(name).to_owned())
}

fn stop(child: &mut Child) -> Result<()> {
    let group = format!("-{}", child.id());
    Command::new("kill").args(["-KILL", "--", &group]).status()?;
    child.wait()?;
    Ok(())
}
