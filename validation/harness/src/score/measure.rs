//! The figures of one run.

use super::SCORED_ERROR;
use super::event_names::EventNames;
use super::matching::{Matching, WINDOW};
use super::measures::Measures;
use super::mismatch::{Excused, Mismatch};
use super::occurrence::Occurrence;
use super::probed::ProbeResults;
use super::rule::{ErrorRule, of_length};
use super::scored_horizon::ScoredBy;
use super::statistics::{Spread, worst};
use crate::engine::{Outcome, Task};
use crate::system::System;
use crate::truth::{Truth, TruthRow};
use percuss::TwoWord;

/// A true run, with what runs of engines are measured by.
#[derive(Clone, Copy)]
pub struct MeasuredBy<'a> {
    /// The run that is asked for.
    pub task: &'a Task,
    /// The truth.
    pub truth: &'a Truth,
    /// The names of its events.
    pub names: &'a EventNames,
    /// How errors are counted.
    pub rule: &'a ErrorRule,
}

/// A run to be measured.
struct MeasuredRun<'a> {
    by: MeasuredBy<'a>,
    outcome: &'a Outcome,
    /// The truth's events, and the engine's.
    events: [&'a [Occurrence]; 2],
    pairs: &'a [(usize, usize)],
    /// What an error of one tolerance becomes along the longest segment.
    unit: f64,
}

/// Measures a run.
#[must_use]
pub fn measure(by: MeasuredBy<'_>, outcome: &Outcome, scored_by: ScoredBy<'_>) -> Measures {
    let MeasuredBy { task, truth, names, rule } = by;
    let period = task.system.period();
    let window = WINDOW * period;
    let (horizon, whole) = rule.scored_horizon(truth, scored_by);
    let (all, own) = (names.of_truth(truth), names.of_outcome(task, truth, outcome));
    let until = |events: &[Occurrence], time: f64| {
        events.iter().take_while(|it| it.elapsed <= time).count()
    };
    // An event just past the horizon may be the partner of one just before it.
    let (rows, found) = (until(&all, horizon + window), until(&own, horizon + window));
    let (expected, counted) = (until(&all, horizon), until(&own, horizon));
    let matching = Matching::new(&all[..rows], &own[..found], window);
    let mismatch = Mismatch::new(&matching, (rows, expected), (found, counted));
    let pairs: Vec<_> = matching.pairs.iter().copied().filter(|(i, _)| *i < expected).collect();
    let unit = scored_by.unit * of_length(longest_segment(truth, horizon), task.system.system());
    let run = MeasuredRun { by, outcome, events: [&all, &own], pairs: &pairs, unit };
    let is_sampled = truth.samples.is_empty() || !outcome.samples.is_empty();
    let samples = if is_sampled { &truth.samples[..] } else { &[] };
    let scored = samples.iter().take_while(|it| it.elapsed.value() <= horizon).count();
    let errors = sample_errors(truth, rule, outcome);
    let lost = errors.iter().position(|error| error.is_nan() || *error > SCORED_ERROR);
    let valid = lost
        .map_or(truth.end.elapsed.value(), |k| truth.samples[k.saturating_sub(1)].elapsed.value());
    Measures {
        horizon_periods: horizon / period,
        whole,
        total: all.len(),
        is_sampled,
        samples: samples.len().saturating_sub(1),
        sampled: scored.saturating_sub(1),
        expected,
        matched: pairs.len(),
        phase_sequence_ok: mismatch.same_phases(&all[..rows], &own, &Excused::default()),
        event_time: Spread::new(
            run.times().map(|(_, time, own)| rule.time_error(time, own)).collect(),
        ),
        // The start is given: its error is none.
        state: Spread::new(errors.get(1..scored).unwrap_or_default().to_vec()),
        drift: if whole && is_sampled {
            rule.drift_error(&truth.end, &outcome.end)
        } else {
            f64::NAN
        },
        drift_by_times: if whole { run.drift_by_times() } else { f64::NAN },
        valid_periods: if is_sampled { valid / period } else { f64::NAN },
        event_time_units: run.time_units().collect(),
        event_constant: run.event_constant(),
        state_constant: run.state_constant(scored),
        found: own,
        mismatch,
        probed: ProbeResults::default(),
        local: None,
    }
}

/// The longest time without an event, up to a time.
fn longest_segment(truth: &Truth, until: f64) -> f64 {
    let events = truth.events.iter().map(|it| it.elapsed.value());
    let mut before = 0.0;
    let lengths = events.take_while(|it| *it < until).chain([until]).map(|it| {
        let length = it - before;
        before = it;
        length
    });
    lengths.fold(0.0, f64::max)
}

