//! A guard's series on a piece in Bernstein's form: a polynomial lies within the hull of these
//! coefficients.

use crate::ball::Ball;
use crate::guard::{Expansion, ORDERS};

/// A guard's series on a piece: its terms over the binomials, as Bernstein's form needs them.
pub(crate) struct Piecewise {
    pub terms: [Ball; ORDERS + 1],
    pub remainder: f64,
    pub reduced: bool,
    /// Between what the quick exponential lies that the terms leave out; zero where they do not.
    pub range: (f64, f64),
    /// Range of the polynomial's slope, in the unit of the slopes' coefficients.
    pub slope_range: (f64, f64),
}

/// (n - k)!/n! for n = ORDERS.
const FACTORIAL_RATIOS: [Ball; ORDERS + 1] = {
    let mut shares = [Ball::ONE; ORDERS + 1];
    let mut k = 1;
    while k <= ORDERS {
        shares[k] = shares[k - 1].over(Ball::exact((ORDERS + 1 - k) as f64));
        k += 1;
    }
    shares
};

impl Piecewise {
    pub(crate) fn full(here: &Expansion, length: Ball) -> Self {
        let (terms, remainder) = terms(&here.whole, here.bounds[1], length);
        let none = (0.0, 0.0);
        Self { terms, remainder, reduced: false, range: none, slope_range: none }
    }

    pub(crate) fn reduced(here: &Expansion, length: Ball) -> Self {
        let (terms, remainder) = terms(&here.smooth, here.bounds[0], length);
        let slope = -(here.quick * here.rate) * length * FACTORIAL_RATIOS[1];
        let slope_range = with_zero(slope);
        Self { terms, remainder, reduced: true, range: here.quick_range(), slope_range }
    }

    /// The first half of the piece.
    pub(crate) fn halve(&mut self) {
        let mut power = 1.0;
        for term in &mut self.terms {
            *term = term.scaled(power);
            power *= 0.5;
        }
        self.remainder *= 2.0 * power;
    }
}

/// The series' terms over the binomials, and a bound of its remainder.
fn terms(orders: &[Ball; ORDERS], bound: f64, length: Ball) -> ([Ball; ORDERS + 1], f64) {
    let mut terms = [Ball::ZERO; ORDERS + 1];
    let mut power = Ball::ONE;
    for (k, order) in orders.iter().enumerate() {
        terms[k] = if k == 0 { *order } else { *order * power * FACTORIAL_RATIOS[k] };
        power = power * length;
    }
    (terms, (Ball::exact(bound) * power * FACTORIAL_RATIOS[ORDERS]).size())
}

/// The bounds of all coefficients.
pub(crate) struct Between {
    pub low: f64,
    pub high: f64,
    /// So many of the first ones are known to lie on the one and on the other.
    pub zeros: [usize; 2],
}

/// Whether all coefficients in Bernstein's form, the last one with the remainder, lie between the
/// bounds.
pub(crate) fn holds(terms: &[Ball], remainder: f64, bounds: &Between) -> bool {
    let Between { low, high, zeros } = *bounds;
    let last = terms.len() - 1;
    let mut sharp = false;
    for (i, (value, error)) in rough_terms(terms).into_iter().take(last + 1).enumerate() {
        let error = if i == last { (error + remainder).next_up() } else { error };
        let (most, least) = ((value + error).next_up(), (value - error).next_down());
        let above = i < zeros[1] || most < high;
        let below = i < zeros[0] || least > low;
        if above && below {
            continue;
        }
        // Certain to fail, or not known in one word.
        if (i >= zeros[1] && least >= high) || (i >= zeros[0] && most <= low) {
            return false;
        }
        sharp = true;
    }
    !sharp || holds_in_two_words(terms, remainder, bounds)
}

/// Decides in two words what one word leaves open.
#[cold]
fn holds_in_two_words(terms: &[Ball], remainder: f64, bounds: &Between) -> bool {
    let Between { low, high, zeros } = *bounds;
    let last = terms.len() - 1;
    bernstein(terms).iter().take(last + 1).enumerate().all(|(i, it)| {
        let it = if i == last { it.widened(remainder) } else { *it };
        (i < zeros[1] || high == f64::INFINITY || (it - Ball::exact(high)).upper() < 0.0)
            && (i < zeros[0] || low == f64::NEG_INFINITY || (it - Ball::exact(low)).lower() > 0.0)
    })
}

/// Coefficients in Bernstein's form from a series' terms over the binomials: sums along Pascal's
/// triangle.
fn bernstein(terms: &[Ball]) -> [Ball; ORDERS + 1] {
    let mut row = [Ball::ZERO; ORDERS + 1];
    row[..terms.len()].copy_from_slice(terms);
    let mut hull = row;
    for i in 0..terms.len() {
        hull[i] = row[0];
        for k in 0..terms.len() - 1 - i {
            row[k] = row[k] + row[k + 1];
        }
    }
    hull
}

/// Coefficients in one word, each with how far members may be from it.
fn rough_terms(terms: &[Ball]) -> [(f64, f64); ORDERS + 1] {
    let mut row = [(0.0, 0.0); ORDERS + 1];
    for (place, term) in row.iter_mut().zip(terms) {
        *place = term.word_and_error();
    }
    let mut hull = row;
    for i in 0..terms.len() {
        hull[i] = row[0];
        for k in 0..terms.len() - 1 - i {
            let ((a, a_error), (b, b_error)) = (row[k], row[k + 1]);
            let sum = a + b;
            // An eps is two roundings of the sum, and eight of the errors are more than they take.
            let errors = (a_error + b_error) * (1.0 + 4.0 * f64::EPSILON);
            row[k] = (sum, (errors + f64::EPSILON * sum.abs()) * (1.0 + f64::EPSILON));
        }
    }
    hull
}

/// Bounds of a ball and zero; a NaN stays one.
fn with_zero(ball: Ball) -> (f64, f64) {
    let (least, most) = (ball.lower(), ball.upper());
    (if least > 0.0 { 0.0 } else { least }, if most < 0.0 { 0.0 } else { most })
}

impl Expansion {
    /// Between what the quick exponential lies from here on.
    pub(crate) fn quick_range(&self) -> (f64, f64) {
        with_zero(self.quick)
    }
}
