//! Grazes of a system's true run: extrema of guards close to zero, where an engine whose allowed
//! error is larger than the margin may find the events of a crossing or not.

use super::event_names::EventNames;
use super::graze::Graze;
use super::rule::ErrorRule;
use crate::system::{Direction, System, SystemProblem};
use crate::truth::{Truth, TruthRow};
use percuss::affine::{Event, Time, What};

/// Margins above this part of a guard's size are no grazes.
const MAX_MARGIN_SHARE: f64 = 1e-2;
/// Instants at which a guard's rate is looked at, in one period of the forcing or of the system's
/// fastest oscillation.
const EVALUATIONS_PER_PERIOD: f64 = 128.0;
/// The fewest evaluations of a guard's rate in a segment.
const MIN_EVALUATIONS: f64 = 16.0;
/// The most evaluations of a guard's rate in a segment.
const MAX_EVALUATIONS: f64 = 1e5;
/// A guard this close to zero at a segment's entry, over its size, began on it.
const ZERO_TOLERANCE: f64 = 1e-12;
/// The largest time after which a mode that is entered again counts as entered soon, in times to
/// the turn of its guard.
const MAX_REENTRY_RATIO: f64 = 4.0;
/// Halvings of a bracket, after which an extremum is known to rounding.
const HALVINGS: u32 = 60;

/// The grazes of a true run, in the order of time.
#[must_use]
pub fn grazes(
    problem: &SystemProblem,
    truth: &Truth,
    (names, rule): (&EventNames, &ErrorRule),
) -> Vec<Graze> {
    let scan = Scan { problem, system: problem.checked.system(), truth, names, rule };
    let ends = truth.events.iter().chain([&truth.end]);
    let begins = std::iter::once(&truth.start).chain(&truth.events);
    let mut found: Vec<Graze> = begins
        .zip(ends)
        .enumerate()
        .flat_map(|(n, (begin, end))| scan.segment(n, begin, end))
        .collect();
    // Both segments that meet at an extremum may have found it.
    let same = 1e-9 * problem.turn();
    found.sort_by(|a, b| a.event.cmp(&b.event).then(a.elapsed.total_cmp(&b.elapsed)));
    found.dedup_by(|b, a| a.event == b.event && b.elapsed - a.elapsed <= same);
    found.sort_by(|a, b| a.elapsed.total_cmp(&b.elapsed));
    found
}

struct Scan<'a> {
    problem: &'a SystemProblem,
    system: &'a System,
    truth: &'a Truth,
    names: &'a EventNames,
    rule: &'a ErrorRule,
}

/// A segment of the true run in closed form.
struct ScannedSegment<'a> {
    scan: &'a Scan<'a>,
    begin: Event<f64>,
    began: f64,
    mode: usize,
}

/// A guard of a mode, and which of its crossings are events.
struct ScannedGuard<'a> {
    event: usize,
    row: &'a [f64],
    /// `None`: it ends its mode.
    direction: Option<Direction>,
}

impl Scan<'_> {
    /// The grazes of the segment after `n` events.
    fn segment(&self, n: usize, begin: &TruthRow, end: &TruthRow) -> Vec<Graze> {
        let began = begin.elapsed.value();
        let length = end.elapsed.minus(begin.elapsed).value();
        let clock = Time::new(&self.problem.start.time);
        let time = clock.after(if self.problem.backward { -began } else { began });
        let state = begin.state.iter().map(|it| it.value()).collect();
        let begin = Event { what: What::Start, time, state, mode: begin.mode, errors: None };
        let segment = ScannedSegment { scan: self, mode: begin.mode, begin, began };
        let guards = self.guards(segment.mode);
        guards.iter().flat_map(|guard| segment.grazes(n, guard, length)).collect()
    }

    fn guards(&self, mode: usize) -> Vec<ScannedGuard<'_>> {
        let mode = &self.system.modes[mode];
        let until = mode.until.iter().map(|it| (&it.guard, None));
        let watch = mode.watch.iter().map(|it| (&it.guard, Some(it.direction)));
        let all = until.chain(watch).enumerate();
        all.map(|(event, (row, direction))| ScannedGuard { event, row, direction }).collect()
    }

    /// Whether an event is only watched in a mode, which goes on.
    fn is_watched(&self, mode: usize, row: &TruthRow) -> bool {
        row.mode == mode && row.event >= self.system.modes[mode].until.len()
    }

    /// The number of events that a crossing makes which turns back at once.
    fn makes(&self, mode: usize, guard: &ScannedGuard<'_>) -> usize {
        match guard.direction {
            Some(Direction::Both) => 2,
            Some(_) => 1,
            None => {
                let next = &self.system.modes[mode].until[guard.event].next;
                if next.iter().all(|(_, next)| *next == mode) { 1 } else { 2 }
            }
        }
    }

    /// The error in a guard that one unit of error in the states may have become.
    fn growth(&self, guard: &[f64], elapsed: f64, state: &[f64]) -> f64 {
        let passed = |it: &&TruthRow| it.elapsed.value() <= elapsed;
        let sample = self.truth.samples.iter().take_while(passed).last();
        self.rule.guard_growth(guard, sample.unwrap_or(&self.truth.start), state)
    }
}

