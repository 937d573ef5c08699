//! The least cost of one evaluation of a closed form: its sine, cosine and exponential.
//!
//! An event needs one evaluation: the state at the root. The evaluation is timed in the same rounds
//! as the workloads, for its dependent-chain latency (each evaluation needs the result of the one
//! before, as in one run) and with independent evaluations (as in many runs side by side).

use super::rounds::{Benchmark, Plain, RoundPace, RoundTimes, time_interleaved};
use super::workload::{Repeated, Workload};
use crate::engine::Failure;
use std::hint::black_box;

/// Units of work per call.
const UNITS: u64 = 2000;

/// Many short batches: no other benchmark runs so briefly.
const PACE: RoundPace = RoundPace { batch: 0.5e6, batches: 5 };

/// The least cost of an evaluation, and the cost of an event in the same rounds.
#[derive(Clone, Debug)]
pub struct Floors {
    /// Dependent-chain latency, ns: each evaluation waits for the result of the one before.
    pub chained: RoundTimes,
    /// Reciprocal throughput, ns: no evaluation waits for another.
    pub independent: RoundTimes,
    /// The cost of each workload, in the order in which the workloads were given.
    pub events: Vec<Result<Cost, Failure>>,
}

/// The cost of one workload.
#[derive(Clone, Debug)]
pub struct Cost {
    /// The workload's name.
    pub name: String,
    /// Closed-form evaluations per unit of work.
    pub evaluations: f64,
    /// The best time of each round, ns per unit of work.
    pub series: RoundTimes,
}

/// Evaluates one sine-cosine pair and one exponential of libm. This is kept as a fixed reference
/// for all versions, although the solver now uses its own tables.
#[must_use]
pub fn transcendental(angle: f64) -> f64 {
    let (sin, cos) = libm::sincos(angle);
    1.0 + 0.5 * sin * libm::exp(-cos.abs())
}

/// Times the floor and the workloads in interleaved rounds.
///
/// # Errors
/// Never for a floor that can be computed.
pub fn floors(
    workloads: &[Box<dyn Workload + '_>],
    rounds: usize,
    done: &dyn Fn(),
) -> Result<Floors, Failure> {
    let angles: Vec<f64> = (0..UNITS).map(|k| 1.0 + 1e-3 * k as f64).collect();
    let mut chained = Plain(|| {
        let last = (0..UNITS).fold(black_box(0.3), |angle, _| transcendental(angle));
        black_box(last);
    });
    let mut independent = Plain(|| {
        let sum: f64 = black_box(&angles).iter().map(|angle| transcendental(*angle)).sum();
        black_box(sum);
    });
    let mut repeated: Vec<_> =
        workloads.iter().map(|it| Repeated { workload: it.as_ref(), units: UNITS }).collect();
    let mut benchmarks: Vec<&mut dyn Benchmark> = vec![&mut chained, &mut independent];
    benchmarks.extend(repeated.iter_mut().map(|it| it as &mut dyn Benchmark));
    let per_unit =
        |series: RoundTimes| RoundTimes(series.0.iter().map(|it| it / UNITS as f64).collect());
    let mut times = time_interleaved(&mut benchmarks, rounds, PACE, done).into_iter();
    let mut next = || times.next().unwrap_or_else(|| Err(Failure::new("not timed"))).map(per_unit);
    let (chained, independent) = (next()?, next()?);
    let mut cost = |workload: &dyn Workload| {
        let series = next()?;
        let evaluations = workload.run(UNITS)? as f64 / UNITS as f64;
        Ok(Cost { name: workload.name(), evaluations, series })
    };
    Ok(Floors {
        chained,
        independent,
        events: workloads.iter().map(|it| cost(it.as_ref())).collect(),
    })
}

/// The number of progress steps of [`floors`].
#[must_use]
pub fn size(workloads: usize, rounds: usize) -> u64 {
    ((workloads + 2) * rounds) as u64
}
