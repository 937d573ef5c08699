//! What two words of f64 cannot hold ends a run as undecided; what they can hold is right, however
//! large the time, the frequency or the quotient of two couplings.

use super::{enclosed_events, events, name, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Event, Solver, System};

/// A system of one mode with one watched guard.
fn watched_system(states: &str, equations: &str, guard: &str, start: &str) -> System {
    system(&format!(
        "schema = 1\nname = \"limits\"\nstates = [{states}]\n{}
[[mode]]\nname = \"free\"\nequations = [{equations}]
[[mode.watch]]\nname = \"reached\"\nguard = \"{guard}\"\ndirection = \"both\"
[start]\nmode = \"free\"\n{start}\n",
        if equations.contains("cos") { "forcing = { omega = 1.0, phi = 0.0 }" } else { "" },
    ))
}

fn ends_undecided(system: &System, all: &[Event<DoubleDouble>]) {
    let shown = names(system, all);
    assert_eq!(shown.last().map(String::as_str), Some("undecided"), "{shown:?}");
    let is_finite = |it: &Event<DoubleDouble>| {
        let errors = it.errors.as_ref().unwrap();
        let states = it.state.iter().map(|it| it.words().0).chain(errors.state.iter().copied());
        states.chain([errors.time]).all(f64::is_finite)
    };
    assert!(all.iter().all(is_finite), "{all:?}");
}

#[test]
fn states_that_overflow_are_not_given_out() {
    let text = "\"x' = 1\", \"y' = 1000*y\"";
    let system = watched_system("\"x\", \"y\"", text, "x > 2", "x = 0\ny = 1");
    ends_undecided(&system, &enclosed_events(&system, 3.0));
    assert_eq!(names(&system, &events::<f64>(&system, 3.0)), ["undecided"]);
    let text = "\"x' = 1\", \"y' = -1000*y\"";
    let system = watched_system("\"x\", \"y\"", text, "x > -2", "x = 0\ny = 1");
    let solver = Solver::<DoubleDouble>::backward(&system).unwrap();
    let start = system.start.as_ref().unwrap();
    let until = DoubleDouble::new(-3.0, 0.0);
    let all: Vec<_> = solver.run_enclosed(start, until).unwrap().collect();
    ends_undecided(&system, &all);
}

#[test]
fn an_angle_beyond_two_to_the_fifty_is_not_decided() {
    let text = "\"x' = v\", \"v' = -2*x\"";
    let system = watched_system("\"x\", \"v\"", text, "x > 10", "x = 1\nv = 0");
    assert_eq!(names(&system, &enclosed_events::<DoubleDouble>(&system, 7e14)), ["end"]);
    for until in [9e14, 1e15, 1e308] {
        ends_undecided(&system, &enclosed_events(&system, until));
    }
}

/// x = x0 - t^2/2 crosses zero, however large the unit is in which its rate is measured; so does a
/// fall beside a decay of any rate.
#[test]
fn small_couplings_are_not_taken_for_rounding() {
    for exponent in [20, 45, 46, 60, 120] {
        let unit = format!("x = 2\nv = 0\n[parameters]\ns = 1e{exponent}");
        let fall = watched_system("\"x\", \"v\"", "\"x' = v/s\", \"v' = -s\"", "0 > x", &unit);
        let decay = format!("x = 5\nv = 0\ny = 1\n[parameters]\ns = 1e{}", 2 * exponent);
        let equations = "\"x' = v\", \"v' = -10\", \"y' = -s*y\"";
        let beside = watched_system("\"x\", \"v\", \"y\"", equations, "0 > x", &decay);
        for (system, expected) in [(&fall, 2.0), (&beside, 1.0)] {
            let all = enclosed_events::<DoubleDouble>(system, 3.0);
            assert_eq!(names(system, &all), ["reached", "end"], "{exponent}");
            assert!((all[0].time.value().words().0 - expected).abs() < 1e-15, "{exponent}");
            let plain = names(system, &events::<f64>(system, 3.0));
            assert_eq!(plain, ["reached", "end"], "{exponent}");
        }
    }
    // x = s (sin t - 2 t), at -2 s.
    for exponent in [0, 100, 200, 250] {
        let start = format!("x = 0\n[parameters]\ns = 1e-{exponent}");
        let system = watched_system("\"x\"", "\"x' = s*cos - 2*s\"", "x > -2*s", &start);
        let all = enclosed_events::<DoubleDouble>(&system, 3.0);
        assert_eq!(names(&system, &all), ["reached", "end"], "{exponent}");
        let time = all[0].time.value().words().0;
        assert!((time.sin() - 2.0 * time + 2.0).abs() < 1e-15, "{exponent}: {time}");
    }
}

