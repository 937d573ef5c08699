//! Interleaved rounds: every benchmark in short batches in every round, the best batch of each
//! counts.
//!
//! Times of two separate runs cannot be compared on a machine that does other things as well: its
//! frequency, its caches and its neighbours change meanwhile. Within one round they change little;
//! what is left is removed by the best of several batches, by turning the order round every round,
//! and by the median over the rounds.

use super::clock::Stopwatch;
use crate::engine::Failure;
use crate::score::Spread;

/// A piece of work that can be called, timed and checked.
pub trait Benchmark {
    /// Does the work once. Only this call is timed.
    ///
    /// # Errors
    /// Why the work could not be done.
    fn call(&mut self) -> Result<(), Failure>;

    /// Whether the last call's answer was right. Not timed.
    ///
    /// # Errors
    /// What is wrong with the answer.
    fn check(&mut self) -> Result<(), Failure> {
        Ok(())
    }

    /// The largest number of rounds in which the benchmark takes part.
    fn rounds(&self) -> usize {
        usize::MAX
    }
}

/// A benchmark whose answer needs no check.
pub struct Plain<F>(pub F);

impl<F: FnMut()> Benchmark for Plain<F> {
    fn call(&mut self) -> Result<(), Failure> {
        (self.0)();
        Ok(())
    }
}

/// The length and the number of the batches of a round.
#[derive(Clone, Copy, Debug)]
pub struct RoundPace {
    /// The least time of a batch, ns: calls are repeated until they fill it.
    pub batch: f64,
    /// Batches per round; one where a single call fills several.
    pub batches: u32,
}

/// Half a millisecond is five hundred times what reading the clock costs, and short enough to lie
/// between two interruptions.
pub const PACE: RoundPace = RoundPace { batch: 0.5e6, batches: 3 };

/// The best time of a call in each round, ns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoundTimes(pub Vec<f64>);

impl RoundTimes {
    /// The median over the rounds.
    #[must_use]
    pub fn median(&self) -> f64 {
        Spread::new(self.0.clone()).median
    }

    /// The least of all rounds.
    #[must_use]
    pub fn best(&self) -> f64 {
        self.0.iter().copied().fold(f64::NAN, f64::min)
    }

    /// The median over the rounds of the quotient of the two times in one round.
    #[must_use]
    pub fn ratio_to(&self, other: &Self) -> f64 {
        Spread::new(self.quotients(other)).median
    }

    /// Half the distance between the least and the largest of these quotients.
    #[must_use]
    pub fn ratio_spread(&self, other: &Self) -> f64 {
        let quotients = self.quotients(other);
        let [least, most] =
            [f64::min, f64::max].map(|pick| quotients.iter().copied().fold(f64::NAN, pick));
        0.5 * (most - least)
    }

    fn quotients(&self, other: &Self) -> Vec<f64> {
        self.0.iter().zip(&other.0).map(|(own, other)| own / other).collect()
    }
}

/// Times all benchmarks in interleaved rounds. A benchmark that fails, or whose answer is wrong in
/// any batch, has no times.
pub fn time_interleaved(
    benchmarks: &mut [&mut dyn Benchmark],
    rounds: usize,
    pace: RoundPace,
    done: &dyn Fn(),
) -> Vec<Result<RoundTimes, Failure>> {
    let mut results: Vec<Result<RoundTimes, Failure>> =
        benchmarks.iter().map(|_| Ok(RoundTimes::default())).collect();
    let mut calls: Vec<u32> = vec![0; benchmarks.len()];
    for round in 0..rounds {
        let order: Vec<usize> = match round % 2 {
            0 => (0..benchmarks.len()).collect(),
            _ => (0..benchmarks.len()).rev().collect(),
        };
        for i in order {
            if let Ok(series) = &mut results[i]
                && round < benchmarks[i].rounds()
                && !has_enough_rounds(series, round)
            {
                let best = best_of(benchmarks[i], &mut calls[i], pace);
                match best {
                    Ok(best) => series.0.push(best),
                    Err(failure) => results[i] = Err(failure),
                }
            }
            done();
        }
    }
    results
}

