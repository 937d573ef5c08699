//! The other end of a worker: a binary started as one, asked and waited for, never for ever.

use super::worker::GREETING;
use crate::engine::Failure;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

/// A worker's answer takes milliseconds; a machine that swaps may take longer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(60);
/// The most bytes of a line that is read; names of all workloads are shorter.
const MAX_LINE_BYTES: u64 = 1 << 16;

/// A running worker. It ends when it is dropped.
pub struct Worker {
    binary: String,
    child: Child,
    input: ChildStdin,
    lines: Receiver<String>,
    /// Version and commit, as it greets.
    pub version: String,
}

impl Worker {
    /// Starts a binary as a worker.
    ///
    /// # Errors
    /// Why that is not possible: it cannot be run, or is no worker.
    pub fn start(binary: &Path) -> Result<Self, Failure> {
        let shown = binary.display().to_string();
        let refused = |what: String| {
            Failure::new(format!("{shown}: {what}; accepted is a percuss that has bench worker"))
        };
        let child = Command::new(binary)
            .args(["bench", "worker"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut child = child.map_err(|error| refused(format!("cannot be run ({error})")))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(refused("has no streams".to_owned()));
        };
        // A line ahead at most: what talks without being asked waits.
        let (sender, lines) = sync_channel(1);
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            loop {
                let mut line = String::new();
                let read = output.by_ref().take(MAX_LINE_BYTES).read_line(&mut line);
                if !matches!(read, Ok(1..)) || sender.send(line).is_err() {
                    return;
                }
            }
        });
        let mut worker = Self { binary: shown, child, input, lines, version: String::new() };
        let greeting = worker.line()?;
        match greeting.strip_prefix(GREETING) {
            Some(version) => worker.version = version.trim().to_owned(),
            None => return Err(worker.failure("does not greet as one")),
        }
        Ok(worker)
    }

    /// The names of its workloads.
    ///
    /// # Errors
    /// Why there is no answer.
    pub fn names(&mut self) -> Result<Vec<String>, Failure> {
        let names = self.ask("names", "names")?;
        Ok(names.split_whitespace().map(str::to_owned).collect())
    }

    /// Processor time of the best batch, ns.
    ///
    /// # Errors
    /// Why there is no answer.
    pub fn best(&mut self, name: &str, units: u64, batches: u32) -> Result<f64, Failure> {
        let answer = self.ask(&format!("best {name} {units} {batches}"), "ns")?;
        let time = answer.trim().parse().ok().filter(|it: &f64| it.is_finite() && *it > 0.0);
        time.ok_or_else(|| self.failure(&format!("answers {answer}")))
    }

    fn ask(&mut self, question: &str, word: &str) -> Result<String, Failure> {
        let asked = writeln!(self.input, "{question}").and_then(|()| self.input.flush());
        asked.map_err(|error| self.failure(&format!("does not listen ({error})")))?;
        let line = self.line()?;
        match line.split_once(' ') {
            Some((first, rest)) if first == word => Ok(rest.trim().to_owned()),
            _ => Err(self.failure(&format!("answers {:?}", line.trim_end()))),
        }
    }

    fn line(&mut self) -> Result<String, Failure> {
        let line = self.lines.recv_timeout(ANSWER_TIMEOUT);
        line.map_err(|_| self.failure("does not answer"))
    }

    fn failure(&self, what: &str) -> Failure {
        let what: String = what.chars().take(200).collect();
        let accepted = "accepted is a percuss that has bench worker";
        Failure::new(format!("{}: {what}; {accepted}", self.binary))
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
