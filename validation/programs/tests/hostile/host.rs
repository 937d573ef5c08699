//! A process that runs one program: how much memory that takes, and what is left of the program
//! when its host ends it.

use super::kinds::{ExpectedEnd, KINDS};
use super::left::{left, processes};
use super::rows::{program, run};
use libtest_mimic::{Failed, Trial};
use percuss_programs::end_all;
use std::process::Command;
use std::time::Duration;

/// Kinds that would fill the memory, if it were not bounded.
const LARGE_KINDS: [&str; 8] = [
    "line-without-end",
    "lines-without-end",
    "empty-lines-without-end",
    "events-without-number",
    "state-without-number",
    "long-failure",
    "deep",
    "megabytes-of-complaints",
];
/// The most memory that a host may take, in KiB: a few of the longest lines.
const MAX_KIB: u64 = 300 << 10;

/// The tests that need a host.
pub fn trials() -> Vec<Trial> {
    let memory = |kind: &'static str| {
        Trial::test(format!("memory_of_{kind}"), move || memory_is_bounded(kind))
    };
    let mut trials: Vec<Trial> = LARGE_KINDS.into_iter().map(memory).collect();
    trials.push(Trial::test("all_programs_end_with_their_host", all_programs_end));
    trials
}

/// Is the host of a program; prints the most memory that it has taken, in KiB.
pub fn host(kind: &str, token: &str) {
    let engines = program(kind, token, Duration::from_secs(120)).start().expect("it is started");
    if kind == "leaves-a-session" {
        let waiting = processes(token).len();
        end_all();
        let again = program(kind, token, Duration::from_secs(120)).start();
        println!("{waiting} {} {}", left(token).len(), again.is_err());
        return;
    }
    let _ = run(&engines[1], Duration::from_secs(120));
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux shows it");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    println!("{}", peak.expect("the most memory").trim().trim_end_matches(" kB"));
}

fn hosted(kind: &str) -> Result<String, Failed> {
    let token = format!("token-host-{kind}-{}", std::process::id());
    let mut command = Command::new(std::env::current_exe()?);
    let output = command.args(["host", kind, &token]).output()?;
    match left(&token) {
        left if left.is_empty() => Ok(String::from_utf8(output.stdout)?.trim().to_owned()),
        left => Err(format!("processes are left: {left:?}").into()),
    }
}

fn memory_is_bounded(kind: &str) -> Result<(), Failed> {
    let is_kind = KINDS.iter().any(|(it, expected)| {
        *it == kind && matches!(expected, ExpectedEnd::Row(_) | ExpectedEnd::Right)
    });
    let peak: u64 = hosted(kind)?.parse()?;
    if !is_kind || peak == 0 || peak > MAX_KIB {
        return Err(format!("it takes {peak} KiB; accepted are {MAX_KIB}").into());
    }
    Ok(())
}

/// A program waits; its host ends it and starts no other.
fn all_programs_end() -> Result<(), Failed> {
    match hosted("leaves-a-session")?.as_str() {
        "1 0 true" => Ok(()),
        other => Err(other.to_owned().into()),
    }
}