/// Two turns of nearly the same frequency, after 10^15 radians: digits from mpmath.
#[test]
fn a_cluster_is_right_after_ten_to_the_fifteen_radians() {
    let equations = "\"p' = 10^6*q\", \"q' = -10^6*p\", \"r' = 1001000*s\", \"s' = -1001000*r\", \
                     \"y' = 1\"";
    let start = "p = 1\nq = 0\nr = 1\ns = 0\ny = 0";
    let system = watched_system("\"p\", \"q\", \"r\", \"s\", \"y\"", equations, "y > 10^9", start);
    let all = enclosed_events::<DoubleDouble>(&system, 2e9);
    assert_eq!(name(&system, &all[0]), "reached");
    for (n, expected) in [(0, -0.513_193_737_786_97), (1, -0.858_272_793_170_24)] {
        let (value, error) = (all[0].state[n].words().0, all[0].errors.as_ref().unwrap().state[n]);
        assert!(error < 1e-10 && (value - expected).abs() < error + 1e-14, "{n}: {value} {error}");
    }
}

/// A sum of two turns crests 3e-26 above its threshold, or below it, after 10^11 units of time:
/// less than what rounding does to their phases, so that neither events nor their absence are
/// proved.
#[test]
fn a_phase_is_rounded_by_its_size() {
    for (a, b, c, until) in [
        (
            0.003_836_972_963_535_228_7,
            -1.685_358_804_554_353_7e-19,
            -2.800_254_230_018_89e-36,
            99_980_038_474.822_66,
        ),
        (
            0.003_797_483_210_935_277,
            -1.939_820_418_843_699e-19,
            8.350_650_314_901_861e-36,
            99_980_038_079.411_07,
        ),
    ] {
        let equations = "\"p' = q\", \"q' = -2*p\", \"r' = s\", \"s' = -3*r\", \"y' = k\"";
        let start = format!(
            "p = 1\nq = 0\nr = 1\ns = 0\ny = -10000\n[parameters]\nk = 1e-07\nla = {a:?}\nlb = \
             {b:?}\nlc = {c:?}"
        );
        let states = "\"p\", \"q\", \"r\", \"s\", \"y\"";
        let system = watched_system(states, equations, "p + r + y > la + lb + lc", &start);
        ends_undecided(&system, &enclosed_events(&system, until));
    }
}

/// The forcing's angle in f64, which is held in two words, after so many units of time.
#[test]
fn a_forced_run_in_one_word_keeps_its_digits_far_from_time_zero() {
    for time in [1e9, 1e11, 1e13, 1e14, 9e14] {
        let text = format!(
            "schema = 1\nname = \"limits\"\nstates = [\"x\"]\nforcing = {{ omega = 1.1, phi = 0.0 }}
[[mode]]\nname = \"free\"\nequations = [\"x' = 0\"]
[[mode.watch]]\nname = \"reached\"\nguard = \"x + cos > 6/10\"\ndirection = \"both\"
[start]\nmode = \"free\"\nt = {:?}\nx = 0\n",
            time + 1.0
        );
        let system = system(&text);
        let until = time + 7.0;
        let (narrow, wide) =
            (events::<f64>(&system, until), events::<DoubleDouble>(&system, until));
        assert_eq!(names(&system, &narrow), names(&system, &wide));
        for (a, b) in narrow.iter().zip(&wide) {
            let (high, low) = b.time.value().words();
            let off = ((a.time.high - high) + (a.time.low - low)).abs();
            assert!(off < 1e-14, "{time:e}: {off:e}");
        }
    }
}

