//! The figures of one run of a piecewise-affine system.
//!
//! States are divided by their scales and times by the time scale; errors are then counted in units
//! of error x (1 + size) x growth x number of events, where the size is that of the largest state
//! so far: an error of one state grows into the others.

use super::decisions::Decision;
use super::event_names::EventNames;
use crate::engine::{Accuracy, Outcome, Task};
use crate::score::SCORED_ERROR;
use crate::score::graze::Graze;
use crate::score::matching::{Matching, WINDOW};
use crate::score::measures::Measures;
use crate::score::mismatch::{Excused, Mismatch};
use crate::score::occurrence::Occurrence;
use crate::score::probed::ProbeResults;
use crate::score::statistics::{Spread, worst};
use crate::truth::{SystemTruth, SystemTruthRow};
use percuss::TwoWord;

/// A run to be measured, with what it is measured against.
pub(super) struct SystemRun<'a> {
    pub(super) task: &'a Task,
    pub(super) truth: &'a SystemTruth,
    pub(super) outcome: &'a Outcome,
    pub(super) unit: f64,
}

/// The largest error of a method in units of its error: the widest bound on the constants of a
/// class of methods.
pub(super) const MOST_UNITS: f64 = 20.0;

/// The figures that decide how far a run of a system is scored.
#[derive(Clone, Copy, Debug)]
pub struct SystemScale<'a> {
    /// The engine's unit of error: its tolerance, or eps.
    pub unit: f64,
    /// The grazes of the true run.
    pub grazes: &'a [Graze],
    /// The decisions of the true run; none where structural zeros are known.
    pub decisions: &'a [Decision],
}

impl<'a> SystemScale<'a> {
    /// The scale to which an engine's errors are held along a true run.
    #[must_use]
    pub fn of(
        (accuracy, unit): (Accuracy, f64),
        grazes: &'a [Graze],
        decisions: &'a [Decision],
    ) -> Self {
        // The exact solver knows which values are zero by the model.
        let decisions = if accuracy == Accuracy::Exact { &[][..] } else { decisions };
        Self { unit, grazes, decisions }
    }
}

/// Measures a run.
#[must_use]
pub fn measure_system(
    task: &Task,
    truth: &SystemTruth,
    names: &EventNames,
    outcome: &Outcome,
    scale: SystemScale<'_>,
) -> Measures {
    let run = SystemRun { task, truth, outcome, unit: scale.unit };
    let period = task.system.period();
    let window = WINDOW * period;
    let (horizon, whole) = scored_horizon(task, truth, scale);
    let (all, own) = (names.of_truth(truth), names.of_outcome(task, truth, outcome));
    let until = |events: &[Occurrence], time: f64| {
        events.iter().take_while(|it| it.elapsed <= time).count()
    };
    let (rows, found) = (until(&all, horizon + window), until(&own, horizon + window));
    let (expected, counted) = (until(&all, horizon), until(&own, horizon));
    let matching = Matching::of(&all[..rows], &own[..found], window);
    let mismatch = Mismatch::of(&matching, (rows, expected), (found, counted));
    let pairs: Vec<_> = matching.pairs.iter().copied().filter(|(i, _)| *i < expected).collect();
    let timed: Vec<_> = pairs.iter().map(|(i, j)| (all[*i].elapsed, own[*j].elapsed, *i)).collect();
    let scored = truth.samples.iter().take_while(|it| it.elapsed.value() <= horizon).count();
    let errors = run.sample_errors();
    let lost = errors.iter().position(|error| error.is_nan() || *error > SCORED_ERROR);
    let valid = lost
        .map_or(truth.end.elapsed.value(), |k| truth.samples[k.saturating_sub(1)].elapsed.value());
    Measures {
        horizon_periods: horizon / period,
        whole,
        total: all.len(),
        samples: truth.samples.len().saturating_sub(1),
        sampled: scored.saturating_sub(1),
        expected,
        matched: pairs.len(),
        phase_sequence_ok: mismatch.same_phases(&all[..rows], &own, &Excused::default()),
        event_time: Spread::of(timed.iter().map(|(truth, own, _)| (truth - own).abs()).collect()),
        state: Spread::of(errors.get(1..scored).unwrap_or_default().to_vec()),
        drift: f64::NAN,
        drift_by_times: f64::NAN,
        valid_periods: valid / period,
        event_time_units: timed.iter().map(|it| run.time_units(*it)).collect(),
        event_constant: run.event_constant(&pairs, &timed, &all),
        state_constant: run.state_constant(scored),
        found: own,
        mismatch,
        probed: ProbeResults::default(),
    }
}

