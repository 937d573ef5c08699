//! What the library's sine, cosine, exponential and remainders promise (docs/ROUNDING.md), measured
//! against intervals.

use percuss::insides::remainders::{circular, decay};
use percuss::number::Number;
use percuss_intervals::ball::Ball;
use percuss_intervals::functions::{exp, exp_less_1, sin_cos};
use percuss_intervals::regimes::Chance;

/// Arguments a range.
const DRAWS: usize = 200_000;

/// How far a value is from what the ball holds, in units of `unit`.
fn error(value: f64, exact: Ball, unit: f64) -> f64 {
    (Ball::exact(value) - exact).size() / unit
}

/// One unit in the last place.
fn ulp(value: f64) -> f64 {
    value.abs().next_up() - value.abs()
}

fn worst_error(seed: u64, mut draw: impl FnMut(f64) -> f64) -> f64 {
    let mut chance = Chance::new(seed);
    (0..DRAWS).map(|_| draw(chance.unit())).fold(0.0, f64::max)
}

/// Half a unit of the value, and a tenth of a unit of 1.
#[test]
fn sines_and_cosines_by_table_and_by_libm() {
    let measure = |x: f64| {
        let ((s, c), (sine, cosine)) = (x.sin_cos_by_library(), sin_cos(Ball::exact(x)));
        let unit = |value: f64| 0.5 * ulp(value) + 0.1 * f64::EPSILON;
        error(s, sine, unit(s)).max(error(c, cosine, unit(c)))
    };
    let near = worst_error(1, |u| measure((u - 0.5) * 20.0));
    let far = worst_error(2, |u| measure((u - 0.5) * 1.2e5));
    let libm = worst_error(3, |u| {
        let x = 6e4 + u * 1e9;
        let ((s, c), (sine, cosine)) = (x.sin_cos_by_library(), sin_cos(Ball::exact(x)));
        error(s, sine, ulp(s)).max(error(c, cosine, ulp(c)))
    });
    println!("table: {near:.3} to 10, {far:.3} to 6e4, of half a unit and a tenth of one of 1");
    println!("libm: {libm:.3} units in the last place");
    assert!(near <= 1.0 && far <= 1.0 && libm <= 1.0, "{near} {far} {libm}");
}

#[test]
fn exponentials_by_table_and_by_libm() {
    let units = |x: f64| {
        let value = Number::exp(x);
        error(value, exp(Ball::exact(x)), ulp(value))
    };
    let near = worst_error(4, |u| units(-u * 40.0));
    let far = worst_error(5, |u| units(-u * 690.0));
    println!("table: {near:.3} units to 40, {far:.3} to 690");
    assert!(near <= 0.53 && far <= 0.53, "{near} {far}");
}

/// Relative to themselves while the argument is small, to their largest term beyond.
#[test]
fn remainders() {
    let eps = f64::EPSILON;
    let (mut turn, mut shrink) = (0.0_f64, 0.0_f64);
    worst_error(6, |u| {
        let x = 50.0 * u * u * u;
        let (ball, it) = (Ball::exact(x), circular(x));
        let (sin, cos) = sin_cos(ball);
        let big = |value: f64, terms: f64| eps * if x < 1.0 { value.abs() } else { terms };
        // Near zero the interval of sin x - x cancels, and says nothing.
        if x > 1e-3 {
            turn = turn
                .max(error(it.sin_minus_x, sin - ball, big(it.sin_minus_x, 1.0 + x)))
                .max(error(it.cos_minus_1, cos - Ball::ONE, big(it.cos_minus_1, 2.0)));
        }
        let it = decay(x);
        let big = |value: f64, terms: f64| eps * if x < 0.5 { value.abs() } else { terms };
        if x > 1e-3 {
            let minus_1 = exp_less_1(-ball);
            shrink = shrink.max(error(it.minus_1, minus_1, big(it.minus_1, 1.0))).max(error(
                it.remainder,
                minus_1 + ball,
                big(it.remainder, 1.0 + x),
            ));
        }
        0.0
    });
    println!("sine and cosine: {turn:.3} eps, exponential: {shrink:.3} eps");
    assert!(turn <= 3.0 && shrink <= 3.0, "{turn} {shrink}");
}

/// The closed forms' own sine and cosine; f64 has another of that name.
trait ByLibrary {
    fn sin_cos_by_library(self) -> (f64, f64);
}

impl ByLibrary for f64 {
    fn sin_cos_by_library(self) -> (f64, f64) {
        Number::sin_cos(self)
    }
}
