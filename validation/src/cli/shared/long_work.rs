//! Long work: its length, its threads and its progress.

use super::parse::MAX_PERIODS;
use super::terminal::{is_quiet, note};
use anyhow::{Context, Result, bail};
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt;
use std::io::{self, IsTerminal};
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// A run of both together has an accepted length.
pub(in crate::cli) fn check_horizon(transient: u64, periods: u64) -> Result<()> {
    let whole = transient.saturating_add(periods);
    if whole > MAX_PERIODS {
        bail!(
            "--transient and --periods make {whole} forcing periods: accepted are at most {MAX_PERIODS}"
        );
    }
    Ok(())
}

/// A pool of as many threads as were asked for, or of all.
pub(in crate::cli) fn pool(threads: Option<u16>) -> Result<rayon::ThreadPool> {
    let threads = usize::from(threads.unwrap_or(0));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.context("--threads: the threads cannot be started")
}

/// Work that is done sooner shows no progress.
const SILENT_TIME: Duration = Duration::from_secs(2);

/// The time between two lines about work, where stderr is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(30);

/// Progress on stderr with the time to go: of work that takes long, unless `--quiet` was given. A
/// terminal has a bar, anything else a line now and then.
pub(in crate::cli) struct Bar {
    bar: ProgressBar,
    /// Ends the wait for [`SILENT_TIME`], or for the next line.
    waiting: Mutex<Option<Sender<()>>>,
}

impl Bar {
    fn new(
        bar: ProgressBar,
        style: &str,
        done: impl Fn(&ProgressBar) -> String + Send + 'static,
    ) -> Self {
        let bar = match ProgressStyle::with_template(style) {
            Ok(style) => bar.with_style(style.with_key("to_go", show_time_to_go)),
            Err(_) => bar,
        };
        bar.set_draw_target(ProgressDrawTarget::hidden());
        let told = |bar: ProgressBar| {
            told_every(LINE_INTERVAL, move || {
                let elapsed = bar.elapsed();
                let to_go = time_to_go(elapsed, bar.position(), bar.length());
                note(&line(&done(&bar), elapsed, to_go));
            })
        };
        let waiting = (!is_quiet()).then(|| match io::stderr().is_terminal() {
            true => shown_later(bar.clone()),
            false => told(bar.clone()),
        });
        Self { bar, waiting: Mutex::new(waiting) }
    }

    /// Tells the bar that this much more is done.
    pub(in crate::cli) fn inc(&self, count: u64) {
        self.bar.inc(count);
    }

    /// Adds work to the bar.
    pub(in crate::cli) fn inc_length(&self, count: u64) {
        self.bar.inc_length(count);
    }

    /// Shows the share of the work that is done, 0 to 1.
    pub(in crate::cli) fn show_share(&self, share: f64) {
        self.bar.set_position((share * SHARE_STEPS) as u64);
    }

    /// Removes the bar from the terminal, or says no more lines.
    pub(in crate::cli) fn finish_and_clear(&self) {
        drop(self.waiting.lock().map(|mut waiting| waiting.take()));
        self.bar.finish_and_clear();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.finish_and_clear();
    }
}

/// The time that the rest of the work takes at the mean rate so far; zero where nothing is done.
/// The bar's own estimate forgets early steps and grows to years while one step is slow.
fn time_to_go(elapsed: Duration, position: u64, length: Option<u64>) -> Duration {
    let rest = length.unwrap_or(position).saturating_sub(position);
    let seconds = elapsed.as_secs_f64() * rest as f64 / position as f64;
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}

/// Writes [`time_to_go`] of a bar, a question mark where it is not known.
fn show_time_to_go(state: &ProgressState, out: &mut dyn fmt::Write) {
    let to_go = time_to_go(state.elapsed(), state.pos(), state.len());
    let _ = match to_go {
        Duration::ZERO => write!(out, "?"),
        _ => write!(out, "{:#}", HumanDuration(to_go)),
    };
}

