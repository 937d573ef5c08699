//! What errors are counted in, as data: the two rules that there are.

use super::statistics::worst;
use crate::case::Case;
use crate::system::System;
use crate::truth::{Truth, TruthRow};
use percuss::TwoWord;

/// What an error is judged beside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// One and the value itself, each with its own growth; times are plain.
    Value,
    /// One and the largest state so far, in the scales of the system, with the growth of times too:
    /// an error of one state grows into the others.
    Largest,
}

/// How errors along a case's run are counted.
#[derive(Clone, Debug)]
pub struct ErrorRule {
    /// What an error is judged beside.
    pub beside: Beside,
    /// The scales of the states.
    pub scales: Vec<f64>,
    /// The scale of times.
    pub time_scale: f64,
    /// The states that drift, which are no part of the state's error.
    pub drift: Vec<usize>,
}

impl ErrorRule {
    /// The rule of a case, which is a run of this system.
    #[must_use]
    pub fn new(case: &Case, system: &System) -> Self {
        let beside = if case.oscillator.is_some() { Beside::Value } else { Beside::Largest };
        let (scales, time_scale) = (system.scales.clone(), case.unit_of_time());
        Self { beside, scales, time_scale, drift: system.drift.clone() }
    }

    /// The largest error of a state, over its scale.
    #[must_use]
    pub fn state_error(&self, row: &TruthRow, state: &[f64]) -> f64 {
        let states = row.state.iter().zip(state).zip(&self.scales).enumerate();
        let states = states.filter(|(k, _)| !self.drift.contains(k));
        worst(states.map(|(_, ((truth, own), scale))| deviation(*truth, *own) / scale))
    }

    /// The largest error of a state that drifts, over its scale; NaN where there is none.
    #[must_use]
    pub fn drift_error(&self, row: &TruthRow, state: &[f64]) -> f64 {
        self.of_drifts(|k| deviation(row.state[k], state[k]) / self.scales[k])
    }

    /// The largest of a number for each state that drifts; NaN where there is none.
    pub(super) fn of_drifts(&self, of: impl Fn(usize) -> f64) -> f64 {
        if self.drift.is_empty() { f64::NAN } else { worst(self.drift.iter().map(|k| of(*k))) }
    }

    /// The error of an event's time.
    #[must_use]
    pub fn time_error(&self, truth: TwoWord, own: f64) -> f64 {
        match self.beside {
            Beside::Value => deviation(truth, own),
            Beside::Largest => (truth.value() - own).abs(),
        }
    }

    /// The error of an event's time over its size and growth; an ending has those of the last row.
    pub(super) fn time_units(&self, truth: &Truth, n: usize, (time, own): (TwoWord, f64)) -> f64 {
        let row = truth.events.get(n);
        // An ending has no growth of its own.
        let growth = row.or(truth.events.last()).map_or(1.0, |row| row.growth_time);
        let elapsed = time.value().abs() / self.time_scale;
        let size = match self.beside {
            Beside::Value => elapsed,
            Beside::Largest => row.map_or(truth.end.size, |row| row.size).max(elapsed),
        };
        self.time_error(time, own) / self.time_scale / (1.0 + size) / growth
    }

    /// The largest error of a state over its size and growth.
    pub(super) fn state_units(&self, row: &TruthRow, state: &[f64]) -> f64 {
        worst((0..row.state.len().min(state.len())).map(|k| self.units(row, k, state[k])))
    }

    /// The error of one state over its size and growth.
    pub(super) fn units(&self, row: &TruthRow, k: usize, own: f64) -> f64 {
        let error = deviation(row.state[k], own) / self.scales[k];
        match self.beside {
            Beside::Value => error / (1.0 + row.state[k].value().abs()) / row.growth[k],
            Beside::Largest => error / row.growth[k].max(row.growth_time) / (1.0 + row.size),
        }
    }

    /// The largest of the contributions of the states' errors to that of a guard, at a state, by
    /// their growth in a row of the truth.
    pub(super) fn guard_growth(&self, guard: &[f64], row: &TruthRow, state: &[f64]) -> f64 {
        let size = |k: usize| match self.beside {
            Beside::Value => state[k].abs(),
            Beside::Largest => row.size,
        };
        let part = |k: usize| guard[k].abs() * self.scales[k] * row.growth[k] * (1.0 + size(k));
        let states = (0..row.state.len()).filter(|k| !self.drift.contains(k));
        states.map(part).fold(0.0, f64::max)
    }

    /// The largest growth of a state, at least one.
    #[must_use]
    pub fn largest_growth(&self, row: &TruthRow) -> f64 {
        let growth = row.growth.iter().enumerate().filter(|(k, _)| !self.drift.contains(k));
        growth.fold(1.0_f64, |most, (_, growth)| most.max(*growth))
    }
}

/// The time scales of the longest segment that needs no factor: a step's error adds up over a
/// segment, which is no matter up to so many.
const MAX_SHORT_TIME_SCALES: f64 = 10.0;

/// The largest factor of long segments: three times that of the longest one, of 279 time scales, on
/// which right engines need a factor.
const MAX_LENGTH_FACTOR: f64 = 100.0;

/// The factor of long segments, along which the errors of many steps add up.
pub(super) fn of_length(length: f64, system: &System) -> f64 {
    (length / (MAX_SHORT_TIME_SCALES * system.time_scale)).clamp(1.0, MAX_LENGTH_FACTOR)
}

/// The distance of a value from the truth.
pub(crate) fn deviation(truth: TwoWord, value: f64) -> f64 {
    truth.minus(TwoWord::new(value)).value().abs()
}
