//! The programs that run now, which have to be ended before this process ends.

use super::sweep::MARK_VARIABLE;
use std::collections::BTreeMap;
use std::io;
use std::process::{Child, Command};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

/// The programs that run, by the numbers of their processes, each with its mark.
static LIVE_PROGRAMS: Mutex<Live> = Mutex::new(Live { programs: BTreeMap::new(), is_over: false });

struct Live {
    programs: BTreeMap<u32, String>,
    /// Whether no program is started any more.
    is_over: bool,
}

fn live() -> MutexGuard<'static, Live> {
    // A map of numbers is as good after a panic as before it.
    LIVE_PROGRAMS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a program that is ended by [`end`] or [`end_all`].
pub(super) fn start(command: &mut Command) -> io::Result<Child> {
    let mark = mark();
    // Known from the moment it exists.
    let mut live = live();
    if live.is_over {
        return Err(io::Error::other("no program is started any more"));
    }
    let child = command.env(MARK_VARIABLE, &mark).spawn()?;
    live.programs.insert(child.id(), mark);
    Ok(child)
}

/// A unique mark of a program.
fn mark() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    format!("{}-{count}-{}", std::process::id(), now.as_nanos())
}

/// Ends a program with all that it has started.
pub(super) fn end(id: u32) {
    let mark = live().programs.remove(&id);
    if let Some(mark) = mark {
        end_tree(id, &mark);
    }
}

/// Ends all programs, and starts no more: for the end of this process, or its interruption.
pub fn end_all() {
    let mut live = live();
    live.is_over = true;
    for (id, mark) in std::mem::take(&mut live.programs) {
        end_tree(id, &mark);
    }
}

#[cfg(target_os = "linux")]
fn end_tree(id: u32, mark: &str) {
    super::sweep::end(id, mark);
}

/// Ends the group of a program; a process that has left the group is found on Linux alone.
#[cfg(all(unix, not(target_os = "linux")))]
fn end_tree(id: u32, _: &str) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(group) = i32::try_from(id).ok().and_then(Pid::from_raw) {
        let _ = kill_process_group(group, Signal::KILL);
    }
}

/// Does nothing: without groups of processes the program alone is ended, by its owner.
#[cfg(not(unix))]
fn end_tree(_: u32, _: &str) {}
