//! Systems whose events are known: rational times, limit cycles, published instants.

use super::models::{bouncing_ball, relay, rigid_oscillator, spheres, two_state_switching};
use super::{AskedRun, FIRST_ORDER_ENGINE, LOOSE_ROOTS_ENGINE, SAMPLES, check, every};

/// Times of impact are 2 (1 + e + e^2 + ...), and halfway between them the ball is highest.
#[test]
fn the_bouncing_ball_is_a_geometric_series() {
    let system = bouncing_ball(0.5);
    let mut truth = Vec::new();
    let (mut t, mut dwell) = (0.0, 2.0);
    while dwell > 1e-3 {
        truth.extend([(1, 0, t + 0.5 * dwell), (0, 0, t + dwell)]);
        t += dwell;
        dwell *= 0.5;
    }
    let asked = AskedRun { system: &system, mode: 0, state: &[0.0, 1.0], span: t + 0.25 * dwell };
    check(&asked, &truth, 20.0, &[LOOSE_ROOTS_ENGINE]);
}

/// Samples are taken where events cut steps short too, and lie on the parabola of their flight.
#[test]
fn samples_lie_on_their_flights() {
    let system = bouncing_ball(0.5);
    let asked = AskedRun { system: &system, mode: 0, state: &[0.0, 1.0], span: 3.9 };
    for (name, unit, outcome) in every(&asked).into_iter().filter(|it| it.0 != LOOSE_ROOTS_ENGINE) {
        let samples = outcome.unwrap_or_default().samples;
        assert_eq!(samples.len(), SAMPLES as usize + 1, "{name}");
        for (k, sample) in samples.iter().enumerate() {
            let t = 3.9 * k as f64 / f64::from(SAMPLES);
            let (mut begin, mut speed) = (0.0, 1.0);
            while t > begin + 2.0 * speed {
                begin += 2.0 * speed;
                speed *= 0.5;
            }
            let since = t - begin;
            let expected = speed * since - 0.5 * since * since;
            assert!((sample[0] - expected).abs() <= 20.0 * unit, "{name} {t}: {sample:?}");
        }
    }
}

/// The half period T of the relay's limit cycle, by bisection: after it the state has changed its
/// sign, (I + exp(A T)) d = -2 with d the distance from the rest state (1, 1, 1).
fn half_period(delta: f64) -> f64 {
    let output = |t: f64| {
        let decay = (-t).exp();
        let third = -2.0 / (1.0 + decay);
        let second = (-2.0 - decay * t * third) / (1.0 + decay);
        let first = (-2.0 - decay * (t * second + 0.5 * t * t * third)) / (1.0 + decay);
        -(1.0 + first)
    };
    let (mut left, mut right) = (1.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (left + right);
        if output(middle) < delta { left = middle } else { right = middle }
    }
    right
}

#[test]
fn the_relay_settles_to_its_limit_cycle() {
    for (delta, known) in [(1e-2, 1.919_201), (1e-4, 1.840_734)] {
        let period = half_period(delta);
        assert!((period - known).abs() < 1e-6, "{period}");
        let system = relay(delta);
        let asked = AskedRun { system: &system, mode: 0, state: &[0.0, 0.0, 0.0], span: 40.0 };
        for (name, unit, outcome) in
            every(&asked).into_iter().filter(|it| it.0 != LOOSE_ROOTS_ENGINE)
        {
            let events = outcome.map(|it| it.events).unwrap_or_default();
            let times: Vec<f64> = events.iter().map(|event| event.elapsed).collect();
            let last = times.windows(2).last().map_or(0.0, |pair| pair[1] - pair[0]);
            // The cycle attracts: errors do not add up.
            let error = (last - period).abs() / unit;
            assert!(times.len() > 15 && error < 100.0, "{name} {delta}: {last} {error}");
        }
    }
}

/// Three spheres of which the first meets the second, and that the third: at 1, 5/3 and 3.
#[test]
fn spheres_meet_at_rational_times() {
    let system = spheres(3, 1.0);
    let state = [0.0, 2.0, 4.5, 1.0, 0.0, -0.5];
    let asked = AskedRun { system: &system, mode: 0, state: &state, span: 5.0 };
    check(&asked, &[(0, 0, 1.0), (1, 0, 5.0 / 3.0), (0, 0, 3.0)], 20.0, &[]);
}

/// Published instants of ARGESIM's comparison C5. Explicit methods do not come to its end in three
/// million calls.
#[test]
fn two_state_switching_is_as_published() {
    let system = two_state_switching();
    let times = [1.108_306_167_771, 2.129_685_355_155, 3.054_152_906_996, 4.075_532_094_379];
    let truth: Vec<_> = times.iter().enumerate().map(|(n, t)| (0, (n + 1) % 2, *t)).collect();
    let asked = AskedRun { system: &system, mode: 0, state: &[4.2, 0.3], span: 4.5 };
    let stiff = [
        "diffsol-tsit45",
        "ode_solvers-dopri5",
        FIRST_ORDER_ENGINE,
        "ode_solvers-dop853-time",
        "ode_solvers-rk4",
        "differential-equations-rkv655e",
        LOOSE_ROOTS_ENGINE,
        "differential-equations-rkv767e",
        "differential-equations-dop853",
    ];
    check(&asked, &truth, 20.0, &stiff);
}

/// A stop that is met now and then, and a middle that is passed in both directions.
#[test]
fn the_rigid_oscillator_follows_its_closed_form() {
    let system = rigid_oscillator(0.05, 2.0, 2.0, 0.5);
    let asked = AskedRun { system: &system, mode: 0, state: &[0.3, 0.1], span: 30.0 };
    let truth = asked.truth(1e-2);
    assert!(truth.len() > 20, "{truth:?}");
    check(&asked, &truth, 20.0, &[FIRST_ORDER_ENGINE, LOOSE_ROOTS_ENGINE]);
}
