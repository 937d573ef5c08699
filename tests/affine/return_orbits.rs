//! Orbits and exponents of return maps, beside closed forms and the oscillator's own.

use percuss::affine::{Exponents, Orbit, Place, Plane, SectionMap, Solver, System};
use percuss::dynamics::orbit::{Orbit as StrobeOrbit, scan};
use percuss::dynamics::strobe::StrobeMap;
use percuss::system::Section;
use percuss::{Instant, Model, Parameters, gallery};

const RELAY: &str = include_str!("../../validation/systems/relay-feedback.system.toml");
const OSCILLATOR: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");

/// The rounding, beside 1, that runs of a few events and Newton's method leave.
const ROUNDING_TOLERANCE: f64 = 1e-12;

/// A system, and what is asked of its return map from the place of the return after `skipped`.
fn at_return<R>(
    text: &str,
    section: &Section,
    skipped: usize,
    asked: impl Fn(&SectionMap<'_, f64>, &Place<f64>) -> R,
) -> R {
    let system = System::parse("test.system.toml", text).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, section).unwrap();
    let mut returns = map.returns(system.start.as_ref().unwrap()).unwrap();
    returns.by_ref().take(skipped + 1).for_each(|it| {
        it.unwrap();
    });
    asked(&map, &returns.place().unwrap())
}

fn orbit(text: &str, section: &Section, skipped: usize, period: u32) -> Orbit {
    at_return(text, section, skipped, |map, place| map.orbit(place, period).unwrap())
}

fn exponents(text: &str, section: &Section, skipped: usize, returns: u64) -> Exponents {
    at_return(text, section, skipped, |map, place| {
        map.exponents(place, 60, returns, &mut |_| ()).unwrap()
    })
}

/// The state just before a switch of the relay's symmetric cycle with this half period, from
/// (1 + E) x = (1 - E) (1, 1, 1) with E = exp(A h) = exp(-h) ((1, h, h^2/2), (0, 1, h), (0, 0, 1)).
fn relay_state(half: f64) -> [f64; 3] {
    let e = (-half).exp();
    let square = 0.5 * half * half;
    let third = (1.0 - e) / (1.0 + e);
    let second = (1.0 - e - e * half - e * half * third) / (1.0 + e);
    let right = 1.0 - e - e * half - e * square;
    let first = (right - e * half * second - e * square * third) / (1.0 + e);
    [first, second, third]
}

/// The half period of the relay's cycle, at which the first state is delta: by bisection.
fn relay_half_period(delta: f64) -> f64 {
    let (mut low, mut high) = (1.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if relay_state(middle)[0] > delta { high = middle } else { low = middle }
    }
    low
}

/// The traces of D^2 and of its square, with the derivative D = (1 - f w/(w f)) E of half a cycle:
/// the sums of the multipliers, and of their squares.
fn relay_sums(half: f64) -> [f64; 2] {
    let [x, y, z] = relay_state(half);
    let field = [y - x, z - y, 1.0 - z];
    let e = (-half).exp();
    let flow = [[e, e * half, 0.5 * e * half * half], [0.0, e, e * half], [0.0, 0.0, e]];
    let derivative: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| flow[i][j] - field[i] * flow[0][j] / field[0])
    });
    let square = |m: [[f64; 3]; 3]| -> [[f64; 3]; 3] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| m[i][k] * m[k][j]).sum()))
    };
    let whole = square(derivative);
    [whole, square(whole)].map(|it| it[0][0] + it[1][1] + it[2][2])
}

#[test]
fn the_relays_cycle_is_that_of_its_closed_form() {
    let half = relay_half_period(0.01);
    let cycle = orbit(RELAY, &Section::event("switch-down"), 1, 2);
    assert_eq!(cycle.period(), 1);
    assert!((cycle.time - 2.0 * half).abs() < ROUNDING_TOLERANCE, "{} {half}", cycle.time);
    for (found, known) in cycle.points[0].state.iter().zip(relay_state(half)) {
        assert!((found - known).abs() < ROUNDING_TOLERANCE, "{:?} {half}", cycle.points);
    }
    let [first, second, last] = cycle.multipliers[..] else { panic!("{:?}", cycle.multipliers) };
    assert_eq!((first[1], second[1], last), (0.0, 0.0, [0.0; 2]));
    let [sum, squares] = relay_sums(half);
    assert!((first[0] + second[0] - sum).abs() < ROUNDING_TOLERANCE);
    assert!((first[0] * first[0] + second[0] * second[0] - squares).abs() < ROUNDING_TOLERANCE);
}

