//! The proof that a guard stays inside its corridor between two evaluations.
//!
//! Let H be the polynomial of degree seven that shares the guard's value and three derivatives at
//! both ends of a piece of length L. Then G - H = G8(z) s^4 (L - s)^4 / 8! for some z in the piece.
//! In the Bernstein basis of degree eight, s^4 (L - s)^4 is L^8/70 times the middle member alone,
//! so with M <= G8 <= N in the piece the coefficients of H, with M L^8/2822400 (N L^8/2822400)
//! added to the middle one, bound G from below (above): a polynomial lies within the hull of its
//! Bernstein coefficients. If all of them are inside the corridor, so is the guard. The end
//! coefficients are the guard's own values: where a guard is known to start or to end on a
//! threshold, they may equal it. With L small the hull is as narrow as the guard itself, so halving
//! always decides, up to rounding.

use crate::crossing::{Corridor, Proof, ThresholdEnds};
use crate::flow::Point;
use crate::numeric::real::Real;

/// 8! C(8, 4): the middle Bernstein coefficient of s^4 (1 - s)^4/8! is its inverse, and all others
/// are zero.
pub const REMAINDER_DIVISOR: f64 = 2_822_400.0;

/// The guard, or something that bounds it, on a piece.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Value and three derivatives at the left end.
    pub left: [f64; 4],
    /// Value and three derivatives at the right end.
    pub right: [f64; 4],
    /// Length of the piece.
    pub length: f64,
    /// A lower and an upper bound of the eighth derivative inside; zero on a side where the
    /// corridor is open.
    pub eighth: (f64, f64),
}

impl Piece {
    /// The guard of a phase between two evaluations.
    #[inline(always)]
    pub fn between(left: &Point<f64>, right: &Point<f64>, eighth: (f64, f64)) -> Self {
        let length = right.elapsed - left.elapsed;
        Self { left: left.guard.orders, right: right.guard.orders, length, eighth }
    }

    /// Checks all Bernstein coefficients against the corridor, with `slack` for rounding.
    #[inline(always)]
    pub fn verdict(&self, corridor: &Corridor, ends: ThresholdEnds, slack: f64) -> Proof {
        let (pairs, middle) = self.coefficients();
        let mut excesses = pairs.map(|pair| pair.map(|coefficient| corridor.excess(coefficient)));
        let (lowest, highest) = self.bounds(middle);
        let (up, down) = (highest - corridor.high, corridor.low - lowest);
        if ends.left {
            excesses[0][0] = f64::NEG_INFINITY;
        }
        if ends.left_double {
            excesses[1][0] = f64::NEG_INFINITY;
        }
        if ends.right {
            excesses[0][1] = f64::NEG_INFINITY;
            // Next to a root the sign alone is asked for: the slope there is known to be outward.
            if excesses[1][1] < 0.0 {
                excesses[1][1] = f64::NEG_INFINITY;
            }
        }
        let worst = largest(excesses, up.larger(down));
        let size = largest(pairs.map(|pair| pair.map(f64::abs)), middle.abs());
        let slack = slack + f64::EPSILON * size;
        // The middle coefficient holds all orders of both ends: any NaN is one there.
        if worst < -slack && !middle.is_nan() {
            Proof::Inside
        } else if worst <= slack && !middle.is_nan() {
            Proof::Touches
        } else {
            Proof::Open
        }
    }

    /// Whether the guard stays inside, where the hull of the whole piece is too wide to tell: the
    /// bounding polynomials are divided at their crests, which takes no evaluation and narrows the
    /// hull.
    #[cold]
    pub fn stays_inside_in_parts(
        &self,
        corridor: &Corridor,
        ends: ThresholdEnds,
        slack: f64,
    ) -> bool {
        let (pairs, middle) = self.coefficients();
        let (lowest, highest) = self.bounds(middle);
        let (below, above) = (in_order(pairs, lowest), in_order(pairs, highest));
        let size = below.iter().chain(&above).fold(0.0_f64, |size, c| size.larger(c.abs()));
        // Eight roundings more for each division.
        let slack = slack + 8.0 * f64::from(HULL_DIVISIONS + 1) * f64::EPSILON * size;
        let over = Excess(above.map(|coefficient| coefficient - corridor.high));
        let under = Excess(below.map(|coefficient| corridor.low - coefficient));
        over.is_negative(ends, slack, HULL_DIVISIONS)
            && under.is_negative(ends, slack, HULL_DIVISIONS)
    }

    /// The middle coefficients of the polynomials that bound the guard from below and from above.
    #[inline]
    fn bounds(&self, middle: f64) -> (f64, f64) {
        let square = self.length * self.length;
        let scale = square * square * (square * square) * (1.0 / REMAINDER_DIVISOR);
        let (least, most) = self.eighth;
        (middle + least.smaller(0.0) * scale, middle + most.larger(0.0) * scale)
    }

    /// Bernstein coefficients of degree eight of the Hermite interpolant.
    #[inline]
    pub fn coefficients(&self) -> Coefficients<f64> {
        coefficients(&self.left, &self.right, self.length)
    }
}

/// Bernstein coefficients of degree eight: in pairs from both ends inwards, which are computed side
/// by side, and the middle one.
pub type Coefficients<T> = ([[T; 2]; 4], T);

