//! Attractors and basins of return maps, beside the oscillator's own and systems whose attractors
//! are known.

use percuss::affine::{
    DEFAULT_MAX_RETURN_TIME, NoOrbit, Plane, ReturnBasins, SectionMap, Solver, System, SystemFile,
};
use percuss::dynamics::attractor::{AttractorKind, Basins, Grid, Label, Window};
use percuss::dynamics::strobe::StrobeMap;
use percuss::system::Section;
use percuss::{Instant, Model, Parameters};

const OSCILLATOR: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");
const RELAY: &str = include_str!("../../validation/systems/relay-feedback.system.toml");
const RIGID: &str = include_str!("../../validation/systems/rigid-impact-oscillator.system.toml");

/// Two wells at x = -1 and x = 1, each linear, that meet at x = 0.
const WELLS: &str = r#"
schema = 1
name = "wells"
states = ["x", "v"]
forcing = { omega = 1, phi = 0 }
[parameters]
damping = 0.5
force = 0.05
[[mode]]
name = "left"
equations = ["x' = v", "v' = force*cos - damping*v - (x + 1)"]
[[mode.until]]
name = "up"
guard = "x > 0"
next = [{ mode = "right" }]
[[mode]]
name = "right"
equations = ["x' = v", "v' = force*cos - damping*v - (x - 1)"]
[[mode.until]]
name = "down"
guard = "x < 0"
next = [{ mode = "left" }]
[start]
mode = "right"
x = 1
v = 0
"#;

fn with(text: &str, set: &[(&str, f64)], mode: &str) -> System {
    let mut file = SystemFile::read("test.system.toml", text).unwrap();
    for (name, value) in set {
        file.set(name, *value, "the test").unwrap();
    }
    file.set_start_mode(mode, "the test");
    file.system().unwrap()
}

fn basins(system: &System, section: &Section, plane: &Plane, transient: u64) -> ReturnBasins {
    let solver = Solver::<f64>::new(system).unwrap();
    let map = SectionMap::new(&solver, section).unwrap();
    map.basins(system.start().unwrap(), plane, transient, &|_| ()).unwrap()
}

fn plane(window: [f64; 4], columns: u32, rows: u32) -> Plane {
    let [left, right, low, high] = window;
    Plane { axes: [0, 1], window: [[left, right], [low, high]], columns, rows }
}

fn kinds(basins: &ReturnBasins) -> Vec<(AttractorKind, Option<usize>)> {
    basins.attractors.iter().map(|it| (it.kind, it.period())).collect()
}

/// The oscillator's own labels of starts with q = 0 that fly.
fn own_labels(omega: f64, window: [f64; 4], columns: u32, rows: u32) -> Basins {
    let parameters = Parameters { xi: 0.1, omega, ..Parameters::default() };
    let map = StrobeMap::new(Model::new(parameters).unwrap(), Instant::at(omega, 0.0, 0));
    let [left, right, low, high] = window;
    let window = Window { p: [left, right], y: [low, high] };
    Basins::new(&map, &Grid { window, columns, rows, q: 0.0 }, 60, &|_| ())
}

/// The census of each frame of Fig. 7, whose window it is, at xi = 0.1. Cells may differ whose own
/// label hangs on the last digits: it changes where the start is shifted by 1e-12.
#[test]
fn the_oscillators_census_is_its_own() {
    let frames = [(1.4, 2), (1.45, 3), (1.56, 3), (1.58, 2), (1.6, 2), (1.7, 3)];
    let differ: usize = frames.iter().map(|(omega, count)| census(*omega, *count)).sum();
    // One of 1008 was seen to: a label may differ in each frame before this tells of more.
    assert!(differ <= frames.len(), "{differ} cells differ");
}

