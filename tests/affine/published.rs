//! The dynamics of systems, held to what others have published: each value to the digits that its
//! source has, or to its closed form.

use super::branches::{Varied, assert_value, only_bifurcation};
use super::{events, system};
use percuss::affine::{SectionMap, Solver, System};
use percuss::dynamics::continuation::BifurcationKind;
use percuss::system::Section;
use std::f64::consts::{PI, TAU};

/// The friction oscillator with a start from which it slips at every force.
fn slipping() -> String {
    let text = include_str!("../../validation/systems/dry-friction-oscillator.system.toml");
    let slipping = text.replace("mode = \"stick\"\nt = 2.0", "mode = \"right\"\nt = 0");
    assert_ne!(slipping, text);
    slipping
}

/// Den Hartog's V and U, Trans. ASME 53 (1931) 107: the response without friction, and what
/// friction takes from it. He divides the forcing's frequency by the free one.
fn den_hartogs(frequency: f64) -> [f64; 2] {
    let angle = PI / frequency;
    [1.0 / (1.0 - frequency * frequency), angle.sin() / (frequency * (1.0 + angle.cos()))]
}

/// A motion without stops has the amplitude sqrt((A V)^2 - (F U)^2).
#[test]
fn a_mass_with_dry_friction_moves_as_far_as_den_hartog_says() {
    for (frequency, a) in [(0.8, 1.5), (0.8, 2.0), (1.3, 1.5), (0.65, 2.5)] {
        let set = [("frequency", frequency)];
        let varied = Varied::new(&slipping(), Section::event("stop"), "A", &set);
        let orbit = varied.map(a, |map| map.orbit(&varied.settled_return(a, 60), 2).unwrap());
        let [v, u] = den_hartogs(frequency);
        let known = (a * a * v * v - u * u).sqrt();
        let found = orbit.points[0].state[0].abs();
        assert!((found - known).abs() < 1e-12 * known, "{frequency} {a}: {found} {known}");
    }
}

/// It stops where A V / F is sqrt(U^2 + frequency^-4): both events of its two stops change there.
#[test]
fn a_mass_with_dry_friction_begins_to_stop_where_den_hartog_says() {
    for (frequency, ends) in [(0.8, [1.5, 1.1]), (0.65, [2.5, 1.2])] {
        let set = [("frequency", frequency)];
        let varied = Varied::new(&slipping(), Section::strobe(0.0), "A", &set);
        let branch = varied.follow(&varied.settled_return(ends[0], 100), 1, ends);
        let [v, u] = den_hartogs(frequency);
        assert_value(
            only_bifurcation(&branch, BifurcationKind::Corner),
            u.hypot(frequency.powi(-2)) / v,
        );
    }
}

/// Chua's circuit with the values of Matsumoto, Chua and Komuro, IEEE Trans. Circuits and Systems
/// 32 (1985) 797.
const DOUBLE_SCROLL: &str = r#"
schema = 1
name = "double-scroll"
states = ["v1", "v2", "i"]
[parameters]
G = 0.7
m0 = -0.5
m1 = -0.8
[[mode]]
name = "inner"
equations = ["v1' = 9*(G*(v2 - v1) - m1*v1)", "v2' = G*(v1 - v2) + i", "i' = -7*v2"]
[[mode.until]]
name = "up"
guard = "v1 > 1"
next = [{ mode = "right" }]
[[mode.until]]
name = "down"
guard = "v1 < -1"
next = [{ mode = "left" }]
[[mode]]
name = "right"
equations = ["v1' = 9*(G*(v2 - v1) - m0*v1 - m1 + m0)", "v2' = G*(v1 - v2) + i", "i' = -7*v2"]
until = [{ name = "back", guard = "v1 < 1", next = [{ mode = "inner" }] }]
[[mode]]
name = "left"
equations = ["v1' = 9*(G*(v2 - v1) - m0*v1 + m1 - m0)", "v2' = G*(v1 - v2) + i", "i' = -7*v2"]
until = [{ name = "back", guard = "v1 > -1", next = [{ mode = "inner" }] }]
[start]
mode = "inner"
v1 = 0.1
v2 = 0
i = 0
"#;

