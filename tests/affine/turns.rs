//! Impacts that accumulate over two modes: after an impact another mode begins, out of which a turn
//! leads back.

use super::past_limits::{judge, overlap};
use super::{enclosed_events, events, names};
use percuss::affine::{Bits212, DoubleDouble, Ending as AffineEnding, What};
use percuss::number::Number;
use percuss::{Ending, Proved, System};
use proptest::prelude::*;

/// A ball that falls at a rate a and rises against a rate b, until it is at rest; after the time
/// tau it is thrown again, twice. The state s is the integral of x, m the sum of the changes of v
/// at impacts, and n counts throws.
fn ball(numbers: &str) -> System {
    ball_with_turn("", numbers)
}

/// The ball of [`ball`] with further keys in its turn.
fn ball_with_turn(keys: &str, numbers: &str) -> System {
    let text = format!(
        r#"
        schema = 1
        name = "ball"
        states = ["x", "v", "s", "m", "c", "n"]
        parameters = {{ {numbers} }}
        [[mode]]
        name = "falling"
        equations = ["x' = v", "v' = -a", "s' = x", "m' = 0", "c' = 0", "n' = 0"]
        [[mode.until]]
        name = "impact"
        guard = "x < 0"
        reset = ["x = 0", "v = -e*v", "m = m - (1 + e)*v"]
        next = [{{ mode = "rising" }}]
        [mode.until.accumulates_to]
        reset = ["x = 0", "v = 0", "c = 0"]
        next = [{{ when = "n > 3/2", mode = "over" }}, {{ mode = "rest" }}]
        [[mode]]
        name = "rest"
        equations = ["x' = 0", "v' = 0", "s' = x", "m' = 0", "c' = 1", "n' = 0"]
        [[mode.until]]
        name = "throw"
        guard = "c > tau"
        reset = ["v = u", "n = n + 1"]
        next = [{{ mode = "rising" }}]
        [[mode]]
        name = "over"
        equations = ["x' = 0", "v' = 0", "s' = x", "m' = 0", "c' = 0", "n' = 0"]
        [[mode]]
        name = "rising"
        equations = ["x' = v", "v' = -b", "s' = x", "m' = 0", "c' = 0", "n' = 0"]
        [[mode.until]]
        name = "turn"
        guard = "v < 0"
        {keys}
        next = [{{ mode = "falling" }}]
        [start]
        mode = "rising"
        x = 0
        v = "u"
        s = 0
        m = 0
        c = 0
        n = 0
        "#
    );
    System::from_toml(&text).unwrap()
}

/// The time, s and m at the n-th limit: a ball of the speed u rises for u/b and falls for u/sqrt(a
/// b), with u^3/(3 b^2) and u^3/(3 b sqrt(a b)) as integrals of its height. It comes back at u
/// sqrt(a/b), and goes on with e times that.
fn closed_form<T: Number>([u, a, b, e, tau]: [f64; 5], n: f64) -> [T; 3] {
    let [u, a, b, e, tau, n] = [u, a, b, e, tau, n].map(T::exact);
    let (one, mean) = (T::one(), (a * b).sqrt());
    let faster = (a / b).sqrt();
    let q = e * faster;
    let bounces = (u / b + u / mean) / (one - q);
    let area = u * u * u * (one / b + one / mean) / (T::exact(3.0) * b * (one - q * q * q));
    let kicks = (one + e) * faster * u / (one - q);
    [n * bounces + (n - one) * tau, n * area, n * kicks]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// After a turn the gap is known to the arithmetic's unit, beside 1, and an impact of the speed
    /// u to that over u. Enclosed errors at a limit are those where they meet its second order:
    /// with b bits 2^(-2 b/3), or where bounds round more than that, below 1e-14, 2^-90. A limit
    /// multiplies what it inherits by at most 1 + 2 q/(1 - q) <= 39.
    #[test]
    fn a_ball_comes_to_rest_where_the_series_says(
        u in 0.5_f64..20.0, b in 1.0_f64..12.0, share in 0.3_f64..1.2, q in 0.02_f64..0.9,
        tau in 0.1_f64..3.0,
    ) {
        let (a, e) = (share * b, (q / share.sqrt()).min(0.95));
        let ball = ball(&format!("u = {u:?}, a = {a:?}, b = {b:?}, e = {e:?}, tau = {tau:?}"));
        let numbers = [u, a, b, e, tau];
        let end = closed_form::<f64>(numbers, 3.0)[0] + 1.0;
        judge(&events::<f64>(&ball, end), |n| closed_form(numbers, n), [1e-12, 1e-12]);
        let most = |bits: f64| 39_f64.powi(2) * (-bits).exp2();
        let narrow = enclosed_events::<DoubleDouble>(&ball, end);
        judge(&narrow, |n| closed_form(numbers, n), [1e-29, most(2.0 * 106.0 / 3.0 - 7.0)]);
        let wide = enclosed_events::<Bits212>(&ball, end);
        judge(&wide, |n| closed_form(numbers, n), [1e-60, most(90.0)]);
        let [f64s, wide] = [names(&ball, &events::<f64>(&ball, end)), names(&ball, &wide)];
        prop_assert_eq!(&f64s, &wide);
        prop_assert_eq!(f64s.last().map(String::as_str), Some("end"));
    }
}

