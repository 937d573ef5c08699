//! Guards of the forcing angle whose constant is a state that stands still: the model decides them
//! as if the constant were written as a number.

use super::{enclosed_events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Event, System};
use std::f64::consts::PI;

/// A mode that turns at one radian a unit of time from 1/2 on, beside states that stand still.
fn turning(states: &str, equations: &str, guards: &str, start: &str) -> System {
    system(&format!(
        "schema = 1\nname = \"still\"\nstates = [{states}]\nforcing = {{ omega = 1.0, phi = 0.5 }}\n\
         [[mode]]\nname = \"turn\"\nequations = [{equations}]\n{guards}\n[start]\nmode = \"turn\"\n\
         {start}\n"
    ))
}

fn watch(name: &str, guard: &str) -> String {
    let direction = "direction = \"both\"";
    format!("[[mode.watch]]\nname = \"{name}\"\nguard = \"{guard}\"\n{direction}\n")
}

/// Times of events beside those of a closed form.
fn assert_times(events: &[Event<DoubleDouble>], expected: &[f64]) {
    let times: Vec<f64> = events.iter().map(|it| it.time.value().to_f64()).collect();
    assert_eq!(times.len(), expected.len() + 1, "{times:?}");
    for (own, exact) in times.iter().zip(expected) {
        assert!((own - exact).abs() < 1e-14, "{own} {exact}");
    }
}

/// The sine touches 1 at pi/2 - 1/2, and 3 sin + 4 cos its amplitude 5: neither is an event, of a
/// watched guard or of one that ends the mode, and no run is undecided for them. A sine above 1
/// less 2^-40 crosses twice, where its angle is pi/2 less or more an arc cosine.
#[test]
fn a_sine_touches_what_stands_still() {
    let level = 1.0 - 0.5_f64.powi(40);
    let guards = [
        watch("one", "sin > c"),
        watch("five", "3*sin + 4*cos > 2*c + d - 1/2"),
        watch("minus", "sin > -c"),
        watch("below", "sin > e"),
        "[[mode.until]]\nname = \"over\"\nguard = \"sin > c\"\nreset = [\"c = 7\"]\n".to_owned(),
    ];
    let start = format!("c = 1\nd = 3.5\ne = {level:?}");
    let equations = "\"c' = 0\", \"d' = 0\", \"e' = d - 7*c/2\"";
    let touch = turning("\"c\", \"d\", \"e\"", equations, &guards.concat(), &start);
    let all = enclosed_events::<DoubleDouble>(&touch, 6.0);
    assert_eq!(names(&touch, &all), ["below", "below", "end"]);
    assert_eq!(all[2].state[0].to_f64(), 1.0);
    // 1 - cos(x) = 2 sin(x/2)^2 = 2^-40.
    let half = 2.0 * 0.5_f64.powi(41).sqrt().asin();
    let crest = 0.5 * PI - 0.5;
    assert_times(&all, &[crest - half, crest + half]);
}

/// The same where an event at no rational time sets the constant, by its reset or by its guard: u
/// decays from 4 to 1 at the logarithm of 4, and stands still from there on.
#[test]
fn what_an_event_leaves_standing_still_is_known() {
    let text = "schema = 1\nname = \"set\"\nstates = [\"u\", \"c\"]\n\
         forcing = { omega = 1.0, phi = 0.5 }\n[[mode]]\nname = \"decay\"\n\
         equations = [\"u' = -u\", \"c' = 0\"]\n[[mode.until]]\nname = \"set\"\nguard = \"u < 1\"\n\
         reset = [\"c = c + 4\"]\nnext = [{ mode = \"rest\" }]\n[[mode]]\nname = \"rest\"\n\
         equations = [\"u' = 0\", \"c' = 0\"]\n[[mode.watch]]\nname = \"u\"\nguard = \"sin > u\"\n\
         [[mode.watch]]\nname = \"c\"\nguard = \"3*sin + 4*cos > c\"\n\
         [start]\nmode = \"decay\"\nu = 4\nc = 1\n";
    let set = system(text);
    let all = enclosed_events::<DoubleDouble>(&set, 20.0);
    assert_eq!(names(&set, &all), ["set", "end"]);
    assert_times(&all, &[4.0_f64.ln()]);
    // A constant that is too small by 1/64 is crossed on every turn.
    let crossed = system(&text.replace("c + 4", "c + 4 - 1/64"));
    let names = names(&crossed, &enclosed_events::<DoubleDouble>(&crossed, 20.0));
    assert_eq!(names, ["set", "c", "c", "c", "end"]);
}

/// A sine and a cosine of one angle that cross 3/5 and -4/5 at one instant, of which each may be
/// a state; the decay that meets its own constant there stands still too.
#[test]
fn ties_with_what_stands_still_are_decided() {
    for (sine, cosine) in [("5*sin < c", "5*cos < -4"), ("5*sin < 3", "d > 5*cos")] {
        let guards = [watch("sine", sine), watch("cosine", cosine)].concat();
        let tie = turning("\"c\", \"d\"", "\"c' = 0\", \"d' = 0\"", &guards, "c = 3\nd = -4");
        let all = enclosed_events::<DoubleDouble>(&tie, 3.0);
        let first = 0.6_f64.asin() - 0.5;
        assert_eq!(names(&tie, &all), ["sine", "sine", "cosine", "end"]);
        assert_times(&all, &[first, PI - 0.5 - 0.6_f64.asin(), PI - 0.5 - 0.6_f64.asin()]);
        assert_eq!(all[1].time.value(), all[2].time.value());
    }
    // u = 4 exp(-t) passes the state that stands still at 1 where it passes 1, and nowhere else.
    let guards = [watch("state", "u < c"), watch("number", "u < 1")].concat();
    let tie = turning("\"u\", \"c\"", "\"u' = -u\", \"c' = 0\"", &guards, "u = 4\nc = 1");
    let all = enclosed_events::<DoubleDouble>(&tie, 3.0);
    assert_eq!(names(&tie, &all), ["state", "number", "end"]);
    assert_times(&all, &[4.0_f64.ln(); 2]);
}

/// What is not known to stand still is no constant: c' = d with d not zero passes the touch.
#[test]
fn what_moves_is_no_constant() {
    let guards = watch("one", "sin > c");
    let moved =
        turning("\"c\", \"d\"", "\"c' = d\", \"d' = 0\"", &guards, "c = 1\nd = -0.0009765625");
    let all = enclosed_events::<DoubleDouble>(&moved, 3.0);
    assert_eq!(names(&moved, &all), ["one", "one", "end"]);
}