/// They have the exponents 0.23 and 0 per unit of time, and the dimension 2.13.
#[test]
fn the_double_scroll_has_its_published_exponent_and_dimension() {
    let system = System::parse("test.system.toml", DOUBLE_SCROLL).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::event("back")).unwrap();
    let mut returns = map.returns(system.start.as_ref().unwrap()).unwrap();
    returns.by_ref().take(500).for_each(|it| drop(it.unwrap()));
    let place = returns.place().unwrap();
    let found = map.exponents(&place, 0, 100_000, &mut |_| ()).unwrap();
    let [first, second, third] = found.per_time()[..] else { panic!("{found:?}") };
    // 100000 returns leave an error of 0.0006 of the first.
    assert!(found.standard_error[0] / found.mean_return_time < 1e-3, "{found:?}");
    assert!((first - 0.23).abs() < 0.005, "{first}");
    assert!(second.abs() < 1e-5, "{second}");
    assert!((2.0 - first / third - 2.13).abs() < 0.005, "{}", 2.0 - first / third);
}

/// The flow of x'' + 2 zeta x' + x = 0 from x = 0 with a speed of 1: place and speed.
fn struck_flow(zeta: f64, time: f64) -> [f64; 2] {
    let damped = (1.0 - zeta * zeta).sqrt();
    let (sin, cos) = (damped * time).sin_cos();
    let decay = (-zeta * time).exp();
    [decay * sin / damped, decay * (cos - zeta * sin / damped)]
}

