//! Eigenvalues that are close to each other, with couplings that are large beside their distance.

use super::{enclosed_events, events, names, system};
use percuss::affine::{Bits212, Bits1696, Bits3392, DoubleDouble, Ending, Event, System, What};
use percuss::number::{Bound, Number};

fn watched_system(
    states: &str,
    forcing: &str,
    equations: &str,
    guard: &str,
    start: &str,
) -> System {
    system(&format!(
        "schema = 1\nname = \"close\"\nstates = [{states}]\n{forcing}\n[parameters]\nr = 1.1\n\
         [[mode]]\nname = \"free\"\nequations = [{equations}]\n[[mode.watch]]\nname = \"m\"\n\
         guard = \"{guard}\"\n[start]\nmode = \"free\"\n{start}\n",
    ))
}

/// a = exp(-t), d = 1e4 (exp(-t) - exp(-1.1 t)), which is 350 at most.
#[test]
fn two_tanks_in_a_row() {
    let tanks = |level: &str| {
        let equations = "\"a' = -a\", \"d' = 1000*a - r*d\"";
        watched_system("\"a\", \"d\"", "", equations, &format!("d > {level}"), "a = 1\nd = 0")
    };
    assert_eq!(
        names(&tanks("90000"), &enclosed_events::<DoubleDouble>(&tanks("90000"), 50.0)),
        ["end"]
    );
    let high = tanks("300");
    let all = enclosed_events::<DoubleDouble>(&high, 0.9);
    assert_eq!(names(&high, &all), ["m", "end"]);
    let own = events::<f64>(&high, 0.9);
    let times = [all[0].time.value().words().0, own[0].time.high + own[0].time.low];
    for t in times {
        let level = 1e4 * ((-t).exp() - (-1.1 * t).exp());
        assert!((level - 300.0).abs() < 1e-10, "{t:e}: {level:e}");
        assert!((t - 0.515_286_064_623_728_3).abs() < 1e-15, "{t:e}");
    }
}

/// Forced next to its frequency or at it, an oscillator beats: errors grow no faster than it.
#[test]
fn forcing_near_resonance() {
    for (damping, omega) in [("1/50", 1.05), ("1/1000", 1.0001), ("0", 1.01), ("0", 1.0)] {
        let forcing = format!("forcing = {{ omega = {omega:?}, phi = 0 }}");
        let equations = format!("\"x' = v\", \"v' = cos - x - {damping}*v\"");
        let far = watched_system("\"x\", \"v\"", &forcing, &equations, "x > 10000", "x = 0\nv = 0");
        assert_eq!(names(&far, &enclosed_events::<DoubleDouble>(&far, 1000.0)), ["end"], "{omega}");
        assert_eq!(names(&far, &enclosed_events::<f64>(&far, 30.0)), ["end"], "{omega}");
    }
    // x = t sin(t)/2 at resonance: it passes 3 near t = 7.1.
    let near = watched_system(
        "\"x\", \"v\"",
        "forcing = { omega = 1.0, phi = 0 }",
        "\"x' = v\", \"v' = cos - x\"",
        "x > 3",
        "x = 0\nv = 0",
    );
    for t in [
        enclosed_events::<DoubleDouble>(&near, 8.0)[0].time.value().words().0,
        events::<f64>(&near, 8.0)[0].time.high,
    ] {
        assert!((0.5 * t * t.sin() - 3.0).abs() < 1e-14, "{t:e}");
    }
}

/// Two oscillators that do not act on each other, with frequencies that are close.
#[test]
fn oscillators_side_by_side() {
    let states = "\"a\", \"b\", \"d\", \"e\"";
    let equations = "\"a' = b\", \"b' = -a\", \"d' = e\", \"e' = -r*d\"";
    let start = "a = 0.1\nb = 0.1\nd = 0.1\ne = 0";
    let far = watched_system(states, "", equations, "a + d > 1", start);
    assert_eq!(names(&far, &enclosed_events::<DoubleDouble>(&far, 3000.0)), ["end"]);
}

/// Pairs that hardly turn, and equal pairs, beside couplings of any size.
#[test]
fn pairs_that_hardly_turn_and_equal_ones() {
    for coupling in ["1", "1000"] {
        let equations = format!("\"a' = {coupling}*b - a\", \"b' = -b - a/{coupling}^2/10000\"");
        let level = format!("a > 10*{coupling}");
        let far = watched_system("\"a\", \"b\"", "", &equations, &level, "a = 1\nb = 1");
        assert_eq!(
            names(&far, &enclosed_events::<DoubleDouble>(&far, 100.0)),
            ["end"],
            "{coupling}"
        );
        let states = "\"a\", \"b\", \"d\", \"e\"";
        let equations = format!(
            "\"a' = b - a\", \"b' = -a - b\", \"d' = e - d\", \"e' = {coupling}*a - d - e\""
        );
        let level = format!("d > 10*{coupling}");
        let far = watched_system(states, "", &equations, &level, "a = 1\nb = 1\nd = 1\ne = 1");
        assert_eq!(
            names(&far, &enclosed_events::<DoubleDouble>(&far, 100.0)),
            ["end"],
            "{coupling}"
        );
    }
}

