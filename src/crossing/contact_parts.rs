//! A contact followed in fixed steps from an evaluation: where the trial force may leave its
//! corridor (a guess), and that it does not before (a certificate in pieces).
//!
//! The force less b is a free oscillation and a forced one. A step of the model's own length
//! turns both by known factors, so that places around an evaluation need none of their own.

use crate::crossing::allowances::{CONTACT_PIECES, MAX_LAST_STEP_RATIO};
use crate::crossing::certificate::Piece;
use crate::crossing::{Corridor, Proof, ThresholdEnds};
use crate::flow::steps::ContactStep;
use crate::numeric::real::Real;
use crate::numeric::roots::zero_between;

/// The trial force in parts, at some place.
#[derive(Clone, Copy, Debug)]
pub struct ContactParts<T> {
    /// The time since the segment began.
    pub elapsed: T,
    /// Free part.
    pub free: T,
    /// The rate of the free part.
    pub free_rate: T,
    /// Forced part.
    pub forced: T,
    /// The rate of the forced part over omega.
    pub quarter: T,
}

impl<T: Real> ContactParts<T> {
    /// The parts after a step.
    #[inline(always)]
    pub fn after(&self, step: &ContactStep<T>) -> Self {
        let ContactStep { length, sin, cos, c, s, s_rate } = *step;
        Self {
            elapsed: self.elapsed + length,
            free: self.free.times_plus(c, self.free_rate * s),
            free_rate: self.free.times_from(s, self.free_rate * s_rate),
            forced: self.forced.times_plus(cos, self.quarter * sin),
            quarter: self.forced.times_from(sin, self.quarter * cos),
        }
    }

    /// The free part and its first three derivatives, by x'' + 2 xi x' + x = 0.
    #[inline(always)]
    pub fn free_orders(&self, two_xi: T) -> [T; 4] {
        let bend = -two_xi.times_plus(self.free_rate, self.free);
        [self.free, self.free_rate, bend, -two_xi.times_plus(bend, self.free_rate)]
    }

    /// The guard and its first three derivatives, from those of the free part; `level` is b less
    /// the guard's reference.
    #[inline(always)]
    pub fn orders(&self, level: T, omega: T, [free, rate, bend, third]: [T; 4]) -> [T; 4] {
        let omega2 = omega * omega;
        [
            level + free + self.forced,
            omega.times_plus(self.quarter, rate),
            omega2.times_from(self.forced, bend),
            (omega * omega2).times_from(self.quarter, third),
        ]
    }
}

/// The constants that all places of a contact have in common.
#[derive(Clone, Copy, Debug)]
pub struct ContactShape {
    /// b less the guard's reference.
    pub level: f64,
    /// 2 xi
    pub two_xi: f64,
    /// omega
    pub omega: f64,
    /// The corridor in which the guard has to stay.
    pub corridor: Corridor,
    /// A bound of the guard's eighth derivative.
    pub eighth: f64,
    /// Rounding room.
    pub slack: f64,
}

impl ContactParts<f64> {
    fn guard(&self, shape: &ContactShape) -> [f64; 4] {
        self.orders(shape.level, shape.omega, self.free_orders(shape.two_xi))
    }

    fn value_and_rate(&self, shape: &ContactShape) -> (f64, f64) {
        (shape.level + self.free + self.forced, self.free_rate + shape.omega * self.quarter)
    }

    /// A guess of the first exit in so many steps, or the parts where they end.
    #[inline(always)]
    pub fn first_exit(
        &self,
        shape: &ContactShape,
        step: &ContactStep<f64>,
        steps: usize,
    ) -> Result<f64, Self> {
        let corridor = shape.corridor;
        let mut here = *self;
        let (mut last, mut last_rate) = here.value_and_rate(shape);
        for _ in 0..steps {
            let next = here.after(step);
            let (value, rate) = next.value_and_rate(shape);
            if corridor.excess(value) >= 0.0 {
                let threshold = if value >= corridor.high { corridor.high } else { corridor.low };
                let slopes = (last_rate * step.length, rate * step.length);
                let share = zero_between(last - threshold, value - threshold, slopes);
                return Ok(here.elapsed + step.length * share);
            }
            (here, last, last_rate) = (next, value, rate);
        }
        Err(here)
    }

    /// Whether the guard stays inside from here to the right end: proved, or not known.
    pub fn stays_inside(
        &self,
        orders: &[f64; 4],
        (right, right_orders): (f64, &[f64; 4]),
        ends: ThresholdEnds,
        shape: &ContactShape,
        step: &ContactStep<f64>,
    ) -> bool {
        let inside = |left: &[f64; 4], right: &[f64; 4], length: f64, ends: ThresholdEnds| {
            let eighth = (-shape.eighth, shape.eighth);
            let piece = Piece { left: *left, right: *right, length, eighth };
            match piece.verdict(&shape.corridor, ends, shape.slack) {
                Proof::Inside => true,
                Proof::Touches => false,
                Proof::Open => piece.stays_inside_in_parts(&shape.corridor, ends, shape.slack),
            }
        };
        let (mut here, mut orders) = (*self, *orders);
        let mut left_ends = ThresholdEnds { right: false, ..ends };
        for _ in 0..CONTACT_PIECES {
            let rest = right - here.elapsed;
            if rest < MAX_LAST_STEP_RATIO * step.length {
                let ends = ThresholdEnds { right: ends.right, ..left_ends };
                return inside(&orders, right_orders, rest, ends);
            }
            let next = here.after(step);
            let next_orders = next.guard(shape);
            if !inside(&orders, &next_orders, step.length, left_ends) {
                return false;
            }
            (here, orders, left_ends) = (next, next_orders, ThresholdEnds::FREE);
        }
        false
    }
}
