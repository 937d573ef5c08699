//! Long work: its length, its threads and its progress.

use super::parse::MAX_PERIODS;
use super::terminal::is_quiet;
use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
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
const PATIENCE: Duration = Duration::from_secs(2);

/// Progress on stderr with the time to go: of work that takes long, where stderr is a terminal and
/// `--quiet` was not given.
pub(in crate::cli) struct Bar {
    bar: ProgressBar,
    /// Ends the wait for [`PATIENCE`].
    waiting: Mutex<Option<Sender<()>>>,
}

impl Bar {
    fn new(bar: ProgressBar, style: &str) -> Self {
        let bar = match ProgressStyle::with_template(style) {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        };
        bar.set_draw_target(ProgressDrawTarget::hidden());
        let wanted = io::stderr().is_terminal() && !is_quiet();
        let waiting = Mutex::new(wanted.then(|| shown_later(bar.clone())));
        Self { bar, waiting }
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
        self.bar.set_position((share * SHARES) as u64);
    }

    /// Removes the bar from the terminal.
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

/// Shows a bar after a while, unless what is returned is dropped before.
fn shown_later(bar: ProgressBar) -> Sender<()> {
    let (waiting, done) = channel();
    std::thread::spawn(move || {
        if done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            // Moves while a long step is under way.
            bar.enable_steady_tick(Duration::from_millis(200));
        }
    });
    waiting
}

/// A progress bar of the given number of units.
pub(in crate::cli) fn bar(length: u64, unit: &str) -> Bar {
    let style = format!("{{bar:40}} {{pos}}/{{len}} {unit}, {{eta}} to go");
    Bar::new(ProgressBar::new(length), &style)
}

/// Steps of a bar for a share.
const SHARES: f64 = 1000.0;

/// A bar for a share of 0 to 1.
pub(in crate::cli) fn share_bar() -> Bar {
    Bar::new(ProgressBar::new(SHARES as u64), "{bar:40} {percent} %, {eta} to go")
}

/// A bar for a run of one motion, from its start to its horizon; none where its rows appear on the
/// terminal themselves.
pub(in crate::cli) fn run_bar(rows_are_seen: bool) -> Option<Bar> {
    (!rows_are_seen).then(share_bar)
}