/// The coefficients of the Hermite interpolant of a guard that has these values and derivatives at
/// the ends of a piece.
#[inline(always)]
pub fn coefficients<T: Real>(left: &[T; 4], right: &[T; 4], length: T) -> Coefficients<T> {
    let seventh = length * length.broadcast(1.0 / 7.0);
    let square = seventh * length * length.broadcast(1.0 / 6.0);
    let cube = square * (length * length.broadcast(1.0 / 5.0));
    let scaled = |[value, slope, bend, third]: [T; 4], [seventh, square, cube]: [T; 3]| {
        [value, slope * seventh, bend * square, third * cube]
    };
    interpolant(scaled(*left, [seventh, square, cube]), scaled(*right, [-seventh, square, -cube]))
}

/// The coefficients from the derivatives at both ends times L/7, L^2/42 and L^3/210, L being the
/// length, negative at the right end.
#[inline(always)]
pub fn interpolant<T: Real>(left: [T; 4], right: [T; 4]) -> Coefficients<T> {
    let [a, b, c, d] = next_to_an_end(left);
    let [h, g, f, e] = next_to_an_end(right);
    // Degree seven, raised to eight.
    let pairs = [
        [a, h],
        [mix(a, b, 0.875), mix(h, g, 0.875)],
        [mix(b, c, 0.75), mix(g, f, 0.75)],
        [mix(c, d, 0.625), mix(f, e, 0.625)],
    ];
    (pairs, d.broadcast(0.5) * (d + e))
}

/// The four coefficients of degree seven next to an end, from value and scaled derivatives there.
#[inline(always)]
fn next_to_an_end<T: Real>([value, first, second, third]: [T; 4]) -> [T; 4] {
    [
        value,
        value + first,
        value + value.broadcast(2.0).times_plus(first, second),
        value + value.broadcast(3.0).times_plus(first + second, third),
    ]
}

/// A share of the way from one number to another.
#[inline(always)]
fn mix<T: Real>(from: T, to: T, share: f64) -> T {
    from.broadcast(1.0 - share).times_plus(from, from.broadcast(share) * to)
}

/// The number of times that a bounding polynomial is divided: each time its hull comes four times
/// nearer to it.
const HULL_DIVISIONS: i32 = 3;

/// The Bernstein coefficients of a bounding polynomial's excess.
struct Excess([f64; 9]);

impl Excess {
    fn is_negative(&self, ends: ThresholdEnds, slack: f64, divisions: i32) -> bool {
        let ThresholdEnds { left, left_double, right } = ends;
        let known = |i: usize| match i {
            0 => left,
            1 => left_double,
            7 => right && self.0[7] < 0.0,
            8 => right,
            _ => false,
        };
        // Written so that a NaN is not negative.
        let fails = |i: &usize| !(known(*i) || self.0[*i] < -slack);
        let crest = (0..9).filter(fails).max_by(|i, j| self.0[*i].total_cmp(&self.0[*j]));
        let Some(crest) = crest else { return true };
        if divisions == 0 || fails(&0) || fails(&8) {
            return false;
        }
        let (before, after) = divided(self.0, (crest as f64 / 8.0).clamp(0.25, 0.75));
        Self(before).is_negative(ThresholdEnds { right: false, ..ends }, slack, divisions - 1)
            && Self(after).is_negative(
                ThresholdEnds { right, ..ThresholdEnds::FREE },
                slack,
                divisions - 1,
            )
    }
}

/// The coefficients from left to right.
pub fn in_order<T: Real>([a, b, c, d]: [[T; 2]; 4], middle: T) -> [T; 9] {
    [a[0], b[0], c[0], d[0], middle, d[1], c[1], b[1], a[1]]
}

/// De Casteljau's division at a share of the length, where the later part begins with the value.
///
/// It goes point by point: degree by degree, the points would be stored in pairs and loaded again
/// shifted by one, for which processors wait.
fn divided(points: [f64; 9], place: f64) -> ([f64; 9], [f64; 9]) {
    let (mut before, mut after) = (points, points);
    for (end, point) in points.into_iter().enumerate() {
        let mut latest = point;
        for of_a_degree in after[9 - end..].iter_mut().rev() {
            let left = std::mem::replace(of_a_degree, latest);
            latest = left + place * (latest - left);
        }
        (before[end], after[8 - end]) = (latest, latest);
    }
    (before, after)
}

/// The largest of four pairs and one more.
#[inline]
fn largest(pairs: [[f64; 2]; 4], middle: f64) -> f64 {
    let side_by_side = |a: [f64; 2], b: [f64; 2]| [a[0].larger(b[0]), a[1].larger(b[1])];
    let [a, b, c, d] = pairs;
    let [left, right] = side_by_side(side_by_side(a, b), side_by_side(c, d));
    left.larger(right).larger(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_and_the_eighth_power_are_divided_as_they_are_known_to_be() {
        let place = 0.25;
        let numbers: [f64; 9] = std::array::from_fn(|n| n as f64);
        let (before, after) = divided(numbers.map(|n| n / 8.0), place);
        assert_eq!(before, numbers.map(|n| place * n / 8.0));
        assert_eq!(after, numbers.map(|n| place + (1.0 - place) * n / 8.0));

        let mut eighth_power = [0.0; 9];
        eighth_power[8] = 1.0;
        let (before, after) = divided(eighth_power, place);
        let power = |n: f64| place.powi(8 - n as i32);
        assert_eq!(before, numbers.map(|n| if n == 8.0 { power(0.0) } else { 0.0 }));
        assert_eq!(after, numbers.map(power));
    }
}