/// The time up to which a run is scored, and whether that is all of it: until one unit of error,
/// grown, passes the error that is scored or could let an event change places with its neighbour,
/// or until the errors that are allowed could lead into another mode.
pub(super) fn scored_horizon(
    task: &Task,
    truth: &SystemTruth,
    scale: SystemScale<'_>,
) -> (f64, bool) {
    let unit = scale.unit;
    let largest = |row: &SystemTruthRow| row.growth.iter().fold(row.growth_time, |a, b| a.max(*b));
    let is_lost = |row: &SystemTruthRow| unit * largest(row) > SCORED_ERROR;
    let times: Vec<f64> = truth.events.iter().map(|it| it.elapsed.value()).collect();
    let unit_of_time = unit * task.system.system().time_scale;
    let mixed_up = |n: usize, row: &SystemTruthRow| unit_of_time * row.growth_time > gap(&times, n);
    // Events of one instant are lost together, with the first of them.
    let is_first = |n: usize| n == 0 || times[n] > times[n - 1];
    let mut firsts = truth.events.iter().enumerate().filter(|(n, _)| is_first(*n));
    let event = firsts.find(|(n, row)| is_lost(row) || mixed_up(*n, row));
    let sample = truth.samples.iter().find(|row| is_lost(row));
    let first = event.map(|(_, row)| row).into_iter().chain(sample);
    let lost = first.map(|row| row.elapsed.value()).chain(in_doubt(&times, scale));
    let lost = lost.fold(f64::INFINITY, f64::min);
    if lost.is_infinite() {
        return (truth.end.elapsed.value(), true);
    }
    let samples = truth.samples.iter().map(|row| row.elapsed.value());
    let before = times.iter().copied().chain(samples).filter(|time| *time < lost);
    (before.fold(0.0, f64::max), false)
}

/// The instants from which on the mode is in doubt: an event whose successor hangs by less than the
/// errors that are allowed, or a graze that ends its mode or does not by as little.
fn in_doubt(times: &[f64], scale: SystemScale<'_>) -> impl Iterator<Item = f64> {
    let allowed = MOST_UNITS * scale.unit;
    let grazes = scale.grazes.iter().filter(move |it| it.ends && it.is_undecidable(allowed));
    let grazed = grazes.map(|it| it.events.first().map_or(it.elapsed, |n| times[*n]));
    let decisions = scale.decisions.iter().filter(move |it| it.margin <= allowed * it.growth);
    grazed.chain(decisions.map(|it| it.elapsed))
}

/// The distance of an event from the nearest one at another instant, or from the start.
fn gap(times: &[f64], n: usize) -> f64 {
    let before = times[..n].iter().rev().chain([&0.0]).map(|it| times[n] - it);
    let after = times[n + 1..].iter().map(|it| it - times[n]);
    let before = before.into_iter().find(|gap| *gap > 0.0);
    before.into_iter().chain(after.into_iter().find(|gap| *gap > 0.0)).fold(f64::INFINITY, f64::min)
}

impl SystemRun<'_> {
    pub(super) fn scales(&self) -> &[f64] {
        &self.task.system.system().scales
    }

    /// The largest error of a state at each sample of the truth, over its scale.
    fn sample_errors(&self) -> Vec<f64> {
        let error = |(k, row): (usize, &SystemTruthRow)| {
            let Some(state) = self.outcome.samples.get(k) else { return f64::NAN };
            let states = row.state.iter().zip(state.iter()).zip(self.scales());
            worst(states.map(|((truth, own), scale)| off(*truth, *own) / scale))
        };
        self.truth.samples.iter().enumerate().map(error).collect()
    }

    pub(super) fn time_units(&self, (truth, own, n): (f64, f64, usize)) -> f64 {
        let scale = self.task.system.system().time_scale;
        // An ending has no growth of its own.
        let growth = self.truth.events.get(n).or(self.truth.events.last());
        let growth = growth.map_or(1.0, |row| row.growth_time);
        let of_states = self.truth.events.get(n).map_or(self.truth.end.size, |row| row.size);
        let size = 1.0 + of_states.max(truth.abs() / scale);
        (truth - own).abs() / scale / size / growth / (self.unit * (n + 1) as f64)
    }

    fn event_constant(
        &self,
        pairs: &[(usize, usize)],
        timed: &[(f64, f64, usize)],
        all: &[Occurrence],
    ) -> f64 {
        if pairs.is_empty() {
            return f64::NAN;
        }
        let times = timed.iter().map(|it| self.time_units(*it));
        // Between events of one instant the state is a matter of their order.
        let placed = pairs.iter().filter(|(i, _)| all[*i].mode.is_some());
        let states = placed.filter_map(|(i, j)| {
            let (row, event) = (self.truth.events.get(*i)?, self.outcome.events.get(*j)?);
            Some(self.units(row, &event.state, i + 1))
        });
        worst(times.chain(states.collect::<Vec<_>>()))
    }

    /// The largest error of a state, in units.
    pub(super) fn units(&self, row: &SystemTruthRow, state: &[f64], events: usize) -> f64 {
        let states = row.state.iter().zip(state).zip(&row.growth).zip(self.scales());
        let grown = states.map(|(((truth, own), growth), scale)| {
            off(*truth, *own) / scale / growth.max(row.growth_time)
        });
        worst(grown) / (self.unit * (1.0 + row.size) * events.max(1) as f64)
    }

    fn state_constant(&self, scored: usize) -> f64 {
        // The start is given and measures nothing.
        if scored <= 1 {
            return f64::NAN;
        }
        let mut events = 0;
        worst((1..scored).map(|k| {
            let row = &self.truth.samples[k];
            let passed = |it: &&SystemTruthRow| it.elapsed.minus(row.elapsed).value() <= 0.0;
            events += self.truth.events[events..].iter().take_while(passed).count();
            let state = self.outcome.samples.get(k);
            state.map_or(f64::NAN, |state| self.units(row, state, events))
        }))
    }
}

pub(super) fn off(truth: TwoWord, value: f64) -> f64 {
    truth.minus(TwoWord::new(value)).value().abs()
}
