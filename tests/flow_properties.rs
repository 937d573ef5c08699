//! Properties that any exact flow of the model has, whatever its formulas.

use crate::support::original::Equations;
use percuss::{Entry, Exit, Instant, Model, Parameters, Phase, Segment, Start, State};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseError};
use std::f64::consts::TAU;

fn config(cases: u32) -> Config {
    Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(2004), ..Config::default() }
}

fn log(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

/// Models of moderate size, each with a start above, on or off the slider.
fn problems() -> impl Strategy<Value = (Parameters, Start)> {
    let parameters =
        (log(0.03, 3.0), -0.05..0.6_f64, log(1e-3, 20.0), log(0.05, 10.0), 0.0..0.3_f64, 0.0..TAU);
    let depth = prop_oneof![1 => Just(0.0), 2 => log(1e-6, 1.0)];
    let start = (0.0..1.0_f64, -0.5..0.5_f64, depth, -50.0..50.0_f64);
    (parameters, start).prop_map(|((a, b, xi, omega, g, phi), (q, y, depth, tau))| {
        let start = Start { tau, p: q + g - depth, y, q: Some(q), v: 0.3, ..Start::default() };
        (Parameters { a, b, xi, omega, g, phi }, start)
    })
}

fn begin((parameters, start): &(Parameters, Start)) -> (Model, Entry) {
    let model = Model::new(*parameters).unwrap();
    let entry = model.start(start).unwrap();
    (model, entry)
}

/// State and drift without their instant, as bits.
fn bits(entry: &Entry) -> [u64; 5] {
    let angle = entry.instant.angle();
    [entry.state.p, entry.state.y, entry.state.q, entry.v(), angle].map(f64::to_bits)
}

fn is_legal(from: Phase, to: Phase) -> bool {
    match from {
        Phase::NoContact | Phase::Contact => to != from,
        Phase::Progression => to == Phase::Contact,
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn phases_alternate_and_stay_where_they_belong(problem in problems()) {
        let (model, entry) = begin(&problem);
        let Parameters { xi, g, .. } = problem.0;
        let mut v = entry.v();
        for segment in model.trajectory(entry).take(60) {
            let until = if segment.duration().is_finite() { segment.duration() } else { 5.0 };
            let mut largest = 1.0 + segment.entry().state.y.abs();
            for k in 0..=16 {
                let d = until * f64::from(k) / 16.0;
                let sample = segment.at(d);
                let state = sample.state;
                largest = largest.max(state.y.abs());
                let room = 16.0 * f64::EPSILON * (largest + (1.0 + state.y.abs()) * d);
                prop_assert!(state.q >= -room && state.q <= 1.0 + room + 2.0 * xi * largest, "{sample:?} at {d:e} room {room:e} of {segment:?}");
                prop_assert!(state.p <= state.q + g + room, "p: {sample:?} at {d:e} room {room:e} of {segment:?}");
                let step = sample.v - v;
                let terms = v.abs() + problem.0.a / (problem.0.omega * problem.0.omega);
                prop_assert!(step >= -4.0 * f64::EPSILON * terms, "{segment:?}: drift falls by {step:e}");
                v = sample.v;
                if segment.phase() == Phase::NoContact {
                    prop_assert!(state.q.abs() <= segment.entry().state.q.abs());
                }
            }
            if let Exit::Switch(next) = segment.exit() {
                let (one, other) = (segment.phase(), next.phase());
                prop_assert!(is_legal(one, other), "{one} to {other}");
                prop_assert!(segment.duration() > 0.0, "{segment:?}");
                prop_assert!(next.v() >= segment.entry().v());
            }
        }
    }

    /// The slider's top is pressed by forces between 0 and 1: from rest 0 <= q <= 1 for ever.
    #[test]
    fn the_slider_stays_between_rest_and_threshold(problem in problems()) {
        let (parameters, start) = problem;
        let start = Start { p: start.p - start.q.unwrap() - 1e-3, q: Some(0.0), ..start };
        let (model, entry) = begin(&(parameters, start));
        for segment in model.trajectory(entry).take(60) {
            let until = if segment.duration().is_finite() { segment.duration() } else { 5.0 };
            for k in 0..=16 {
                let q = segment.at(until * f64::from(k) / 16.0).state.q;
                let room = 1e-14 * (1.0 + 2.0 * parameters.xi * segment.entry().state.y.abs());
                prop_assert!(q >= -room && q <= 1.0 + room, "{q} in {segment:?}");
            }
        }
    }

    #[test]
    fn cycles_do_not_change_the_states(problem in problems(), late in 1_i64..4_000_000_000) {
        let (model, entry) = begin(&problem);
        for cycle in [1, 100_000_000, late, -late] {
            let later = model.start(&Start { cycle, ..problem.1 }).unwrap();
            prop_assert_eq!(later.instant.cycle() - entry.instant.cycle(), i128::from(cycle));
            for (one, other) in model.trajectory(entry).zip(model.trajectory(later)).take(40) {
                prop_assert_eq!(one.phase(), other.phase());
                prop_assert_eq!(bits(one.entry()), bits(other.entry()));
                prop_assert_eq!(one.duration().to_bits(), other.duration().to_bits());
            }
        }
    }

    /// Cut anywhere and started again, the run goes on as if it had not been cut.
    #[test]
    fn a_cut_changes_nothing(problem in problems(), segments in 0..12_usize, part in 0.02..0.98_f64) {
        let (model, entry) = begin(&problem);
        let Some(segment) = model.trajectory(entry).nth(segments) else { return Ok(()) };
        let Exit::Switch(next) = segment.exit() else { return Ok(()) };
        let omega = problem.0.omega;
        let d = part * segment.duration();
        prop_assume!(d > 1e-3 && segment.duration() - d > 1e-3);
        let sample = segment.at(d);
        let tau = segment.entry().instant.tau(omega) + d;
        let State { p, y, q } = sample.state;
        let again = model.start(&Start { tau, cycle: 0, p, y, q: Some(q), v: sample.v, phase: None });
        // Next to a threshold the rounded state may lie on the other side of it.
        let Ok(again) = again else { return Ok(()) };
        prop_assume!(again.phase() == segment.phase());
        let rest = model.trajectory(again).next().unwrap();
        let Exit::Switch(other) = rest.exit() else { return Err(TestCaseError::fail(format!("{rest:?}"))) };
        prop_assert_eq!(other.phase(), next.phase());
        // The guard is known to 1e-13 of its terms on either way; divided by its slope, a time.
        let slope = crossing_slope(&model, &segment, next);
        let scale = 1.0 + y.abs() + segment.entry().state.y.abs() + problem.0.a / omega + tau.abs() * 0.1;
        let damping = (1.0 / (2.0 * problem.0.xi)).max(1.0);
        let room = 1e-13 * scale * (1.0 + segment.duration()) * damping * (1.0 + 1.0 / slope);
        prop_assume!(room < 1e-6);
        prop_assert!((d + rest.duration() - segment.duration()).abs() <= room);
        let rate = 1.0 + problem.0.a + other.state.y.abs() + other.state.q.abs() * damping;
        for (x, y) in [(other.state.p, next.state.p), (other.state.y, next.state.y), (other.state.q, next.state.q), (other.v(), next.v())] {
            prop_assert!((x - y).abs() <= room * rate, "{x:e} {y:e} {room:e}");
        }
    }

    /// CONTRACT: a start taken from any printed row repeats the rows after it.
    #[test]
    fn any_row_repeats_the_rows_after_it(problem in problems()) {
        let (model, entry) = begin(&problem);
        let omega = problem.0.omega;
        let segments: Vec<Segment> = model.trajectory(entry).take(12).collect();
        for pair in segments.windows(2).skip(1) {
            let row = pair[0].entry();
            let State { p, y, q } = row.state;
            let printed = Start { tau: row.instant.tau(omega), cycle: 0, p, y, q: Some(q), v: row.v(), phase: None };
            let again = model.start(&printed).unwrap();
            prop_assert_eq!(again.phase(), row.phase(), "{:?} {:?}", problem, row);
            let segment = model.trajectory(again).next().unwrap();
            let next = pair[1].entry();
            let slope = crossing_slope(&model, &pair[0], next);
            prop_assume!(slope > 1e-4);
            let damping = (1.0 / (2.0 * problem.0.xi)).max(1.0);
            let room = 1e-12 * damping * (1.0 + row.instant.tau(omega).abs()) * (1.0 + pair[0].duration()) / slope.min(1.0);
            prop_assert!((segment.duration() - pair[0].duration()).abs() <= room, "{:?} {:?}", segment, pair[0]);
        }
    }

    #[test]
    fn the_original_equations_give_the_same(problem in problems()) {
        let (model, entry) = begin(&problem);
        let parameters = problem.0;
        for segment in model.trajectory(entry).take(10) {
            let until = if segment.duration().is_finite() { segment.duration() } else { 3.0 };
            let equations = Equations { phase: segment.phase(), parameters };
            prop_assume!(equations.steps(until) < 3000.0);
            let State { p, y, q } = segment.entry().state;
            let v = segment.entry().v();
            let theta = segment.entry().instant.angle() + parameters.phi;
            let [x, y, z, w] = equations.integrate(theta, [p + v, y, q + v, v], until);
            let end = segment.at(until);
            let scale = 1.0 + v.abs() + x.abs() + (1.0 + y.abs()) * (1.0 + until) + equations.rate();
            let room = 1e-15 * scale * (4.0 + equations.steps(until).sqrt());
            let pairs = [(x, end.state.p + end.v), (y, end.state.y), (z, end.state.q + end.v), (w, end.v)];
            for (integrated, exact) in pairs {
                prop_assert!((integrated - exact).abs() <= room, "{segment:?}: {integrated:e} {exact:e} {room:e}");
            }
        }
    }
}

/// The slope of the guard that ends a segment, at the crossing.
fn crossing_slope(model: &Model, segment: &Segment, next: &Entry) -> f64 {
    let two_xi = 2.0 * model.parameters().xi;
    let State { y, q, .. } = next.state;
    let force = model.force(&next.instant)[0];
    let slope = match segment.phase() {
        Phase::NoContact => y + q / two_xi,
        Phase::Contact => two_xi * (force - (two_xi * y + q)) + y,
        Phase::Progression => force - 1.0 + y / two_xi,
    };
    slope.abs()
}

/// Drift after many periods of a settled orbit against the drift of its own period.
#[test]
fn drift_adds_up_over_a_million_periods() {
    const PERIODS: u64 = 1_000_000;
    let model = Model::new(Parameters { omega: 0.1, ..Parameters::default() }).unwrap();
    let strobe = |from: Entry, periods: u64| -> (Entry, f64, [f64; 3]) {
        let end = from.instant.after_periods(periods, 1);
        let segment = model.trajectory(from).until(end).last().unwrap();
        let at = segment.at_instant(&end);
        (*segment.entry(), at.v, [at.state.p, at.state.y, at.state.q])
    };
    let rest = model.start(&Start::default()).unwrap();
    let settle = |n: u64| strobe(rest, n).1;
    // Settled after 400 periods; the orbit has period two.
    let per_period = (settle(600) - settle(400)) / 200.0;
    let (far, near) = (settle(400 + PERIODS), settle(400));
    let expected = per_period * PERIODS as f64;
    let error = (far - near) / expected - 1.0;
    println!(
        "drift per period {per_period}, after {PERIODS} periods {far}, relative error {error:e}"
    );
    // per_period is known to an eps of v over 200 periods.
    assert!(error.abs() <= 4.0 * f64::EPSILON * near / (200.0 * per_period) + 1e-14, "{error:e}");
}

/// Late starts by tau itself: whole periods only as far as tau can say so.
#[test]
fn a_late_horizon_is_where_it_should_be() {
    let model = Model::new(Parameters { omega: 1.0, ..Parameters::default() }).unwrap();
    let start = model.start(&Start { cycle: 1 << 53, ..Start::default() }).unwrap();
    let horizon: Instant = start.instant.after_periods(3, 1);
    let total: f64 = model.trajectory(start).until(horizon).map(|segment| segment.duration()).sum();
    assert!((total - 3.0 * TAU).abs() < 1e-13, "{total}");
}
