//! The processes of one program: as many as there are runs at a time, each used again as long as it
//! does nothing wrong.

use crate::process::Process;
use crate::programs_file::Program;
use crate::wire::{ReplyContent, RunAsk, RunReply};
use percuss_engines::engine::Failure;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The processes of one program.
pub(crate) struct Pool {
    program: Program,
    idle: Mutex<Vec<Process>>,
}

impl Pool {
    /// A pool that begins with a process which was started.
    pub(crate) fn new(program: Program, first: Process) -> Self {
        Self { program, idle: Mutex::new(vec![first]) }
    }

    /// The program.
    pub(crate) fn program(&self) -> &Program {
        &self.program
    }

    /// Makes a run, and says how long it was from the request to the answer.
    ///
    /// A process that did something wrong is ended, and another one started for the next run.
    ///
    /// # Errors
    /// What the program did wrong, that it was late, or its own reason for making no run.
    pub(crate) fn run(
        &self,
        run: &RunAsk<'_>,
        wait: Duration,
    ) -> Result<(RunReply, Duration), Failure> {
        let mut process = self.process().map_err(Failure::new)?;
        let began = Instant::now();
        let answered = process.run(run, wait).map_err(Failure::new)?;
        let took = began.elapsed();
        process.still_ready(wait).map_err(Failure::new)?;
        let answered = match answered {
            ReplyContent::Run(reply) => Ok((*reply, took)),
            ReplyContent::Failure(why) if why.is_empty() => {
                Err(Failure::new("failed without a reason"))
            }
            ReplyContent::Failure(why) => Err(Failure::new(why)),
            ReplyContent::GaveUp(why) => Err(Failure::new(format!("gave up: {why}"))),
            _ => {
                return Err(Failure::new("answered something else where a run was asked for"));
            }
        };
        self.idle_processes().push(process);
        answered
    }

    /// A process that waits for a request.
    fn process(&self) -> Result<Process, String> {
        let waiting = self.idle_processes().pop();
        if let Some(process) = waiting.filter(|process| !process.is_disturbed()) {
            return Ok(process);
        }
        let mut process = Process::start(&self.program)
            .map_err(|error| format!("cannot be started again: {error}"))?;
        process.ready(self.program.timeout).map_err(|why| format!("started again: {why}"))?;
        Ok(process)
    }

    fn idle_processes(&self) -> MutexGuard<'_, Vec<Process>> {
        // Its processes are as good after a panic as before it.
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
