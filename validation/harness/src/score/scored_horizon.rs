//! How far a run is scored: up to where an engine's error may have grown too large to tell its
//! events apart, by the truth and the engine's unit of error alone.

use super::decisions::Decision;
use super::graze::Graze;
use super::rule::{Beside, ErrorRule};
use super::{SCORED_ERROR, SCORED_FACTOR};
use crate::engine::Accuracy;
use crate::truth::{Truth, TruthRow};

/// The largest error of a method in units of its error: the widest bound on the constants of a
/// class of methods.
pub(super) const MAX_ERROR_UNITS: f64 = 20.0;

/// The figures that decide how far a run is scored.
#[derive(Clone, Copy, Debug)]
pub struct ScoredBy<'a> {
    /// The engine's unit of error: its tolerance, or eps.
    pub unit: f64,
    /// The grazes of the true run.
    pub grazes: &'a [Graze],
    /// The decisions of the true run; none where structural zeros are known.
    pub decisions: &'a [Decision],
}

impl<'a> ScoredBy<'a> {
    /// What an engine's errors are held to along a true run.
    #[must_use]
    pub fn new(
        (accuracy, unit): (Accuracy, f64),
        grazes: &'a [Graze],
        decisions: &'a [Decision],
    ) -> Self {
        // The exact solver knows which values are zero by the model.
        let decisions = if accuracy == Accuracy::Exact { &[][..] } else { decisions };
        Self { unit, grazes, decisions }
    }
}

impl ErrorRule {
    /// The time up to which a run is scored, and whether that is all of it.
    pub(super) fn scored_horizon(&self, truth: &Truth, by: ScoredBy<'_>) -> (f64, bool) {
        match self.beside {
            Beside::Value => self.until_a_sample_is_lost(truth, by.unit),
            Beside::Largest => self.until_a_mode_is_lost(truth, by),
        }
    }

    /// Up to the last sample before one unit of error, grown, passes the error that is scored.
    fn until_a_sample_is_lost(&self, truth: &Truth, unit: f64) -> (f64, bool) {
        let is_lost =
            |row: &TruthRow| SCORED_FACTOR * unit * self.largest_growth(row) > SCORED_ERROR;
        match truth.samples.iter().position(is_lost) {
            Some(n) => (truth.samples[n.saturating_sub(1)].elapsed.value(), false),
            None => (truth.end.elapsed.value(), true),
        }
    }

    /// Until one unit of error, grown, passes the error that is scored or could let an event change
    /// places with its neighbour, or until the errors that are allowed could lead into another
    /// mode.
    fn until_a_mode_is_lost(&self, truth: &Truth, by: ScoredBy<'_>) -> (f64, bool) {
        let unit = by.unit;
        let largest = |row: &TruthRow| row.growth.iter().fold(row.growth_time, |a, b| a.max(*b));
        let is_lost = |row: &TruthRow| unit * largest(row) > SCORED_ERROR;
        let times: Vec<f64> = truth.events.iter().map(|it| it.elapsed.value()).collect();
        let unit_of_time = unit * self.time_scale;
        let mixed_up = |n: usize, row: &TruthRow| unit_of_time * row.growth_time > gap(&times, n);
        // Events of one instant are lost together, with the first of them.
        let is_first = |n: usize| n == 0 || times[n] > times[n - 1];
        let mut firsts = truth.events.iter().enumerate().filter(|(n, _)| is_first(*n));
        let event = firsts.find(|(n, row)| is_lost(row) || mixed_up(*n, row));
        let sample = truth.samples.iter().find(|row| is_lost(row));
        let first = event.map(|(_, row)| row).into_iter().chain(sample);
        let lost = first.map(|row| row.elapsed.value()).chain(in_doubt(&times, by));
        let lost = lost.fold(f64::INFINITY, f64::min);
        if lost.is_infinite() {
            return (truth.end.elapsed.value(), true);
        }
        let samples = truth.samples.iter().map(|row| row.elapsed.value());
        let before = times.iter().copied().chain(samples).filter(|time| *time < lost);
        (before.fold(0.0, f64::max), false)
    }

    /// Whether errors of this unit leave open nothing that follows in a short run.
    pub(super) fn decides(&self, truth: &Truth, by: ScoredBy<'_>) -> bool {
        self.beside == Beside::Value || self.until_a_mode_is_lost(truth, by).1
    }
}

/// The instants from which on the mode is in doubt: an event whose successor hangs by less than the
/// errors that are allowed, or a graze that ends its mode or does not by as little.
fn in_doubt(times: &[f64], by: ScoredBy<'_>) -> impl Iterator<Item = f64> {
    let allowed = MAX_ERROR_UNITS * by.unit;
    let grazes = by.grazes.iter().filter(move |it| it.ends && it.is_undecidable(allowed));
    let grazed = grazes.map(|it| it.events.first().map_or(it.elapsed, |n| times[*n]));
    let decisions = by.decisions.iter().filter(move |it| it.margin <= allowed * it.growth);
    grazed.chain(decisions.map(|it| it.elapsed))
}

/// The distance of an event from the nearest one at another instant, or from the start.
fn gap(times: &[f64], n: usize) -> f64 {
    let before = times[..n].iter().rev().chain([&0.0]).map(|it| times[n] - it);
    let after = times[n + 1..].iter().map(|it| it - times[n]);
    let before = before.into_iter().find(|gap| *gap > 0.0);
    before.into_iter().chain(after.into_iter().find(|gap| *gap > 0.0)).fold(f64::INFINITY, f64::min)
}
