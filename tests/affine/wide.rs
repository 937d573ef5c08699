//! Runs in more than 106 bits.

use super::{BALL, PLASTIC, RELAY, SPHERES, enclosed_events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Bits212, Bits848, Ending, Event, System, What};
use percuss::number::{Bound, Number};

/// x' = -x, watched for zero.
const DECAY: &str = r#"
schema = 1
name = "decay"
states = ["x"]
[[mode]]
name = "only"
equations = ["x' = -x"]
[[mode.watch]]
name = "zero"
guard = "x < 0"
[start]
mode = "only"
x = 1
"#;

fn last<T: Number>(system: &System, until: f64) -> Event<T> {
    enclosed_events::<T>(system, until).pop().unwrap()
}

/// exp(-1e5) is beyond the exponents of f64, and its bound as well.
#[test]
fn a_decay_goes_on_beyond_the_exponents_of_f64() {
    let end = last::<Bits212>(&system(DECAY), 1e5);
    assert_eq!(end.what, What::End(Ending::Horizon));
    let (mantissa, exponent) = end.state[0].bound().parts();
    // exp(-1e5) = 1.410211063072247... 2^-144270, by mpmath.
    assert_eq!(exponent, -144_270);
    assert!((mantissa - 1.410_211_063_072_247).abs() < 1e-14, "{mantissa}");
    let error = end.errors.unwrap().state[0] / end.state[0].bound();
    assert!(error > 0.0 && error < 1e-55, "{error:?}");
}

/// The names and the first 30 digits of events are those of 106 bits, whose errors hold the
/// differences.
#[test]
fn wide_runs_are_those_of_106_bits() {
    for (text, until) in [(BALL, 3.0), (RELAY, 8.0), (PLASTIC, 12.0), (SPHERES, 9.0)] {
        let system = system(text);
        let narrow = enclosed_events::<DoubleDouble>(&system, until);
        compare(&system, &narrow, &enclosed_events::<Bits212>(&system, until));
        compare(&system, &narrow, &enclosed_events::<Bits848>(&system, until));
    }
}

fn compare<T: Number>(system: &System, narrow: &[Event<DoubleDouble>], wide: &[Event<T>]) {
    assert!(narrow.len() > 2, "{}", system.name);
    assert_eq!(names(system, narrow)[..], names(system, wide)[..narrow.len()], "{}", system.name);
    for (a, b) in narrow.iter().zip(wide) {
        let errors = a.errors.as_ref().unwrap();
        let words = |it: T| {
            let high = it.to_f64();
            DoubleDouble::new(high, (it - T::exact(high)).to_f64())
        };
        let off = (a.time.value() - words(b.time.value())).to_f64().abs();
        assert!(off <= errors.time + 1e-31 * b.time.value().to_f64().abs(), "{off:e}");
        for ((x, y), error) in a.state.iter().zip(&b.state).zip(&errors.state) {
            let off = (*x - words(*y)).to_f64().abs();
            assert!(off <= error + 1e-31 * x.to_f64().abs(), "{}: {off:e} {error:e}", system.name);
        }
    }
}
