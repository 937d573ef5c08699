//! Grazes of a true run: how close each guard comes to its threshold, and how far it goes beyond.
//!
//! A guard that turns just short of its threshold, or just beyond it, is a graze. An engine whose
//! allowed error at that instant is larger than the margin may find the events of such a graze or
//! not: either answer is right. The margin is read off the closed form of the phase in which the
//! guard is watched, continued past the event where there is one.

use super::growth::RunGrowth;
use crate::engine::{Equations, OscillatorTask};
use crate::integration::{GUARDS, Oscillator};
use crate::integrators::Closed;
use crate::score::graze::Graze;
use crate::engine::place;
use crate::truth::{Truth, TruthRow};
use percuss::{Parameters, Phase};
use std::f64::consts::PI;

/// Margins above this, in units of displacement or of force, are no grazes.
const WIDEST: f64 = 1e-2;
/// Instants at which a guard's rate is looked at, in one period of the forcing or of the contact.
const LOOKS: f64 = 128.0;
/// A guard this close to its threshold at a phase's entry began on it.
const ON_THRESHOLD: f64 = 1e-13;
/// Halvings of a bracket, after which an extremum is known to rounding.
const HALVINGS: u32 = 60;

/// The grazes of a true run, in the order of time.
#[must_use]
pub fn grazes(task: &OscillatorTask, truth: &Truth, growth: &RunGrowth) -> Vec<Graze> {
    let scan = Scan { task, truth, growth };
    let ends = truth.events.iter().chain([&truth.end]);
    let begins = std::iter::once(&truth.start).chain(&truth.events);
    begins.zip(ends).enumerate().flat_map(|(n, (begin, end))| scan.segment(n, begin, end)).collect()
}

struct Scan<'a> {
    task: &'a OscillatorTask,
    truth: &'a Truth,
    growth: &'a RunGrowth,
}

/// The closed form of one segment with its guards.
struct ScannedSegment {
    phase: Phase,
    began: f64,
    oscillator: Oscillator,
    closed: Closed,
}

impl ScannedSegment {
    fn guards(&self, d: f64) -> [f64; GUARDS] {
        self.oscillator.guards(place(self.phase), self.began + d, &self.closed.at(d))
    }

    fn rates(&self, d: f64) -> [f64; GUARDS] {
        self.oscillator.rates(place(self.phase), self.began + d, &self.closed.at(d))
    }

    /// The first maximum of a guard between two times, if its rate changes sign from above.
    fn maximum(&self, guard: usize, (from, to): (f64, f64), step: f64) -> Option<f64> {
        let count = ((to - from) / step).ceil().max(1.0) as usize;
        let at = |k: usize| from + (to - from) * k as f64 / count as f64;
        let mut rate = self.rates(from)[guard];
        for k in 1..=count {
            let next = self.rates(at(k))[guard];
            if rate > 0.0 && next <= 0.0 {
                return Some(self.turn(guard, (at(k - 1), at(k))));
            }
            rate = next;
        }
        None
    }

    /// The instant at which a rate that is positive at the left vanishes.
    fn turn(&self, guard: usize, (mut left, mut right): (f64, f64)) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (left + right);
            if self.rates(middle)[guard] > 0.0 { left = middle } else { right = middle }
        }
        0.5 * (left + right)
    }
}

