//! Co-ordinates and terms of very different sizes: what is small has digits of its own.

use super::{enclosed_events, events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Solver, Time};
use percuss::{Ending, Proved};

/// A watched motion of one mode.
fn watched_system(states: &[&str], equations: &[&str], guards: &[&str], start: &str) -> String {
    let list =
        |all: &[&str]| all.iter().map(|it| format!("\"{it}\"")).collect::<Vec<_>>().join(", ");
    let watch = |(name, guard): (char, &&str)| {
        format!("[[mode.watch]]\nname = \"{name}\"\nguard = \"{guard}\"\ndirection = \"both\"\n")
    };
    format!(
        "schema = 1\nname = \"sizes\"\nstates = [{}]\n[[mode]]\nname = \"free\"\nequations = \
         [{}]\n{}[start]\nmode = \"free\"\n{start}\n",
        list(states),
        list(equations),
        ('m'..).zip(guards).map(watch).collect::<String>(),
    )
}

/// The rate of x is a difference of 3e7: its rounding moves a crossing by 4e-12, and two crossings
/// are closer.
#[test]
fn crossings_that_the_rounding_of_a_slope_hides_are_counted() {
    let start = "a = 46446564.24518299\nb = -36445215.47745203\nx = 0\ny = 0\n[parameters]\n\
                 p = 0.7644940535496205\nq = 0.974287590512972\nk = 0.7783061926697576\n\
                 l = 0.7783061936508475";
    let equations = ["a' = 0", "b' = 0", "x' = p*a + q*b", "y' = 1"];
    let guards = ["y > k", "x > l"];
    let system = system(&watched_system(&["a", "b", "x", "y"], &equations, &guards, start));
    assert_eq!(names(&system, &enclosed_events::<DoubleDouble>(&system, 2.0)), ["n", "m", "end"]);
    let solver = Solver::<f64>::new(&system).unwrap();
    let mut run = solver.run(system.start.as_ref().unwrap(), 2.0).unwrap();
    let own: Vec<_> = run.by_ref().collect();
    let right = names(&system, &own) == ["n", "m", "end"];
    assert!(right || run.work().undecidable > 0, "{:?}", names(&system, &own));
}

/// x = c (t^2/2 + t - 1) beside co-ordinates of size one: its square of the time is not dropped.
#[test]
fn a_drift_of_any_size_is_kept() {
    for c in [1e-20, 1e-85, 1e-95, 1e-150] {
        let start = format!("x = -{c:e}\nd = {c:e}\na = 0\nb = {c:e}\n[parameters]\nc = {c:e}");
        let equations = ["x' = d - a", "d' = b + c", "a' = b", "b' = -a"];
        let system =
            system(&watched_system(&["x", "d", "a", "b"], &equations, &["x > 2*c"], &start));
        let all = enclosed_events::<DoubleDouble>(&system, 3.0);
        assert_eq!(names(&system, &all), ["m", "end"], "{c:e}");
        let time = all[0].time.value().words().0;
        assert!((time - (7.0_f64.sqrt() - 1.0)).abs() < 1e-15, "{c:e}: {time}");
        let end = events::<f64>(&system, 3.0)[1].state[0] / c;
        assert!((end - 6.5).abs() < 1e-14, "{c:e}: {end}");
    }
}

/// Co-ordinates of 1e-13 beside 1e12 in one block, over 1e-24 units of time.
#[test]
fn a_small_co_ordinate_is_moved_by_a_large_one_in_a_short_time() {
    let system = system(include_str!("sizes.system.toml"));
    let (narrow, wide) =
        (enclosed_events::<f64>(&system, 1.0), enclosed_events::<DoubleDouble>(&system, 1.0));
    let (own, truth) = (&narrow[0], &wide[0]);
    let off = (own.time.high - truth.time.value().words().0).abs();
    let most = own.errors.as_ref().unwrap().time;
    assert!(off <= most && most < 1e-25, "{off:e} {most:e}");
}