/// x is zero for ever, and stays below any digit of a motion that would grow.
#[test]
fn what_is_zero_does_not_grow() {
    for (rate, coupling) in [("r", "10"), ("r", "7"), ("13/10", "10"), ("-r", "10")] {
        let equations = format!("\"x' = {rate}*x\", \"y' = {coupling}*x - 2*y + 1\"");
        let at_rest =
            watched_system("\"x\", \"y\"", "", &equations, "x + 1/1000 < 0", "x = 0\ny = 0");
        let all = enclosed_events::<DoubleDouble>(&at_rest, 300.0);
        let end = &all[all.len() - 1];
        assert_eq!(names(&at_rest, &all), ["end"], "{rate}");
        let (x, off) = (end.state[0].words().0.abs(), end.errors.as_ref().unwrap().state[0]);
        assert!(x <= off, "{rate}: {x:e} is off by more than {off:e}");
    }
}

/// v decays to 1e-63 while x, which does not act on it, stays near 1: v keeps its sign for ever.
#[test]
fn what_does_not_depend_on_large_neighbours() {
    let (a, d, until) = (1.0 / 4e5, 1.0 / 4e3, 470_000.0);
    let equations = "\"x' = v - x/400000\", \"v' = -101/400000*v\"";
    let falling = watched_system("\"x\", \"v\"", "", equations, "v > 0", "x = 1\nv = -0.0000025");
    let all = enclosed_events::<Bits212>(&falling, until);
    assert_eq!(names(&falling, &all), ["end"]);
    let end = &all[0];
    let v = -a * f64::exp(-(a + d) * until);
    let x = f64::exp(-a * until) * (1.0 + a / d * (f64::exp(-d * until) - 1.0));
    let own = [0, 1].map(|n| end.state[n].to_f64());
    assert!((own[1] / v - 1.0).abs() < 1e-12, "{:e} is not {v:e}", own[1]);
    assert!((own[0] / x - 1.0).abs() < 1e-12, "{:e} is not {x:e}", own[0]);
}

/// Two coupled masses are thrown apart, and by the symmetry of their motion w is 1 where they meet:
/// after the hit w = -1 is a rest, away from which exp(100 t) drives any error.
#[test]
fn series_of_wide_numbers_have_terms_below_every_f64() {
    let text = r#"
        schema = 1
        name = "apart"
        states = ["a", "u", "b", "w"]
        [[mode]]
        name = "both"
        equations = [
            "a' = u", "u' = -4*a - (a - b)/2 + 1", "b' = w", "w' = -4*b - (b - a)/2 + 1",
        ]
        [[mode.until]]
        name = "hit"
        guard = "b > 1/2"
        reset = ["w = -w"]
        next = "after"
        [[mode]]
        name = "after"
        equations = ["a' = u", "u' = 0", "b' = w", "w' = 100*w + 100"]
        [start]
        mode = "both"
        a = 0.5
        u = -1
        b = 0
        w = 1
    "#;
    let system = system(text);
    rests_at_one(&enclosed_events::<Bits1696>(&system, 9.0), 1e-120);
    rests_at_one(&enclosed_events::<Bits3392>(&system, 9.0), 1e-290);
}

fn rests_at_one<T: Number>(events: &[Event<T>], most: f64) {
    let end = events.last().unwrap();
    assert_eq!(end.what, What::End(Ending::Horizon));
    let error = end.errors.as_ref().unwrap().state[3].to_f64();
    let apart = (end.state[3] + T::one()).to_f64().abs();
    assert!(apart <= error && error <= most, "{apart:e} {error:e}");
}

/// x comes to 1/2 earlier than y by 2 q^2, which is less than every f64.
#[test]
fn crossings_are_told_apart_below_every_f64() {
    let text = |level: &str| {
        let watch = |state: &str, level: &str| {
            format!("[[mode.watch]]\nname = \"{state}\"\nguard = \"{state} < {level}\"\n")
        };
        let watches = watch("x", "1/2") + &watch("y", level);
        format!(
            "schema = 1\nname = \"two\"\nstates = [\"x\", \"y\"]\nparameters = {{ q = 1e-180 }}\n\
             [[mode]]\nname = \"fall\"\nequations = [\"x' = -x\", \"y' = -y\"]\n{watches}\
             [start]\nmode = \"fall\"\nx = 1\ny = 1\n"
        )
    };
    for (level, order) in [("1/2 - q*q", ["x", "y", "end"]), ("1/2 + q*q", ["y", "x", "end"])] {
        let two = system(&text(level));
        assert_eq!(names(&two, &enclosed_events::<Bits3392>(&two, 1.0)), order, "{level}");
    }
}