/// The exponents of a motion on a stable cycle are the logarithms of its multipliers, and one along
/// the motion is zero.
#[test]
fn exponents_of_cycles_are_logarithms_of_multipliers() {
    let section = Section::event("switch-down");
    let cycle = orbit(RELAY, &section, 1, 1);
    let found = exponents(RELAY, &section, 30, 64);
    let known = [1.0, cycle.multipliers[0][0], cycle.multipliers[1][0]].map(f64::ln);
    for (found, known) in found.per_return.iter().zip(known) {
        assert!((found - known).abs() < 1e-10, "{found} {known}");
    }
    assert!((found.mean_return_time - cycle.time).abs() < ROUNDING_TOLERANCE);
}

/// The volume of small changes shrinks by exp(-damping t), and by r^2 in an impact with restitution
/// r: so the exponents' sum is known from the number of impacts, in chaos too.
#[test]
fn exponents_sum_to_the_contraction() {
    let returns = 500;
    let section = Section::strobe(0.0);
    let found = exponents(gallery::IMPACT_OSCILLATOR, &section, 60, returns);
    let impacts = at_return(gallery::IMPACT_OSCILLATOR, &section, 120, |map, place| {
        let mut impacts = 0;
        let mut at = place.clone();
        for _ in 0..returns {
            let passage = map.passage(&at).unwrap();
            impacts += passage.events.iter().filter(|it| !it.is_watched).count();
            at = passage.image;
        }
        impacts as f64
    });
    let period = std::f64::consts::TAU / 2.8;
    let known = -0.1 * period + 2.0 * 0.75_f64.ln() * impacts / returns as f64;
    let sum: f64 = found.per_return.iter().sum();
    assert!((sum - known).abs() < 1e-9, "{sum} {known}");
}

/// The oscillator without its drift, which grows and closes no orbit.
fn without_drift(xi: &str, omega: &str) -> String {
    let text = OSCILLATOR
        .replace("drift = [\"v\"]\n", "")
        .replace(", \"v\"]", "]")
        .replace(", \"v' = 0\"", "")
        .replace("    \"v' = y + (q - 1)/(2*xi)\",\n", "")
        .replace("\nv = 0\n", "\n");
    let text = text.replace("xi = 0.01", &format!("xi = {xi}"));
    text.replace("frequency = 1.4", &format!("frequency = {omega}"))
}

/// Each orbit that the oscillator's own scan finds, from its first point.
#[test]
fn the_oscillators_orbits_are_its_own() {
    let text = without_drift("0.1", "1.6");
    let parameters = Parameters { xi: 0.1, omega: 1.6, ..Parameters::default() };
    let model = Model::new(parameters).unwrap();
    let map = StrobeMap::new(model, Instant::at(1.6, 0.0, 0));
    let found = scan(&map, 6, &mut |_| ());
    let flies = |it: &&StrobeOrbit| it.phases[0] == percuss::Phase::NoContact;
    let known: Vec<&StrobeOrbit> = found.iter().filter(flies).collect();
    assert!(known.len() >= 4, "{}", known.len());
    let system = System::parse("oscillator.system.toml", &text).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::strobe(0.0)).unwrap();
    for known in known {
        let start = system.start_at("no-contact", 0.0, &known.points[0]).unwrap();
        let mut returns = map.returns(&start).unwrap();
        returns.next().unwrap().unwrap();
        let orbit = map.orbit(&returns.place().unwrap(), known.period()).unwrap();
        assert_eq!(orbit.period() as u32, known.period());
        for (found, own) in orbit.points.iter().zip(&known.points) {
            let apart = found.state.iter().zip(own).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < ROUNDING_TOLERANCE, "{orbit:?} {known:?}");
        }
        for (found, own) in orbit.multipliers.iter().zip(known.multipliers) {
            // Multipliers are products of six returns that grow and decay.
            let apart = (found[0] - own[0]).hypot(found[1] - own[1]);
            assert!(apart < 1e-9 * (1.0 + own[0].hypot(own[1])), "{orbit:?} {known:?}");
        }
    }
}

