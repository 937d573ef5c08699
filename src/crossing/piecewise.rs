//! The certificate of a long flight or progression: pieces in fixed steps from both ends.
//!
//! The guard, counted so that it is negative inside, is a parabola, a harmonic and an exponential.
//! All three are known at an evaluation, and a step of the model's own length turns the harmonic
//! and shrinks the exponential by known factors: the ends of the pieces need no evaluation. In
//! between there is mostly nothing to prove: the parabola lies below minus the harmonic's
//! amplitude.
//!
//! An exponential that lasts longer than a piece stays in the interpolant. A shorter one is covered
//! while it lasts by the first piece or, after a separation under a strong spring, by an
//! inequality. What is left of it is replaced by a line above it: by its tangent at the right end
//! where it pulls inwards (it is concave then), else by its chord.

use crate::crossing::allowances::MAX_LAST_STEP_RATIO;
use crate::crossing::certificate::Piece;
use crate::crossing::{Corridor, Proof, ThresholdEnds};
use crate::flow::steps::{
    FORCE_FACTOR, FreeStep, MAX_PULLING_DECAY_TIMES, MAX_PUSHING_DECAY_TIMES, MIN_SLIDER_RETURN,
    Steps,
};

/// A guard's excess in parts, at some place.
#[derive(Clone, Copy, Debug)]
pub struct FreeParts {
    /// The time since the segment began.
    pub elapsed: f64,
    /// Parabola and harmonic.
    pub value: f64,
    /// The slope of parabola and harmonic.
    pub slope: f64,
    /// The harmonic's second derivative.
    pub bow: f64,
    /// The third derivative of the harmonic part over omega.
    pub quarter: f64,
    /// The exponential.
    pub lasting: f64,
    /// Rounding room of the guard's parts.
    pub room: f64,
}

/// The constants that all places of a motion without contact have in common.
#[derive(Clone, Copy, Debug)]
pub struct FreeShape {
    /// The parabola's second derivative.
    pub curvature: f64,
    /// The largest terms that cancel in the slope at an evaluation.
    pub grain: f64,
    /// The largest `bow`.
    pub strength: f64,
    /// omega
    pub omega: f64,
    /// omega^6
    pub omega6: f64,
    /// 1/omega^2
    pub per_omega2: f64,
    /// Rate of the exponential.
    pub rate: f64,
    /// The eighth power of the rate.
    pub rate8: f64,
}

/// An end of a piece: the guard's own orders there, and its parts.
#[derive(Clone, Copy, Debug)]
pub struct PieceEnd {
    /// Value and three derivatives of the excess.
    pub orders: [f64; 4],
    /// The guard at this end in parts.
    pub parts: FreeParts,
}

impl FreeParts {
    fn after(&self, step: &FreeStep, shape: &FreeShape) -> Self {
        const ROUNDING_TOLERANCE: f64 = 8.0 * f64::EPSILON;
        let FreeShape { curvature, strength, grain, .. } = *shape;
        let FreeStep { length, sin, cos, decay, speed, sag, fall, drop } = *step;
        let (lift, gain) = (0.5 * length * curvature, length * curvature);
        let change = length * (self.slope + lift);
        let slopes = self.slope.abs() + lift.abs() + grain;
        let terms = self.value.abs() + length.abs() * slopes;
        Self {
            elapsed: self.elapsed + length,
            value: self.value + (change + (self.bow * fall + self.quarter * drop)),
            slope: self.slope + (gain + (self.bow * speed + self.quarter * sag)),
            bow: self.bow * cos + self.quarter * sin,
            quarter: self.quarter * cos - self.bow * sin,
            lasting: self.lasting * decay,
            room: self.room + ROUNDING_TOLERANCE * (terms + strength * fall + self.lasting.abs()),
        }
    }

    fn before(&self, step: &FreeStep, shape: &FreeShape) -> Self {
        self.after(&step.reversed(), shape)
    }

