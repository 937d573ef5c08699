//! Impacts that accumulate beside states that do not come to a limit as their speed does: timers
//! that each impact sets back, counts of the impacts, and conditions on the speed.

use super::{enclosed_events, events, names};
use percuss::System;
use percuss::affine::{Bits212, DoubleDouble, Event, What};
use percuss::number::{Bound, Number};
use proptest::prelude::*;

/// A ball with a timer c, a countdown d, a count n and a sum w that each impact makes smaller. At
/// rest the timer goes on; the ball is thrown again when it is tau.
fn text(numbers: &str, limit: &str) -> String {
    format!(
        r#"
        schema = 1
        name = "ball"
        states = ["x", "v", "c", "d", "n", "w"]
        parameters = {{ {numbers} }}
        [[mode]]
        name = "flight"
        equations = ["x' = v", "v' = -g", "c' = 1", "d' = -2", "n' = 0", "w' = 1 + w"]
        [[mode.until]]
        name = "impact"
        guard = "x < 0"
        reset = ["x = 0", "v = -e*v", "c = 0", "d = 5", "n = n + 1", "w = w/3"]
        next = [{{ when = "v > 0", mode = "flight" }}, {{ mode = "rest" }}]
        accumulates_to = {{ reset = [{limit}], next = "rest" }}
        [[mode]]
        name = "rest"
        equations = ["x' = 0", "v' = 0", "c' = 1", "d' = 0", "n' = 0", "w' = 0"]
        [[mode.until]]
        name = "throw"
        guard = "c > tau"
        reset = ["v = u"]
        next = [{{ mode = "flight" }}]
        [start]
        mode = "flight"
        x = 0
        v = "u"
        c = 3
        d = 0
        n = 0
        w = 1
        "#
    )
}

fn ball(numbers: &str, limit: &str) -> System {
    System::from_toml(&text(numbers, limit)).unwrap()
}

const LIMIT: &str = r#""v = 0", "n = 0", "w = 0""#;

/// Compares the times of two limits and of the throws after them, and the states there.
fn judge<T: Number>(ball: &System, events: &[Event<T>], [u, g, e, tau]: [f64; 4], share: f64) {
    let [u, g, e, tau] = [u, g, e, tau].map(T::exact);
    let bounces = T::exact(2.0) * u / (g * (T::one() - e));
    let is_told = |it: &&Event<T>| {
        matches!(it.what, What::Limit(..)) || ball.modes[1].until[0].name == super::name(ball, it)
    };
    let told: Vec<_> = events.iter().filter(is_told).collect();
    let known = [bounces, bounces + tau, bounces + bounces + tau, (bounces + tau) * T::exact(2.0)];
    assert_eq!(told.len(), known.len(), "{:?}", names(ball, events));
    for (it, known) in told.into_iter().zip(known) {
        let size = known.to_f64();
        let room = it.errors.as_ref().map_or(0.0, |it| it.time.to_f64());
        let apart = (it.time.value() - known).to_f64().abs();
        assert!(apart <= room + share * size, "{apart:e} of {size}, {room:e}");
        let [c, d, n, w] = [2, 3, 4, 5].map(|k| it.state[k].to_f64());
        assert_eq!([d, n, w], [5.0, 0.0, 0.0]);
        let is_limit = matches!(it.what, What::Limit(..));
        let c_known = if is_limit { T::zero() } else { tau };
        assert!((c - c_known.to_f64()).abs() <= 1e-15 * c_known.to_f64(), "{c}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    /// Impacts of a ball accumulate where the series says, whatever goes on beside it: the shares
    /// are those of [`super::past_limits`].
    #[test]
    fn states_beside_impacts_do_not_hide_their_limit(
        u in 0.5_f64..20.0, g in 1.0_f64..12.0, e in 0.02_f64..0.95, tau in 0.1_f64..3.0,
    ) {
        let ball = ball(&format!("u = {u:?}, g = {g:?}, e = {e:?}, tau = {tau:?}"), LIMIT);
        let numbers = [u, g, e, tau];
        let end = 2.0 * (2.0 * u / (g * (1.0 - e)) + tau) + 0.01;
        judge(&ball, &events::<f64>(&ball, end), numbers, 1e-12);
        judge(&ball, &enclosed_events::<DoubleDouble>(&ball, end), numbers, 1e-29);
        judge(&ball, &enclosed_events::<Bits212>(&ball, end), numbers, 1e-60);
    }
}

const NUMBERS: &str = "u = 1, g = 1, e = 0.5, tau = 1";

/// The names of a ball's events up to its first limit, in f64 and proved.
fn endings(ball: &System) -> [Vec<String>; 2] {
    let proved = enclosed_events::<DoubleDouble>(ball, 10.0);
    [names(ball, &events::<f64>(ball, 10.0)), names(ball, &proved)]
}

/// A count has no limit: a run goes on beyond the impacts only where their limit resets it.
#[test]
fn a_count_that_the_limit_keeps_ends_the_run() {
    for limit in [r#""v = 0", "w = 0""#, r#""v = 0", "n = n + 1", "w = 0""#] {
        for all in endings(&ball(NUMBERS, limit)) {
            assert_eq!(all.last().map(String::as_str), Some("accumulation"), "{limit}");
        }
    }
}

/// An event that depends on a count happens at its impact: with e = 1/2 the time left is proved to
/// be below 2^-30 from about the thirtieth on.
#[test]
fn a_condition_that_counts_impacts_comes_before_their_limit() {
    let text = text(NUMBERS, LIMIT).replace("v > 0", "n < 81/2");
    for all in endings(&System::from_toml(&text).unwrap()) {
        assert_eq!(all.iter().position(|it| it != "impact"), Some(41), "{all:?}");
        assert_eq!(all[41], "throw");
    }
}

/// A count that moves another state matters.
#[test]
fn a_sum_that_moves_another_state_is_not_left_out() {
    let text = r#"
        schema = 1
        name = "ball"
        states = ["x", "v", "n", "y"]
        [[mode]]
        name = "flight"
        equations = ["x' = v", "v' = -1", "n' = 0", "y' = n"]
        [[mode.until]]
        name = "impact"
        guard = "x < 0"
        reset = ["x = 0", "v = -v/2", "n = n + 1"]
        next = [{ mode = "flight" }]
        [start]
        mode = "flight"
        x = 0
        v = 1
        n = 0
        y = 0
    "#;
    let ball = System::from_toml(text).unwrap();
    let all = names(&ball, &enclosed_events::<DoubleDouble>(&ball, 10.0));
    assert_ne!(all.last().map(String::as_str), Some("accumulation"));
    let idle = System::from_toml(&text.replace("y' = n", "y' = x")).unwrap();
    for all in endings(&idle) {
        assert_eq!(all.last().map(String::as_str), Some("accumulation"));
    }
}

/// A condition that is a multiple of the speed, up to what is zero after an impact, is the same at
/// each; one that asks for a speed fails at the impact that has less.
#[test]
fn conditions_on_the_speed_hold_up_to_the_limit() {
    let text = text(NUMBERS, LIMIT);
    let with = |when: &str| System::from_toml(&text.replace("v > 0", when)).unwrap();
    for when in ["v > 0", "2*v + x > 0", "v - c > 0"] {
        for all in endings(&with(when)) {
            assert!(all.iter().any(|it| it == "accumulation"), "{when}: {all:?}");
        }
    }
    // Impact k has the speed 2^-k after it.
    for all in endings(&with("2^20*v > 3/2")) {
        assert_eq!(all.iter().position(|it| it != "impact"), Some(20), "{all:?}");
        assert_eq!(all[20], "throw");
    }
}
