//! Derivatives of return maps by a parameter, beside differences of maps in 212 bits.

use super::past_limits::two_masses;
use super::returns::changes_along;
use super::turns::friction;
use percuss::affine::{
    Bits212, Place, Return, ReturnFamily, SectionMap, Solver, System, SystemFile, Time,
};
use percuss::gallery;
use percuss::number::Number;
use percuss::system::Section;

/// The step of the differences, of which a value's shortest decimal leaves 1e-9 open.
const STEP: f64 = 1.0 / 16_777_216.0;

/// The error of derivatives beside the largest: that of the step, 1e-9 and 4e-15 times the third
/// derivative, grown by the motion.
const TOLERANCE: f64 = 1e-8;

fn read(text: &str, name: &str, value: f64) -> System {
    let mut file = SystemFile::read("test.system.toml", text).unwrap();
    file.set(name, value, "test").unwrap();
    file.system().unwrap()
}

/// The states, and the times as shares of the forcing period, with which a motion returns in 212
/// bits from a place at such a share.
fn returned(
    system: &System,
    section: &Section,
    (place, share): (&Place<f64>, f64),
    returns: usize,
) -> Vec<Vec<Bits212>> {
    let wide = Solver::<Bits212>::new(system).unwrap();
    let map = SectionMap::new(&wide, section).unwrap();
    let period = map.forcing_period();
    let start = period.map_or_else(Bits212::zero, |it| Bits212::exact(share) * it);
    let state = place.state.iter().map(|it| Bits212::exact(*it)).collect();
    let place = place.moved_to(Time { high: start, low: Bits212::zero() }, state);
    // A strobe from which a motion begins is its first return.
    let is_start = |it: &Return<Bits212>| (it.time - start).to_f64().abs() < 1e-12;
    let all = map
        .returns_from(&place)
        .map(|it| it.unwrap_or_else(|why| panic!("{} {section}: {why}", system.name)))
        .filter(|it| !is_start(it));
    let shares = all.map(|it| {
        let share = period.map_or_else(Bits212::zero, |period| it.time / period);
        it.state.into_iter().chain([share]).collect()
    });
    shares.take(returns).collect()
}

/// Holds the derivatives by a parameter of a motion's returns from its start against differences:
/// each is that of the map by its place, along the derivative of the place, and that of the map by
/// the parameter.
fn check(text: &str, name: &str, section: &Section, returns: usize) {
    let value = read_value(text, name);
    let at = |value: f64| Ok(read(text, name, value));
    let system = read(text, name, value);
    let narrow = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&narrow, section).unwrap();
    let family = ReturnFamily::new(section.clone(), None, &at);
    let period = map.forcing_period().unwrap_or(1.0);
    let mut place = narrow.place(system.start.as_ref().unwrap()).unwrap();
    let start = (&place.clone(), place.time.value() / period);
    let [above, below] = [STEP, -STEP]
        .map(|step| returned(&read(text, name, value + step), section, start, returns));
    let states = system.states.len();
    let mut change = vec![0.0; states + 1];
    for (number, (above, below)) in above.into_iter().zip(below).enumerate() {
        let passage = map.passage(&place).unwrap();
        let moved = changes_along(&passage, &change[..states], change[states], &map.rates(&place));
        let own = family.by_parameter(value, &place).unwrap();
        change = moved;
        change.iter_mut().zip(own).for_each(|(it, own)| *it += own);
        if !map.has_times() {
            change[states] = 0.0;
        }
        let expected = above.into_iter().zip(below).map(|(a, b)| (a - b).to_f64() / (2.0 * STEP));
        let mut expected: Vec<f64> = expected.collect();
        expected[states] *= period;
        let size = expected.iter().fold(1.0, |most: f64, it| most.max(it.abs()));
        for (own, beside) in change.iter().zip(&expected) {
            let error = (own - beside).abs();
            let said = || format!("{name} {section} {number}: {change:?} {expected:?}");
            assert!(error <= TOLERANCE * size, "{}", said());
        }
        place = map.rebased(&passage.image);
    }
    assert!(change.iter().any(|it| *it != 0.0), "{name} {section}");
}

/// The value of a parameter, moved to where its differences are exact.
fn read_value(text: &str, name: &str) -> f64 {
    let value = System::parse("test.system.toml", text).unwrap().parameters[name];
    libm::round(value * 1024.0) / 1024.0
}

macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../validation/systems/", $name, ".system.toml"))
    };
}

#[test]
fn derivatives_of_impacts_are_those_of_differences() {
    let text = gallery::IMPACT_OSCILLATOR;
    for name in System::parse("test", text).unwrap().parameters.keys() {
        check(text, name, &Section::strobe(0.0), 9);
        check(text, name, &Section::strobe(1.0), 4);
        check(text, name, &Section::event("impact"), 9);
        check(text, name, &Section::event("impact").every(3), 3);
    }
}

#[test]
fn derivatives_of_the_percussive_oscillator_are_those_of_differences() {
    let text = system!("percussive-oscillator");
    for name in ["a", "b", "xi", "frequency", "phase"] {
        check(text, name, &Section::strobe(0.0), 6);
        check(text, name, &Section::event("impact"), 4);
    }
}

#[test]
fn derivatives_of_relays_and_friction_are_those_of_differences() {
    check(system!("relay-feedback"), "delta", &Section::event("switch-up"), 5);
    for name in ["outside", "lowest", "highest"] {
        check(gallery::THERMOSTAT, name, &Section::event("switch-off"), 5);
    }
    for name in ["frequency", "A"] {
        check(system!("dry-friction-oscillator"), name, &Section::strobe(0.0), 9);
    }
}

#[test]
fn derivatives_past_accumulations_are_those_of_differences() {
    for [load, r, kick] in [[0.625, 0.3125, 0.0], [0.625, 0.3125, 0.1875], [0.875, 0.625, 0.1875]] {
        let masses = two_masses([0.6875, 0.125, load, r, kick]);
        for name in ["k", "c", "load", "r", "kick"] {
            check(&masses, name, &Section::strobe(0.0), 5);
            check(&masses, name, &Section::event("detach"), 2);
        }
    }
}

#[test]
fn derivatives_past_turns_that_accumulate_are_those_of_differences() {
    for [omega, r] in [[0.15, 0.625], [0.2, 0.3125], [0.1, 0.875]] {
        let rig = friction([omega, 2.0, 0.3125, 0.125, r]);
        for name in ["f", "mu", "c", "r"] {
            check(&rig, name, &Section::strobe(0.0), 4);
            check(&rig, name, &Section::event("leave"), 3);
            check(&rig, name, &Section::event("impact"), 9);
        }
    }
}
