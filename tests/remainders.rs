//! The remainder functions in f64 against 106 bits.
//!
//! `cargo test --release --test library remainders:: -- --nocapture` prints what each reaches.

use crate::support::random::Draw;
use percuss::affine::DoubleDouble;
use percuss::insides::remainders::{Circular, Decay, circular, circular_of, decay};
use percuss::number::Number;

const DRAWS: usize = 200_000;

/// Relative error of a series in eps: its two leading terms and the product before them.
const SERIES_EPS: f64 = 2.0;

/// Absolute error of sine, cosine and exponential, and of sums with the argument (in eps of the
/// argument) where no series is used: libm's one unit in the last place, doubled by the angle's
/// formula.
const FUNCTION_EPS: f64 = 3.0;

/// The smallest argument: below it the remainders leave the range in which f64 is relatively exact.
const MIN_ARGUMENT: f64 = 1e-100;

type Real = DoubleDouble;

fn relative(found: f64, exact: Real) -> f64 {
    ((Real::exact(found) - exact) / exact).to_f64().abs() / f64::EPSILON
}

fn absolute_error(found: f64, exact: Real) -> f64 {
    (Real::exact(found) - exact).to_f64().abs() / f64::EPSILON
}

/// x^n/n! - x^(n + s)/(n + s)! ... with signs alternating by `sign`: a truth that shares no code
/// with the library beyond the number type, and takes twice the terms.
fn power_series(x: Real, first: usize, stride: usize, sign: f64) -> Real {
    let mut term = Real::one();
    for k in 1..=first {
        term = term * x / Real::exact(k as f64);
    }
    let mut sum = Real::zero();
    for n in (first..first + 30 * stride).step_by(stride) {
        sum = sum + term;
        for k in n + 1..=n + stride {
            term = term * x / Real::exact(k as f64);
        }
        term = term.times(sign);
    }
    sum
}

#[test]
fn circular_remainders_are_relatively_exact_below_one_radian() {
    let mut draw = Draw(6);
    let mut worst = [0.0_f64; 3];
    for _ in 0..DRAWS / 10 {
        let x = draw.decades(MIN_ARGUMENT, 1.0);
        let exact = Real::exact(x);
        let Circular { sin, cos_minus_1, sin_minus_x } = circular(x);
        let errors = [
            relative(sin, power_series(exact, 1, 2, -1.0)),
            relative(cos_minus_1, -power_series(exact, 2, 2, -1.0)),
            relative(sin_minus_x, -power_series(exact, 3, 2, -1.0)),
        ];
        worst = std::array::from_fn(|k| worst[k].max(errors[k]));
    }
    println!("sin, cos - 1, sin - x: {worst:.2?} eps");
    assert!(worst.iter().all(|error| *error <= SERIES_EPS), "{worst:?}");
}

#[test]
fn circular_functions_are_exact_to_eps_beyond_one_radian() {
    let mut draw = Draw(7);
    let mut worst = [0.0_f64; 3];
    for _ in 0..DRAWS {
        let x = draw.decades(1.0, 1e8);
        let exact = Real::exact(x);
        let (sine, cosine) = exact.sin_cos();
        let Circular { sin, cos_minus_1, sin_minus_x } = circular(x);
        let errors = [
            absolute_error(sin, sine),
            absolute_error(cos_minus_1, cosine - Real::one()),
            absolute_error(sin_minus_x, sine - exact) / x,
        ];
        worst = std::array::from_fn(|k| worst[k].max(errors[k]));
    }
    println!("sin, cos - 1, (sin - x)/x: {worst:.2?} eps");
    assert!(worst.iter().all(|error| *error <= FUNCTION_EPS), "{worst:?}");
}

/// With the product's error put back, the angle omega d is as good as exact.
#[test]
fn circular_functions_of_a_product_do_not_feel_its_rounding() {
    let mut draw = Draw(8);
    let mut worst = [0.0_f64; 3];
    for _ in 0..DRAWS {
        let (omega, d) = (draw.decades(0.01, 50.0), draw.decades(1e-12, 1e6));
        let exact = Real::exact(omega) * Real::exact(d);
        let (sine, cosine) = exact.sin_cos();
        let Circular { sin, cos_minus_1, sin_minus_x } =
            circular_of(omega * d, omega.product_error(d));
        let small = (omega * d).min(1.0);
        let errors = [
            absolute_error(sin, sine) / small,
            absolute_error(cos_minus_1, cosine - Real::one()) / small,
            absolute_error(sin_minus_x, sine - exact) / (omega * d),
        ];
        worst = std::array::from_fn(|k| worst[k].max(errors[k]));
    }
    println!("of a product: {worst:.2?} eps");
    assert!(worst.iter().all(|error| *error <= FUNCTION_EPS), "{worst:?}");
}

#[test]
fn decay_remainders_are_relatively_exact_below_one_half() {
    let mut draw = Draw(9);
    let mut worst = [0.0_f64; 3];
    for _ in 0..DRAWS / 10 {
        let z = draw.decades(MIN_ARGUMENT, 0.5);
        let minus = -Real::exact(z);
        let Decay { exp, minus_1, remainder } = decay(z);
        let errors = [
            relative(exp, power_series(minus, 0, 1, 1.0)),
            relative(minus_1, power_series(minus, 1, 1, 1.0)),
            relative(remainder, power_series(minus, 2, 1, 1.0)),
        ];
        worst = std::array::from_fn(|k| worst[k].max(errors[k]));
    }
    println!("exp(-z), exp(-z) - 1, exp(-z) - 1 + z: {worst:.2?} eps");
    assert!(worst.iter().all(|error| *error <= SERIES_EPS), "{worst:?}");
}

#[test]
fn decay_is_relatively_exact_beyond_one_half() {
    let mut draw = Draw(10);
    let mut worst = [0.0_f64; 3];
    for _ in 0..DRAWS {
        let z = draw.decades(0.5, 600.0);
        let exact = (-Real::exact(z)).exp();
        let Decay { exp, minus_1, remainder } = decay(z);
        let errors = [
            relative(exp, exact),
            relative(minus_1, exact - Real::one()),
            relative(remainder, exact - Real::one() + Real::exact(z)),
        ];
        worst = std::array::from_fn(|k| worst[k].max(errors[k]));
    }
    println!("exp(-z), exp(-z) - 1, exp(-z) - 1 + z beyond 1/2: {worst:.2?} eps");
    assert!(worst[0] <= SERIES_EPS && worst[1] <= SERIES_EPS, "{worst:?}");
    assert!(worst[2] <= FUNCTION_EPS, "{worst:?}");
}

/// What has wholly decayed, and what has not begun.
#[test]
fn the_ends_of_the_range_are_exact() {
    let Decay { exp, minus_1, remainder } = decay(1e300);
    assert_eq!((exp, minus_1, remainder), (0.0, -1.0, 1e300));
    let Decay { exp, minus_1, remainder } = decay(0.0);
    assert_eq!((exp, minus_1, remainder), (1.0, 0.0, 0.0));
    let Circular { sin, cos_minus_1, sin_minus_x } = circular(0.0);
    assert_eq!((sin, cos_minus_1, sin_minus_x), (0.0, 0.0, 0.0));
}
