//! Starts whose states are expressions of other states.

use percuss::affine::{Plane, SectionMap, Solver, System, SystemFile};
use percuss::dynamics::attractor::{AttractorKind, Label};
use percuss::system::Section;
use percuss::{Rational, gallery};

const OSCILLATOR: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");

/// A file with these states at the start, in this order.
fn file(text: &str, start: &[(&str, &str)]) -> SystemFile {
    let mut file = SystemFile::read("test.system.toml", text).unwrap();
    for (name, value) in start {
        file.set_start(name, value, "test").unwrap();
    }
    file
}

fn states(system: &System) -> Vec<[Rational; 3]> {
    system.start().unwrap().state.clone()
}

/// An exact number of cos theta, sin theta and 1.
fn entry(cos: i32, sin: i32, one: i32) -> [Rational; 3] {
    [cos, sin, one].map(Rational::from)
}

#[test]
fn states_follow_others_in_any_order() {
    let start = [("q", "p - 2*y + sin"), ("p", "3"), ("y", "v + cos"), ("v", "p - 1")];
    let system = file(OSCILLATOR, &start).system().unwrap();
    let expected = [entry(0, 0, 3), entry(1, 0, 2), entry(-2, 1, -1), entry(0, 0, 2)];
    assert_eq!(states(&system), expected);
    // A state that is replaced moves those that follow it.
    let mut moved = file(OSCILLATOR, &start);
    moved.set_start("p", "4", "test").unwrap();
    let expected = [entry(0, 0, 4), entry(1, 0, 3), entry(-2, 1, -2), entry(0, 0, 3)];
    assert_eq!(states(&moved.system().unwrap()), expected);
}

#[test]
fn a_circle_is_refused_by_name() {
    for start in [[("p", "1"), ("q", "q")], [("p", "y"), ("y", "p + 1")]] {
        let error = file(OSCILLATOR, &start).system().unwrap_err().to_string();
        assert!(error.contains("hangs on itself"), "{error}");
    }
    let error = file(OSCILLATOR, &[("p", "w")]).system().unwrap_err().to_string();
    assert!(error.contains("w is not known: accepted are p, y, q, v"), "{error}");
}

/// With v = 2 x at the start and g = 1 the ball lands at 2 x + sqrt(4 x^2 + 2 x), whose derivative
/// at x = 1 is 2 + 5/sqrt(6); that by v alone is 1 + 2/sqrt(6).
#[test]
fn derivatives_by_a_state_take_along_what_follows_it() {
    let system = file(gallery::BOUNCING_BALL, &[("x", "1"), ("v", "2*x")]).system().unwrap();
    let solver = system.solver::<f64>().unwrap();
    let names = ["start.x", "start.v"];
    let mut events = solver.run().gradients(names).unwrap().events(2).unwrap();
    let landing = events.find(|it| it.name() == "impact").unwrap();
    assert!((landing.time() - (2.0 + 6_f64.sqrt())).abs() < 1e-14);
    let by = |name| *landing.gradient(name).unwrap().unwrap().time();
    assert!((by("start.x") - (2.0 + 5.0 / 6_f64.sqrt())).abs() < 1e-14, "{}", by("start.x"));
    assert!((by("start.v") - (1.0 + 2.0 / 6_f64.sqrt())).abs() < 1e-14, "{}", by("start.v"));
}

/// All starts lie on the guard, by the model: none is beyond it by its rounding, and each reaches
/// what the start that is written down for its cell alone reaches.
#[test]
fn starts_of_a_plane_follow_its_axes() {
    let mut file = file(OSCILLATOR, &[("p", "0"), ("y", "0"), ("q", "p - g")]);
    for (name, value) in [("xi", 0.5), ("frequency", 0.9)] {
        file.set(name, value, "test").unwrap();
    }
    let system = file.system().unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::strobe(0.0)).unwrap();
    let plane = Plane { axes: [0, 1], window: [[-0.3, 0.4], [-1.0, 1.0]], columns: 6, rows: 7 };
    let found = map.basins(system.start().unwrap(), &plane, 60, &|_| ()).unwrap();
    let [across, up] = [0, 1].map(|axis| plane.centres(axis));
    let mut settled = 0;
    for (n, label) in found.labels.iter().enumerate() {
        assert_ne!(*label, Label::Inadmissible, "{n}");
        let Label::Attractor(id) = *label else { continue };
        let attractor = &found.attractors[id];
        if attractor.kind != AttractorKind::Periodic {
            continue;
        }
        let mut alone = file.clone();
        for (name, value) in [("p", across[n % 6]), ("y", up[n / 6])] {
            alone.set_start(name, &format!("{value:?}"), "test").unwrap();
        }
        let alone = alone.system().unwrap();
        let own = Solver::<f64>::new(&alone).unwrap();
        let own = SectionMap::new(&own, &Section::strobe(0.0)).unwrap();
        let last = own.returns(alone.start().unwrap()).unwrap().take(600).last().unwrap().unwrap();
        let near = attractor
            .points
            .iter()
            .any(|it| it.state.iter().zip(&last.state).take(3).all(|(a, b)| (a - b).abs() < 1e-6));
        assert!(near, "{n}: {last:?}");
        settled += 1;
    }
    assert!(settled > 20, "{settled} of {}", found.labels.len());
}