impl Scan<'_> {
    /// The grazes of the segment after `n` events.
    fn segment(&self, n: usize, begin: &TruthRow, end: &TruthRow) -> Vec<Graze> {
        let Some(phase) = begin.phase else { return Vec::new() };
        let began = begin.elapsed.value();
        let length = end.elapsed.minus(begin.elapsed).value();
        let parameters = &self.task.parameters;
        let angle = self.task.forcing_angle + parameters.omega * began;
        let segment = ScannedSegment {
            phase,
            began,
            oscillator: Oscillator::of(parameters, self.task.forcing_angle),
            closed: Closed::new(parameters, phase, begin.rounded(), angle, false),
        };
        let mut found: Vec<Graze> =
            (0..GUARDS).flat_map(|guard| self.near_misses(n, &segment, guard, length)).collect();
        if end.phase.is_some() {
            found.extend(self.crossing(n, &segment, length));
        }
        found.sort_by(|a, b| a.elapsed.total_cmp(&b.elapsed));
        found
    }

    fn step(&self) -> f64 {
        self.task.problem.model.period().min(2.0 * PI) / LOOKS
    }

    /// Every maximum of a guard inside a segment that stays short of the threshold by little.
    fn near_misses(
        &self,
        n: usize,
        segment: &ScannedSegment,
        guard: usize,
        length: f64,
    ) -> Vec<Graze> {
        let step = self.step().min(length / 4.0);
        // A phase that begins on a threshold leaves it; the double zero there is no near miss.
        let on_threshold = segment.guards(0.0)[guard].abs() <= ON_THRESHOLD;
        let mut from = if on_threshold { step } else { 0.0 };
        let mut found = Vec::new();
        while let Some(at) = segment.maximum(guard, (from, length), step) {
            let margin = segment.guards(at)[guard];
            if (-WIDEST..0.0).contains(&margin) {
                found.push(self.graze(n, segment, (guard, at), Vec::new()));
            }
            from = at + step;
            if from >= length {
                break;
            }
        }
        found
    }

    /// The crossing that ends a segment, where the guard would have turned soon after it.
    fn crossing(&self, n: usize, segment: &ScannedSegment, length: f64) -> Option<Graze> {
        let guards = segment.guards(length);
        let guard = usize::from(guards[1] > guards[0]);
        let beyond = length + self.task.problem.model.period();
        let at = segment.maximum(guard, (length, beyond), self.step())?;
        let returns = self.truth.events.get(n + 1).is_some_and(|next| {
            let soon = next.elapsed.value() - segment.began - length <= 4.0 * (at - length);
            next.phase == Some(segment.phase) && soon
        });
        let events = if returns { vec![n, n + 1] } else { vec![n] };
        let found = self.graze(n, segment, (guard, at), events);
        (found.margin <= WIDEST).then_some(found)
    }

    fn graze(
        &self,
        n: usize,
        segment: &ScannedSegment,
        (guard, at): (usize, f64),
        events: Vec<usize>,
    ) -> Graze {
        let elapsed = segment.began + at;
        let growth = self.guard_growth(segment.phase, &segment.closed.at(at), elapsed);
        Graze {
            elapsed,
            margin: segment.guards(at)[guard],
            growth: growth * n.max(1) as f64,
            events,
            mode: place(segment.phase),
            event: None,
            ends: true,
            makes: 2,
        }
    }

    /// What one unit of error in p, y or q may have become in a guard, by the growth at the sample
    /// before the graze: the largest of the three contributions.
    fn guard_growth(&self, phase: Phase, state: &[f64; 4], elapsed: f64) -> f64 {
        let samples = f64::from(Truth::SAMPLES_PER_PERIOD);
        let k = (elapsed / self.task.problem.model.period() * samples) as usize;
        let last = self.growth.samples.len().saturating_sub(1);
        let growth = self.growth.samples.get(k.min(last)).copied().unwrap_or([1.0; 4]);
        let gradient = gradient(phase, &self.task.parameters);
        let part = |i: usize| gradient[i].abs() * (1.0 + state[i].abs()) * growth[i];
        (0..3).map(part).fold(0.0, f64::max)
    }
}

/// The gradient of a guard with respect to p, y and q, but for its sign.
fn gradient(phase: Phase, parameters: &Parameters) -> [f64; 3] {
    match phase {
        Phase::NoContact => [1.0, 0.0, 1.0],
        Phase::Contact | Phase::Progression => [0.0, 2.0 * parameters.xi, 1.0],
    }
}

#[cfg(test)]
#[path = "grazes_tests.rs"]
mod tests;
