//! The processes of one program: as many as there are runs at a time, each used again as long as it
//! does nothing wrong.

use crate::file::Program;
use crate::process::Process;
use crate::wire::{ReplyContent, RunAsk, RunReply};
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
    /// What the program did wrong, or its own reason for making no run.
    pub(crate) fn run(
        &self,
        run: &RunAsk<'_>,
        wait: Duration,
    ) -> Result<(RunReply, Duration), String> {
        let mut process = self.process()?;
        let began = Instant::now();
        let answered = process.run(run, wait)?;
        let took = began.elapsed();
        process.still_ready(wait)?;
        let answered = match answered {
            ReplyContent::Run(reply) => Ok((*reply, took)),
            ReplyContent::Failure(why) if why.is_empty() => {
                Err("failed without a reason".to_owned())
            }
            ReplyContent::Failure(why) => Err(why),
            _ => return Err("answered something else where a run was asked for".to_owned()),
        };
        self.idle().push(process);
        answered
    }

    /// A process that waits for a request.
    fn process(&self) -> Result<Process, String> {
        let waiting = self.idle().pop();
        if let Some(process) = waiting.filter(|process| !process.is_disturbed()) {
            return Ok(process);
        }
        let mut process = Process::start(&self.program)
            .map_err(|error| format!("cannot be started again: {error}"))?;
        process.ready(self.program.timeout).map_err(|why| format!("started again: {why}"))?;
        Ok(process)
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Process>> {
        // Its processes are as good after a panic as before it.
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
