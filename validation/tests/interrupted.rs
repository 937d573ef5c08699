//! An interrupted run leaves the old file or none, and says by its exit code what ended it.

use crate::support;
use rustix::process::{Pid, Signal, kill_process};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("read");
    let name = |it: std::io::Result<std::fs::DirEntry>| it.expect("an entry").file_name();
    let mut names: Vec<_> = entries.map(|it| name(it).to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Starts a run that writes a file for hours.
fn started(output: &Path) -> Child {
    let mut command = Command::new(support::percuss(&[]).get_program());
    command.args(["simulate", "--periods", "1000000000", "--samples", "1000", "--output"]);
    command.arg(output).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().expect("started")
}

fn interrupted_by(signal: Signal, code: i32, old: Option<&str>) {
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join("run.csv");
    if let Some(old) = old {
        std::fs::write(&output, old).expect("written");
    }
    let before = names(folder.path());
    let mut child = started(&output);
    // Gives up rather than wait for ever; no duration is asserted.
    let patience = Instant::now() + Duration::from_secs(300);
    let is_unfinished = |name: &String| name.starts_with(".percuss-");
    while !names(folder.path()).iter().any(is_unfinished) {
        assert!(Instant::now() < patience, "no temporary file appears");
        std::thread::sleep(Duration::from_millis(5));
    }
    kill_process(Pid::from_child(&child), signal).expect("sent");
    let status = child.wait().expect("ended");
    assert_eq!(status.code(), Some(code), "{status:?}");
    assert_eq!(names(folder.path()), before);
    if let Some(old) = old {
        assert_eq!(std::fs::read_to_string(&output).expect("read"), old);
    }
}

#[test]
fn sigint_leaves_no_file() {
    interrupted_by(Signal::INT, 130, None);
}

#[test]
fn sigterm_leaves_no_file() {
    interrupted_by(Signal::TERM, 143, None);
}

#[test]
fn sigterm_leaves_the_old_file() {
    interrupted_by(Signal::TERM, 143, Some("old"));
}
