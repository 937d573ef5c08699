//! The standard streams of a program, each with a thread of its own: no program can block its
//! reader by not reading, or by writing to its standard error, and none fills the memory.

use super::MAX_LINE_BYTES;
use super::group::Pipes;
use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{ChildStderr, ChildStdin, ChildStdout};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, SyncSender, TryRecvError, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::Builder;
use std::time::Duration;

/// The most bytes that are kept of what a program writes to its standard error: the end of it.
const MAX_COMPLAINT_BYTES: usize = 4096;

/// A line of a program's output.
#[derive(Debug)]
pub(super) enum OutputLine {
    /// A whole line.
    Text(Vec<u8>),
    /// A line that is too long; the rest is not read.
    TooLong,
    /// The output ended in a line of so many bytes.
    Unfinished(usize),
    /// The output ended.
    Closed,
}

/// The streams of a program.
pub(super) struct Streams {
    input: SyncSender<Vec<u8>>,
    output: Receiver<OutputLine>,
    partial: Arc<AtomicUsize>,
    complaint: Arc<Mutex<VecDeque<u8>>>,
    complained: Receiver<()>,
}

impl Streams {
    /// Takes over the streams of a program.
    ///
    /// # Errors
    /// The operating system starts no more threads.
    pub(super) fn new(pipes: Pipes) -> io::Result<Self> {
        let (input, requests) = sync_channel(1);
        // One line waits to be asked for, and one to be taken over: no more are in the memory.
        let (lines, output) = sync_channel(1);
        let (partial, complaint) = (Arc::default(), Arc::default());
        let (done, complained) = channel();
        let (progress, kept) = (Arc::clone(&partial), Arc::clone(&complaint));
        let Pipes { stdin, stdout, stderr } = pipes;
        let named = |name: &str| Builder::new().name(name.to_owned());
        named("requests").spawn(move || write_requests(stdin, &requests))?;
        named("answers").spawn(move || read_lines(stdout, &lines, &progress))?;
        named("complaints").spawn(move || keep_end(stderr, &kept, done))?;
        Ok(Self { input, output, partial, complaint, complained })
    }

    /// Writes a request; one that cannot be written shows in the answer that does not come.
    pub(super) fn write(&self, request: Vec<u8>) {
        let _ = self.input.try_send(request);
    }

    /// The next line, if there is one in time.
    pub(super) fn read(&self, wait: Duration) -> Option<OutputLine> {
        use std::sync::mpsc::RecvTimeoutError::{Disconnected, Timeout};
        match self.output.recv_timeout(wait) {
            Ok(line) => Some(line),
            Err(Disconnected) => Some(OutputLine::Closed),
            Err(Timeout) => None,
        }
    }

    /// Whether there is something to be read, or the output has ended.
    pub(super) fn is_disturbed(&self) -> bool {
        !matches!(self.output.try_recv(), Err(TryRecvError::Empty)) || self.partial() > 0
    }

    /// How many bytes there are of a line that is not whole.
    pub(super) fn partial(&self) -> usize {
        self.partial.load(Ordering::Relaxed)
    }

    /// The end of what the program wrote to its standard error, once it has ended.
    pub(super) fn complaint(&self, wait: Duration) -> Vec<u8> {
        // Nothing is sent: the thread ends, and its end of the channel is gone.
        let _ = self.complained.recv_timeout(wait);
        let kept = self.complaint.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().copied().collect()
    }
}

fn write_requests(mut stdin: ChildStdin, requests: &Receiver<Vec<u8>>) {
    for request in requests {
        if stdin.write_all(&request).and_then(|()| stdin.flush()).is_err() {
            return;
        }
    }
}

fn read_lines(stdout: ChildStdout, lines: &SyncSender<OutputLine>, partial: &AtomicUsize) {
    let mut reader = BufReader::new(stdout);
    loop {
        let line = read_line(&mut reader, partial);
        let is_last = !matches!(line, OutputLine::Text(_));
        // Nobody waits for it any more where the program was given up.
        if lines.send(line).is_err() || is_last {
            return;
        }
    }
}

fn read_line(reader: &mut impl BufRead, partial: &AtomicUsize) -> OutputLine {
    let mut line = Vec::new();
    loop {
        partial.store(line.len(), Ordering::Relaxed);
        let bytes = match reader.fill_buf() {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(_) => &[],
        };
        if bytes.is_empty() {
            return if line.is_empty() {
                OutputLine::Closed
            } else {
                OutputLine::Unfinished(line.len())
            };
        }
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let count = end.unwrap_or(bytes.len());
        if line.len() + count > MAX_LINE_BYTES {
            return OutputLine::TooLong;
        }
        line.extend_from_slice(&bytes[..count]);
        reader.consume(end.map_or(count, |end| end + 1));
        if end.is_some() {
            partial.store(0, Ordering::Relaxed);
            return OutputLine::Text(line);
        }
    }
}

/// Reads all that is written, so that the program is never blocked, and keeps the end of it. `done`
/// is dropped when there is no more.
fn keep_end(mut stderr: ChildStderr, kept: &Mutex<VecDeque<u8>>, done: Sender<()>) {
    let mut bytes = [0; MAX_COMPLAINT_BYTES];
    while let Ok(count) = stderr.read(&mut bytes) {
        if count == 0 {
            break;
        }
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&bytes[..count]);
        let surplus = kept.len().saturating_sub(MAX_COMPLAINT_BYTES);
        kept.drain(..surplus);
    }
    drop(done);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_at_their_ends() {
        let partial = AtomicUsize::new(0);
        let mut reader = io::Cursor::new(b"one\r\n\ntwo".as_slice());
        let lines: Vec<OutputLine> = (0..4).map(|_| read_line(&mut reader, &partial)).collect();
        let [
            OutputLine::Text(one),
            OutputLine::Text(empty),
            OutputLine::Unfinished(3),
            OutputLine::Closed,
        ] = lines.as_slice()
        else {
            unreachable!("{lines:?}")
        };
        assert_eq!((one.as_slice(), empty.len()), (b"one\r".as_slice(), 0));
    }

    #[test]
    fn a_line_without_end_is_not_kept() {
        let partial = AtomicUsize::new(0);
        let mut reader = BufReader::new(io::repeat(b'x'));
        assert!(matches!(read_line(&mut reader, &partial), OutputLine::TooLong));
        let whole = [b"x".repeat(MAX_LINE_BYTES), b"\n".to_vec()].concat();
        let OutputLine::Text(line) = read_line(&mut whole.as_slice(), &partial) else {
            unreachable!()
        };
        assert_eq!(line.len(), MAX_LINE_BYTES);
    }
}
