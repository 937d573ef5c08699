//! Return maps: their derivatives beside differences in 212 bits, and returns that are known.

use super::past_limits::two_masses;
use super::turns::friction;
use percuss::affine::{Bits212, Passage, Place, SectionMap, Solver, System, Time};
use percuss::gallery;
use percuss::number::Number;
use percuss::system::Section;

/// A step of differences in 212 bits: its square is beyond every digit that is compared.
const STEP: f64 = 1e-24;

/// The error of derivatives beside the largest: some hundred roundings of f64, grown by the motion.
const DERIVATIVE_TOLERANCE: f64 = 1e-10;

fn numbers<T: Number>(values: impl IntoIterator<Item = T>) -> Vec<f64> {
    values.into_iter().map(Number::to_f64).collect()
}

fn time<T: Number>(value: T) -> Time<T> {
    Time { high: value, low: T::zero() }
}

/// The place of the return after `skipped`, and the passages from there and from its image.
fn passages<'a>(
    map: &SectionMap<'a, f64>,
    skipped: usize,
) -> (Place<f64>, Passage<f64>, Passage<f64>) {
    let start = map.system().start.as_ref().unwrap();
    let mut returns = map.returns(start).unwrap();
    returns.by_ref().take(skipped + 1).for_each(|it| {
        it.unwrap();
    });
    let place = map.rebased(&returns.place().unwrap());
    let first = map.passage(&place).unwrap();
    let second = map.passage(&first.image).unwrap();
    (place, first, second)
}

/// The state and the time at which a motion returns in 212 bits from a place that is moved by a
/// change of the state and of the time.
fn returned_place(
    map: &SectionMap<'_, Bits212>,
    place: &Place<f64>,
    change: &[f64],
    delay: f64,
    step: f64,
) -> Vec<Bits212> {
    let moved =
        |from: f64, by: f64| Bits212::exact(from) + Bits212::exact(by) * Bits212::exact(step);
    let state = place.state.iter().zip(change).map(|(from, by)| moved(*from, *by)).collect();
    let at = moved(place.time.high, delay) + Bits212::exact(place.time.low);
    let mut returns = map.returns_from(&place.moved_to(time(at), state));
    let mut next = || returns.next().unwrap().unwrap();
    // A strobe from which a motion begins is its first return.
    let mut image = next();
    if (image.time - at).to_f64().abs() < 1e-12 {
        image = next();
    }
    image.state.into_iter().chain([image.time]).collect()
}

/// Holds the derivatives of a section's map against differences, at places along a motion. The
/// changes are those that an earlier passage has made, which the model allows at the place.
fn check(text: &str, section: &Section, skips: &[usize]) {
    let system = System::parse("test.system.toml", text).unwrap();
    let narrow = Solver::<f64>::new(&system).unwrap();
    let wide = Solver::<Bits212>::new(&system).unwrap();
    let map = SectionMap::new(&narrow, section).unwrap();
    let wide = SectionMap::new(&wide, section).unwrap();
    for skipped in skips {
        let (_, first, second) = passages(&map, *skipped);
        let rates = map.rates(&first.image);
        let largest = first.at_return.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (column, delay) in first.at_return.iter().zip(&first.delays) {
            let scaled: Vec<f64> = column.iter().map(|it| it / largest).collect();
            let delay = delay / largest;
            let ends =
                [STEP, -STEP].map(|it| returned_place(&wide, &first.image, &scaled, delay, it));
            let [above, below] = &ends;
            let differences: Vec<f64> =
                above.iter().zip(below).map(|(a, b)| (*a - *b).to_f64() / (2.0 * STEP)).collect();
            let predicted = changes_along(&second, &scaled, delay, &rates);
            let size = second.at_return.iter().flatten().fold(1.0, |a: f64, b| a.max(b.abs()));
            for (found, expected) in predicted.iter().zip(&differences) {
                assert!(
                    (found - expected).abs() <= DERIVATIVE_TOLERANCE * size,
                    "{} {section}, {skipped}: {predicted:?} {differences:?}",
                    system.name
                );
            }
        }
    }
}

/// The changes of a passage's state and time for a change of the place's.
pub fn changes_along(
    passage: &Passage<f64>,
    change: &[f64],
    delay: f64,
    rates: &[f64],
) -> Vec<f64> {
    let fixed: Vec<f64> = change.iter().zip(rates).map(|(it, rate)| it - rate * delay).collect();
    let sum = |entry: &dyn Fn(usize) -> f64| {
        fixed.iter().enumerate().map(|(j, it)| it * entry(j)).sum::<f64>()
    };
    let states = (0..rates.len()).map(|i| sum(&|j| passage.at_return[j][i]));
    states.chain([sum(&|j| passage.delays[j])]).collect()
}

macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../validation/systems/", $name, ".system.toml"))
    };
}

#[test]
fn derivatives_of_impacts_are_those_of_differences() {
    let text = gallery::IMPACT_OSCILLATOR;
    check(text, &Section::strobe(0.0), &[0, 7, 40]);
    check(text, &Section::strobe(1.0), &[3]);
    check(text, &Section::event("impact"), &[0, 5, 30]);
    check(text, &Section::event("impact").every(3), &[2]);
}

#[test]
fn derivatives_across_watched_events_are_those_of_differences() {
    let text = system!("watched-impact-oscillator");
    check(text, &Section::strobe(0.3), &[1, 12]);
    for event in ["turn", "crest", "up", "down"] {
        check(text, &Section::event(event), &[1, 10]);
    }
}

#[test]
fn derivatives_of_the_percussive_oscillator_are_those_of_differences() {
    let text = system!("percussive-oscillator");
    check(text, &Section::strobe(0.0), &[1, 20, 21, 22]);
    check(text, &Section::event("separation"), &[3, 20]);
    check(text, &Section::event("impact"), &[3, 20]);
}

#[test]
fn derivatives_of_relays_and_friction_are_those_of_differences() {
    check(system!("relay-feedback"), &Section::event("switch-up"), &[0, 4]);
    check(gallery::THERMOSTAT, &Section::event("switch-off"), &[0, 4]);
    check(system!("buck-converter"), &Section::event("clock"), &[2, 15]);
    check(system!("dry-friction-oscillator"), &Section::strobe(0.0), &[1, 15]);
}

#[test]
fn derivatives_past_accumulations_are_those_of_differences() {
    for [load, r, kick] in [[0.6, 0.3, 0.0], [0.6, 0.3, 0.2], [0.9, 0.6, 0.2], [0.6, 0.0, 0.2]] {
        let masses = two_masses([0.7, 0.1, load, r, kick]);
        check(&masses, &Section::strobe(0.0), &[1, 4]);
        check(&masses, &Section::event("detach"), &[0, 2]);
    }
}

#[test]
fn derivatives_past_turns_that_accumulate_are_those_of_differences() {
    for [omega, r] in [[0.15, 0.6], [0.2, 0.3], [0.1, 0.9], [0.15, 0.0]] {
        let rig = friction([omega, 2.0, 0.3, 0.1, r]);
        check(&rig, &Section::strobe(0.0), &[1, 3]);
        check(&rig, &Section::event("leave"), &[0, 2]);
        if r > 0.0 {
            check(&rig, &Section::event("impact"), &[3, 8]);
        }
    }
}

/// From v at the table a ball of e = 1/2 and g = 1 comes back after 2 v, with v/2.
#[test]
fn a_bouncing_balls_map_is_known() {
    let system = System::parse("ball", gallery::BOUNCING_BALL).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::event("impact")).unwrap();
    let (place, first, _) = passages(&map, 0);
    let v = place.state[1];
    assert_eq!(place.state[0], 0.0);
    let passed = first.image.time.value() - place.time.value();
    assert!((passed - 2.0 * v).abs() < 1e-15);
    let known = [0.0, 0.5];
    let found = numbers(first.at_return[1][..2].to_vec());
    assert!(found.iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
    assert!((first.delays[1] - 2.0).abs() < 1e-14);
}

/// Far from time zero a start is a strobe only within rounding, and no strobe is passed over.
#[test]
fn strobes_late_in_time_are_where_the_angle_is() {
    let text = |time: f64| {
        format!(
            "schema = 1\nname = \"late\"\nstates = [\"x\"]\nforcing = {{ omega = 2 }}\n[[mode]]\n\
             name = \"m\"\nequations = [\"x' = cos - x\"]\n[start]\nmode = \"m\"\nt = {time:?}\n\
             x = 0\n"
        )
    };
    let period = std::f64::consts::PI;
    for turns in [3e5, 1e6, 1e9, 1e12] {
        // The time itself is known to 1e-16 of it.
        let shares = [0.0, 3e-4, 0.02, 0.4, 0.98].into_iter();
        for share in shares.filter(|it| *it == 0.0 || *it > 1e-15 * turns) {
            let start = (turns + share) * period;
            let system = System::parse("late.system.toml", &text(start)).unwrap();
            let solver = Solver::<f64>::new(&system).unwrap();
            let map = SectionMap::new(&solver, &Section::strobe(0.0)).unwrap();
            let mut returns = map.returns(system.start.as_ref().unwrap()).unwrap();
            let first = returns.next().unwrap().unwrap().time / period;
            let expected = if share == 0.0 { turns } else { turns + 1.0 };
            assert!((first - expected).abs() < 1e-15 * turns, "{turns} {share}: {first}");
        }
    }
}
