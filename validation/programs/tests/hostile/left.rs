//! Processes that are left, found by a word among their arguments, which is not how they are ended.

use std::time::{Duration, Instant};

/// The time within which what is left has to end: it has been told.
const END_TIMEOUT: Duration = Duration::from_secs(20);

/// The processes of a word that have not ended when they had time to.
pub fn left(token: &str) -> Vec<u32> {
    let until = Instant::now() + END_TIMEOUT;
    loop {
        let found = processes(token);
        if found.is_empty() || Instant::now() > until {
            return found;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The processes that run now, but for this one.
pub fn processes(token: &str) -> Vec<u32> {
    let entries = std::fs::read_dir("/proc").expect("Linux shows its processes");
    let number = |name: &std::ffi::OsStr| name.to_str()?.parse::<u32>().ok();
    let numbers = entries.filter_map(|entry| number(&entry.ok()?.file_name()));
    numbers.filter(|id| *id != std::process::id() && bears(*id, token)).collect()
}

/// Whether a process has the word among its arguments; one that has ended shows none.
fn bears(id: u32, token: &str) -> bool {
    let Ok(arguments) = std::fs::read(format!("/proc/{id}/cmdline")) else { return false };
    arguments.split(|byte| *byte == 0).any(|word| word == token.as_bytes())
}
