//! The cost of a run against its length: the time is proportional to the length, the memory
//! constant.
//!
//! A chaotic run of a million periods has no truth to be held to. A stable orbit has: after any
//! multiple of its period the motion is where it began. So every length that is timed is checked
//! too.

use super::clock::Stopwatch;
use crate::engine::Failure;
use crate::number::brief;
use percuss::dynamics::orbit::Orbit;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Entry, Model, Parameters, Start, Step};

/// Lengths in forcing periods, multiples of the orbit's five.
const LENGTHS: [u64; 6] = [10, 100, 1_000, 10_000, 100_000, 1_000_000];
/// Lengths that are timed only when long runs are asked for.
const LONG_LENGTHS: [u64; 2] = [10_000_000, 100_000_000];
/// Each length is run until it has taken this long, ns, and once at least.
const MIN_TIME_NS: f64 = 2e7;
/// Rounding a period, damped by the orbit's multipliers, adds up to no more than this.
const CLOSURE_TOLERANCE: f64 = 1e-12;

/// The time and the error of a run of one length.
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
#[allow(missing_docs, reason = "the keys of bench.json, explained in its schema")]
pub struct Length {
    pub periods: u64,
    pub ns_per_period: f64,
    /// max(|dp|, |dy|, |dq|) at the end.
    pub state_error_max: f64,
    /// The most memory that the process has held so far, where the system tells.
    pub peak_bytes: Option<u64>,
}

/// Times the lengths, up to 1e6 periods or, if asked, 1e8.
///
/// # Errors
/// [`Failure`] where a run does not come back to the orbit.
pub fn lengths(long: bool, done: &dyn Fn()) -> Result<Vec<Length>, Failure> {
    let (model, start) = orbit()?;
    let length = |periods: u64| {
        let found = length(&model, &start, periods);
        done();
        found
    };
    LENGTHS.into_iter().chain(LONG_LENGTHS.into_iter().filter(|_| long)).map(length).collect()
}

/// The number of progress steps of the measurement.
#[must_use]
pub fn size(long: bool) -> u64 {
    (LENGTHS.len() + if long { LONG_LENGTHS.len() } else { 0 }) as u64
}

/// The orbit of period five at omega = 1.6, xi = 0.1 (Fig. 7e), by Newton's method.
fn orbit() -> Result<(Model, Entry), Failure> {
    let parameters = Parameters { omega: 1.6, xi: 0.1, ..Parameters::default() };
    let model = Model::new(parameters).map_err(Failure::new)?;
    let rest = model.start(&Start::default()).map_err(Failure::new)?;
    let map = StrobeMap::new(model, rest.instant);
    let found = Orbit::find(&map, [-0.465663, 0.064662, 1e-6], 5).map_err(Failure::new)?;
    if found.period() != 5 || !found.is_stable() {
        return Err(Failure::new("the orbit of period five is not where it was"));
    }
    Ok((model, map.entry(found.points[0]).map_err(Failure::new)?))
}

fn length(model: &Model, start: &Entry, periods: u64) -> Result<Length, Failure> {
    let [mut least, mut whole] = [f64::INFINITY, 0.0];
    let mut error = f64::NAN;
    while whole < MIN_TIME_NS {
        let watch = Stopwatch::start();
        let end = end(model, start, periods);
        let time = watch.nanoseconds();
        whole += time.max(1.0);
        least = least.min(time);
        error = distance(&end?.point(), &start.point());
    }
    if error <= CLOSURE_TOLERANCE {
        let ns_per_period = least / periods as f64;
        Ok(Length { periods, ns_per_period, state_error_max: error, peak_bytes: peak_bytes() })
    } else {
        let error = brief(error);
        Err(Failure::new(format!(
            "off by {error} after {periods} periods, accepted is {CLOSURE_TOLERANCE}"
        )))
    }
}

/// The state at which a run of this many forcing periods ends.
fn end(model: &Model, start: &Entry, periods: u64) -> Result<Entry, Failure> {
    let horizon = start.instant.after_periods(periods, 1);
    let mut run = model.trajectory(*start).until(horizon);
    while let Some(step) = run.step() {
        if let Step::Last(segment) = step {
            return Ok(segment.entry_at(&horizon));
        }
    }
    Err(Failure::new("a run without end"))
}

fn distance(one: &[f64; 3], other: &[f64; 3]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// The largest resident set so far.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}
