//! Ends a program with all that it has started, as far as Linux lets them be found.
//!
//! Processes are found by the program's group; by their parents, as long as these live; and by the
//! mark in the environment that they were started with, which stays with those that leave the group
//! and lose their parents. What does all of it, and starts itself anew without that environment, is
//! not found.

use rustix::process::{Pid, PidfdFlags, Signal, kill_process_group, pidfd_open, pidfd_send_signal};
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// The variable that marks the processes of a program.
pub(super) const MARK_VARIABLE: &str = "PERCUSS_PROGRAM";

/// The time for which processes that are left are looked for.
const SWEEP_TIMEOUT: Duration = Duration::from_secs(5);
/// The time that a process that was killed may still be there before it is looked for again.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// A process as the system shows it.
struct ProcessStatus {
    state: char,
    parent: u32,
    /// Tells processes of one number from each other.
    began: u64,
}

/// Ends a program: the process of this number, which nobody has waited for yet, and those that
/// bear the mark.
pub(super) fn end(id: u32, mark: &str) {
    let mark = format!("{MARK_VARIABLE}={mark}");
    let until = Instant::now() + SWEEP_TIMEOUT;
    // Whose parents are about to go.
    let mut known = descendants(id);
    loop {
        if let Some(group) = pid(id) {
            let _ = kill_process_group(group, Signal::KILL);
        }
        for &(descendant, began) in &known {
            kill_if(descendant, || process_status(descendant).is_some_and(|it| it.began == began));
        }
        let left: Vec<u32> =
            processes().into_iter().filter(|it| *it != id && bears(*it, &mark)).collect();
        for &process in &left {
            known.extend(descendants(process));
            kill_if(process, || bears(process, &mark));
        }
        known.retain(|(it, began)| {
            process_status(*it).is_some_and(|it| it.began == *began && it.state != 'Z')
        });
        if (left.is_empty() && known.is_empty()) || Instant::now() > until {
            return;
        }
        std::thread::sleep(POLL_INTERVAL);
    }
}

/// The state of a process: `T` where it is stopped.
pub(super) fn state(id: u32) -> Option<char> {
    process_status(id).map(|it| it.state)
}

fn pid(id: u32) -> Option<Pid> {
    Pid::from_raw(i32::try_from(id).ok()?)
}

/// Kills a process of which something holds, and no other that has come to its number since.
fn kill_if(id: u32, holds: impl FnOnce() -> bool) {
    let Some(process) = pid(id) else { return };
    let Ok(handle) = pidfd_open(process, PidfdFlags::empty()) else { return };
    if holds() {
        let _ = pidfd_send_signal(&handle, Signal::KILL);
    }
}

/// The numbers of all processes.
fn processes() -> Vec<u32> {
    let Ok(entries) = std::fs::read_dir("/proc") else { return Vec::new() };
    entries.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok()).collect()
}

/// Whether a process was started with the mark. Those that have ended show no environment.
fn bears(id: u32, mark: &str) -> bool {
    let Ok(environment) = std::fs::read(format!("/proc/{id}/environ")) else { return false };
    environment.split(|byte| *byte == 0).any(|variable| variable == mark.as_bytes())
}

/// The processes that a process has started, and those that they have, with the times of their
/// beginnings.
fn descendants(id: u32) -> BTreeSet<(u32, u64)> {
    let all: Vec<(u32, ProcessStatus)> =
        processes().into_iter().filter_map(|it| Some((it, process_status(it)?))).collect();
    let mut parents = BTreeSet::from([id]);
    let mut found = BTreeSet::new();
    loop {
        let next: Vec<_> = all
            .iter()
            .filter(|(it, shown)| parents.contains(&shown.parent) && !parents.contains(it))
            .collect();
        if next.is_empty() {
            return found;
        }
        parents.extend(next.iter().map(|(it, _)| *it));
        found.extend(next.iter().map(|(it, shown)| (*it, shown.began)));
    }
}

/// What the system shows of a process: `id (name) state parent ...`, where a name may hold
/// anything.
fn process_status(id: u32) -> Option<ProcessStatus> {
    let text = std::fs::read(format!("/proc/{id}/stat")).ok()?;
    let text = String::from_utf8_lossy(&text).into_owned();
    let (_, rest) = text.rsplit_once(") ")?;
    let mut fields = rest.split(' ');
    let state = fields.next()?.chars().next()?;
    let parent = fields.next()?.parse().ok()?;
    // The 22nd field of all.
    let began = fields.nth(17)?.parse().ok()?;
    Some(ProcessStatus { state, parent, began })
}
