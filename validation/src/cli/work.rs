//! Long work: its length, its threads and its progress.

use super::parse::MAX_PERIODS;
use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A run of both together has an accepted length.
pub(super) fn check_horizon(transient: u64, periods: u64) -> Result<()> {
    let whole = transient.saturating_add(periods);
    if whole > MAX_PERIODS {
        bail!(
            "--transient and --periods make {whole} forcing periods: accepted are at most {MAX_PERIODS}"
        );
    }
    Ok(())
}

/// As many threads as were asked for; all where none were.
pub(super) fn pool(threads: Option<u16>) -> Result<rayon::ThreadPool> {
    let threads = usize::from(threads.unwrap_or(0));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.context("--threads: the threads cannot be started")
}

/// A bar on stderr; nothing where that is no terminal.
pub(super) fn bar(length: u64, unit: &str) -> ProgressBar {
    let style = format!("{{bar:40}} {{pos}}/{{len}} {unit}, {{eta}} to go");
    styled(ProgressBar::new(length), &style)
}

/// A bar for a share of 0 to 1.
pub(super) fn share_bar() -> ProgressBar {
    styled(ProgressBar::new(1000), "{bar:40} {percent} %, {eta} to go")
}

/// Where that bar stands.
pub(super) fn show_share(bar: &ProgressBar, share: f64) {
    bar.set_position((share * 1000.0) as u64);
}

/// A sign of life for work that does not tell how far it is.
pub(super) fn sign_of_life(what: &str) -> ProgressBar {
    styled(ProgressBar::new_spinner(), &format!("{{spinner}} {what}, {{elapsed}}"))
}

fn styled(bar: ProgressBar, style: &str) -> ProgressBar {
    // Moves while a long step is under way.
    bar.enable_steady_tick(Duration::from_millis(200));
    match ProgressStyle::with_template(style) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