/// Compares a frame's census, of so many attractors; the number of cells that differ.
fn census(omega: f64, attractors: usize) -> usize {
    let (columns, rows, q_and_gap) = (14, 12, 0.02);
    let window = [-3.0, q_and_gap, -1.5, 1.5];
    let system = with(OSCILLATOR, &[("xi", 0.1), ("frequency", omega)], "no-contact");
    let found = basins(&system, &Section::strobe(0.0), &plane(window, columns, rows), 60);
    let known = own_labels(omega, window, columns, rows);
    let listed = known.attractors.iter();
    let listed: Vec<_> = listed.map(|it| (it.kind, it.period().map(|it| it as usize))).collect();
    assert_eq!(kinds(&found), listed, "omega = {omega}");
    assert_eq!(listed.len(), attractors, "omega = {omega}");
    let shifted = [1e-12, -1e-12].map(|by| {
        own_labels(omega, [window[0] + by, window[1] + by, window[2], window[3]], columns, rows)
            .labels
    });
    let mut differ = 0;
    for (n, (label, own)) in found.labels.iter().zip(&known.labels).enumerate() {
        let hangs_on_digits = shifted.iter().any(|it| it[n] != *own);
        assert!(label == own || hangs_on_digits, "omega = {omega}, {n}: {label:?} {own:?}");
        differ += usize::from(label != own);
    }
    // Orbits have the oscillator's exponents, chaos the same to its standard errors.
    for (found, own) in found.attractors.iter().zip(&known.attractors) {
        let error = 5.0 * found.lyapunov_error.hypot(own.lyapunov_error) + 1e-8;
        let apart = (found.lyapunov_per_return - own.lyapunov_per_period).abs();
        assert!(apart <= error, "omega = {omega}: {found:?} {own:?}");
    }
    differ
}

/// Near the bottom of each well a motion stays in it: the force moves it by 0.05/|1 - 1 + i/2| =
/// 0.1 at most, and both orbits have the multipliers exp(-pi/2 +- ...) of their mode alone.
/// Stick-slip and a cycle that never sticks lie 0.03 apart on the section. Runs from all centres
/// in f64, 800 units of time long, stick for ever from 28 of the 64.
#[test]
fn an_orbit_beyond_a_discontinuity_is_another_one() {
    let system = System::from_toml(include_str!("drill_string.system.toml")).unwrap();
    let plane = Plane { axes: [0, 2], window: [[-2.0, 3.0], [0.1, 4.0]], columns: 8, rows: 8 };
    for section in ["slow", "fast"] {
        let basins = basins(&system, &Section::event(section), &plane, 60);
        assert_eq!(kinds(&basins), [(AttractorKind::Periodic, Some(1)); 2], "{section}");
        let mut shares = [0, 1].map(|n| basins.fraction(Label::Attractor(n)));
        shares.sort_by(f64::total_cmp);
        assert_eq!(shares, [28.0 / 64.0, 36.0 / 64.0], "{section}");
    }
}

#[test]
fn each_well_has_its_orbit() {
    for (mode, middle) in [("right", 1.0), ("left", -1.0)] {
        let system = with(WELLS, &[], mode);
        let window = [middle - 0.3, middle + 0.3, -0.3, 0.3];
        let found = basins(&system, &Section::strobe(0.0), &plane(window, 4, 3), 20);
        assert_eq!(kinds(&found), [(AttractorKind::Periodic, Some(1))]);
        assert!(found.labels.iter().all(|it| *it == Label::Attractor(0)));
        let orbit = &found.attractors[0];
        // x - middle = 0.05 Re(e^(it)/(i/2)) is 0 at the strobe, where its rate is 0.1.
        assert!((orbit.points[0].state[0] - middle).abs() < 1e-12, "{orbit:?}");
        assert!((orbit.points[0].state[1] - 0.1).abs() < 1e-12, "{orbit:?}");
        let decay = -0.25 * std::f64::consts::TAU;
        assert!((orbit.lyapunov_per_return - decay).abs() < 1e-12, "{orbit:?}");
    }
    // A start in the other mode's half is none.
    let system = with(WELLS, &[], "right");
    let found = basins(&system, &Section::strobe(0.0), &plane([-1.0, 1.0, -0.1, 0.1], 4, 1), 20);
    let is_beyond: Vec<_> = found.labels.iter().map(|it| *it == Label::Inadmissible).collect();
    assert_eq!(is_beyond, [true, true, false, false]);
}