/// A frequency of 1e6, to an event and to a horizon whose distance f64 rounds; and one whose second
/// word is half a unit of the first.
#[test]
fn fast_turns_keep_their_phase() {
    let start = "x = 1\ny = 0\ns = 0\n[parameters]\nf = 1e6\nl = 0.3";
    let equations = ["x' = f*y", "y' = -f*x", "s' = 1"];
    let text = watched_system(&["x", "y", "s"], &equations, &["s > l"], start);
    let text = text
        .replace("mode.watch", "mode.until")
        .replace("direction = \"both\"", "reset = [\"s = -1\"]");
    let turning = system(&text);
    let end = |it: &[f64]| [it[0], it[1]];
    let own = events::<f64>(&turning, 1.0);
    let off = (end(&own.last().unwrap().state)[0] - 1e6_f64.cos()).abs();
    assert!(off < 1e-15, "{off:e}");
    let tied = "x = 3\ny = 1\n[parameters]\np = 4298.189831273655\nq = 5372.737289092069";
    let tied =
        system(&watched_system(&["x", "y"], &["x' = p*y - p*x", "y' = p*y - q*x"], &[], tied));
    let (narrow, wide) =
        (Solver::<f64>::new(&tied).unwrap(), Solver::<DoubleDouble>::new(&tied).unwrap());
    let start = tied.start.as_ref().unwrap();
    let begun =
        (narrow.run(start, 1.0).unwrap().start(), wide.run(start, DoubleDouble::new(1.0, 0.0)));
    let (high, zero) = (DoubleDouble::new(10.0, 0.0), DoubleDouble::new(0.0, 0.0));
    let own = narrow.state_at(&begun.0, &Time { high: 10.0, low: 0.0 });
    let truth = wide.state_at(&begun.1.unwrap().start(), &Time { high, low: zero });
    for (own, truth) in own.iter().zip(&truth) {
        let off = (own - truth.words().0).abs();
        assert!(off < 1e-14, "{off:e}");
    }
}

/// x' = cos t - x follows the forcing as (cos t + sin t)/2; sine and cosine of 1e22 are those of
/// mpmath 1.3.0.
#[test]
fn many_turns_of_the_forcing_have_proved_digits() {
    const FOLLOWED: f64 = 0.5 * (0.523_214_785_395_138_945_5 - 0.852_200_849_767_188_801_8);
    let text = watched_system(&["x"], &["x' = cos - x"], &["x > 2"], "x = 0");
    let forced = system(&text.replace("[[mode]]", "forcing = { omega = 1 }\n[[mode]]"));
    let solver = forced.solver::<Proved>().unwrap();
    let end = solver.run().until(1e22).unwrap().last().unwrap();
    assert_eq!(end.ending(), Some(Ending::Horizon));
    let x = end.state()[0].midpoint();
    assert!((x - FOLLOWED).abs() < 1e-16, "{x}");
    assert!(solver.run().until(1e300).unwrap().last().unwrap().state()[0].midpoint().abs() < 0.75);
}

/// At rates of 1e60 the rounding of 212 bits makes the pieces of a search so short that it is given
/// up; twice as many bits decide.
#[test]
fn a_search_that_is_given_up_is_tried_in_more_bits() {
    let watched: Vec<String> = (5..17).map(|level| format!("x > {level}")).collect();
    let guards: Vec<&str> = watched.iter().map(String::as_str).collect();
    let equations = ["x' = K*y - K*x + K*cos/1000", "y' = q - x", "q' = -y - q/10 + sin"];
    let start = "x = 0\ny = 0\nq = 1\n[parameters]\nK = 1e60";
    let text = watched_system(&["x", "y", "q"], &equations, &guards, start);
    let stiff = system(&text.replace("[[mode]]", "forcing = { omega = 3 }\n[[mode]]"));
    let solver = stiff.solver::<Proved>().unwrap();
    let mut events = solver.run().until(0.25).unwrap();
    let end = events.by_ref().last().unwrap();
    assert_eq!(end.ending(), Some(Ending::Horizon), "{:?}", events.cause());
    assert!(events.bits() > 212);
}