    /// Value and slope of the parabola and a line that stands for the exponential.
    fn slow_part(&self, shape: &FreeShape, line: &Chord) -> (f64, f64) {
        let value = self.value + self.bow * shape.per_omega2;
        let slope = self.slope + self.quarter * (shape.omega * shape.per_omega2);
        (value + line.at(self.elapsed), slope + line.slope)
    }
}

/// The straight line that stands for the exponential.
#[derive(Clone, Copy)]
struct Chord {
    end: f64,
    value: f64,
    slope: f64,
}

impl Chord {
    /// A straight line that is nowhere below the exponential between the two places.
    fn above(from: &FreeParts, to: &FreeParts, rate: f64) -> Self {
        // At the right end it may have sunk below the smallest number: the left one has its sign.
        let slope = if from.lasting > 0.0 {
            (to.lasting - from.lasting) / (to.elapsed - from.elapsed)
        } else {
            -rate * to.lasting
        };
        Self { end: to.elapsed, value: to.lasting, slope }
    }

    fn at(&self, elapsed: f64) -> f64 {
        self.value + self.slope * (elapsed - self.end)
    }
}

/// The certificate of a long stretch of the guard, in steps of fixed length.
pub struct PiecewiseCertificate<'a> {
    shape: &'a FreeShape,
    steps: &'a Steps,
    /// The line above the exponential, once that has died out.
    line: Option<Chord>,
}

/// How high the harmonic's crests may be between two places.
struct Crests {
    /// How high a crest may be at the left place.
    here: f64,
    /// Anywhere between.
    most: f64,
    /// What the parts' sums may have rounded off.
    rounding: f64,
}

/// Pieces after which the stretch is left to divisions.
const MAX_PIECES: usize = 12;

/// The corridor of a guard that is negative inside.
const NEGATIVE_CORRIDOR: Corridor = Corridor { low: f64::NEG_INFINITY, high: 0.0 };

impl<'a> PiecewiseCertificate<'a> {
    /// A certificate for guards of this shape, with steps of these lengths.
    pub fn new(shape: &'a FreeShape, steps: &'a Steps) -> Self {
        Self { shape, steps, line: None }
    }

    /// What can be said about the excess between the two ends, which round it within `slack`. The
    /// parts may be far larger than their sum: a touch that only their rounding hides is left to
    /// shorter pieces, which are certified by evaluations alone.
    pub fn proof(self, left: PieceEnd, right: PieceEnd, ends: ThresholdEnds, slack: f64) -> Proof {
        /// The widest rounding room in which a touch is decided, in slacks.
        const MAX_TOUCH_SLACKS: f64 = 16.0;
        match self.verdict(left, right, ends) {
            (Proof::Touches, room) if room > MAX_TOUCH_SLACKS * slack => Proof::Open,
            (verdict, _) => verdict,
        }
    }

    /// What can be said about the excess between the two ends by their parts, and within which
    /// room.
    fn verdict(mut self, left: PieceEnd, right: PieceEnd, ends: ThresholdEnds) -> (Proof, f64) {
        let rate = self.shape.rate;
        let pushes = left.parts.lasting > 0.0;
        let decay_times = if pushes { MAX_PUSHING_DECAY_TIMES } else { MAX_PULLING_DECAY_TIMES };
        let length = right.parts.elapsed - left.parts.elapsed;
        let left_ends = ThresholdEnds { right: false, ..ends };
        if rate * self.steps.piece.length <= decay_times || rate * length <= decay_times {
            return self.between((left, left_ends), (right, ends.right));
        }
        let (settled, first) = if ends.left_double && self.parts_for_certain(&left.parts) {
            (left.parts.after(&self.steps.separation_interval, self.shape), Proof::Inside)
        } else {
            let life = if pushes { &self.steps.pushing } else { &self.steps.pulling };
            let settled = left.parts.after(life, self.shape);
            (settled, self.piece_verdict(&left, &self.end(settled), left_ends))
        };
        let room = settled.room;
        if first == Proof::Open {
            return (first, room);
        }
        let line = Chord::above(&settled, &right.parts, rate);
        // From here on the line stands for it.
        let (mut settled, mut right) = (settled, right);
        (settled.lasting, right.parts.lasting) = (0.0, 0.0);
        let mut orders = self.orders_with_line(&right.parts, &line);
        if ends.right {
            orders[0] = right.orders[0];
        }
        self.line = Some(line);
        let (rest, last_room) = self.between(
            (self.end(settled), ThresholdEnds::FREE),
            (PieceEnd { orders, ..right }, ends.right),
        );
        (first.max(rest), room.max(last_room))
    }

