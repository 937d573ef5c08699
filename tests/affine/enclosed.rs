//! Runs that follow their errors: how far they go, and that their bounds hold at large times.

use super::{names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Ending, Event, What};
use percuss::number::Number;

/// Motions that are polynomials of the time, whose couplings are large: an error grows with a power
/// of the time, not with an exponential of the coupling.
const RAMP: &str = "
schema = 1
name = \"ramp\"
states = [\"x\"]
[[mode]]
name = \"rising\"
equations = [\"x' = 7\"]
[[mode.until]]
name = \"top\"
guard = \"x > 1000\"
reset = [\"x = 0\"]
[start]
mode = \"rising\"
x = 0
";

/// In millimetres and seconds, from a kilometre: the impact is after 14.3 seconds.
const FALL: &str = "
schema = 1
name = \"fall\"
states = [\"x\", \"v\"]
[[mode]]
name = \"flight\"
equations = [\"x' = v\", \"v' = -9810\"]
[[mode.until]]
name = \"impact\"
guard = \"x < 0\"
reset = [\"x = 0\", \"v = -v/2\"]
[start]
mode = \"flight\"
x = 1000000
v = 0
";

const BALL: &str = "
schema = 1
name = \"ball\"
states = [\"x\", \"v\"]
[parameters]
e = 0.99
[[mode]]
name = \"flight\"
equations = [\"x' = v\", \"v' = -2\"]
[[mode.until]]
name = \"impact\"
guard = \"x < 0\"
reset = [\"x = 0\", \"v = -e*v\"]
[start]
mode = \"flight\"
x = 0
v = 1
";

/// A triple eigenvalue that decays, behind couplings of 50.
const CASCADE: &str = "
schema = 1
name = \"cascade\"
states = [\"a\", \"b\", \"c\"]
[[mode]]
name = \"filling\"
equations = [\"a' = 50*b - a\", \"b' = 50*c - b\", \"c' = 1 - c\"]
[[mode.watch]]
name = \"half\"
guard = \"2*a > 2500\"
[[mode.until]]
name = \"never\"
guard = \"c > 2\"
[start]
mode = \"filling\"
a = 0
b = 0
c = 0
";

/// A forced oscillator that is watched far from time 0, from START on.
const FORCED: &str = "
schema = 1
name = \"forced\"
states = [\"x\", \"v\"]
forcing = { omega = \"11/10\", phi = 0 }
[[mode]]
name = \"free\"
equations = [\"x' = v\", \"v' = -x/9 + cos\"]
[[mode.watch]]
name = \"half\"
guard = \"cos > 1/2\"
[start]
mode = \"free\"
t = \"START\"
x = 0
v = 0
";

/// The names of a run's events, with the events.
fn named_events<T: Number>(text: &str, until: f64) -> (Vec<String>, Vec<Event<T>>) {
    let system = system(text);
    let events = super::enclosed_events(&system, until);
    (names(&system, &events), events)
}

#[test]
fn errors_of_polynomial_motions_grow_with_powers_of_the_time() {
    for (text, until, expected, time) in [
        (RAMP, 300.0, &["top", "top", "end"][..], 1000.0 / 7.0),
        (FALL, 20.0, &["impact", "end"], (2.0 * 1e6 / 9810.0_f64).sqrt()),
        (CASCADE, 20.0, &["half", "end"], 2.674_060_313_723_560_3),
    ] {
        let (found, events) = named_events::<DoubleDouble>(text, until);
        assert_eq!(found, expected);
        assert!((events[0].time.value().to_f64() / time - 1.0).abs() < 1e-15);
        let error = events[0].errors.as_ref().unwrap().time;
        assert!(0.0 < error && error < 1e-26 * time, "{error:e}");
        let (found, _) = named_events::<f64>(text, until);
        assert_eq!(found, expected);
    }
}

/// Two thousand impacts, until their rate is 1e-11: its error is no error of the height, which is
/// zero there.
#[test]
fn errors_of_a_rate_do_not_hide_small_flights() {
    let (names, events) = named_events::<DoubleDouble>(BALL, 1000.0);
    assert_eq!(names.last().map(String::as_str), Some("accumulation"));
    let ending = &events[events.len() - 1];
    let What::End(Ending::Accumulation(from, to)) = ending.what else { panic!("{ending:?}") };
    let error = DoubleDouble::exact(ending.errors.as_ref().unwrap().time);
    let (from, to) = (ending.time.value() + (from - error), ending.time.value() + (to + error));
    // The times of the flights are 1, e, e^2 and so on; 1 - e is exact in f64.
    let limit = DoubleDouble::one() / DoubleDouble::exact(1.0 - 0.99);
    assert!(from <= limit && limit <= to, "{from:?} {limit:?} {to:?}");
    assert!((to - from).to_f64() < 1e-20, "{from:?} {to:?}");
}

/// The second crossing after two starts, with both words of its rate, computed with mpmath at 80
/// digits: the phase is known to 1.1e8 or 1.1e12 times 2^-106.
#[test]
fn bounds_hold_far_from_time_zero() {
    for (start, until, rate) in [
        ("330000001/3", 110_000_015.0, (0.020_433_771_650_834_535, -1.178_316_619_858_692_5e-18)),
        ("3000000000001/3", 1e12 + 15.0, (-0.070_732_609_434_886_74, -5.246_931_103_250_777e-18)),
    ] {
        let (names, events) = named_events::<DoubleDouble>(&FORCED.replace("START", start), until);
        assert_eq!(names[..2], ["half", "half"], "{start}");
        let found = events[1].state[1] - DoubleDouble::new(rate.0, rate.1);
        let (error, bound) = (found.to_f64().abs(), events[1].errors.as_ref().unwrap().state[1]);
        // Beyond the bound the expected value is rounded to 106 bits.
        assert!(error <= bound + 1e-33, "{start}: {error:e} beyond {bound:e}");
    }
}

/// A damped oscillation crosses zero until it underflows: its errors decay as it does.
#[test]
fn errors_decay_with_a_motion_that_is_watched() {
    let text = "schema = 1\nname = \"damped\"\nstates = [\"x\", \"v\"]\n[parameters]\nc = 0.2
[[mode]]\nname = \"free\"\nequations = [\"x' = v\", \"v' = -x - c*v\"]
[[mode.watch]]\nname = \"zero\"\nguard = \"x > 0\"\ndirection = \"both\"
[start]\nmode = \"free\"\nx = 1\nv = 0\n";
    let (names, all) = named_events::<DoubleDouble>(text, 2000.0);
    // A quarter turn and half turns of the frequency sqrt(0.99).
    let frequency = 0.99_f64.sqrt();
    let crossings = ((2000.0 * frequency - frequency.atan2(-0.1)) / std::f64::consts::PI) as usize;
    assert_eq!((names.len(), names.last().map(String::as_str)), (crossings + 2, Some("end")));
    let (state, errors) = (&all[crossings].state, all[crossings].errors.as_ref().unwrap());
    let rate = state[1].words().0.abs();
    assert!(rate < 1e-85 && errors.state[1] < 1e-24 * rate, "{rate:e} {:e}", errors.state[1]);
}
