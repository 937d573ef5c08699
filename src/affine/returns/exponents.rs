//! Lyapunov exponents along the returns of a motion, with what events do to small changes.
//!
//! A frame of small changes is carried along and made orthonormal again after each piece of a
//! segment that is short beside the fastest rate, and after each event, so that what decays fast is
//! not lost beside what grows. An event that makes changes of one direction vanish removes a vector
//! of the frame: the last exponent is minus infinity from there on.

use super::map::SectionMap;
use super::walk::{NoReturn, Walk};
use crate::affine::arithmetic::vector::Vector;
use crate::affine::run::place::Place;
use crate::affine::run::variation::{Variation, is_at_once};
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::dynamics::batches::{Batches, Stationarity, standard_error};

/// The most that a rate times a piece of a segment may be: a change then decays by a factor that
/// f64 has digits for.
const MAX_PIECE_DECAY_TIMES: f64 = 8.0;

/// The most pieces of a segment.
const MAX_PIECES: f64 = 10_000.0;

/// A direction of which an event leaves no larger share of the largest change is gone.
const MIN_DIRECTION_SHARE: f64 = 1e-11;

/// Lyapunov exponents of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Exponents {
    /// The exponents per return, largest first, as many as states: minus infinity for a direction
    /// that events make vanish.
    pub per_return: Vec<f64>,
    /// Their standard errors, from the scatter of the batches; NaN beside minus infinity.
    pub standard_error: Vec<f64>,
    /// The mean change per return of each of the [drifts](crate::System::drifts), in their order.
    pub drift_per_return: Vec<f64>,
    /// Their standard errors, from the same batches.
    pub drift_standard_error: Vec<f64>,
    /// The mean time of a return.
    pub mean_return_time: f64,
    /// The number of batches.
    pub batches: u64,
    /// Whether the exponents and the drifts of the batches scatter about one value each.
    pub stationarity: Stationarity,
    /// The number of choices that rounding left open.
    pub undecidable: u64,
}

impl Exponents {
    /// The exponents per unit of time: of an autonomous system one of them is 0.
    #[must_use]
    pub fn per_time(&self) -> Vec<f64> {
        self.per_return.iter().map(|it| it / self.mean_return_time).collect()
    }
}

/// The growth so far of the frame's vectors, the drifts, and the time.
struct Mark {
    growth: Vec<f64>,
    drift: Vec<f64>,
    time: f64,
}

impl SectionMap<'_, f64> {
    /// The exponents of the motion from a place over `returns` returns, at least one. Before these
    /// the frame of small changes finds its directions in `settling` returns. `seen` is told the
    /// number of returns so far.
    ///
    /// # Errors
    /// A motion that does not return as often.
    pub fn exponents(
        &self,
        place: &Place<f64>,
        settling: u64,
        returns: u64,
        seen: &mut dyn FnMut(u64),
    ) -> Result<Exponents, NoReturn> {
        let batches = Batches::new(returns);
        let mut walk = Walk::begin(self, place, false).for_many();
        let mut frame = Frame::new(self);
        let mut marks: Vec<Mark> = Vec::new();
        let (mut passed, mut drift) = (0, self.drift_of(&place.state));
        for k in 0..=batches.count() {
            while passed < settling + batches.end(k) {
                let event = walk.next_with_derivative(&mut |from, to| frame.pass(from, to))?;
                let time = event.time.value();
                passed += 1;
                if passed == settling + batches.end(k) {
                    drift = self.drift_of(&event.state);
                }
                frame.settle(&event);
                frame.time = time;
                seen(passed);
            }
            marks.push(frame.mark(place, &drift));
        }
        let undecidable = walk.undecidable();
        Ok(exponents(batches, returns.max(1), &marks, frame.columns(), undecidable))
    }
}

/// The exponents that the marks at the ends of all batches have, with so many vectors left.
fn exponents(
    batches: Batches,
    returns: u64,
    marks: &[Mark],
    left: usize,
    undecidable: u64,
) -> Exponents {
    let states = marks.first().map_or(0, |it| it.growth.len());
    let mean = |n: usize| batches.means(marks, |a, b| b.growth[n] - a.growth[n]);
    let mut means: Vec<Vec<f64>> = (0..left).map(mean).collect();
    let ends = [marks.first(), marks.last()];
    let [Some(first), Some(last)] = ends else {
        return Exponents {
            per_return: Vec::new(),
            standard_error: Vec::new(),
            drift_per_return: Vec::new(),
            drift_standard_error: Vec::new(),
            mean_return_time: f64::NAN,
            batches: 0,
            stationarity: Stationarity::Unknown,
            undecidable,
        };
    };
    let whole = |n: usize| (last.growth[n] - first.growth[n]) / returns as f64;
    let mut all: Vec<(f64, f64)> =
        (0..left).map(|n| (whole(n), standard_error(&means[n]))).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.resize(states, (f64::NEG_INFINITY, f64::NAN));
    let drifts = 0..first.drift.len();
    let mean = |n: usize| batches.means(marks, |a, b| b.drift[n] - a.drift[n]);
    let drift_means: Vec<Vec<f64>> = drifts.clone().map(mean).collect();
    let whole = |n: usize| (last.drift[n] - first.drift[n]) / returns as f64;
    let drift_per_return = drifts.map(whole).collect();
    let drift_standard_error = drift_means.iter().map(|it| standard_error(it)).collect();
    means.extend(drift_means);
    Exponents {
        per_return: all.iter().map(|it| it.0).collect(),
        standard_error: all.iter().map(|it| it.1).collect(),
        drift_per_return,
        drift_standard_error,
        mean_return_time: (last.time - first.time) / returns as f64,
        batches: batches.count(),
        stationarity: batches.stationarity(&means),
        undecidable,
    }
}

