//! Sine, cosine and exponential of intervals, by Taylor's series with its remainder.

use crate::ball::Ball;
use percuss::TwoWord;

/// Terms of every series: the most that one here needs.
const TERMS: usize = 24;

/// 1/n!
pub const INVERSE_FACTORIALS: [Ball; TERMS] = {
    let mut table = [Ball::ONE; TERMS];
    let mut n = 1;
    while n < TERMS {
        table[n] = table[n - 1].over(Ball::exact(n as f64));
        n += 1;
    }
    table
};

/// pi/2; its third word is -1.5e-33.
const QUARTER_TURN: Ball =
    Ball::words(TwoWord { high: std::f64::consts::FRAC_PI_2, low: 6.123_233_995_736_766e-17 })
        .widened(2e-33);

/// ln 2; its third word is 5.7e-34.
const LN_2: Ball =
    Ball::words(TwoWord { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 })
        .widened(1e-33);

/// More turns are not taken off: nothing is known of such an angle.
const MAX_ANGLE: f64 = 1e12;

/// Sine and cosine.
#[must_use]
pub fn sin_cos(x: Ball) -> (Ball, Ball) {
    const HALVINGS: usize = 3;
    // Written so that a NaN knows nothing.
    if !(x.size() < MAX_ANGLE) {
        let unknown = Ball::ZERO.widened(f64::NAN);
        return (unknown, unknown);
    }
    let quarters = (x.about() / std::f64::consts::FRAC_PI_2).round();
    let rest = x - QUARTER_TURN * Ball::exact(quarters);
    let (mut sin, mut cos_less_1) = near_zero(rest.scaled(1.0 / (1 << HALVINGS) as f64));
    for _ in 0..HALVINGS {
        // sin 2x = 2 sin x cos x, cos 2x - 1 = -2 sin^2 x
        let twice = sin.scaled(2.0);
        (sin, cos_less_1) = (twice + twice * cos_less_1, -(twice * sin));
    }
    let cos = Ball::ONE + cos_less_1;
    match (quarters as i64).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// sin x and cos x - 1 for |x| <= 0.1 or so.
fn near_zero(x: Ball) -> (Ball, Ball) {
    /// The next term is 0.1^18/19! = 8e-36 of the first.
    const LAST_TERM: usize = 8;
    let square = x.square();
    let (mut s, mut c) = (Ball::ZERO, Ball::ZERO);
    for k in (1..=LAST_TERM).rev() {
        s = square * (INVERSE_FACTORIALS[2 * k + 1] - s);
        c = square * (INVERSE_FACTORIALS[2 * k + 2] - c);
    }
    // The series alternate: what is left out is less than its first term.
    let left_out =
        power(square.size(), LAST_TERM + 1) * INVERSE_FACTORIALS[2 * LAST_TERM + 3].size();
    let sin = x - x * s;
    let cos_less_1 = square * (c - Ball::exact(0.5));
    let more = left_out * 1.000_001;
    (sin.widened(more * x.size()), cos_less_1.widened(more * square.size()))
}

/// exp(x) - 1, without cancellation for small x; of x above 700 nothing is known.
#[must_use]
pub fn exp_less_1(x: Ball) -> Ball {
    match scaled_growth(x) {
        Some((grown, 1.0)) => grown,
        Some((grown, scale)) => grown.scaled(scale) + (Ball::exact(scale) - Ball::ONE),
        None => -Ball::ONE + underflowed_exponential(x),
    }
}

/// exp(x); of x above 700 nothing is known.
#[must_use]
pub fn exp(x: Ball) -> Ball {
    scaled_growth(x).map_or_else(
        || underflowed_exponential(x),
        |(grown, scale)| (Ball::ONE + grown).scaled(scale),
    )
}

/// exp(x) for x so far from zero that it is no number one can use.
fn underflowed_exponential(x: Ball) -> Ball {
    /// An upper bound of exp(x) for x below -690.
    const MAX_UNDERFLOW: f64 = 1e-299;
    Ball::ZERO.widened(if x.upper() < -690.0 { MAX_UNDERFLOW } else { f64::NAN })
}

/// exp(x) = (1 + grown) scale, where the scale is a power of two.
fn scaled_growth(x: Ball) -> Option<(Ball, f64)> {
    const HALVINGS: usize = 4;
    const MAX_ARGUMENT: f64 = 700.0;
    // Written so that a NaN is none.
    if !(x.size() < MAX_ARGUMENT) {
        return None;
    }
    let doublings = (x.about() / std::f64::consts::LN_2).round();
    let rest = x - LN_2 * Ball::exact(doublings);
    let mut grown = grown_a_little(rest.scaled(1.0 / (1 << HALVINGS) as f64));
    for _ in 0..HALVINGS {
        grown = grown * (grown + Ball::exact(2.0));
    }
    Some((grown, f64::from_bits(((1023 + doublings as i64) as u64) << 52)))
}

/// exp(x) - 1 for |x| <= 0.03 or so.
fn grown_a_little(x: Ball) -> Ball {
    /// The next term is 0.03^14/15! = 4e-34 of the first.
    const LAST_TERM: usize = 14;
    let mut sum = INVERSE_FACTORIALS[LAST_TERM];
    for k in (1..LAST_TERM).rev() {
        sum = INVERSE_FACTORIALS[k] + x * sum;
    }
    // Lagrange's remainder: exp of at most 1/8 times the first term that is left out.
    let left_out = power(x.size(), LAST_TERM + 1) * INVERSE_FACTORIALS[LAST_TERM + 1].size();
    let small = x.size() < 0.125;
    (x * sum).widened(if small { left_out * 1.2 } else { f64::NAN })
}

/// x^n for x >= 0, not too small by more than a few roundings.
fn power(x: f64, n: usize) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x, sin x, cos x and exp x, computed with 70 digits (mpmath) and cut to two words; no
    /// exponential where it is above 700.
    const KNOWN_VALUES: [[(f64, f64); 4]; 8] = [
        [
            (0.001, 0.0),
            (0.0009999998333333417, 5.670638989736153e-21),
            (0.9999995000000417, -7.831485455398128e-18),
            (1.0010005001667084, -4.290842058948394e-17),
        ],
        [
            (0.75, 0.0),
            (0.6816387600233341, 4.410467313197903e-17),
            (0.7316888688738209, -1.0475824306512768e-17),
            (2.117000016612675, -1.1571006249440234e-16),
        ],
        [
            (-1.0, 0.0),
            (-0.8414709848078965, -1.776845092935536e-18),
            (0.5403023058681398, -4.760954612604417e-17),
            (0.36787944117144233, -1.2428753672788363e-17),
        ],
        [
            (3.0, 0.0),
            (0.1411200080598672, 8.577269787017502e-18),
            (-0.9899924966004454, -4.2060261566099734e-17),
            (20.085536923187668, -1.8275625525512858e-16),
        ],
        [
            (-37.25, 0.0),
            (0.4341656243337532, -2.17482609784034e-17),
            (0.9008330648055067, -6.795449470699078e-19),
            (6.64554417291507e-17, -5.891784267265031e-34),
        ],
        [
            (1000.5, 0.0),
            (0.9952739571052135, 5.1293231726011145e-17),
            (0.09710690144438526, 3.9534046844460945e-18),
            (0.0, 0.0),
        ],
        [
            (-612.75, 0.0),
            (0.13898119413134707, 1.0514723396245068e-17),
            (-0.9902950205256132, -2.803082260907173e-17),
            (7.692300006801093e-267, 3.59468943606463e-283),
        ],
        [
            (680.0, 0.0),
            (0.9880409219176677, -4.865741788961323e-17),
            (0.15419188245846607, -1.1595039644277922e-17),
            (2.090488073610356e+295, 1.6738636682279071e+279),
        ],
    ];

    /// Whether the ball holds the value to which these words are within 2^-105, and little else.
    fn holds(ball: Ball, (high, low): (f64, f64)) {
        let value = Ball::words(TwoWord { high, low });
        let off = (ball - value).size();
        assert!((ball - value).lower() <= 1e-31 * high.abs(), "{ball:?} {value:?}");
        assert!((ball - value).upper() >= -1e-31 * high.abs(), "{ball:?} {value:?}");
        assert!(off <= 1e-26 * (1e-3 + high.abs()), "{ball:?} {value:?} {off:e}");
    }

    #[test]
    fn known_values_are_held() {
        for [(x, _), sin, cos, power] in KNOWN_VALUES {
            let (s, c) = sin_cos(Ball::exact(x));
            holds(s, sin);
            holds(c, cos);
            if x < 700.0 {
                holds(exp(Ball::exact(x)), power);
            }
        }
    }

    #[test]
    fn identities_are_held_at_many_places() {
        let mut x = -60.0;
        while x < 60.0 {
            let ball = Ball::exact(x);
            let (s, c) = sin_cos(ball);
            let one =
                [s.square() + c.square(), exp(ball) * exp(-ball), exp(ball) - exp_less_1(ball)];
            for (value, size) in one.into_iter().zip([1.0, 1.0, 1.0 + x.exp()]) {
                let off = value - Ball::ONE;
                assert!(off.lower() <= 0.0 && off.upper() >= 0.0, "{x}: {value:?}");
                assert!(off.size() <= 1e-27 * size, "{x}: {value:?}");
            }
            // The library's last digit.
            let near = |ball: Ball, value: f64| {
                let off = (ball - Ball::exact(value)).size();
                assert!(off <= f64::EPSILON * value.abs().max(1e-300), "{x}: {ball:?} {value}");
            };
            near(s, x.sin());
            near(c, x.cos());
            near(exp(ball), x.exp());
            near(exp_less_1(ball), x.exp_m1());
            x += 0.017_3;
        }
    }

    #[test]
    fn of_what_is_not_finite_nothing_is_known() {
        for x in [f64::NAN, f64::INFINITY, 1e300] {
            let (s, _) = sin_cos(Ball::exact(x));
            assert!(s.upper().is_nan() && exp(Ball::exact(x)).upper().is_nan());
        }
        assert!(exp(Ball::exact(-1e300)).upper() <= 1e-298);
    }
}
