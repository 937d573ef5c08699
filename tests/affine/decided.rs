//! Runs that the model decides: kinds on which earlier solvers gave up without cause.

use super::{enclosed_events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Bits212, Bits3392, Ending, Event, System, What};
use percuss::number::Number;

/// A system of one mode that is watched, with a start.
fn watched_system(
    states: &str,
    head: &str,
    equations: &str,
    guards: &[&str],
    start: &str,
) -> System {
    let guards: String = guards
        .iter()
        .enumerate()
        .map(|(n, it)| format!("[[mode.watch]]\nname = \"g{n}\"\n{it}\n"))
        .collect();
    system(&format!(
        "schema = 1\nname = \"decided\"\nstates = [{states}]\n{head}\n[[mode]]\nname = \"only\"\n\
         equations = [{equations}]\n{guards}[start]\nmode = \"only\"\n{start}\n"
    ))
}

fn last<T: Number>(system: &System, until: f64) -> Event<T> {
    enclosed_events::<T>(system, until).pop().unwrap()
}

/// x = x0 cos(t sqrt(k/m)), whose quotient is no sum of powers of two in most of these; the stop is
/// never reached.
#[test]
fn quotients_of_round_numbers_are_as_good_as_decimals() {
    let masses: [f64; 7] = [0.1, 0.2, 0.3, 0.5, 0.7, 3.0, 7.0];
    let springs: [f64; 7] = [13.0, 20.0, 30.0, 50.0, 100.0, 200.0, 400.0];
    for (k, m) in springs.iter().flat_map(|k| masses.map(|m| (*k, m))) {
        let oscillator = watched_system(
            "\"x\", \"v\"",
            &format!("[parameters]\nk = {k}\nm = {m:?}\nstop = 0.004"),
            "\"x' = v\", \"v' = -k*x/m\"",
            &["guard = \"x > stop\""],
            "x = -0.003\nv = 0",
        );
        let end = last::<DoubleDouble>(&oscillator, 20.0);
        assert_eq!(end.what, What::End(Ending::Horizon), "{k}/{m}");
        let exact = -0.003 * (20.0 * (k / m).sqrt()).cos();
        assert!((end.state[0].to_f64() - exact).abs() < 1e-15 * (1.0 + 20.0 * (k / m)), "{k}/{m}");
        let error = end.errors.unwrap().state[0];
        assert!(error < 1e-28, "{k}/{m}: {error:e}");
    }
}

/// x'' = -k x - c x' with rates that are (nearly) equal and slow: exp(-c t/2) (1 + c t/2) where
/// they are.
#[test]
fn slow_pairs_are_passed_at_once() {
    for (k, c) in [("1e-6", "2e-3"), ("1e-6", "2.000001e-3"), ("2.5e-5", "1e-2"), ("1e-8", "2e-4")]
    {
        let pair = watched_system(
            "\"x\", \"v\"",
            &format!("[parameters]\nk = {k}\nc = {c}\nfar = 5"),
            "\"x' = v\", \"v' = -k*x - c*v\"",
            &["guard = \"x + far < 0\""],
            "x = 1\nv = 0",
        );
        let end = last::<DoubleDouble>(&pair, 3000.0);
        assert_eq!(end.what, What::End(Ending::Horizon), "{k} {c}");
        let turn = 0.5 * c.parse::<f64>().unwrap() * 3000.0;
        let (x, exact) = (end.state[0].to_f64(), (-turn).exp() * (1.0 + turn));
        assert!((x - exact).abs() < 1e-5 * exact, "{k} {c}: {x} {exact}");
        let error = end.errors.unwrap().state[0];
        assert!(error < 1e-24 * exact, "{k} {c}: {error:e}");
    }
}

