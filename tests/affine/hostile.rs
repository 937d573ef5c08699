//! Systems whose numbers lie at the edge of what f64 holds, or whose events cannot be searched to
//! the end: a run decides, or ends as undecided after a bounded number of pieces.

use super::{name, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Event, SearchWork, Solver, System};
use percuss::number::Number;

/// The largest number of pieces in a search of one guard from one event to the next.
const MAX_PIECES: u64 = 1 << 18;

fn system_in_form(
    parameters: &str,
    equations: &str,
    guard: &str,
    reset: &str,
    start: &str,
) -> System {
    let states: Vec<_> = start.lines().filter_map(|line| line.split_once(" = ")).collect();
    let states: Vec<_> = states.iter().map(|(name, _)| format!("{name:?}")).collect();
    system(&format!(
        "schema = 1\nname = \"hostile\"\nstates = [{}]\n[parameters]\n{parameters}\n
[[mode]]\nname = \"free\"\nequations = [{equations}]
[[mode.until]]\nname = \"reached\"\nguard = \"{guard}\"\nreset = [{reset:?}]\n
[start]\nmode = \"free\"\n{start}\n",
        states.join(", ")
    ))
}

fn run<T: Number>(system: &System, until: f64, enclosed: bool) -> (Vec<Event<T>>, SearchWork) {
    let solver = Solver::<T>::new(system).unwrap();
    let (start, until) = (system.start.as_ref().unwrap(), T::exact(until));
    let run = if enclosed { solver.run_enclosed(start, until) } else { solver.run(start, until) };
    let mut run = run.unwrap();
    let all = run.by_ref().collect();
    (all, run.work())
}

/// Powers of slow rates underflow. What they bound is not zero for that: an event is where it is,
/// within what an enclosed run says, or undecided.
#[test]
fn rates_whose_powers_underflow_make_no_polynomial() {
    for exponent in (0..100).chain([120, 150]) {
        let rate: f64 = format!("1e-{exponent}").parse().unwrap();
        let parameters = format!("rate = {rate:?}\nhalf = 0.5");
        let equations = "\"x' = rate*y\", \"y' = -rate*x\"";
        let (third, half) = (std::f64::consts::FRAC_PI_3, std::f64::consts::PI);
        for (guard, start, expected) in
            [("x > half", "x = -1\ny = 0", 2.0 * third), ("x < 0", "x = 0\ny = 1", half)]
        {
            let system = system_in_form(&parameters, equations, guard, "x = x", start);
            for enclosed in [false, true] {
                let (all, work) = run::<f64>(&system, 10.0 / rate, enclosed);
                let is_there = name(&system, &all[0]) == "reached";
                let off = (all[0].time.value() * rate - expected).abs();
                assert!(
                    is_there && off < 1e-14 || name(&system, &all[0]) == "undecided",
                    "{rate:e} {guard} {enclosed}: off by {off:e}, {work:?}"
                );
                if let (true, Some(errors)) = (is_there, &all[0].errors) {
                    assert!(off <= errors.time * rate + 1e-15, "{rate:e} {guard}: {off:e}");
                }
            }
        }
    }
}

/// An oscillation that meets half of its amplitude, at a sixth of a half turn.
fn large(amplitude: &str, factor: &str) -> System {
    system_in_form(
        &format!("size = {amplitude}\nfactor = {factor}"),
        "\"x' = v\", \"v' = -x\"",
        "factor*x > factor*size/2",
        "x = 0",
        "x = 0\nv = \"size\"",
    )
}

