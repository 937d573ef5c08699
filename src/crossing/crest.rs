//! Where a piece is divided that its certificate leaves open.

use crate::crossing::Corridor;
use crate::crossing::certificate::{Piece, in_order};

impl Piece {
    /// The time at which a piece is divided: at the place of the largest excess, so that a near
    /// miss is met at its crest, where both halves are easily certified.
    pub fn worst_place(&self, from: f64, corridor: &Corridor) -> f64 {
        let step =
            self.crest_next_to_an_end(corridor).unwrap_or_else(|| self.sampled_crest(corridor));
        let place = from + step;
        let inside = place > from && place < from + self.length;
        if inside { place } else { from + 0.5 * self.length }
    }

    /// Makes one Newton step on the slope, where an end is already near a crest of the excess.
    fn crest_next_to_an_end(&self, corridor: &Corridor) -> Option<f64> {
        const MAX_STEP_SHARE: f64 = 0.1; // of the piece
        let newton = |orders: &[f64; 4]| {
            let [value, slope, bend, _] = *orders;
            let outward = if value - corridor.high >= corridor.low - value { 1.0 } else { -1.0 };
            (bend * outward < 0.0).then(|| -slope / bend)
        };
        let near = MAX_STEP_SHARE * self.length;
        let from_left = newton(&self.left).filter(|step| *step > 0.0 && *step < near);
        let from_right = newton(&self.right).filter(|step| *step < 0.0 && *step > -near);
        from_left.or(from_right.map(|step| self.length + step))
    }

    fn sampled_crest(&self, corridor: &Corridor) -> f64 {
        let (pairs, middle) = self.coefficients();
        let mut values = [0.0; CREST_PLACES];
        for (weights, coefficient) in BERNSTEIN_AT_PLACES.iter().zip(in_order(pairs, middle)) {
            for (value, weight) in values.iter_mut().zip(weights) {
                *value += weight * coefficient;
            }
        }
        let excesses = values.map(|value| corridor.excess(value));
        let places = 0..CREST_PLACES;
        let crest = places.max_by(|i, j| excesses[*i].total_cmp(&excesses[*j]));
        self.length * crest.map_or(0.5, place_of_crest)
    }
}

/// The number of places of a piece that are compared when its crest is looked for, in steps of a
/// 32nd of its length; none is next to an end.
const CREST_PLACES: usize = 27;

/// The share of a piece's length at which one of those places is.
const fn place_of_crest(index: usize) -> f64 {
    (index + 3) as f64 / 32.0
}

/// The Bernstein polynomials of degree eight at those places, a row a polynomial.
const BERNSTEIN_AT_PLACES: [[f64; CREST_PLACES]; 9] = {
    const BINOMIALS: [f64; 9] = [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0];
    let mut rows = [[0.0; CREST_PLACES]; 9];
    let mut order = 0;
    while order < 9 {
        let mut index = 0;
        while index < CREST_PLACES {
            let place = place_of_crest(index);
            let mut weight = BINOMIALS[order];
            let mut factors = 0;
            while factors < 8 {
                weight *= if factors < order { place } else { 1.0 - place };
                factors += 1;
            }
            rows[order][index] = weight;
            index += 1;
        }
        order += 1;
    }
    rows
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_one_are_met_at_every_place() {
        for index in 0..CREST_PLACES {
            let column = BERNSTEIN_AT_PLACES.map(|row| row[index]);
            let sum: f64 = column.iter().sum();
            let first: f64 = column.iter().zip(0..).map(|(it, n)| it * f64::from(n) / 8.0).sum();
            // Eight roundings of factors and eight of sums, all of one sign.
            let room = 16.0 * f64::EPSILON;
            assert!((sum - 1.0).abs() <= room, "{index}: {sum}");
            assert!((first - place_of_crest(index)).abs() <= room, "{index}: {first}");
        }
    }

    #[test]
    fn a_piece_is_divided_at_the_place_of_its_crest() {
        for index in 0..CREST_PLACES {
            let crest = place_of_crest(index);
            // -(s - crest)^4, which has no Newton step on its slope next to an end.
            let end = |s: f64| {
                let off = s - crest;
                [-off.powi(4), -4.0 * off.powi(3), -12.0 * off * off, -24.0 * off]
            };
            let piece = Piece { left: end(0.0), right: end(1.0), length: 1.0, eighth: (0.0, 0.0) };
            let corridor = Corridor { low: f64::NEG_INFINITY, high: 0.0 };
            assert_eq!(piece.sampled_crest(&corridor), crest, "{index}");
        }
    }
}
