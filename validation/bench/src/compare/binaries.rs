//! Two binaries against each other: both alive, in short batches, turn by turn.
//!
//! In one round the sides go old, new, new, old, so that a machine that slows down or speeds up
//! meanwhile favours neither; a round's quotient is that of the best batches. Where code, stack and
//! heap of a process come to lie makes it a percent faster or slower for all its life: so both are
//! started anew several times, and the quotient is the median over the rounds of all of them.

use super::process::Worker;
use crate::engine::Failure;
use crate::score::Spread;
use std::path::Path;

/// The two sides and how much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    /// The old binary.
    pub old: &'a Path,
    /// The new one.
    pub new: &'a Path,
    /// Work that the new side does and is not credited with, as a share: a slowdown put in on
    /// purpose.
    pub burden: f64,
}

/// The number of times that both workers are started anew.
pub const RESTARTS: u32 = 20;
/// The rounds between two restarts.
const ROUNDS_PER_RESTART: u32 = 8;
/// The batches of one turn.
const BATCHES_PER_TURN: u32 = 4;
/// The length of a batch, in ns: short enough to lie between two interruptions, long enough that a
/// clock that ticks in tens of nanoseconds tells a thousandth.
const BATCH_NS: f64 = 3e5;

/// The quotient of a workload.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeQuotient {
    /// The workload.
    pub bench: String,
    /// The time of the new side over that of the old one.
    pub value: f64,
    /// The spread of the medians of the worker processes.
    pub spread: f64,
}

/// The workloads that both have, or those of `only` among them.
///
/// # Errors
/// [`Failure`] of a binary that is no worker.
pub fn common(pair: &Pair<'_>) -> Result<Common, Failure> {
    let (mut old, mut new) = (Worker::start(pair.old)?, Worker::start(pair.new)?);
    let (before, after) = (old.names()?, new.names()?);
    let (shared, lost) = before.into_iter().partition(|it| after.contains(it));
    Ok(Common { shared, lost, versions: [old.version.clone(), new.version.clone()] })
}

/// The workloads that two binaries have in common.
#[derive(Clone, Debug)]
pub struct Common {
    /// Workloads of both.
    pub shared: Vec<String>,
    /// Workloads that the new one no longer has.
    pub lost: Vec<String>,
    /// Version and commit of each.
    pub versions: [String; 2],
}

/// Measures the quotients of these workloads.
///
/// # Errors
/// [`Failure`] of a binary that stops answering.
pub fn quotients(
    pair: &Pair<'_>,
    benches: &[String],
    done: &dyn Fn(),
) -> Result<Vec<TimeQuotient>, Failure> {
    let mut rounds: Vec<Vec<f64>> = vec![Vec::new(); benches.len()];
    let mut lives: Vec<Vec<f64>> = rounds.clone();
    for life in 0..RESTARTS {
        let mut sides = both(pair, life)?;
        for (i, bench) in benches.iter().enumerate() {
            let own = sides.rounds(bench, pair.burden)?;
            lives[i].push(Spread::new(own.clone()).median);
            rounds[i].extend(own);
            done();
        }
    }
    let quotient = |(i, bench): (usize, &String)| {
        let least = lives[i].iter().copied().fold(f64::INFINITY, f64::min);
        let most = lives[i].iter().copied().fold(0.0, f64::max);
        TimeQuotient {
            bench: bench.clone(),
            value: Spread::new(rounds[i].clone()).median,
            spread: most - least,
        }
    };
    Ok(benches.iter().enumerate().map(quotient).collect())
}

/// The running processes of both sides.
struct Processes {
    old: Worker,
    new: Worker,
}

/// The side that starts first may find the better place: they take turns in that too.
fn both(pair: &Pair<'_>, life: u32) -> Result<Processes, Failure> {
    if life.is_multiple_of(2) {
        let old = Worker::start(pair.old)?;
        Ok(Processes { old, new: Worker::start(pair.new)? })
    } else {
        let new = Worker::start(pair.new)?;
        Ok(Processes { old: Worker::start(pair.old)?, new })
    }
}

impl Processes {
    /// The quotients of one life's rounds.
    fn rounds(&mut self, bench: &str, burden: f64) -> Result<Vec<f64>, Failure> {
        let units = self.filling(bench)?;
        let burdened = (units as f64 * (1.0 + burden)).round() as u64;
        let mut quotients = Vec::new();
        for _ in 0..ROUNDS_PER_RESTART {
            let first = self.old.best(bench, units, BATCHES_PER_TURN)?;
            let second = self.new.best(bench, burdened, BATCHES_PER_TURN)?;
            let third = self.new.best(bench, burdened, BATCHES_PER_TURN)?;
            let fourth = self.old.best(bench, units, BATCHES_PER_TURN)?;
            quotients.push(second.min(third) / first.min(fourth));
        }
        Ok(quotients)
    }

    /// Units that fill a batch of the old side.
    fn filling(&mut self, bench: &str) -> Result<u64, Failure> {
        const TRIAL_UNITS: u64 = 500;
        const MAX_UNITS: f64 = 1e7;
        let time = self.old.best(bench, TRIAL_UNITS, BATCHES_PER_TURN)?;
        Ok((TRIAL_UNITS as f64 * BATCH_NS / time).clamp(100.0, MAX_UNITS) as u64)
    }
}