/// Whether a benchmark is left out of a round: a call that is so long meets the quiet and the busy
/// moments of a machine alike, and three rounds tell as much as ten.
fn has_enough_rounds(series: &RoundTimes, round: usize) -> bool {
    const LONG_BATCH_NS: f64 = 5e7;
    const LONG_BATCH_ROUNDS: usize = 3;
    round >= LONG_BATCH_ROUNDS && series.best() > LONG_BATCH_NS
}

/// The best batch of a round, ns per call. `calls` is the number of calls that fill a batch, found
/// in the first round.
fn best_of(
    benchmark: &mut dyn Benchmark,
    calls: &mut u32,
    pace: RoundPace,
) -> Result<f64, Failure> {
    if *calls == 0 {
        *calls = filling(benchmark, pace.batch)?;
    }
    let mut best = f64::INFINITY;
    for _ in 0..pace.batches {
        let time = batch(benchmark, *calls)?;
        benchmark.check()?;
        best = best.min(time);
        if time > f64::from(pace.batches) * 4.0 * pace.batch {
            break;
        }
    }
    Ok(best / f64::from(*calls))
}

/// The number of calls that fill a batch.
fn filling(benchmark: &mut dyn Benchmark, least: f64) -> Result<u32, Failure> {
    const MAX_CALLS: u32 = 1 << 20;
    let mut calls = 1;
    while calls < MAX_CALLS && batch(benchmark, calls)? < least {
        calls *= 2;
    }
    Ok(calls)
}

fn batch(benchmark: &mut dyn Benchmark, calls: u32) -> Result<f64, Failure> {
    let watch = Stopwatch::start();
    for _ in 0..calls {
        benchmark.call()?;
    }
    Ok(watch.nanoseconds())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_is_the_median_of_the_rounds_quotients() {
        // The machine was twice as slow in the second round and disturbed one benchmark in the
        // fourth.
        let exact = RoundTimes(vec![1.0, 2.0, 1.0, 1.0, 1.0]);
        let engine = RoundTimes(vec![300.0, 600.0, 310.0, 900.0, 290.0]);
        assert_eq!(engine.ratio_to(&exact), 300.0);
        assert_eq!(exact.ratio_to(&exact), 1.0);
        assert_eq!(engine.ratio_spread(&exact), 305.0);
        assert_eq!(engine.best(), 290.0);
        assert_eq!(engine.median(), 310.0);
        // Neither the quotient of medians nor of least times.
        let drifting = RoundTimes(vec![4.0, 1.0, 9.0]);
        assert_eq!(drifting.ratio_to(&RoundTimes(vec![2.0, 1.0, 3.0])), 2.0);
    }

    /// A benchmark whose answer is right until its `last` check.
    struct FaultyBenchmark {
        checks: u32,
        last: u32,
    }

    impl Benchmark for FaultyBenchmark {
        fn call(&mut self) -> Result<(), Failure> {
            Ok(())
        }

        fn check(&mut self) -> Result<(), Failure> {
            self.checks += 1;
            if self.checks < self.last { Ok(()) } else { Err(Failure::new("wrong")) }
        }
    }

    #[test]
    fn a_benchmark_that_answers_wrongly_in_any_batch_has_no_times() {
        let pace = RoundPace { batch: 1e4, batches: 2 };
        let (mut right, mut late) =
            (FaultyBenchmark { checks: 0, last: u32::MAX }, FaultyBenchmark { checks: 0, last: 3 });
        let results = time_interleaved(&mut [&mut right, &mut late], 4, pace, &|| ());
        assert!(results[0].as_ref().is_ok_and(|series| series.0.len() == 4), "{results:?}");
        assert_eq!(results[1], Err(Failure::new("wrong")));
        assert!(right.checks >= 4 && late.checks == 3);
    }
}