/// Shows a bar after a while, unless what is returned is dropped before.
fn shown_later(bar: ProgressBar) -> Sender<()> {
    let (waiting, done) = channel();
    std::thread::spawn(move || {
        if done.recv_timeout(SILENT_TIME) == Err(RecvTimeoutError::Timeout) {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            // Moves while a long step is under way.
            bar.enable_steady_tick(Duration::from_millis(200));
        }
    });
    waiting
}

/// Speaks each time that so long has passed, unless what is returned is dropped before.
fn told_every(interval: Duration, speak: impl Fn() + Send + 'static) -> Sender<()> {
    let (waiting, done) = channel();
    std::thread::spawn(move || {
        while done.recv_timeout(interval) == Err(RecvTimeoutError::Timeout) {
            speak();
        }
    });
    waiting
}

/// The line about work of which so much is done, after so long, with the time to go where it is
/// known.
fn line(done: &str, elapsed: Duration, to_go: Duration) -> String {
    let so_far = format!("so far {done} in {}", HumanDuration(elapsed));
    match to_go {
        Duration::ZERO => so_far,
        _ => format!("{so_far}, about {} to go", HumanDuration(to_go)),
    }
}

/// A progress bar of the given number of units.
pub(in crate::cli) fn bar(length: u64, unit: &'static str) -> Bar {
    let style = format!("{{bar:40}} {{pos}}/{{len}} {unit}, {{to_go}} to go");
    let done = move |bar: &ProgressBar| {
        format!("{} of {} {unit}", bar.position(), bar.length().unwrap_or_default())
    };
    Bar::new(ProgressBar::new(length), &style, done)
}

/// Steps of a bar for a share.
const SHARE_STEPS: f64 = 1000.0;

/// A bar for a share of 0 to 1.
pub(in crate::cli) fn share_bar() -> Bar {
    let done = |bar: &ProgressBar| format!("{} %", bar.position() * 100 / SHARE_STEPS as u64);
    Bar::new(ProgressBar::new(SHARE_STEPS as u64), "{bar:40} {percent} %, {to_go} to go", done)
}

/// A bar for a run of one motion, from its start to its horizon; none where its rows appear on the
/// terminal themselves.
pub(in crate::cli) fn run_bar(rows_are_seen: bool) -> Option<Bar> {
    (!rows_are_seen).then(share_bar)
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn a_line_says_how_much_is_done_and_what_is_to_go() {
        let seconds = Duration::from_secs;
        let known = line("40 of 120 rows", seconds(30), seconds(60));
        assert_eq!(known, "so far 40 of 120 rows in 30 seconds, about 60 seconds to go");
        let unknown = line("0 %", seconds(7200), Duration::ZERO);
        assert_eq!(unknown, "so far 0 % in 2 hours");
    }

    /// A slow step does not make the time to go grow without bound.
    #[test]
    fn the_time_to_go_is_that_at_the_mean_rate() {
        let seconds = Duration::from_secs;
        assert_eq!(time_to_go(seconds(1500), 30, Some(120)), seconds(4500));
        assert_eq!(time_to_go(seconds(1500), 0, Some(120)), Duration::ZERO);
        assert_eq!(time_to_go(seconds(9), 3, None), Duration::ZERO);
    }

    /// Lines come one after the other, none before its time, and none once the work is done.
    #[test]
    fn lines_come_until_the_work_is_done() {
        const INTERVAL: Duration = Duration::from_millis(20);
        let (lines, said) = channel();
        let begin = Instant::now();
        let waiting = told_every(INTERVAL, move || {
            let _ = lines.send(begin.elapsed());
        });
        for n in 1..=3 {
            let at = said.recv_timeout(Duration::from_secs(60)).expect("a line");
            assert!(at >= INTERVAL * n, "{n}: {at:?}");
        }
        drop(waiting);
        // The thread ends, and with it the sender of its lines.
        while said.recv_timeout(Duration::from_secs(60)) != Err(RecvTimeoutError::Disconnected) {}
    }

    #[test]
    fn work_that_is_done_sooner_says_nothing() {
        let (lines, said) = channel();
        drop(told_every(Duration::from_secs(3600), move || {
            let _ = lines.send(());
        }));
        let end = said.recv_timeout(Duration::from_secs(60));
        assert_eq!(end, Err(RecvTimeoutError::Disconnected));
    }
}