/// y = (1/2 - 1/d) exp(-(1 + d) t) + exp(-t)/d with d = 1e-9, as mpmath 1.3.0 has it: 106 bits lose
/// it beside the exponents of f64, 212 do not.
#[test]
fn two_decays_of_nearly_one_rate_keep_their_digits() {
    let pair = watched_system(
        "\"x\", \"y\"",
        "[parameters]\nk = 1.0\nk2 = 1.000000001",
        "\"x' = -k*x\", \"y' = -k2*y + x\"",
        &["guard = \"y < 0\""],
        "x = 1\ny = 0.5",
    );
    for (until, digits, power) in
        [(300.0, 1.547_033_934_393_574_1, -128), (2000.0, 5.154_354_858_213_509, -866)]
    {
        let end = last::<Bits212>(&pair, until);
        assert_eq!(end.what, What::End(Ending::Horizon));
        let ten = Bits212::exact(10.0);
        let scaled = (power..0).fold(end.state[1], |it, _| it * ten).to_f64();
        assert!((scaled / digits - 1.0).abs() < 1e-14, "{until}: {scaled}");
        let share = end.errors.unwrap().state[1] / end.state[1].bound();
        assert!(share < 1e-45, "{share:?}");
    }
}

/// A sine and a cosine of one angle that cross 0.6 and -0.8 at one instant, a sine that touches 1,
/// a parabola that touches its crest, and an oscillation that touches its amplitude.
#[test]
fn ties_and_touches_of_the_model_are_decided() {
    let forced = |guards: &[&str]| {
        watched_system(
            "\"n\"",
            "forcing = { omega = 1.0, phi = 0.5 }",
            "\"n' = 0\"",
            guards,
            "n = 0",
        )
    };
    let tie = forced(&[
        "guard = \"10*sin > 6\"\ndirection = \"falling\"",
        "guard = \"10*cos < -8\"",
        "guard = \"sin > 1\"",
        "guard = \"3*sin + 4*cos > 5\"",
    ]);
    let all = enclosed_events::<DoubleDouble>(&tie, 6.0);
    assert_eq!(names(&tie, &all), ["g0", "g1", "end"]);
    assert_eq!(all[0].time.value(), all[1].time.value());
    assert!(
        (all[0].time.value().to_f64() - (std::f64::consts::PI - 0.6_f64.asin() - 0.5)).abs()
            < 1e-15
    );
    let thrown = watched_system(
        "\"x\", \"v\", \"s\"",
        "",
        "\"x' = v\", \"v' = -8\", \"s' = 1\"",
        &[
            "guard = \"4*x > 1\"",
            "guard = \"4*s > 1\"",
            "guard = \"16*x > 3\"\ndirection = \"both\"",
        ],
        "x = 0\nv = 2\ns = 0",
    );
    let all = enclosed_events::<DoubleDouble>(&thrown, 1.0);
    assert_eq!(names(&thrown, &all), ["g2", "g1", "g2", "end"]);
    let oscillator = watched_system(
        "\"x\", \"v\"",
        "",
        "\"x' = v\", \"v' = -4*x\"",
        &["guard = \"x > 5\"", "guard = \"x < 3\"", "guard = \"v < -8\""],
        "x = 5\nv = 0",
    );
    let all = enclosed_events::<DoubleDouble>(&oscillator, 3.0);
    assert_eq!(names(&oscillator, &all), ["g1", "g2", "end"]);
    assert_eq!(all[0].time.value(), all[1].time.value());
}

/// A watched guard that touches zero at the very instant at which its mode ends.
#[test]
fn a_touch_at_the_end_of_a_mode_is_no_event() {
    let touch = system(
        "schema = 1\nname = \"touch\"\nstates = [\"x\", \"y\", \"w\"]\n[[mode]]\nname = \"a\"\n\
         equations = [\"x' = 1\", \"y' = w\", \"w' = -2\"]\n[[mode.until]]\nname = \"over\"\n\
         guard = \"x > 1\"\nnext = [{ mode = \"b\" }]\n[[mode.watch]]\nname = \"touch\"\n\
         guard = \"y > 0\"\n[[mode]]\nname = \"b\"\nequations = [\"x' = 1\", \"y' = w\", \"w' = -2\"]\n\
         [start]\nmode = \"a\"\nx = 0\ny = -1\nw = 2\n",
    );
    assert_eq!(names(&touch, &enclosed_events::<DoubleDouble>(&touch, 3.0)), ["over", "end"]);
    assert_eq!(names(&touch, &enclosed_events::<f64>(&touch, 3.0)), ["over", "end"]);
}

