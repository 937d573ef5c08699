//! Difference quotients over steps of a name, by runs with the same events.

use super::linear::Linear;
use super::mechanism::EXPLAINED_SHARE;
use super::path::{Stop, Stretch};
use super::walk::{Along, Rows};
use nalgebra::DVector;

/// The most steps of Newton's method to an event.
const MAX_NEWTON_STEPS: usize = 50;
/// An event's time is found where a step is smaller than this share of the stretch.
const TIME_TOLERANCE: f64 = 1e-15;
/// The step by which second and third derivatives are taken, as a share of the name's value: the
/// rounding of a third derivative is then some 1e-16/1e-9.
const RELATIVE_STEP: f64 = 1e-3;

/// Runs for other values of a name. The system is followed to first order in its coefficients, as
/// `export` gives it.
pub(super) struct Quotients<'a> {
    along: Along<'a>,
    size: f64,
}

/// The values of an answer that are compared, each divided by its unit.
pub(super) type Weighed = Vec<f64>;

impl<'a> Quotients<'a> {
    pub(super) fn new(along: Along<'a>, size: f64) -> Self {
        Self { along, size }
    }

    /// The difference quotient over a step.
    pub(super) fn quotient(&self, step: f64, central: bool) -> Option<Rows> {
        let above = self.values(step)?;
        let (below, width) =
            if central { (self.values(-step)?, 2.0 * step) } else { (self.values(0.0)?, step) };
        Some(weighted_sum(&[(1.0 / width, &above), (-1.0 / width, &below)]))
    }

    /// The steps over which one-sided differences and central ones give what was answered: both
    /// may, where their errors differ by a factor alone. `weigh` takes the cells that are compared,
    /// each divided by its unit, and `error` is what was answered less the truth.
    pub(super) fn steps(
        &self,
        truth: &Rows,
        error: &Weighed,
        weigh: impl Fn(&Rows) -> Weighed,
    ) -> Vec<(f64, bool)> {
        let h = RELATIVE_STEP * self.size;
        let [Some(above), Some(at), Some(below)] = [h, 0.0, -h].map(|it| self.values(it)) else {
            return Vec::new();
        };
        let second = weighted_sum(&[
            (1.0 / (h * h), &above),
            (-2.0 / (h * h), &at),
            (1.0 / (h * h), &below),
        ]);
        let central = weighted_sum(&[(0.5 / h, &above), (-0.5 / h, &below), (-1.0, truth)]);
        let of_one_side = 2.0 * share(error, &weigh(&second));
        let of_both = share(error, &weigh(&central)).max(0.0).sqrt() * h;
        [(of_one_side, false), (of_both, true)]
            .into_iter()
            .filter_map(|(step, central)| self.refined_step(step, central, truth, error, &weigh))
            .collect()
    }

    /// A step near this one whose differences explain the error.
    fn refined_step(
        &self,
        mut step: f64,
        central: bool,
        truth: &Rows,
        error: &Weighed,
        weigh: &impl Fn(&Rows) -> Weighed,
    ) -> Option<(f64, bool)> {
        for _ in 0..4 {
            if !(step.is_finite() && step.abs() > 0.0) {
                return None;
            }
            let quotient = self.quotient(step, central)?;
            let found = weigh(&weighted_sum(&[(1.0, &quotient), (-1.0, truth)]));
            let rest: f64 = found.iter().zip(error).map(|(a, b)| (a - b) * (a - b)).sum();
            let all: f64 = error.iter().map(|it| it * it).sum();
            if rest <= EXPLAINED_SHARE * EXPLAINED_SHARE * all {
                return Some((step, central));
            }
            let more = share(error, &found).max(0.0);
            step *= if central { more.sqrt() } else { more };
        }
        None
    }

    /// Times and states of the events for another value of the name.
    fn values(&self, step: f64) -> Option<Rows> {
        let linear = self.along.linear.moved(self.along.rates, step);
        let (mut z, mut time) = (linear.start.clone(), 0.0);
        let mut rows = vec![self.cells(0.0, &z)];
        let last: f64 = self.along.path.iter().map(|it| it.elapsed).sum();
        for stretch in self.along.path {
            let elapsed = match stretch.stop {
                Stop::End => last - time,
                _ if stretch.at_entry => 0.0,
                Stop::Until(guard) | Stop::Watch(guard) => crossing(&linear, stretch, guard, &z)?,
            };
            z = (&linear.modes[stretch.mode].matrix * elapsed).exp() * z;
            time += elapsed;
            if let Stop::Until(until) = stretch.stop {
                z = &linear.modes[stretch.mode].resets[until] * z;
            }
            rows.push(self.cells(if stretch.stop == Stop::End { 0.0 } else { time }, &z));
        }
        Some(rows)
    }

    fn cells(&self, time: f64, z: &DVector<f64>) -> Vec<f64> {
        std::iter::once(time).chain(z.iter().take(self.along.states).copied()).collect()
    }
}

/// The time from the entry to a guard's zero near that of the exact run.
fn crossing(linear: &Linear, stretch: &Stretch, guard: usize, z: &DVector<f64>) -> Option<f64> {
    let mode = &linear.modes[stretch.mode];
    let guard = &mode.guards[guard];
    let mut elapsed = stretch.elapsed;
    for _ in 0..MAX_NEWTON_STEPS {
        let there = (&mode.matrix * elapsed).exp() * z;
        let rate = guard.dot(&(&mode.matrix * &there).transpose());
        let step = guard.dot(&there.transpose()) / rate;
        if !step.is_finite() {
            return None;
        }
        elapsed -= step;
        if step.abs() <= TIME_TOLERANCE * stretch.elapsed.abs() {
            break;
        }
    }
    Some(elapsed)
}

/// The factor by which a direction comes closest to an error.
fn share(error: &Weighed, direction: &Weighed) -> f64 {
    let product: f64 = error.iter().zip(direction).map(|(a, b)| a * b).sum();
    product / direction.iter().map(|it| it * it).sum::<f64>()
}

/// A sum of rows with factors.
fn weighted_sum(terms: &[(f64, &Rows)]) -> Rows {
    let Some((_, first)) = terms.first() else { return Vec::new() };
    let cell = |n: usize, k: usize| terms.iter().map(|(factor, rows)| factor * rows[n][k]).sum();
    (0..first.len()).map(|n| (0..first[n].len()).map(|k| cell(n, k)).collect()).collect()
}