/// Nordmark, J. Sound Vib. 145 (1991) 279: what a touch adds to the image grows with the root of
/// how much further the free motion would go. A blow at the speed u = sqrt(2 |a| depth) changes
/// the speed by -(1 + r) u, and the free flow carries that to the image.
#[test]
fn an_impact_oscillators_map_has_a_square_root_at_the_touch() {
    let (frequency, zeta, d, r) = (2.75, 0.05, 0.125, 0.75);
    let text = include_str!("../../validation/systems/rigid-impact-oscillator.system.toml");
    let [real, imaginary] = [1.0 - frequency * frequency, 2.0 * zeta * frequency];
    let touched = f64::atan2(imaginary, real) / frequency;
    let period = TAU / frequency;
    let (sin, cos) = (frequency * touched).sin_cos();
    // The free motion d cos(frequency (t - touched)) and, added to it, what a blow at the start
    // makes of it.
    let end = |speed: f64| {
        let start = format!("x = {:?}\nv = {:?}", d * cos, d * frequency * sin + speed);
        let a = format!("A = {:?}\n", d * real.hypot(imaginary));
        let text = text.replace("x = 0\nv = 0", &start).replace("A = 1.0\n", &a);
        let all = events::<f64>(&system(&text), period);
        (all.len(), all[all.len() - 1].state.clone())
    };
    let [after, _] = struck_flow(zeta, touched);
    let sign = after.signum();
    let off = |speed: f64| {
        let (count, hit) = end(sign * speed);
        let (missed, _) = end(-sign * speed);
        assert_eq!((count, missed), (2, 1), "{speed}");
        let free = [d * cos, d * frequency * sin];
        let [x, v] = struck_flow(zeta, period);
        let smooth = [free[0] + sign * speed * x, free[1] + sign * speed * v];
        let blow = (1.0 + r) * (2.0 * frequency * frequency * d * after.abs() * speed).sqrt();
        let carried = struck_flow(zeta, period - touched);
        (0..2)
            .map(|n| ((hit[n] - smooth[n]) / (-blow * carried[n]) - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let [far, near] = [off(1e-6), off(1e-8)];
    // The next term is smaller by a root.
    assert!(far < 0.02 && near < 0.15 * far && near > 0.05 * far, "{far} {near}");
}

/// A mass on a belt whose friction falls with the relative speed up to that of the belt and rises
/// beyond: y is its place beyond that of rest.
const TWO_SLOPES: &str = r#"
schema = 1
name = "two-slope-friction"
states = ["y", "v"]
[parameters]
belt = 1
fall = 0.4
rise = 0.2
[[mode]]
name = "stick"
equations = ["y' = belt", "v' = 0"]
until = [{ name = "slip", guard = "y > fall*belt", next = [{ mode = "slow" }] }]
[[mode]]
name = "slow"
equations = ["y' = v", "v' = fall*v - y"]
[[mode.until]]
name = "turn"
guard = "v < 0"
next = [{ mode = "fast" }]
[[mode.until]]
name = "stop"
guard = "v > belt"
reset = ["v = belt"]
next = [{ mode = "stick" }]
[[mode]]
name = "fast"
equations = ["y' = v", "v' = -rise*v - y"]
until = [{ name = "return", guard = "v > 0", next = [{ mode = "slow" }] }]
[start]
mode = "stick"
y = 0
v = "belt"
"#;

/// The ends of the mass's way with the belt and against it while it sticks and slips. It leaves the
/// belt at y = fall belt, where its speed begins to change with no acceleration: with
/// cos a = fall/2 its speed is belt exp(t cos a) sin(a - t sin a) / sin a, and is 0 at
/// t = a / sin a, where y = belt exp(a cot a). Half a turn of the other slope, with
/// cos b = rise/2, brings it to -y exp(-pi cot b).
fn ends(fall: f64, rise: f64, belt: f64) -> [f64; 2] {
    let [a, b] = [fall, rise].map(|it| (it / 2.0).acos());
    let with = belt * (a / a.tan()).exp();
    [with, -with * (-PI / b.tan()).exp()]
}

/// The values at 0.4, 0.2 and 1 were computed in 25 digits, too, by a Taylor series integrator that
/// knows the equations alone.
#[test]
fn a_mass_on_a_belt_goes_as_far_as_friction_with_two_slopes_says() {
    let known = ends(0.4, 0.2, 1.0);
    for (it, digits) in known.iter().zip([1.322_515_287_293_212_4, -0.964_441_118_117_548_8]) {
        assert!((it - digits).abs() < 1e-15, "{it}");
    }
    for (fall, rise, belt) in [(0.4, 0.2, 1.0), (0.9, 0.3, 0.7), (1.5, 0.5, 2.0)] {
        let set = [("rise", rise), ("belt", belt)];
        for (section, known) in ["turn", "return"].into_iter().zip(ends(fall, rise, belt)) {
            let varied = Varied::new(TWO_SLOPES, Section::event(section), "fall", &set);
            let orbit =
                varied.map(fall, |map| map.orbit(&varied.settled_return(fall, 5), 1).unwrap());
            let found = orbit.points[0].state[0];
            assert!((found - known).abs() < 1e-13 * known.abs(), "{fall} {rise}: {found} {known}");
            assert!(orbit.multipliers.iter().all(|it| it[0].abs() < 1e-9), "{orbit:?}");
        }
    }
}

/// The mass reaches the belt's speed again if a turn grows: the largest speed after y = -ends[1] is
/// belt exp(pi (cot a - cot b)), which is that of the belt where both slopes are the same. There
/// all smaller turns are closed, and the branch does not go on.
#[test]
fn a_mass_on_a_belt_sticks_while_friction_falls_faster_than_it_rises() {
    for (rise, first) in [(0.2, 0.4), (0.5, 0.8)] {
        let set = [("rise", rise)];
        let varied = Varied::new(TWO_SLOPES, Section::event("turn"), "fall", &set);
        let branch = varied.follow(&varied.settled_return(first, 20), 1, [first, 0.75 * rise]);
        let grazing = only_bifurcation(&branch, BifurcationKind::Grazing);
        assert!((grazing.value - rise).abs() <= grazing.error.max(1e-12), "{grazing:?}");
    }
}
