//! The units in which a record's defects are counted: what errors of one tolerance anywhere along
//! its segment become at its end.

use super::judgement::Allowance;
use super::motion::{Motion, Segment};
use crate::score::rule::of_length;
use crate::score::worst;
use nalgebra::RowDVector;

/// The largest share of a segment's length that the growth of errors may make of a unit of time:
/// where more is asked for, events are too close for the growth to be that of small errors.
const MAX_LENGTH_SHARE: f64 = 0.1;
/// The defect in units without growth up to which the growth is not asked for.
const NEGLIGIBLE_DEFECT: f64 = 0.05;
/// Roundings of the time since the start in an answer's times and in differences of them.
const TIME_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The rounding of a state in parts of its weight.
const STATE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The change of a state in a time scale, as a share of its weight, below which it is slow.
const MIN_SPEED: f64 = 0.1;

/// Time scales after an event within which states tell how late it is.
const MAX_TIME_SCALES: f64 = 2.0;

/// The units of one engine's answer on one system.
pub(super) struct Units<'a> {
    pub(super) motion: &'a Motion,
    pub(super) allowance: Allowance,
}

/// A segment of an answer: its begin, its mode and its length.
#[derive(Clone, Copy)]
pub(super) struct Stretch<'a> {
    pub(super) mode: usize,
    pub(super) elapsed: f64,
    pub(super) state: &'a [f64],
    pub(super) length: f64,
}