    /// Whether a flight that begins with value and slope zero stays inside until z has the value
    /// [`SEPARATION_DECAY_TIMES`](crate::flow::steps::SEPARATION_DECAY_TIMES): its guard is at most
    /// the largest force times d^2/2, less q0 (exp(-z) - 1 + z).
    fn parts_for_certain(&self, left: &FreeParts) -> bool {
        let FreeShape { curvature, strength, rate, .. } = *self.shape;
        -left.lasting * (rate * rate) * MIN_SLIDER_RETURN
            > (strength + curvature.max(0.0)) * FORCE_FACTOR
    }

    /// Goes from the left end until the amplitude takes over, then back from the right end.
    fn between(
        &self,
        (mut near, mut near_ends): (PieceEnd, ThresholdEnds),
        (mut far, mut is_root): (PieceEnd, bool),
    ) -> (Proof, f64) {
        let step = &self.steps.piece;
        let mut worst = Proof::Inside;
        let mut room = 0.0;
        for _ in 0..MAX_PIECES {
            room = near.parts.room.max(far.parts.room);
            let Crests { here, most, rounding } = self.crests(&near.parts, &far.parts);
            if most < -(room + rounding) {
                return (worst, room);
            }
            if far.parts.elapsed - near.parts.elapsed < MAX_LAST_STEP_RATIO * step.length {
                let last =
                    self.piece_verdict(&near, &far, ThresholdEnds { right: is_root, ..near_ends });
                return (worst.max(last), room);
            }
            let (left, right, ends);
            if here < -(room + rounding) {
                let next = self.end(far.parts.before(step, self.shape));
                (left, right, ends) =
                    (next, far, ThresholdEnds { right: is_root, ..ThresholdEnds::FREE });
                (far, is_root) = (next, false);
            } else {
                let next = self.end(near.parts.after(step, self.shape));
                (left, right, ends) = (near, next, near_ends);
                (near, near_ends) = (next, ThresholdEnds::FREE);
            }
            let verdict = self.piece_verdict(&left, &right, ends);
            // A crest that rounding hides stops no pieces short of the whole stretch.
            if verdict == Proof::Open || (verdict == Proof::Touches && most <= room) {
                let hidden = most <= room;
                return (if hidden { Proof::Touches } else { Proof::Open }, room);
            }
            worst = worst.max(verdict);
        }
        (Proof::Open, room)
    }

    /// How high the harmonic's crests may be.
    fn crests(&self, near: &FreeParts, far: &FreeParts) -> Crests {
        /// The sums of values, and of slopes over the length, round a few times. An evaluation's
        /// own room leaves that out: its parts have cancelled before they were rounded.
        const ROUNDING_TOLERANCE: f64 = 8.0 * f64::EPSILON;
        let FreeShape { curvature, grain, strength, per_omega2, rate, .. } = *self.shape;
        let line = self.line.unwrap_or_else(|| Chord::above(near, far, rate));
        let amplitude = strength * per_omega2;
        let (here, rising) = near.slow_part(self.shape, &line);
        let (there, falling) = far.slow_part(self.shape, &line);
        let mut most = here.max(there);
        if curvature < 0.0 && rising > 0.0 && falling < 0.0 {
            most = most.max(here - 0.5 * rising * rising / curvature);
        }
        let values = near.value.abs() + line.at(near.elapsed).abs();
        let values = values.max(far.value.abs() + line.at(far.elapsed).abs());
        let slopes = near.slope.abs().max(far.slope.abs()) + line.slope.abs() + grain;
        let over_length = (far.elapsed - near.elapsed) * slopes;
        let rounding = ROUNDING_TOLERANCE * (values + over_length + amplitude);
        Crests { here: here + amplitude, most: most + amplitude, rounding }
    }