/// Without the key the run ends at the accumulation, which is enclosed.
/// A turn changes nothing by multiples of its guard; any other change is one, and impacts with it
/// are not known to accumulate.
#[test]
fn the_reset_of_a_turn_may_add_multiples_of_its_guard_alone() {
    let numbers = [3.0, 2.0, 5.0, 0.5, 1.0];
    let with = |reset: &str| {
        let keys = format!("reset = {reset}");
        let ball = ball_with_turn(&keys, "u = 3, a = 2, b = 5, e = 0.5, tau = 1");
        events::<f64>(&ball, 9.0)
    };
    let neutral = [r#"["v = 0"]"#, r#"["v = 0", "x = x - 2*v", "m = m + 3*v"]"#];
    for reset in neutral {
        judge(&with(reset), |n| closed_form(numbers, n), [1e-12, 1e-12]);
    }
    let changed = with(r#"["m = m + 1"]"#);
    assert_eq!(changed.last().map(|it| it.what), Some(What::End(AffineEnding::NoProgress)));
}

#[test]
fn a_run_without_the_key_ends_with_the_time_enclosed() {
    let numbers = [3.0, 2.0, 5.0, 0.5, 1.0];
    let mut ball = ball("u = 3, a = 2, b = 5, e = 0.5, tau = 1");
    ball.modes[0].until[0].accumulates_to = None;
    let known = closed_form::<f64>(numbers, 1.0)[0];
    let solver = ball.solver::<Proved>().unwrap();
    let end = solver.run().until(9.0).unwrap().last().unwrap();
    assert_eq!((end.ending(), end.mode()), (Some(Ending::Accumulation), "rising"));
    let [from, to] = end.accumulation().unwrap();
    assert!(from.midpoint() <= known && known <= to.midpoint(), "{from:?} {to:?} {known}");
    assert!(to.midpoint() - from.midpoint() < 1e-15);
    let solver = ball.solver::<f64>().unwrap();
    let end = solver.run().until(9.0).unwrap().last().unwrap();
    assert_eq!(end.ending(), Some(Ending::Accumulation));
    let [from, to] = end.accumulation().unwrap();
    assert!((from - known).abs() < 1e-14 && (to - known).abs() < 1e-14);
}

/// A horizon between the last row and the limit is reached by impacts and turns without rows; so is
/// what comes after it.
#[test]
fn impacts_without_rows_lead_to_a_horizon_before_the_limit() {
    let ball = ball("u = 1, a = 0.5, b = 2, e = 0.5, tau = 1");
    // 1/2 of rise and 1 of fall, with q = 1/4: the limit is at 2.
    for k in [31, 34, 38] {
        let before = 2.0 - 0.75 / 2_f64.powi(k);
        let solver = ball.solver::<Proved>().unwrap();
        let all: Vec<_> = solver.run().until(before).unwrap().collect();
        let end = all.last().unwrap();
        assert_eq!(end.ending(), Some(Ending::Horizon), "{k}");
        let solver = ball.solver::<f64>().unwrap();
        let mut plain = solver.run().until(before).unwrap();
        let last = plain.by_ref().last().unwrap();
        assert_eq!((last.ending(), last.mode()), (Some(Ending::Horizon), end.mode()), "{k}");
        assert!((last.state()[1] - end.state()[1].midpoint()).abs() < 1e-15, "{last:?} {end:?}");
        assert!(plain.go_on(2.5));
        let rest: Vec<_> = plain.collect();
        let names: Vec<_> = rest.iter().map(percuss::Event::name).collect();
        assert_eq!(names, ["accumulation", "end"]);
        assert!((rest[0].time() - 2.0).abs() < 1e-15);
    }
}

/// Without restitution an impact is its own limit, by way of a turn in the same instant.
#[test]
fn an_impact_without_restitution_rests_at_once() {
    let ball = ball("u = 3, a = 2, b = 5, e = 0, tau = 1");
    let falls = closed_form::<f64>([3.0, 2.0, 5.0, 0.0, 1.0], 1.0)[0];
    let solver = ball.solver::<Proved>().unwrap();
    let all: Vec<_> = solver.run().until(2.0).unwrap().collect();
    let names: Vec<_> = all.iter().map(percuss::Event::name).collect();
    assert_eq!(names, ["turn", "impact", "turn", "accumulation", "end"]);
    assert_eq!((all[3].time().midpoint(), all[3].mode()), (all[1].time().midpoint(), "rest"));
    assert!((all[3].time().midpoint() - falls).abs() < 1e-15);
    let solver = ball.solver::<f64>().unwrap();
    let plain: Vec<_> = solver.run().until(2.0).unwrap().collect();
    assert_eq!(plain.iter().map(percuss::Event::name).collect::<Vec<_>>(), names);
}

/// A mass on a spring with dry friction and a stop, which a slow force presses to the stop and
/// pulls away: it slips ahead and back, sticks, and is held at the stop. The state w remembers
/// impacts and decays.
pub fn friction([omega, force, friction, damping, r]: [f64; 5]) -> String {
    format!(
        r#"
        schema = 1
        name = "friction-at-a-stop"
        states = ["x", "v", "w"]
        forcing = {{ omega = {omega:?}, phi = 0.4 }}
        parameters = {{ f = {force:?}, mu = {friction:?}, c = {damping:?}, r = {r:?} }}
        [let]
        push = "f*cos - x"
        [[mode]]
        name = "ahead"
        equations = ["x' = v", "v' = push - c*v - mu", "w' = -w"]
        [[mode.until]]
        name = "impact"
        guard = "x > 3/8"
        reset = ["x = 3/8", "v = -r*v", "w = w + v"]
        next = [{{ mode = "back" }}]
        [mode.until.accumulates_to]
        reset = ["x = 3/8", "v = 0"]
        next = [{{ when = "push > -mu", mode = "held" }}, {{ mode = "back" }}]
        [[mode.until]]
        name = "stop"
        guard = "v < 0"
        next = [{{ when = "push < -mu", mode = "back" }}, {{ mode = "stick" }}]
        [[mode]]
        name = "back"
        equations = ["x' = v", "v' = push - c*v + mu", "w' = -w"]
        [[mode.until]]
        name = "turn"
        guard = "v > 0"
        next = [{{ when = "push > mu", mode = "ahead" }}, {{ mode = "stick" }}]
        [[mode]]
        name = "stick"
        equations = ["x' = 0", "v' = 0", "w' = -w"]
        [[mode.until]]
        name = "slip-ahead"
        guard = "push > mu"
        next = [{{ mode = "ahead" }}]
        [[mode.until]]
        name = "slip-back"
        guard = "push < -mu"
        next = [{{ mode = "back" }}]
        [[mode]]
        name = "held"
        equations = ["x' = 0", "v' = 0", "w' = -w"]
        [[mode.until]]
        name = "leave"
        guard = "push < -mu"
        next = [{{ mode = "back" }}]
        [start]
        mode = "ahead"
        x = 0
        v = 0.5
        w = 0
        "#
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Enclosures in 106 and in 212 bits overlap at each event, past limits too.
    #[test]
    fn enclosures_overlap_past_limits(
        omega in 0.05_f64..0.6, force in 1.0_f64..3.0, share in 0.05_f64..0.5,
        damping in 0.0_f64..0.3, r in 0.05_f64..0.9,
    ) {
        let rig = friction([omega, force, share * force, damping, r]);
        overlap(&System::from_toml(&rig).unwrap(), 60.0);
    }
}

/// A run in f64 has the events of the proved one, near them, through chatter and sticking.
#[test]
fn a_rig_with_friction_and_a_stop_is_decided_in_f64_too() {
    let rig = System::from_toml(&friction([0.15, 2.0, 0.3, 0.1, 0.6])).unwrap();
    let solver = rig.solver::<Proved>().unwrap();
    let proved: Vec<_> = solver.run().until(150.0).unwrap().collect();
    let named = |name| proved.iter().filter(|it| it.name() == name).count();
    assert_eq!(["accumulation", "leave", "end"].map(named), [4, 4, 1]);
    let solver = rig.solver::<f64>().unwrap();
    let plain: Vec<_> = solver.run().until(150.0).unwrap().collect();
    assert_eq!(plain.len(), proved.len());
    for (plain, proved) in plain.iter().zip(&proved) {
        assert_eq!(plain.name(), proved.name());
        assert!((plain.time() - proved.time().midpoint()).abs() < 1e-11, "{plain:?} {proved:?}");
    }
}

/// A gap that opens again before it closes, where the next pull comes late, and one that closes
/// ever faster: a run in f64 takes no time of a series for a landing that is none, or another one.
#[test]
fn a_short_flight_need_not_land() {
    for (speed, pull, landings) in [(0.000_042_7, "-b + c*y", 0), (0.000_04, "-b/2000 - c*y", 1)] {
        let text = format!(
            r#"
            schema = 1
            name = "landing"
            states = ["x", "v", "y"]
            parameters = {{ b = 0.0001, c = 0.04, e = 0.5 }}
            [[mode]]
            name = "up"
            equations = ["x' = v", "v' = -1", "y' = 0"]
            until = [{{ name = "turn", guard = "v < 0", next = "down" }}]
            [[mode]]
            name = "down"
            equations = ["x' = v", "v' = {pull}", "y' = 1"]
            [[mode.until]]
            name = "impact"
            guard = "x < 1"
            reset = ["x = 1", "v = -e*v"]
            next = "over"
            [[mode]]
            name = "over"
            equations = ["x' = 0", "v' = 0", "y' = 0"]
            [start]
            mode = "up"
            x = 1
            v = {speed:?}
            y = 0
            "#
        );
        let system = System::from_toml(&text).unwrap();
        let solver = system.solver::<Proved>().unwrap();
        let proved: Vec<_> = solver.run().until(10.0).unwrap().collect();
        let solver = system.solver::<f64>().unwrap();
        let plain: Vec<_> = solver.run().until(10.0).unwrap().collect();
        assert_eq!(plain.len(), 2 + landings);
        assert_eq!(plain.len(), proved.len());
        for (plain, proved) in plain.iter().zip(&proved) {
            assert_eq!(plain.name(), proved.name());
            // Without the series the gap of 1e-9 is known to 1e-7 of it.
            assert!((plain.time() - proved.time().midpoint()).abs() < 1e-9, "{plain:?} {proved:?}");
        }
    }
}

/// Some thousand impacts whose jumps sum up in p. The bounds of the quotient of their rates are far
/// apart: the sum is enclosed, or not known.
const LONG_SUM: &str = r#"
schema = 1
name = "unsound"
states = ["x", "v", "q", "s", "a", "p"]
parameters = { K = 1.1444091796875e+23, r0 = 1.7066666666666667e-25, C = 1e+26, eps = 0.0078125, u = 1e-28 }
[let]
e = "1 - eps"
[[mode]]
name = "down"
equations = ["x' = v", "v' = -1", "q' = 1", "s' = 1", "a' = r0 + s", "p' = 0"]
[[mode.until]]
name = "impact"
guard = "q > x"
reset = ["x = q", "v = 1 - e*(v - 1)", "p = p + C*(v - 1)"]
next = [{ mode = "up" }]
accumulates_to = { reset = ["x = 0", "v = 1", "q = 0", "s = 0", "a = 0"], next = "rest" }
[[mode]]
name = "up"
equations = ["x' = v", "v' = -1 - K*s", "q' = 1", "s' = 1", "a' = r0 + s", "p' = 0"]
[[mode.until]]
name = "turn"
guard = "v < 1"
next = [{ mode = "down" }]
[[mode]]
name = "rest"
equations = ["x' = 1", "v' = 0", "q' = 1", "s' = 0", "a' = 0", "p' = 0"]
[start]
mode = "up"
t = 1
x = 0
v = "1 + u"
q = 0
s = 0
a = 0
p = 0
"#;

/// The sum by the recurrence of the impacts in 60 digits, from one to the next.
#[test]
fn a_sum_of_jumps_is_enclosed() {
    let system = System::from_toml(LONG_SUM).unwrap();
    let known = -1.178_620_630_136_569_8;
    let solver = system.solver::<Proved>().unwrap();
    for event in solver.run().until(3.0).unwrap() {
        if event.name() == "accumulation" {
            let sum = &event.state()[5];
            assert!((sum.midpoint() - known).abs() <= sum.error() + 1e-15, "{sum:?}");
        }
    }
}

/// A guard that keeps its sign on the way up alone: it is passed on the way down, before the limit.
const PASSED_ON_THE_WAY: &str = r#"
schema = 1
name = "dead-guard"
states = ["x", "v", "y"]
[parameters]
y1 = 1.9999999999999
[[mode]]
name = "down"
equations = ["x' = v", "v' = -1", "y' = 2"]
[[mode.until]]
name = "impact"
guard = "x < 0"
reset = ["x = 0", "v = -1/2*v"]
next = [{ mode = "up" }]
accumulates_to = "rest"
[[mode]]
name = "up"
equations = ["x' = v", "v' = -1", "y' = -1"]
[[mode.until]]
name = "turn"
guard = "v < 0"
next = [{ mode = "down" }]
[[mode.until]]
name = "high"
guard = "y > y1"
next = [{ mode = "rest" }]
[[mode]]
name = "rest"
equations = ["x' = 0", "v' = 0", "y' = 0"]
[start]
mode = "up"
x = 0
v = 1
y = 0
"#;

/// One that keeps its sign but for jumps.
const PASSED_BY_JUMPS: &str = r#"
schema = 1
name = "dead-one"
states = ["x", "v", "y"]
[parameters]
y1 = 0.9999999999
[[mode]]
name = "down"
equations = ["x' = v", "v' = -1", "y' = 0"]
[[mode.until]]
name = "impact"
guard = "x < 0"
reset = ["x = 0", "v = -1/2*v", "y = y - v"]
[[mode.until]]
name = "high"
guard = "y > y1"
next = "rest"
[[mode]]
name = "rest"
equations = ["x' = 0", "v' = 0", "y' = 0"]
[start]
mode = "down"
x = 0
v = 1
y = -1
"#;

#[test]
fn no_accumulation_is_claimed_beyond_another_event() {
    for text in [PASSED_ON_THE_WAY, PASSED_BY_JUMPS] {
        let system = System::from_toml(text).unwrap();
        let ends = |name: Option<Ending>| assert_eq!(name, Some(Ending::BeyondGuard), "{text}");
        let solver = system.solver::<Proved>().unwrap();
        let all: Vec<_> = solver.run().until(6.0).unwrap().collect();
        assert!(all.iter().all(|it| it.name() != "accumulation"));
        ends(all.last().unwrap().ending());
        let solver = system.solver::<f64>().unwrap();
        ends(solver.run().until(6.0).unwrap().last().unwrap().ending());
    }
}

/// Watched multiples of the gap at a moving table, one of which falls at each impact.
const WATCHED: &str = r#"
schema = 1
name = "ball-with-two-drags"
states = ["x", "v"]
forcing = { omega = 1.25, phi = 0.5 }
parameters = { A = 0.75, g = 1, c = 0.5, d = 0.125, e = 0.625 }
[[mode]]
name = "falling"
equations = ["x' = v", "v' = -g - d*v"]
[[mode.until]]
name = "impact"
guard = "A*cos > x"
reset = ["x = A*cos", "v = -(1 + e)*A*omega*sin - e*v"]
next = [{ mode = "rising" }]
accumulates_to = { next = [{ when = "A*omega^2*cos > g - c*A*omega*sin", mode = "rising" }, { mode = "stuck" }] }
[[mode.watch]]
name = "down"
guard = "x > A*cos"
direction = "falling"
[[mode.watch]]
name = "up"
guard = "2*x > 2*A*cos"
[[mode]]
name = "rising"
equations = ["x' = v", "v' = -g - c*v"]
[[mode.until]]
name = "turn"
guard = "v < -A*omega*sin"
next = [{ mode = "falling" }]
[[mode]]
name = "stuck"
equations = ["x' = v", "v' = -A*omega^2*cos"]
[[mode.until]]
name = "detach"
guard = "A*omega^2*cos - c*v > g"
next = [{ mode = "rising" }]
[start]
mode = "falling"
x = 1
v = -0.5
"#;

/// A stop at zero, where the gap is its own size.
const AT_THE_ORIGIN: &str = r#"
schema = 1
name = "origin"
states = ["x", "v"]
forcing = { omega = 0.9, phi = 0.4 }
parameters = { k = 1, F = 0, mu = 0.25, g = 1, e = 0.6 }
[[mode]]
name = "down"
equations = ["x' = v", "v' = -g - k*x + mu + F*cos"]
[[mode.until]]
name = "impact"
guard = "x < 0"
reset = ["x = 0", "v = -e*v"]
next = [{ mode = "up" }]
accumulates_to = { reset = ["x = 0", "v = 0"], next = "rest" }
[[mode]]
name = "up"
equations = ["x' = v", "v' = -g - k*x - mu + F*cos"]
[[mode.until]]
name = "turn"
guard = "v < 0"
next = [{ mode = "down" }]
[[mode]]
name = "rest"
equations = ["x' = 0", "v' = 0"]
[start]
mode = "down"
x = 0.5
v = 0
"#;

#[test]
fn runs_in_f64_have_the_rows_of_proved_ones() {
    for text in [WATCHED, AT_THE_ORIGIN] {
        let system = System::from_toml(text).unwrap();
        let solver = system.solver::<Proved>().unwrap();
        let proved: Vec<_> = solver.run().until(7.0).unwrap().collect();
        let solver = system.solver::<f64>().unwrap();
        let plain: Vec<_> = solver.run().until(7.0).unwrap().collect();
        assert_eq!(plain.len(), proved.len());
        for (plain, proved) in plain.iter().zip(&proved) {
            assert_eq!(plain.name(), proved.name(), "{plain:?} {proved:?}");
            assert!((plain.time() - proved.time().midpoint()).abs() < 1e-12, "{plain:?}");
        }
    }
}