/// From rest under a sine near resonance: x begins with three zeros, and comes back near a half
/// turn of its own.
#[test]
fn a_run_from_rest_under_a_sine_begins() {
    let forced = watched_system(
        "\"x\", \"v\"",
        "forcing = { omega = \"w + d\", phi = 0 }\n[parameters]\nw = 1.5\nd = 5e-6\nF = 0.9",
        "\"x' = v\", \"v' = -w^2*x + F*sin\"",
        &["guard = \"x > 0\"\ndirection = \"both\""],
        "x = 0\nv = 0",
    );
    let all = enclosed_events::<DoubleDouble>(&forced, 15.0);
    assert!(all.len() > 3 && names(&forced, &all).iter().all(|it| it == "g0" || it == "end"));
    // At resonance x = F (sin(w t) - w t cos(w t))/(2 w^2), which is zero where tan(w t) = w t.
    let first = all[0].time.value().to_f64() * 1.5;
    assert!((first - 4.493_409_457_909_064).abs() < 1e-4, "{first}");
}

/// A bilinear oscillator on its stable orbit: the errors of its states stay what they are.
#[test]
fn no_digits_are_lost_on_a_stable_orbit() {
    let bilinear = system(
        "schema = 1\nname = \"bilinear\"\nstates = [\"x\", \"v\"]\n\
         forcing = { omega = 0.8, phi = 0.0 }\n[parameters]\nz = 0.05\nk = 9.0\ne = 0.5\n\
         [[mode]]\nname = \"free\"\nequations = [\"x' = v\", \"v' = -x - 2*z*v + cos\"]\n\
         [[mode.until]]\nname = \"touch\"\nguard = \"x > e\"\nnext = [{ mode = \"contact\" }]\n\
         [[mode]]\nname = \"contact\"\n\
         equations = [\"x' = v\", \"v' = -x - 2*z*v - k*(x - e) + cos\"]\n\
         [[mode.until]]\nname = \"leave\"\nguard = \"x < e\"\nnext = [{ mode = \"free\" }]\n\
         [start]\nmode = \"free\"\nx = 0\nv = 0\n",
    );
    let all = enclosed_events::<f64>(&bilinear, 40_000.0);
    assert!(all.len() > 10_000, "{}", all.len());
    let error = |n: usize| all[n].errors.as_ref().unwrap().state[1];
    let early = (200..1000).map(error).fold(0.0, f64::max);
    let late = (all.len() - 800..all.len() - 1).map(error).fold(0.0, f64::max);
    assert!(late < 2.0 * early && early < 1e-12, "{early:e} {late:e}");
}

/// Impacts on a ball that is forced from 1e6 units of time on, beside a state that is not coupled:
/// mpmath 1.3.0 follows 60 impacts to 1000003.858530804339970081157, with 4.4e-18 left.
#[test]
fn impacts_accumulate_late_and_beside_other_states() {
    for (states, more, start) in [("", "", ""), (", \"u\"", ", \"u' = -u/8\"", "u = 1\n")] {
        let ball = system(&format!(
            "schema = 1\nname = \"late\"\nstates = [\"x\", \"v\"{states}]\n\
             forcing = {{ omega = 9.25, phi = 0.5 }}\n[parameters]\nF = 0.25\nr = 0.5\n\
             [[mode]]\nname = \"fly\"\nequations = [\"x' = v\", \"v' = -1 + F*cos\"{more}]\n\
             [[mode.until]]\nname = \"hit\"\nguard = \"x < 0\"\nreset = [\"x = 0\", \"v = -r*v\"]\n\
             [start]\nmode = \"fly\"\nt = 1000000.0\nx = 1\nv = 0\n{start}"
        ));
        let end = last::<Bits212>(&ball, 1_000_100.0);
        let What::End(Ending::Accumulation(from, to)) = end.what else { panic!("{:?}", end.what) };
        let since = end.time.value() - Bits212::exact(1_000_003.0);
        let [from, to] = [from, to].map(|it| since + it);
        let exact = Bits212::exact(0.858_530_804_339_970_1);
        let near = |it: Bits212| (it - exact).to_f64().abs() < 1e-16;
        assert!(near(from) && near(to) && from < to, "{from:?} {to:?}");
    }
}