/// Five eigenvalues within 1e-9 of one another: whether they are kept apart or not, the run is
/// not refused.
#[test]
fn eigenvalues_that_nearly_coincide_are_no_reason_to_refuse() {
    let rates =
        [-0.499_999_999_999_999_5, -0.500_000_000_000_714_1, -0.499_999_999_999_183_04, -0.5];
    let last = -0.499_999_999_999_999_06;
    let mut parameters = String::new();
    let mut equations = Vec::new();
    for (n, rate) in rates.iter().chain([&last]).enumerate() {
        parameters += &format!("d{n} = {rate:?}\n");
        let next = if n < 4 { format!(" + x{}", n + 1) } else { String::new() };
        equations.push(format!("\"x{n}' = d{n}*x{n}{next}\""));
    }
    let start = format!("x0 = 0\nx1 = 0\nx2 = 0\nx3 = 0\nx4 = 1\n[parameters]\n{parameters}");
    let states = "\"x0\", \"x1\", \"x2\", \"x3\", \"x4\"";
    let system = watched_system(states, &equations.join(", "), "x3 > 7/10", &start);
    let all = enclosed_events::<DoubleDouble>(&system, 5.0);
    // x3 = t exp(-t/2) but for 1e-12.
    assert_eq!(names(&system, &all), ["reached", "reached", "end"]);
    let time = all[0].time.value().words().0;
    assert!((time * (-0.5 * time).exp() - 0.7).abs() < 1e-11, "{time}");
}

/// A fast decay in a system of eight states: at the event only what is off in the numbers of
/// several hundred bits is left of it in a run, and that is no digit.
#[test]
fn what_is_left_of_a_fast_decay_is_within_its_bound() {
    let system = system(include_str!("coupled.system.toml"));
    let all = enclosed_events::<DoubleDouble>(&system, 20.0);
    assert_eq!(name(&system, &all[0]), "reached");
    // Its true size is exp(-1.2e5)/4.
    let (value, error) = (all[0].state[2].words().0, all[0].errors.as_ref().unwrap().state[2]);
    assert!(value.abs() <= error && error < 1e-150, "{value:e} {error:e}");
}

/// A state of 1e-199 beside guards that are nearly zero at the start: what crosses there within
/// rounding does so at the start, not before it.
#[test]
fn times_do_not_decrease_next_to_guards_that_are_nearly_zero() {
    let system = system(include_str!("near_guards.system.toml"));
    let all = events::<f64>(&system, 8.0);
    let mut last = 0.0;
    for event in &all {
        let time = event.time.value();
        assert!(time >= last, "{} at {time:e} after {last:e}", name(&system, event));
        last = time;
    }
    assert!(all.len() > 5, "{:?}", names(&system, &all));
}

/// A ball whose impacts leave its height as rounding has made it: that error of the height does not
/// shrink with its flights, although the impacts are those of a ball at height zero.
#[test]
fn an_error_of_a_height_is_kept_over_impacts() {
    let system = system(
        "schema = 1\nname = \"ball\"\nstates = [\"x\", \"v\"]\n[parameters]\ng = 1.443733356863027
[[mode]]\nname = \"free\"\nequations = [\"x' = v\", \"v' = -g\"]
[[mode.until]]\nname = \"reached\"\nguard = \"-x > 0\"\nreset = [\"v = -v/2\"]
[start]\nmode = \"free\"\nx = 1.3589779585384858\nv = -0.08378768292928207\n",
    );
    let all = enclosed_events::<f64>(&system, 12.0);
    for (n, event) in all.iter().enumerate() {
        let (x, error) = (event.state[0], event.errors.as_ref().unwrap().state[0]);
        assert!(x.abs() <= error || name(&system, event) == "end", "{n}: {x:e} {error:e}");
    }
    assert!(all.len() > 5, "{:?}", names(&system, &all));
}
