//! Motion that events leave alone: its closed form from the start decides after them as before.
//!
//! Beside it u decays from 2 to 1 and is set to 2 again, at every multiple of the logarithm of two.

use super::{enclosed_events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Event, System};
use std::f64::consts::{LN_2, PI};

/// A block of two states and a clock beside the decay, in two modes that take turns: the block's
/// equations there, what the event assigns in it, and its start.
fn beside_a_decay(
    [first, second]: [&str; 2],
    reset: &str,
    guards: &[(&str, &str)],
    start: &str,
) -> System {
    let watch = |(name, guard): &(&str, &str)| {
        format!("[[mode.watch]]\nname = \"{name}\"\nguard = \"{guard}\"\n")
    };
    let watches: String = guards.iter().map(watch).collect();
    let mode = |name: &str, equations: &str, next: &str| {
        format!(
            "[[mode]]\nname = \"{name}\"\nequations = [{equations}, \"s' = 1\", \"u' = -u\"]\n\
             [[mode.until]]\nname = \"set\"\nguard = \"u < 1\"\nreset = [\"u = 2\"{reset}]\n\
             next = [{{ mode = \"{next}\" }}]\n{watches}"
        )
    };
    system(&format!(
        "schema = 1\nname = \"kept\"\nstates = [\"x\", \"v\", \"s\", \"u\"]\n{}{}\
         [start]\nmode = \"a\"\n{start}\ns = 0\nu = 2\n",
        mode("a", first, "b"),
        mode("b", second, "a"),
    ))
}

const TURNING: &str = "\"x' = v\", \"v' = -4*x\"";
const THROWN: &str = "\"x' = v\", \"v' = -2\"";

/// Times of events but the last, which is the end.
fn times(events: &[Event<DoubleDouble>]) -> Vec<f64> {
    events[..events.len() - 1].iter().map(|it| it.time.value().to_f64()).collect()
}

/// x = 5 cos(2 t) touches 5 and -5 on every turn, and x = 3 and v = -8 are met at one instant on
/// each; of the first there is no event, of the others two at once.
#[test]
fn an_oscillation_touches_and_meets_after_events_that_leave_it_alone() {
    let guards = [("up", "x > 5"), ("down", "x < -5"), ("three", "x < 3"), ("eight", "v < -8")];
    let system = beside_a_decay([TURNING; 2], "", &guards, "x = 5\nv = 0");
    let all = enclosed_events::<DoubleDouble>(&system, 7.0);
    let mut expected: Vec<(f64, &str)> = (1..=10).map(|n| (f64::from(n) * LN_2, "set")).collect();
    for n in 0..3 {
        let time = 0.5 * 0.6_f64.acos() + f64::from(n) * PI;
        expected.extend([(time, "three"), (time, "eight")]);
    }
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected_names: Vec<_> = expected.iter().map(|it| it.1).chain(["end"]).collect();
    assert_eq!(names(&system, &all), expected_names);
    for (own, (exact, _)) in times(&all).iter().zip(&expected) {
        assert!((own - exact).abs() < 1e-14, "{own} {exact}");
    }
}

/// x = -(t - 1)^2 touches zero at 1, and is at -1/16 when the clock is at 5/4.
#[test]
fn a_parabola_touches_and_meets_after_events_that_leave_it_alone() {
    let guards = [("touch", "x > 0"), ("below", "16*x < -1"), ("clock", "4*s > 5")];
    let system = beside_a_decay([THROWN; 2], "", &guards, "x = -1\nv = 2");
    let all = enclosed_events::<DoubleDouble>(&system, 2.0);
    assert_eq!(names(&system, &all), ["set", "below", "clock", "set", "end"]);
    for (own, exact) in times(&all).iter().zip([LN_2, 1.25, 1.25, 2.0 * LN_2]) {
        assert!((own - exact).abs() < 1e-14, "{own} {exact}");
    }
}

/// An event that doubles the rate, and a mode with a slower turn: the amplitude grows beyond 5, and
/// what the start alone would say of it no longer holds.
#[test]
fn what_an_event_touches_is_not_kept() {
    let slower = "\"x' = v\", \"v' = -x\"";
    let turn = 2.0 * LN_2;
    let (x, v) = (5.0 * turn.cos(), -10.0 * turn.sin());
    for (equations, reset, rate, omega) in
        [([TURNING; 2], ", \"v = 2*v\"", 2.0 * v, 2.0), ([TURNING, slower], "", v, 1.0)]
    {
        let system = beside_a_decay(equations, reset, &[("down", "x < -5")], "x = 5\nv = 0");
        let all = enclosed_events::<DoubleDouble>(&system, 1.38);
        assert_eq!(names(&system, &all), ["set", "down", "end"]);
        // x cos(w t) + v/w sin(w t) = -5, first.
        let (amplitude, phase) = (x.hypot(rate / omega), (-rate / omega).atan2(x));
        let time = LN_2 + ((-5.0 / amplitude).acos() - phase) / omega;
        let own = times(&all)[1];
        assert!((own - time).abs() < 1e-14, "{own} {time}");
    }
}