/// Without a force motions come to rest in one well or the other, which the crossings of x = 0
/// decide: a start with v = 0 and 0 < x < 2 lies too low to cross.
#[test]
fn motions_that_rest_are_equilibria() {
    let text = WELLS.replace("forcing = { omega = 1, phi = 0 }\n", "").replace("force*cos", "0");
    let text = text.replace("force = 0.05\n", "");
    let system = with(&text, &[], "right");
    let found = basins(&system, &Section::event("down"), &plane([0.1, 1.9, -0.1, 0.1], 6, 3), 20);
    assert_eq!(kinds(&found), [(AttractorKind::Equilibrium, None)]);
    assert!((found.attractors[0].points[0].state[0] - 1.0).abs() < 1e-9, "{found:?}");
    // Thrown fast enough to the left, some motions end on that side.
    let found = basins(&system, &Section::event("down"), &plane([0.1, 1.9, -4.0, 0.1], 6, 9), 20);
    let rests: Vec<f64> = found.attractors.iter().map(|it| it.points[0].state[0].round()).collect();
    assert_eq!(rests, [-1.0, 1.0]);
    assert_eq!(found.fraction(Label::Unresolved), 0.0);
}

/// The relay's cycle attracts from everywhere; its multipliers along the flow and across it are
/// known from its closed form.
#[test]
fn the_relays_cycle_attracts_all() {
    let system = with(RELAY, &[], "up");
    let section = Section::event("switch-up");
    let found = basins(&system, &section, &plane([-0.5, 0.005, -0.5, 0.5], 4, 4), 30);
    assert_eq!(kinds(&found), [(AttractorKind::Periodic, Some(1))]);
    assert_eq!(found.fraction(Label::Attractor(0)), 1.0);
}

#[test]
fn chaos_is_one_attractor_with_its_exponent() {
    let system = with(RIGID, &[], "free");
    let section = Section::strobe(0.0);
    let found = basins(&system, &section, &plane([-0.5, 0.1, -0.5, 0.5], 5, 4), 40);
    assert_eq!(kinds(&found), [(AttractorKind::Chaotic, None)], "{:?}", found.labels);
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &section).unwrap();
    let place = solver.place(system.start().unwrap()).unwrap();
    let known = map.exponents(&place, 500, 20_000, &mut |_| ()).unwrap();
    let (own, error) =
        (found.attractors[0].lyapunov_per_return, found.attractors[0].lyapunov_error);
    assert!((own - known.per_return[0]).abs() <= 5.0 * error.hypot(known.standard_error[0]));
}

/// A well that is a hill: all motions escape.
#[test]
fn motions_that_escape_have_no_attractor() {
    let text = WELLS.replace("(x + 1)", "(-x)").replace("(x - 1)", "(-x)");
    let system = with(&text, &[], "right");
    let found = basins(&system, &Section::strobe(0.0), &plane([0.5, 1.0, 0.0, 0.1], 3, 2), 20);
    assert_eq!(found.fraction(Label::Escaping), 1.0);
    assert!(found.attractors.is_empty());
}

/// With one mode for all starts those on the other side are none; where the start's conditions
/// choose the mode, each begins in its own, and the whole plane falls into the two wells.
#[test]
fn starts_of_a_plane_lie_in_the_modes_that_the_conditions_choose() {
    let window = [-2.0, 2.0, -1.0, 1.0];
    let one = basins(&with(WELLS, &[], "right"), &Section::strobe(0.0), &plane(window, 8, 4), 100);
    assert_eq!(one.fraction(Label::Inadmissible), 0.5);
    let list = r#"mode = [{ when = "x > 0", mode = "right" }, { mode = "left" }]"#;
    let system = System::from_toml(&WELLS.replace("mode = \"right\"\nx", &format!("{list}\nx")));
    let system = system.unwrap();
    assert_eq!(system.start_modes.len(), 2);
    let both = basins(&system, &Section::strobe(0.0), &plane(window, 8, 4), 100);
    assert_eq!(both.fraction(Label::Inadmissible), 0.0);
    assert_eq!(kinds(&both), [(AttractorKind::Periodic, Some(1)); 2]);
    let share = |id| both.fraction(Label::Attractor(id));
    assert_eq!(share(0) + share(1), 1.0);
}