/// A chain of six states with couplings of 1e-20: the first is 1e-100 t^6/6!, whose powers are far
/// below those of its matrix, and crosses 1 at (6! 1e100)^(1/6).
#[test]
fn a_chain_of_small_couplings_keeps_its_powers() {
    let states: Vec<String> = (0..6).map(|n| format!("\"x{n}\"")).collect();
    let mut equations: Vec<String> = (0..5).map(|n| format!("\"x{n}' = a*x{}\"", n + 1)).collect();
    equations.push("\"x5' = 1\"".to_owned());
    let start: String = (0..6).map(|n| format!("x{n} = 0\n")).collect();
    let chain = watched_system(
        &states.join(", "),
        "[parameters]\na = 1e-20",
        &equations.join(", "),
        &["guard = \"x0 > 1\""],
        &start,
    );
    let all = enclosed_events::<DoubleDouble>(&chain, 2e17);
    assert_eq!(names(&chain, &all), ["g0", "end"]);
    let exact = ((720_f64.ln() + 100.0 * 10_f64.ln()) / 6.0).exp();
    assert!((all[0].time.value().to_f64() / exact - 1.0).abs() < 1e-12);
    assert!((all[1].state[0].to_f64() / (64e2 / 720.0) - 1.0).abs() < 1e-12);
}

/// A chain of nine states with couplings of 1: it has crossed 1 at (9!)^(1/9), and no bound that
/// holds for ever is taken for it.
#[test]
fn a_long_chain_grows() {
    let states: Vec<String> = (0..9).map(|n| format!("\"x{n}\"")).collect();
    let mut equations: Vec<String> = (0..8).map(|n| format!("\"x{n}' = x{}\"", n + 1)).collect();
    equations.push("\"x8' = 1\"".to_owned());
    let start: String = (0..9).map(|n| format!("x{n} = 0\n")).collect();
    let guard = ["guard = \"x0 > 1\""];
    let chain = watched_system(&states.join(", "), "", &equations.join(", "), &guard, &start);
    let exact = (362_880_f64.ln() / 9.0).exp();
    for time in [
        enclosed_events::<DoubleDouble>(&chain, 20.0)[0].time.value().to_f64(),
        enclosed_events::<f64>(&chain, 20.0)[0].time.value(),
    ] {
        assert!((time / exact - 1.0).abs() < 1e-13, "{time}");
    }
}

/// exp(-t) touches exp(-2 t) + 1/4 at the logarithm of two, which no exact arithmetic here knows,
/// and whatever the bits, no crossing is made of the touch.
#[test]
fn a_touch_is_no_crossing_in_any_number_of_bits() {
    let touch = watched_system(
        "\"a\", \"b\"",
        "",
        "\"a' = -a\", \"b' = -2*b\"",
        &["guard = \"4*a > 4*b + 1\""],
        "a = 1\nb = 1",
    );
    assert_eq!(names(&touch, &enclosed_events::<Bits212>(&touch, 1.0)), ["undecided"]);
    assert_eq!(names(&touch, &enclosed_events::<Bits3392>(&touch, 1.0)), ["undecided"]);
}