impl Units<'_> {
    pub(super) fn tolerance(&self) -> f64 {
        self.allowance.tolerance
    }

    fn time_scale(&self) -> f64 {
        self.motion.system().time_scale
    }

    fn of_length(&self, length: f64) -> f64 {
        of_length(length, self.motion.system())
    }

    fn segment(&self, stretch: &Stretch<'_>) -> Segment {
        self.motion.segment(stretch.mode, stretch.elapsed, stretch.state, stretch.length)
    }

    /// The rounding error of a time since the start.
    pub(super) fn rounding_of_time(elapsed: f64) -> f64 {
        TIME_ROUNDING * elapsed.abs()
    }

    /// The defect of an event's time, with its sign: the event of a guard ends the stretch.
    pub(super) fn of_time(&self, off: f64, stretch: &Stretch<'_>, guard: usize) -> f64 {
        let rounding = Self::rounding_of_time(stretch.elapsed + stretch.length);
        let beyond = excess(off, rounding);
        let unit = self.tolerance() * self.time_scale() * self.of_length(stretch.length);
        if (beyond / unit).abs() <= NEGLIGIBLE_DEFECT || stretch.length <= 0.0 {
            return beyond / unit;
        }
        beyond / (unit + self.growth_of_time(stretch, guard))
    }

    /// What the errors along a stretch make of the time of the event at its end.
    fn growth_of_time(&self, stretch: &Stretch<'_>, guard: usize) -> f64 {
        let growth = self.motion.growth_of_time(&self.segment(stretch), guard);
        let growth = self.tolerance() * self.of_length(stretch.length) * growth;
        let most = MAX_LENGTH_SHARE * stretch.length / self.allowance.time;
        if growth.is_finite() { growth.min(most) } else { most }
    }

    /// The largest time by which an event of a guard at the end of a stretch may be off.
    pub(super) fn allowed_time(&self, stretch: &Stretch<'_>, guard: usize) -> f64 {
        let unit = self.tolerance() * self.time_scale() * self.of_length(stretch.length);
        let growth = if stretch.length > 0.0 { self.growth_of_time(stretch, guard) } else { 0.0 };
        let rounding = Self::rounding_of_time(stretch.elapsed + stretch.length);
        self.allowance.time * (unit + growth) + rounding
    }

    /// The defect of a state just after the event of a guard that ends a stretch.
    pub(super) fn of_state(
        &self,
        (own, exact): (&[f64], &[f64]),
        stretch: &Stretch<'_>,
        guard: usize,
    ) -> f64 {
        let grown = |segment: &Segment| self.motion.growth_of_states(segment, guard);
        self.of_states((own, exact), stretch, grown)
    }

    /// The sizes over which errors of a state just after the event of a guard that ends a stretch
    /// are counted: its weights, or the changes by errors of size one along the stretch.
    pub(super) fn sizes_after(
        &self,
        state: &[f64],
        stretch: &Stretch<'_>,
        guard: usize,
    ) -> Vec<f64> {
        let growth = self.motion.growth_of_states(&self.segment(stretch), guard);
        elementwise_max(&self.motion.weights(state), &growth)
    }

    /// The defect of a state along a stretch.
    pub(super) fn of_sample(&self, (own, exact): (&[f64], &[f64]), stretch: &Stretch<'_>) -> f64 {
        self.of_states((own, exact), stretch, |segment| self.motion.growth_of_flow(segment))
    }

    /// The defect of a state beside what the reset of an `until` makes of the flow.
    pub(super) fn of_reset(
        &self,
        (own, exact): (&[f64], &[f64]),
        stretch: &Stretch<'_>,
        until: usize,
    ) -> f64 {
        self.of_states((own, exact), stretch, |it| self.motion.growth_of_reset(it, until))
    }

    /// The time by which a state along a stretch is ahead of the exact one, in tolerances of the
    /// time scale: its error along the flow over the rate. None where the motion is slow, and far
    /// from the begin of the stretch, where errors since then hide it.
    pub(super) fn delay(
        &self,
        (own, exact): (&[f64], &[f64]),
        stretch: &Stretch<'_>,
    ) -> Option<f64> {
        let end = stretch.elapsed + stretch.length;
        let (weights, scale) = (self.motion.weights(exact), self.time_scale());
        let rates = self.motion.rates(stretch.mode, end, exact);
        let parts = rates.iter().zip(&weights).map(|(rate, weight)| scale * rate / weight);
        let parts: Vec<f64> = parts.collect();
        let square: f64 = parts.iter().map(|it| it * it).sum();
        if square < MIN_SPEED * MIN_SPEED || stretch.length > MAX_TIME_SCALES * scale {
            return None;
        }
        let off = own
            .iter()
            .zip(exact)
            .zip(&weights)
            .map(|((own, exact), weight)| excess((own - exact) / weight, STATE_ROUNDING));
        let along: f64 = off.zip(&parts).map(|(off, part)| off * part).sum();
        let rounding = Self::rounding_of_time(end) / scale;
        Some(excess(along / square, rounding) / self.tolerance())
    }

    fn of_states(
        &self,
        (own, exact): (&[f64], &[f64]),
        stretch: &Stretch<'_>,
        grown: impl FnOnce(&Segment) -> Vec<f64>,
    ) -> f64 {
        let weights = self.motion.weights(exact);
        let unit = self.tolerance() * self.of_length(stretch.length);
        let end = stretch.elapsed + stretch.length;
        let rates = self.motion.rates(stretch.mode, end, exact);
        // No state is known better than its time.
        let rounding =
            |n: usize| STATE_ROUNDING * weights[n] + Self::rounding_of_time(end) * rates[n].abs();
        let off = |n: usize| excess(own[n] - exact[n], rounding(n)).abs();
        let worst_by = |sizes: &[f64]| {
            let each =
                (0..own.len()).map(|n| if own[n].is_nan() { f64::NAN } else { off(n) / sizes[n] });
            worst(each) / unit
        };
        let plain = worst_by(&weights);
        if plain <= NEGLIGIBLE_DEFECT || stretch.length <= 0.0 || !plain.is_finite() {
            return plain;
        }
        worst_by(&elementwise_max(&weights, &grown(&self.segment(stretch))))
    }

    /// What the errors that are allowed along a stretch make of a row's value at its end.
    pub(super) fn allowed_value(&self, row: &RowDVector<f64>, stretch: &Stretch<'_>) -> f64 {
        let growth = self.motion.growth(&self.segment(stretch), row);
        let k = self.allowance.time.max(self.allowance.state);
        k * self.tolerance() * self.of_length(stretch.length) * growth
    }
}

/// The larger of each two sizes.
fn elementwise_max(weights: &[f64], growth: &[f64]) -> Vec<f64> {
    weights.iter().zip(growth).map(|(a, b)| a.max(*b)).collect()
}

/// What is left of an error beyond the rounding that hides in it, with its sign.
fn excess(off: f64, rounding: f64) -> f64 {
    (off.abs() - rounding).max(0.0).copysign(off)
}