/// Small changes that are carried along, orthonormal in their units, with the logarithms of their
/// growth.
struct Frame<'a> {
    solver: &'a Solver<f64>,
    units: &'a [f64],
    variation: Variation<f64>,
    growth: Vec<f64>,
    time: f64,
}

impl<'a> Frame<'a> {
    fn new(map: &'a SectionMap<'_, f64>) -> Self {
        let solver = map.solver();
        let mut variation = Variation::of_each_state(solver);
        for (column, unit) in variation.columns.iter_mut().zip(map.units()) {
            column.iter_mut().for_each(|it| *it *= unit);
        }
        let growth = vec![0.0; solver.system().states.len()];
        Self { solver, units: map.units(), variation, growth, time: f64::NAN }
    }

    fn columns(&self) -> usize {
        self.variation.columns.len()
    }

    fn mark(&self, start: &Place<f64>, drift: &[f64]) -> Mark {
        let time = if self.time.is_nan() { start.time.value() } else { self.time };
        Mark { growth: self.growth.clone(), drift: drift.to_vec(), time }
    }

    /// Carries the frame from one event to the next one.
    fn pass(&mut self, from: &Event<f64>, to: &Event<f64>) {
        if is_at_once(from, to) {
            return self.variation.reset_at_once(self.solver, from, to);
        }
        if matches!(to.what, What::Limit(..)) {
            return self.variation.pass(self.solver, from, to);
        }
        let state = self.solver.complete(&from.state, &from.time);
        self.settle_at(from, &state);
        let elapsed = to.time.since(&from.time).value();
        let flow = &self.solver.modes[from.mode].flow;
        let pieces =
            libm::ceil(flow.speed * elapsed / MAX_PIECE_DECAY_TIMES).clamp(1.0, MAX_PIECES);
        let motion = flow.propagator(elapsed / pieces);
        for _ in 0..pieces as usize {
            self.variation.flow(&motion);
            self.renew(0.0);
        }
        let before = || (0..pieces as usize).fold(state, |it, _| motion.after(&it));
        self.variation.arrive(self.solver, to, before);
    }

    /// Takes the frame to the fixed time of an event, without what the event has made vanish.
    fn settle(&mut self, at: &Event<f64>) {
        if self.variation.delays.is_some() {
            self.settle_at(at, &self.solver.complete(&at.state, &at.time));
        }
    }

    /// Takes the frame to the fixed time of an event, whose state z is given.
    fn settle_at(&mut self, at: &Event<f64>, z: &Vector<f64>) {
        if self.variation.delays.is_some() {
            self.variation.settle_at(self.solver, at, z);
            self.renew(MIN_DIRECTION_SHARE);
        }
    }

    /// Makes the frame orthonormal, and counts the growth of its vectors.
    fn renew(&mut self, gone: f64) {
        let mut columns = std::mem::take(&mut self.variation.columns);
        for column in &mut columns {
            column.iter_mut().zip(self.units).for_each(|(it, unit)| *it /= unit);
        }
        let largest = columns.iter().map(length).fold(0.0, f64::max);
        let mut kept: Vec<Vector<f64>> = Vec::with_capacity(columns.len());
        for mut column in columns {
            // Once more, because the first time leaves the roundings of what it takes away.
            for _ in 0..2 {
                for other in &kept {
                    let share: f64 = column.iter().zip(other).map(|(a, b)| a * b).sum();
                    column.iter_mut().zip(other).for_each(|(it, by)| *it -= share * by);
                }
            }
            let length = length(&column);
            if length <= gone * largest || length == 0.0 {
                continue;
            }
            self.growth[kept.len()] += libm::log(length);
            kept.push(column.map(|it| it / length));
        }
        for column in &mut kept {
            column.iter_mut().zip(self.units).for_each(|(it, unit)| *it *= unit);
        }
        self.variation.columns = kept;
    }
}

fn length(column: &Vector<f64>) -> f64 {
    column.iter().map(|it| it * it).sum::<f64>().sqrt()
}