    /// Whether the guard is proved to stay negative between these two ends of a piece.
    fn piece_verdict(&self, left: &PieceEnd, right: &PieceEnd, ends: ThresholdEnds) -> Proof {
        let FreeShape { strength, omega6, rate8, .. } = *self.shape;
        let lift = match self.line {
            None => left.parts.lasting.max(0.0) * rate8,
            Some(_) => 0.0,
        };
        let piece = Piece {
            left: left.orders,
            right: right.orders,
            length: right.parts.elapsed - left.parts.elapsed,
            eighth: (0.0, strength * omega6 + lift),
        };
        let slack = left.parts.room.max(right.parts.room);
        piece.verdict(&NEGATIVE_CORRIDOR, ends, slack)
    }

    fn end(&self, parts: FreeParts) -> PieceEnd {
        let orders = match &self.line {
            Some(line) => self.orders_with_line(&parts, line),
            None => {
                let rate = self.shape.rate;
                let [value, slope, bend, third] = self.orders_without_exponential(&parts);
                let fall = rate * parts.lasting;
                let turn = rate * fall;
                [value + parts.lasting, slope - fall, bend + turn, third - rate * turn]
            }
        };
        PieceEnd { orders, parts }
    }

    /// The orders with a line in place of the exponential.
    fn orders_with_line(&self, parts: &FreeParts, line: &Chord) -> [f64; 4] {
        let [value, slope, bend, third] = self.orders_without_exponential(parts);
        [value + line.at(parts.elapsed), slope + line.slope, bend, third]
    }

    /// The orders without the exponential.
    fn orders_without_exponential(&self, parts: &FreeParts) -> [f64; 4] {
        let FreeShape { omega, curvature, .. } = *self.shape;
        [parts.value, parts.slope, curvature + parts.bow, omega * parts.quarter]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;

    /// A sum rounds by the sizes of its terms: it is the same for a guard that rises to its right
    /// end as for one that falls from its left end.
    #[test]
    fn the_rounding_of_crests_has_no_direction() {
        let (omega, strength) = (0.7, 0.2);
        let steps = Steps::new(&Parameters { omega, ..Parameters::default() });
        let shape = FreeShape {
            curvature: 0.1,
            grain: 0.3,
            strength,
            omega,
            omega6: omega.powi(6),
            per_omega2: 1.0 / (omega * omega),
            rate: 1.0,
            rate8: 1.0,
        };
        let line = Some(Chord { end: 2.0, value: 0.0, slope: 0.0 });
        let certificate = PiecewiseCertificate { shape: &shape, steps: &steps, line };
        let at = |elapsed, slope| FreeParts {
            elapsed,
            value: -0.1,
            slope,
            bow: 0.0,
            quarter: 0.0,
            lasting: 0.0,
            room: 0.0,
        };
        let rounding =
            |from, to| certificate.crests(&at(0.0, from), &at(2.0, to)).rounding / f64::EPSILON;
        let expected = 8.0 * (0.1 + 2.0 * (5.0 + 0.3) + strength * shape.per_omega2);
        for (from, to) in [(5.0, 0.5), (-5.0, 0.5), (0.5, 5.0), (0.5, -5.0)] {
            let found = rounding(from, to);
            assert!((found - expected).abs() < 1e-12 * expected, "{from} {to}: {found} {expected}");
        }
    }
}