/// A scan of starts finds the orbits that the oscillator's own finds, in the same order.
#[test]
fn a_scan_finds_the_oscillators_orbits() {
    let parameters = Parameters { xi: 0.1, omega: 1.6, ..Parameters::default() };
    let model = Model::new(parameters).unwrap();
    let own = scan(&StrobeMap::new(model, Instant::at(1.6, 0.0, 0)), 6, &mut |_| ());
    let text = OSCILLATOR.replace("xi = 0.01", "xi = 0.1");
    let text = text.replace("frequency = 1.4", "frequency = 1.6");
    let system = System::parse("oscillator.system.toml", &text).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::strobe(0.0)).unwrap();
    let plane = Plane { axes: [0, 1], window: [[-2.0, 2.0]; 2], columns: 24, rows: 24 };
    let seen = std::sync::atomic::AtomicU64::new(0);
    let told = |count| {
        seen.fetch_add(count, std::sync::atomic::Ordering::Relaxed);
    };
    let found = map.orbits(system.start.as_ref().unwrap(), &plane, 6, &told).unwrap();
    assert_eq!(seen.into_inner(), 24 * 24);
    assert!(own.len() >= 6 && found.len() == own.len(), "{} {}", found.len(), own.len());
    for (found, own) in found.iter().zip(&own) {
        assert_eq!((found.period() as u32, found.is_stable()), (own.period(), own.is_stable()));
        for (found, own) in found.multipliers.iter().zip(own.multipliers) {
            // Multipliers are products of six returns that grow and decay.
            let apart = (found[0] - own[0]).hypot(found[1] - own[1]);
            assert!(apart < 1e-9 * (1.0 + own[0].hypot(own[1])), "{found:?} {own:?}");
        }
        let least = own.points.iter().map(|it| it[0]).fold(f64::INFINITY, f64::min);
        assert!((found.points[0].state[0] - least).abs() < ROUNDING_TOLERANCE, "{found:?} {own:?}");
        assert!((found.drift_per_return[0] - own.drift_per_period).abs() < 1e-9, "{found:?}");
    }
}

/// A dose at every unit of time, which takes 1 - b of what is left and adds 1.
fn doses(b: f64) -> String {
    format!(
        r#"
        schema = 1
        name = "doses"
        states = ["x", "c"]
        [parameters]
        b = {b}
        [[mode]]
        name = "decay"
        equations = ["x' = -x", "c' = 1"]
        until = [{{ name = "dose", guard = "c > 1", reset = ["c = 0", "x = 1 + (1 - b)*x"] }}]
        [start]
        mode = "decay"
        x = 0
        c = 0
        "#
    )
}

/// Points just after a clock's reset lie far from its guard: x -> 1 + (1 - b) x/e from dose to
/// dose, with the multiplier (1 - b)/e.
#[test]
fn a_section_that_resets_its_own_guard_returns_once_a_period() {
    let decay = (-1.0_f64).exp();
    for b in [0.0, 0.5, 3.5] {
        let multiplier = (1.0 - b) * decay;
        let orbit = orbit(&doses(b), &Section::event("dose"), 3, 1);
        assert!((orbit.time - 1.0).abs() < ROUNDING_TOLERANCE, "{b}: {}", orbit.time);
        assert_eq!(orbit.events.len(), 1);
        let found = orbit.multipliers[0][0];
        assert!((found - multiplier).abs() < ROUNDING_TOLERANCE, "{b}: {found}");
        let x = orbit.points[0].state[0];
        assert!((x - 1.0 / (1.0 - multiplier)).abs() < ROUNDING_TOLERANCE, "{b}: {x}");
        let exponents = exponents(&doses(b), &Section::event("dose"), 3, 50);
        let rate = multiplier.abs().ln();
        // Along the motion there is none.
        let [along, own] = exponents.per_return[..] else { panic!("two states") };
        assert!(along.abs() < ROUNDING_TOLERANCE, "{along}");
        assert!((own - rate).abs() < ROUNDING_TOLERANCE, "{b}: {own}");
    }
    // An integrate-and-fire cell with one state, whose spikes come every ln(I/(I - 1)).
    let cell = r#"
        schema = 1
        name = "cell"
        states = ["u"]
        [[mode]]
        name = "rise"
        equations = ["u' = 7/5 - u"]
        until = [{ name = "spike", guard = "u > 1", reset = ["u = 0"] }]
        [start]
        mode = "rise"
        u = 0
    "#;
    let spikes = orbit(cell, &Section::event("spike"), 3, 1);
    assert!((spikes.time - 3.5_f64.ln()).abs() < ROUNDING_TOLERANCE, "{}", spikes.time);
}