impl ScannedSegment<'_> {
    /// The states, cos theta, sin theta and 1 at a time since the segment's begin.
    fn point(&self, d: f64) -> Vec<f64> {
        let ahead = if self.scan.problem.backward { -d } else { d };
        let mut z = self.scan.problem.solver.state_at(&self.begin, &self.begin.time.after(ahead));
        let (sin, cos) =
            (self.scan.system.omega * (self.began + d) + self.scan.system.phi).sin_cos();
        z.extend([cos, sin, 1.0]);
        z
    }

    fn value(&self, row: &[f64], d: f64) -> f64 {
        row.iter().zip(self.point(d)).map(|(a, b)| a * b).sum()
    }

    fn rate(&self, row: &[f64], d: f64) -> f64 {
        let (system, z) = (self.scan.system, self.point(d));
        let mode = &system.modes[self.mode];
        let states = system.states.len();
        let [cos, sin] = [z[states], z[states + 1]];
        let rate = |i: usize| {
            let own: f64 = mode.a[i].iter().zip(&z).map(|(a, x)| a * x).sum();
            own + mode.b[i][0] * cos + mode.b[i][1] * sin + mode.c[i]
        };
        let of_states: f64 = (0..states).map(|i| row[i] * rate(i)).sum();
        of_states + system.omega * (row[states + 1] * cos - row[states] * sin)
    }

    /// The extrema of a guard that are grazes, those just beyond the segment's end included.
    fn grazes(&self, n: usize, guard: &ScannedGuard<'_>, length: f64) -> Vec<Graze> {
        let size = self.size(guard.row);
        let turn = self.scan.problem.turn();
        let looks =
            (length / turn * EVALUATIONS_PER_PERIOD).clamp(MIN_EVALUATIONS, MAX_EVALUATIONS);
        let mut step = length / looks;
        // The crossing that ends the segment may turn back soon after it. An event that is only
        // watched may be the extremum itself, and rounding puts that on either side of it.
        let watched = |it: &TruthRow| self.scan.is_watched(self.mode, it);
        let goes_on = self.scan.truth.events.get(n).is_some_and(watched);
        let beyond = match guard.direction {
            None => 0.25 * turn,
            Some(_) if goes_on => step,
            Some(_) => 0.0,
        };
        if length <= 0.0 {
            return Vec::new();
        }
        let mut from = 0.0;
        if self.value(guard.row, 0.0).abs() <= ZERO_TOLERANCE * size {
            from = step;
        }
        let mut found = Vec::new();
        let mut rate = self.rate(guard.row, from);
        while from < length + beyond {
            if from >= length {
                step = step.max(turn / EVALUATIONS_PER_PERIOD);
            }
            let next = self.rate(guard.row, from + step);
            if (rate > 0.0) != (next > 0.0) {
                let at = self.turning(guard.row, (from, from + step), rate > 0.0);
                found.extend(self.graze(n, guard, at, (length, size, rate > 0.0)));
            }
            (from, rate) = (from + step, next);
        }
        found
    }

    /// The instant at which a rate changes its sign.
    fn turning(&self, row: &[f64], (mut left, mut right): (f64, f64), rising: bool) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (left + right);
            if (self.rate(row, middle) > 0.0) == rising { left = middle } else { right = middle }
        }
        0.5 * (left + right)
    }

    fn size(&self, row: &[f64]) -> f64 {
        let scales = self.scan.system.scales.iter().chain([&1.0, &1.0, &1.0]);
        row.iter().zip(scales).map(|(entry, scale)| (entry * scale).abs()).sum()
    }

    /// The graze of an extremum; a maximum is one if it is close to zero, and a minimum where the
    /// guard is only watched.
    fn graze(
        &self,
        n: usize,
        guard: &ScannedGuard<'_>,
        at: f64,
        (length, size, maximum): (f64, f64, bool),
    ) -> Option<Graze> {
        let value = self.value(guard.row, at);
        let margin = if maximum { value } else { -value };
        let until = guard.direction.is_none();
        let counts = margin.abs() <= MAX_MARGIN_SHARE * size && (maximum || !until);
        // A guard that ends its mode cannot have passed zero before the segment's end.
        let inside = !until || (margin < 0.0) == (at < length);
        if !counts || !inside {
            return None;
        }
        let scan = self.scan;
        let elapsed = self.began + at;
        let growth = scan.growth(guard.row, elapsed, &self.point(at)) * n.max(1) as f64;
        let makes = scan.makes(self.mode, guard);
        let crossed =
            if margin < 0.0 { None } else { self.touch_crossings(n, guard, makes, (at, maximum)) };
        // What touches zero exactly crosses nothing.
        let touches = margin <= ZERO_TOLERANCE * size;
        let events = crossed.or_else(|| touches.then(Vec::new))?;
        let event = scan.names.telling(self.mode, guard.event);
        Some(Graze { elapsed, margin, growth, events, mode: self.mode, event, ends: until, makes })
    }

    /// The truth's events that a touch makes: the crossings just before and just after it.
    fn touch_crossings(
        &self,
        n: usize,
        guard: &ScannedGuard<'_>,
        makes: usize,
        (at, maximum): (f64, bool),
    ) -> Option<Vec<usize>> {
        let Some(direction) = guard.direction else {
            // The segment ends by the crossing. A parabola comes back after twice the time to its
            // turn: a mode that is entered again within twice that belongs to the graze.
            let events = &self.scan.truth.events;
            let own = events.get(n).is_some_and(|it| it.event == guard.event);
            let last = events.get(n + makes - 1).filter(|_| own)?;
            let length = events[n].elapsed.value() - self.began;
            let soon =
                last.elapsed.value() - self.began - length <= MAX_REENTRY_RATIO * (at - length);
            let returns = makes == 1 || (last.mode == self.mode && soon);
            return Some(if returns { (n..n + makes).collect() } else { vec![n] });
        };
        let before = || self.watched_crossing(guard, at, (0..n).rev());
        let after = || self.watched_crossing(guard, at, n..self.scan.truth.events.len());
        match direction {
            Direction::Both => Some(vec![before()?, after()?]),
            // Up and down again, or down and up: the one of the two that is counted.
            _ if (direction == Direction::Rising) == maximum => Some(vec![before()?]),
            _ => Some(vec![after()?]),
        }
    }

    /// The nearest of these events that is a watched guard's, if the guard goes one way from it to
    /// its extremum, or back, and nothing ends the mode between them.
    fn watched_crossing(
        &self,
        guard: &ScannedGuard<'_>,
        at: f64,
        mut candidates: impl Iterator<Item = usize>,
    ) -> Option<usize> {
        const EVALUATIONS_BETWEEN: u32 = 16;
        let events = &self.scan.truth.events;
        let is_own = |k: &usize| events[*k].event == guard.event && events[*k].mode == self.mode;
        let mut open = true;
        let found = candidates.find(|k| {
            open &= self.scan.is_watched(self.mode, &events[*k]);
            !open || is_own(k)
        });
        let own = found.filter(|_| open)?;
        let from = events[own].elapsed.value() - self.began;
        let share = |k: u32| f64::from(k) / f64::from(EVALUATIONS_BETWEEN);
        let mut rates = (0..EVALUATIONS_BETWEEN)
            .map(|k| self.rate(guard.row, from + share(k) * (at - from)) > 0.0);
        let first = rates.next()?;
        rates.all(|it| it == first).then_some(own)
    }
}

#[cfg(test)]
#[path = "grazes_tests.rs"]
mod tests;