/// The largest error of a state at each sample of the truth; NaN at one that the engine did not
/// deliver.
#[must_use]
pub fn sample_errors(truth: &Truth, rule: &ErrorRule, outcome: &Outcome) -> Vec<f64> {
    let error = |(k, row): (usize, &TruthRow)| {
        outcome.samples.get(k).map_or(f64::NAN, |state| rule.state_error(row, state))
    };
    truth.samples.iter().enumerate().map(error).collect()
}

impl MeasuredRun<'_> {
    /// The place of each matched event among the truth's, its true time, and the engine's.
    fn times(&self) -> impl Iterator<Item = (usize, TwoWord, f64)> {
        let [all, own] = self.events;
        let events = &self.by.truth.events;
        self.pairs.iter().map(move |(i, j)| {
            let truth = events.get(*i).map_or(TwoWord::new(all[*i].elapsed), |row| row.elapsed);
            (*i, truth, own[*j].elapsed)
        })
    }

    /// The error of each matched event's time in units of error x (1 + size) x growth.
    fn time_units(&self) -> impl Iterator<Item = f64> {
        let MeasuredBy { truth, rule, .. } = self.by;
        self.times().map(move |(n, time, own)| rule.time_units(truth, n, (time, own)) / self.unit)
    }

    fn event_constant(&self) -> f64 {
        if self.pairs.is_empty() {
            return f64::NAN;
        }
        // Between events of one instant the state is a matter of their order.
        let [all, _] = self.events;
        let placed = self.pairs.iter().filter(|(i, _)| all[*i].mode.is_some());
        let states = placed.filter_map(|(i, j)| {
            let (row, event) = (self.by.truth.events.get(*i)?, self.outcome.events.get(*j)?);
            Some(self.by.rule.state_units(row, &event.state) / self.unit)
        });
        worst(self.time_units().chain(states))
    }

    fn state_constant(&self, scored: usize) -> f64 {
        // The start is given and measures nothing.
        if scored <= 1 {
            return f64::NAN;
        }
        let MeasuredBy { truth, rule, .. } = self.by;
        let judged = (1..scored).filter(|k| !self.is_between(truth.samples[*k].elapsed.value()));
        worst(judged.map(|k| {
            let state = self.outcome.samples.get(k);
            let units = state.map_or(f64::NAN, |state| rule.state_units(&truth.samples[k], state));
            units / self.unit
        }))
    }

    /// Whether an instant lies between an event of the truth and the engine's own. There the states
    /// differ by what the event makes of them, however small the error of its time.
    fn is_between(&self, elapsed: f64) -> bool {
        let [all, own] = self.events;
        let both = |(i, j): &(usize, usize)| (all[*i].elapsed, own[*j].elapsed);
        let later = self.pairs.partition_point(|it| {
            let (time, own) = both(it);
            time.max(own) <= elapsed
        });
        self.pairs.get(later).is_some_and(|it| {
            let (time, own) = both(it);
            time.min(own) < elapsed
        })
    }

    /// A drift that begins too late by dt lacks v' dt; NaN where nothing drifts.
    fn drift_by_times(&self) -> f64 {
        let system = self.by.task.system.system();
        let truth = self.by.truth;
        let lost = |drift: usize, (n, time, own): (usize, TwoWord, f64)| {
            let Some(row) = truth.events.get(n) else { return 0.0 };
            let before = n.checked_sub(1).map_or(truth.start.mode, |it| truth.events[it].mode);
            let [before, after] = [before, row.mode].map(|it| rate(system, (it, drift), row));
            (after - before) * TwoWord::new(own).minus(time).value()
        };
        let rule = &self.by.rule;
        rule.of_drifts(|k| self.times().map(|it| lost(k, it)).sum::<f64>().abs() / rule.scales[k])
    }
}

/// The rate of a state in a mode, at a row of the truth.
fn rate(system: &System, (mode, state): (usize, usize), row: &TruthRow) -> f64 {
    let (sin, cos) = (system.omega * row.elapsed.value() + system.phi).sin_cos();
    let z = row.rounded().into_iter().chain([cos, sin, 1.0]);
    system.modes[mode].rate(state).iter().zip(z).map(|(factor, value)| factor * value).sum()
}

#[cfg(test)]
#[path = "measure_tests.rs"]
mod tests;
