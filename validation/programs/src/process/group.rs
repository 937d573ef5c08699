//! A program and the processes that it has started.

use super::live;
use crate::programs_file::Program;
use std::io;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// A program with all that it has started, ended together.
pub(super) struct Group {
    leader: Child,
    is_ended: bool,
}

/// The standard streams of a program.
pub(super) struct Pipes {
    pub(super) stdin: ChildStdin,
    pub(super) stdout: ChildStdout,
    pub(super) stderr: ChildStderr,
}

/// The ending of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ProgramExit {
    Code(i32),
    Signal(i32),
    Unknown,
}

/// The time between two looks at a program that is about to end.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

impl Group {
    /// Starts a program in a group of its own, with a mark in its environment that the processes it
    /// starts inherit.
    pub(super) fn start(program: &Program) -> io::Result<(Self, Pipes)> {
        let Some((name, arguments)) = program.command.split_first() else {
            return Err(io::Error::other("the command is empty"));
        };
        let mut command = Command::new(name);
        command.args(arguments).current_dir(&program.folder);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        set_own_group(&mut command);
        let mut leader = live::start(&mut command)?;
        let streams = (leader.stdin.take(), leader.stdout.take(), leader.stderr.take());
        let group = Self { leader, is_ended: false };
        match streams {
            (Some(stdin), Some(stdout), Some(stderr)) => {
                Ok((group, Pipes { stdin, stdout, stderr }))
            }
            _ => Err(io::Error::other("a standard stream is missing")),
        }
    }

    /// How the program ended, if it does so in time.
    pub(super) fn exit(&mut self, wait: Duration) -> Option<ProgramExit> {
        let until = Instant::now() + wait;
        loop {
            match program_exit(&mut self.leader) {
                None if Instant::now() < until => std::thread::sleep(POLL_INTERVAL),
                exit => return exit,
            }
        }
    }

    /// Whether the program is stopped, as far as the system tells.
    pub(super) fn is_stopped(&self) -> bool {
        is_stopped(self.leader.id())
    }

    /// Ends the program and all that it has started.
    pub(super) fn end(&mut self) {
        if self.is_ended {
            return;
        }
        self.is_ended = true;
        live::end(self.leader.id());
        // What cannot be ended by its group is ended alone.
        let _ = self.leader.kill();
        // Only now its number may be given to another process.
        let _ = self.leader.wait();
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(unix)]
fn set_own_group(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
}

#[cfg(not(unix))]
fn set_own_group(_: &mut Command) {}

/// How a process ended, which keeps its number: the group that bears it can still be ended.
#[cfg(unix)]
fn program_exit(leader: &mut Child) -> Option<ProgramExit> {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let pid = Pid::from_raw(i32::try_from(leader.id()).ok()?)?;
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    let Ok(status) = waitid(WaitId::Pid(pid), options) else { return Some(ProgramExit::Unknown) };
    let status = status?;
    let code = status.exit_status().map(ProgramExit::Code);
    Some(
        code.or(status.terminating_signal().map(ProgramExit::Signal))
            .unwrap_or(ProgramExit::Unknown),
    )
}

#[cfg(not(unix))]
fn program_exit(leader: &mut Child) -> Option<ProgramExit> {
    match leader.try_wait() {
        Ok(None) => None,
        Ok(Some(status)) => Some(status.code().map_or(ProgramExit::Unknown, ProgramExit::Code)),
        Err(_) => Some(ProgramExit::Unknown),
    }
}

#[cfg(target_os = "linux")]
fn is_stopped(id: u32) -> bool {
    super::sweep::state(id) == Some('T')
}

#[cfg(not(target_os = "linux"))]
fn is_stopped(_: u32) -> bool {
    false
}
