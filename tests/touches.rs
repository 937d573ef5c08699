//! Touches that f64 cannot decide: each is counted, and the run goes on as after a touch.
//!
//! Each guard is planted so that its crest lies a known distance from the threshold, in units of
//! the rounding room that the solver allows itself: four eps times the largest sum of the guard's
//! terms.

use crate::support::random::Draw;
use percuss::{Model, Parameters, Phase, Start};
use std::f64::consts::PI;

const EPS: f64 = f64::EPSILON;

/// Touches of each kind.
const TOUCHES: u64 = 100;

/// The first phase of a run, with its count of undecidable touches and of switches within some
/// periods.
struct First {
    undecidable: u64,
    switches: u64,
    phase: Phase,
}

fn first(parameters: Parameters, start: Start, periods: u64) -> First {
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let mut run = model.trajectory(entry).until(entry.instant.after_periods(periods, 1));
    let phase = run.next().unwrap().phase();
    First { undecidable: run.counters().undecidable, switches: run.counters().switches, phase }
}

/// A parabola from -g/2 with its crest at the gap plus `above`, in eps of g: with a = 0 and the
/// slider at rest all numbers are exact. Its terms at the crest add up to 2 g.
fn parabola(scale: i32, speed: i32, above: f64) -> First {
    let (g, y) = (2.0_f64.powi(scale), 2.0_f64.powi(speed));
    let (p, b) = (0.5 * g * (1.0 + 2.0 * EPS * above), -y * y / g);
    let parameters = Parameters { a: 0.0, b, xi: 0.25, omega: 1.0, g, phi: 0.0 };
    first(parameters, Start { p, y, q: Some(0.0), ..Start::default() }, 1 << 20)
}

/// Four eps of 2 g are eight units. Inside, both pieces that meet at the crest count a touch.
/// Outside, the crest is a switch, whatever the piece before it counts. Below, the hull of a piece
/// is wider than its guard: how far it counts is not said.
#[test]
fn parabolas_are_decided_outside_the_rounding_room_and_counted_inside() {
    for (scale, speed) in [(0, 0), (-6, -4), (5, 0), (10, 5), (-12, -3)] {
        let counts = |above: i32| {
            let First { undecidable, switches, phase } = parabola(scale, speed, f64::from(above));
            assert_eq!(phase, Phase::NoContact);
            (undecidable, switches)
        };
        for above in -8..=0 {
            assert_eq!(counts(above), (2, 0), "{scale} {speed} {above}");
        }
        for above in 9..=64 {
            assert_eq!(counts(above).1, 1, "{scale} {speed} {above}");
            assert_eq!(counts(-above - 32), (0, 0), "{scale} {speed} {}", -above - 32);
        }
    }
}

/// A damped oscillation of the trial force from rest, whose first crest touches 1 or whose first
/// trough touches 0.
///
/// f'' + 2 xi f' + f = b; from f' = 0 its first extremum is b + (b - f0) exp(-pi xi/nu).
fn damped_oscillation(draw: &mut Draw, top: bool) -> First {
    let xi = draw.decades(1e-3, 0.5);
    let f0 = if top { draw.between(0.05, 0.5) } else { draw.between(0.5, 0.95) };
    let left = libm::exp(-PI * xi / (1.0 - xi * xi).sqrt());
    let threshold = if top { 1.0 } else { 0.0 };
    let b = (threshold + f0 * left) / (1.0 + left);
    let y = -2.0 * xi * (b - f0);
    let q = f0 - 2.0 * xi * y;
    let parameters = Parameters { a: 0.0, b, xi, omega: 1.0, g: 0.02, phi: 0.0 };
    first(parameters, Start { p: q + 0.02, y, q: Some(q), ..Start::default() }, 1)
}

#[test]
fn oscillations_of_the_trial_force_that_touch_a_threshold_are_counted() {
    let mut draw = Draw(41);
    for top in [false, true] {
        for _ in 0..TOUCHES {
            let First { undecidable, switches, phase } = damped_oscillation(&mut draw, top);
            assert_eq!(phase, Phase::Contact);
            assert!(undecidable > 0 && switches == 0, "{undecidable} {switches}");
        }
    }
}