#[test]
fn large_states_and_coefficients_are_those_of_size_one() {
    let expected = run::<DoubleDouble>(&large("1.0", "1.0"), 10.0, true).0;
    let times = |all: &[Event<DoubleDouble>]| -> Vec<f64> {
        all.iter().map(|it| it.time.value().to_f64()).collect()
    };
    assert!((expected[0].time.value().to_f64() - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    for (amplitude, factor) in [("1e300", "1.0"), ("1.0", "1e300"), ("1e-6", "1e-9")] {
        let (all, work) = run::<DoubleDouble>(&large(amplitude, factor), 10.0, true);
        assert_eq!(all.len(), expected.len(), "{amplitude} {factor}");
        for (a, b) in times(&all).iter().zip(times(&expected)).take(4) {
            assert!((a - b).abs() < 1e-15, "{amplitude} {factor}: {a} {b}");
        }
        assert!(work.pieces < 200, "{work:?}");
    }
}

/// A fast decay beside a slow one is there at once, and no matter for what follows.
#[test]
fn the_fastest_decays_are_decided() {
    for rate in ["1e20", "1e60", "1e100"] {
        let decay = system_in_form(
            &format!("fast = {rate}"),
            "\"x' = -fast*x\", \"y' = -y\"",
            "1/2 > x + y",
            "y = 1",
            "x = 1\ny = 1",
        );
        let (all, work) = run::<DoubleDouble>(&decay, 10.0, true);
        assert_eq!(name(&decay, &all[0]), "reached", "{rate}: {:?}", names(&decay, &all));
        let off = all[0].time.value().to_f64() - std::f64::consts::LN_2;
        assert!(off.abs() < 1e-15, "{rate}: {off:e}");
        assert!(work.pieces < 1000, "{rate}: {work:?}");
    }
}

#[test]
fn a_motion_that_overflows_ends_as_undecided_shortly_before() {
    let growth =
        system_in_form("", "\"x' = 1000*x\", \"y' = 0\"", "y > x", "x = 0", "x = 1\ny = 0");
    for enclosed in [true, false] {
        let (all, work) = run::<DoubleDouble>(&growth, 10.0, enclosed);
        assert_eq!(names(&growth, &all), ["undecided"]);
        assert!(work.pieces < 20_000, "{work:?}");
        let (all, work) = run::<f64>(&growth, 10.0, enclosed);
        assert_eq!(names(&growth, &all), ["undecided"]);
        assert!(work.pieces < 20_000, "{work:?}");
    }
}

/// The sum of two oscillations of incommensurable frequencies comes as near to its supremum as one
/// waits for.
#[test]
fn a_search_that_has_no_end_is_given_up() {
    let sum = system_in_form(
        "level = 1.7071067811865475",
        "\"x' = y\", \"y' = -x\", \"c' = d\", \"d' = -2*c\"",
        "x + c > level",
        "x = 0",
        "x = 0\ny = 1\nc = 0\nd = 1",
    );
    let (all, work) = run::<f64>(&sum, 1e9, false);
    assert_eq!(names(&sum, &all), ["undecided"]);
    assert!((MAX_PIECES / 9..=MAX_PIECES).contains(&work.pieces), "{work:?}");
    // A horizon that is not too far is reached.
    assert_eq!(names(&sum, &run::<f64>(&sum, 1e4, false).0), ["end"]);
}

/// A crest is 1e-20 to 1e-31 of itself above or below a level, where the second word of each number
/// is too small to be held.
#[test]
fn a_crest_that_underflows_is_right_or_undecided() {
    for (power, below) in (20..32).flat_map(|power| [(power, true), (power, false)]) {
        let sign = if below { "-" } else { "+" };
        let crest = system_in_form(
            "size = 1e-300",
            "\"x' = v\", \"v' = -x\"",
            &format!("x > size*(1 {sign} 1/10^{power})"),
            "x = 0",
            "x = \"3/5*size\"\nv = \"4/5*size\"",
        );
        let (all, work) = run::<DoubleDouble>(&crest, 5.0, true);
        let first = name(&crest, &all[0]);
        let right = if below { "reached" } else { "end" };
        assert!(first == right || first == "undecided", "{sign}{power}: {first}");
        // Where it stays below by more than what may be lost, 1e-21 of it, that is seen.
        assert!(below || power > 20 || first == right, "{sign}{power}: {first}");
        assert!(work.pieces < 1000, "{work:?}");
    }
}
