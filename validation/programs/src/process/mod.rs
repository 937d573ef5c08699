//! A program that runs: requests go in, answers come out, and nothing is left of it in the end.

mod group;
mod live;
mod streams;
#[cfg(target_os = "linux")]
mod sweep;

pub use live::end_all;

use crate::programs_file::Program;
use crate::text::last_line;
use crate::wire::{Ask, Asked, ReplyContent, RunAsk, decode};
use group::{Group, ProgramExit};
use std::io;
use std::time::{Duration, Instant};
use streams::{OutputLine, Streams};

/// The longest line that is read: an answer of so many events and samples as are accepted is
/// shorter.
const MAX_LINE_BYTES: usize = 32 << 20;
/// The time within which a program has to say that it waits for the next request.
const READY_TIMEOUT: Duration = Duration::from_secs(10);
/// The time within which a program whose output has ended has to end itself.
const EXIT_TIMEOUT: Duration = Duration::from_millis(500);

/// A program that runs. It is ended, with all that it has started, when this is dropped.
pub(crate) struct Process {
    // Dropped before the streams: their threads end when the program's ends of them are closed.
    group: Group,
    streams: Streams,
    asked: u64,
}

impl Process {
    /// Starts a program.
    ///
    /// # Errors
    /// An error of the operating system.
    pub(crate) fn start(program: &Program) -> io::Result<Self> {
        let (group, pipes) = Group::start(program)?;
        Ok(Self { group, streams: Streams::new(pipes)?, asked: 0 })
    }

    /// Asks what the program can do.
    ///
    /// # Errors
    /// What it did instead of answering.
    pub(crate) fn capabilities(&mut self, wait: Duration) -> Result<ReplyContent, String> {
        self.ask(Asked::Capabilities, None, wait)
    }

    /// Asks for a run.
    ///
    /// # Errors
    /// What the program did instead of answering.
    pub(crate) fn run(&mut self, run: &RunAsk<'_>, wait: Duration) -> Result<ReplyContent, String> {
        self.ask(Asked::Run, Some(run), wait)
    }

    /// Asks whether the program waits for the next request, so that what it did wrong after an
    /// answer is the matter of that answer.
    ///
    /// # Errors
    /// What it did instead of answering.
    pub(crate) fn ready(&mut self, wait: Duration) -> Result<(), String> {
        match self.ask(Asked::Ready, None, wait)? {
            ReplyContent::Ready => Ok(()),
            _ => Err("answered something else where it was asked for ready".to_owned()),
        }
    }

    /// Asks after an answer whether the program waits for the next request.
    pub(crate) fn still_ready(&mut self, wait: Duration) -> Result<(), String> {
        self.ready(wait.min(READY_TIMEOUT)).map_err(|why| format!("after its answer: {why}"))
    }

    /// Whether the program has written something since its last answer, or has ended.
    pub(crate) fn is_disturbed(&self) -> bool {
        self.streams.is_disturbed()
    }

    fn ask(
        &mut self,
        asked: Asked,
        run: Option<&RunAsk<'_>>,
        wait: Duration,
    ) -> Result<ReplyContent, String> {
        let until = Instant::now() + wait;
        self.asked += 1;
        let ask =
            run.map_or_else(|| Ask::plain(self.asked, asked), |run| Ask::run(self.asked, run));
        let mut line = serde_json::to_vec(&ask).map_err(|error| error.to_string())?;
        line.push(b'\n');
        self.streams.write(line);
        let line = self.streams.read(until.saturating_duration_since(Instant::now()));
        match line {
            Some(OutputLine::Text(line)) => decode(&line, self.asked),
            Some(OutputLine::TooLong) => {
                Err(format!("wrote a line of more than {MAX_LINE_BYTES} bytes"))
            }
            Some(OutputLine::Unfinished(count)) => {
                Err(self.why_ended(&format!("in a line of {count} bytes that is not whole")))
            }
            Some(OutputLine::Closed) => Err(self.why_ended("without an answer")),
            None => Err(self.why_late(wait)),
        }
    }

    /// Why there is no answer from a program whose output has ended.
    fn why_ended(&mut self, how: &str) -> String {
        let what = match self.group.exit(EXIT_TIMEOUT) {
            Some(ProgramExit::Code(code)) => format!("ended {how}, with exit code {code}"),
            Some(ProgramExit::Signal(signal)) => format!("ended {how}, killed by signal {signal}"),
            Some(ProgramExit::Unknown) => format!("ended {how}"),
            None => format!("closed its output {how} and went on"),
        };
        self.group.end();
        self.with_complaint(what)
    }

    /// Why there is no answer from a program that had time enough.
    fn why_late(&mut self, wait: Duration) -> String {
        let seconds = wait.as_secs_f64();
        let has_ended = self.group.exit(Duration::ZERO).is_some();
        let state = match (self.streams.partial(), self.group.is_stopped()) {
            (_, true) => "the program is stopped".to_owned(),
            (0, _) if has_ended => "the program has ended, and what it started has not".to_owned(),
            (0, _) => "it wrote nothing".to_owned(),
            (count, _) => format!("it wrote {count} bytes of a line that is not whole"),
        };
        self.group.end();
        self.with_complaint(format!("gave up after {seconds} s: {state}"))
    }

    /// A reason with the last that the program wrote to its standard error.
    fn with_complaint(&self, what: String) -> String {
        match last_line(&self.streams.complaint(EXIT_TIMEOUT)) {
            Some(line) => format!("{what}; it said: {line}"),
            None => what,
        }
    }
}