/// x'' = -x - x' crosses zero for ever on its way to rest there.
#[test]
fn a_motion_that_returns_to_rest_for_ever_is_an_equilibrium() {
    let text = r#"
        schema = 1
        name = "sink"
        states = ["x", "v"]
        [[mode]]
        name = "sink"
        equations = ["x' = v", "v' = -x - v"]
        watch = [{ name = "zero", guard = "x > 0", direction = "both" }]
        [start]
        mode = "sink"
        x = 1
        v = 0
    "#;
    let system = with(text, &[], "sink");
    let found = basins(&system, &Section::event("zero"), &plane([-1.0, 1.0, -1.0, 1.0], 5, 5), 5);
    assert_eq!(kinds(&found), [(AttractorKind::Equilibrium, None)]);
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::event("zero")).unwrap();
    let mut returns = map.returns(system.start.as_ref().unwrap()).unwrap();
    returns.by_ref().take(40).for_each(|it| drop(it.unwrap()));
    let orbit = map.orbit(&returns.place().unwrap(), 1);
    assert!(matches!(orbit, Err(NoOrbit::Rest(_))), "{orbit:?}");
}

/// A mass that no longer meets its stop goes on by the free motion, whose state at angle zero is
/// told, whenever the last impact was: x'' = A cos - 2 zeta x' - x.
#[test]
fn motions_that_no_longer_meet_the_stop_are_one_attractor() {
    let [amplitude, zeta, frequency] = [1.0, 0.05, 2.75_f64];
    let system = with(RIGID, &[("d", 0.2)], "free");
    let section = Section::event("impact");
    let found = basins(&system, &section, &plane([-1.0, 0.19, -2.0, 2.0], 10, 10), 100);
    let free = found.attractors.iter().filter(|it| it.kind == AttractorKind::Equilibrium);
    let [free] = free.collect::<Vec<_>>()[..] else { panic!("{:?}", kinds(&found)) };
    let stiffness = 1.0 - frequency.powi(2);
    let size = amplitude / (stiffness.powi(2) + (2.0 * zeta * frequency).powi(2));
    let at_angle_zero = [size * stiffness, size * 2.0 * zeta * frequency.powi(2)];
    // What is left of the last impact, at a speed below 1, when the motion is given up.
    let left = libm::exp(-zeta * DEFAULT_MAX_RETURN_TIME * system.time_scale);
    for (own, known) in free.points[0].state.iter().zip(at_angle_zero) {
        assert!((own - known).abs() <= left, "{own} {known} {left}");
    }
}

/// Every dose takes the state to 1 - x: all starts are on orbits of period 2 with the multiplier
/// -1, and no motion tells them apart however long it is.
#[test]
fn starts_on_neutral_orbits_stay_unresolved() {
    let dose = r#"
schema = 1
name = "dose"
states = ["x", "c"]
[[mode]]
name = "on"
equations = ["x' = 0", "c' = 1"]
until = [{ name = "dose", guard = "c > 1", reset = ["c = 0", "x = 1 - x"] }]
[start]
mode = "on"
x = 0
c = 0
"#;
    let system = with(dose, &[], "on");
    let section = Section::event("dose");
    let found = basins(&system, &section, &plane([-0.5, 1.7, 0.0, 0.9], 30, 30), 100);
    assert!(found.attractors.is_empty(), "{:?}", kinds(&found));
    assert!(found.labels.iter().all(|it| *it == Label::Unresolved));
}