/// A forced mass before a stop, with units of length and of time in which its states are of any
/// size: their scales say which.
fn rig(length: f64, rate: f64) -> String {
    format!(
        r#"
        schema = 1
        name = "rig"
        states = ["x", "v"]
        scales = ["L", "L*W"]
        forcing = {{ omega = "11*W/5" }}
        [parameters]
        L = {length:e}
        W = {rate:e}
        [[mode]]
        name = "free"
        equations = ["x' = v", "v' = -W^2*x - 2*W*v/5 + L*W^2*cos"]
        [[mode.until]]
        name = "impact"
        guard = "x > 0"
        reset = ["x = 0", "v = -4*v/5"]
        next = [{{ mode = "free" }}]
        [start]
        mode = "free"
        x = "-L"
        v = 0
        "#
    )
}

#[test]
fn multipliers_and_exponents_do_not_depend_on_the_units() {
    let strobe = Section::strobe(0.0);
    let of_size_one = orbit(&rig(1.0, 1.0), &strobe, 300, 1);
    let modulus = |it: &[f64; 2]| it[0].hypot(it[1]);
    let [first, second] = &of_size_one.multipliers[..] else { panic!("two states") };
    // Two impacts a period take r^2 each of the area, and so does the damping.
    let impacts = of_size_one.events.len() as i32;
    let area = 0.64_f64.powi(impacts) * (-0.4 * of_size_one.time).exp();
    assert!((modulus(first) * modulus(second) - area).abs() < ROUNDING_TOLERANCE);
    let growth = exponents(&rig(1.0, 1.0), &strobe, 300, 100).per_return;
    for (length, rate) in [(1.0, 3e7), (1.0, 1e12), (1e-12, 1e9), (1.0, 1e-14), (1e9, 1e-7)] {
        let other = orbit(&rig(length, rate), &strobe, 300, 1);
        for (own, other) in of_size_one.multipliers.iter().zip(&other.multipliers) {
            let apart = (own[0] - other[0]).hypot(own[1] - other[1]);
            assert!(apart < 1e-10, "{length:e} {rate:e}: {own:?} {other:?}");
        }
        let other = exponents(&rig(length, rate), &strobe, 300, 100).per_return;
        for (own, other) in growth.iter().zip(&other) {
            assert!((own - other).abs() < 1e-2, "{length:e} {rate:e}: {growth:?} {other:?}");
        }
        let sum = |it: &[f64]| it.iter().sum::<f64>();
        let apart = (sum(&growth) - sum(&other)).abs();
        assert!(apart < 1e-9, "{length:e} {rate:e}: {apart:e}");
    }
}

/// A watched event at the strobe's angle lies on either side of it by rounding.
#[test]
fn an_event_at_the_strobe_is_one_event_of_the_orbit() {
    let text = r#"
        schema = 1
        name = "at-strobe"
        states = ["x", "v"]
        forcing = { omega = 1 }
        [[mode]]
        name = "m"
        equations = ["x' = v", "v' = -4*x - v/5 + cos"]
        watch = [{ name = "start", guard = "sin > 0" }, { name = "low", guard = "cos < 0" }]
        [start]
        mode = "m"
        x = 0
        v = 0
    "#;
    let system = System::parse("test.system.toml", text).unwrap();
    let found = orbit(text, &Section::strobe(0.0), 50, 1);
    let mut names = found.event_names(&system);
    names.sort();
    assert_eq!(names, ["low@m", "start@m"]);
}

/// Newton's method ends a few roundings away from the orbit, by way of stiff teeth.
#[test]
fn an_orbit_that_closes_sooner_has_the_shorter_period() {
    let text = include_str!("gear_pair.system.toml");
    for period in [1, 2, 3, 4, 5, 6] {
        let found = orbit(text, &Section::strobe(0.0), 300, period);
        assert_eq!(found.points.len(), 1, "{period}: {:?}", found.points);
    }
}