/// A progression whose drift velocity (a/omega) (1 + sin(omega d)) touches zero after three
/// quarters of a period.
fn slip(draw: &mut Draw) -> First {
    let (a, omega) = (draw.decades(1e-2, 1e2), draw.decades(0.05, 20.0));
    let parameters = Parameters { a, b: 1.0, xi: 0.2, omega, g: 0.02, phi: 0.0 };
    let start = Start { p: 1.02, y: a / omega, q: Some(1.0), ..Start::default() };
    first(parameters, start, 1)
}

#[test]
fn progressions_that_touch_rest_are_counted() {
    let mut draw = Draw(42);
    for _ in 0..TOUCHES {
        let First { undecidable, switches, phase } = slip(&mut draw);
        assert_eq!(phase, Phase::Progression);
        assert!(undecidable > 0 && switches == 0, "{undecidable} {switches}");
    }
}

/// A flight under a cos(omega tau + phi) - c from rest that grazes.
fn flight(draw: &mut Draw) -> First {
    let (a, omega) = (draw.decades(1e-2, 1e2), draw.decades(0.05, 20.0));
    // p = p0 + y d + (a/omega^2) (1 - cos(omega d)): at y = 0 its crests, 2 a/omega^2 high, touch.
    let rise = 2.0 * (a / (omega * omega));
    let parameters = Parameters { a, b: 0.0, xi: 0.2, omega, g: rise, phi: 0.0 };
    first(parameters, Start { p: 0.0, y: 0.0, q: Some(0.0), ..Start::default() }, 1)
}

#[test]
fn flights_that_graze_are_counted() {
    let mut draw = Draw(43);
    for _ in 0..TOUCHES {
        let First { undecidable, switches, phase } = flight(&mut draw);
        assert_eq!(phase, Phase::NoContact);
        assert!(undecidable > 0 && switches == 0, "{undecidable} {switches}");
    }
}

/// A contact in its steady state, which is highest `above` beyond 1, in eps: the first phase within
/// six periods.
fn steady(draw: &mut Draw, above: f64) -> First {
    let (xi, omega) = (draw.between(0.75, 3.0), draw.decades(0.003, 0.1));
    let (a, phi) = (draw.between(0.05, 0.3), draw.between(0.0, 6.0));
    // f'' + 2 xi f' + f = F + 2 xi F'
    let (pull, lag) = (1.0 - omega * omega, 2.0 * xi * omega);
    let amplitude = a * libm::hypot(1.0, lag) / libm::hypot(pull, lag);
    let b = 1.0 - amplitude + above * EPS;
    let angle = phi + libm::atan(lag) - libm::atan2(lag, pull);
    let force = b + amplitude * libm::cos(angle);
    let force_rate = -omega * amplitude * libm::sin(angle);
    let y = force_rate - 2.0 * xi * (b + a * libm::cos(phi) - force);
    let q = force - 2.0 * xi * y;
    let parameters = Parameters { a, b, xi, omega, g: 0.02, phi };
    first(parameters, Start { p: q + 0.02, y, q: Some(q), ..Start::default() }, 6)
}

/// The amplitude here is good to two eps, and the rounding room is at most four of five.
#[test]
fn steady_states_that_come_next_to_a_threshold_are_decided_or_counted() {
    let mut draw = Draw(44);
    for _ in 0..1000 {
        let above = draw.sign() * draw.decades(0.1, 1000.0);
        let First { undecidable, switches, phase } = steady(&mut draw, above);
        assert_eq!(phase, Phase::Contact);
        let found = format!("{above} eps: {undecidable} touches, {switches} switches");
        match above {
            32.0.. => assert!(switches == 1, "{found}"),
            ..-32.0 => assert!(switches == 0 && undecidable == 0, "{found}"),
            ..0.0 => assert!(switches == 0, "{found}"),
            _ => assert!(switches + undecidable > 0, "{found}"),
        }
    }
}
