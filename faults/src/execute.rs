//! Runs a test program until its first failure.

use crate::compile::Program;
use anyhow::{Context, Result};
use std::io::{BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// What became of a test program.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// All its tests passed, after so long.
    Passed(Duration),
    /// This test failed.
    Failed(String),
    /// It ended by itself without a failed test: out of memory, or of its stack.
    Crashed,
    /// It was stopped after its time.
    TimedOut,
}

/// Memory that a test program may address, in KiB: a fault may make a run collect phases without end.
const MEMORY: &str = "16000000";

/// Runs the program with this fault; 0 is none.
pub fn run(program: &Program, fault: u32, limit: Option<Duration>) -> Result<Outcome> {
    let started = Instant::now();
    let mut child = start(program, fault)?;
    let lines = lines_of(&mut child)?;
    let outcome = loop {
        let left = limit.map_or(Duration::MAX, |limit| limit.saturating_sub(started.elapsed()));
        // Durations near the largest overflow a deadline.
        match lines.recv_timeout(left.min(Duration::from_secs(86_400))) {
            Ok(line) => {
                if let Some(test) = failed_test(&line) {
                    break Some(Outcome::Failed(test));
                }
            }
            Err(RecvTimeoutError::Timeout) => break Some(Outcome::TimedOut),
            Err(RecvTimeoutError::Disconnected) => break None,
        }
    };
    if let Some(outcome) = outcome {
        stop(&mut child)?;
        return Ok(outcome);
    }
    let status = child.wait()?;
    Ok(if status.success() { Outcome::Passed(started.elapsed()) } else { Outcome::Crashed })
}

fn start(program: &Program, fault: u32) -> Result<Child> {
    Command::new("sh")
        .arg("-c")
        .arg(format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\""))
        .arg(&program.path)
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

fn lines_of(child: &mut Child) -> Result<Receiver<String>> {
    let (sender, receiver) = channel();
    let output = child.stdout.take().context("no output")?;
    std::thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    Ok(receiver)
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
