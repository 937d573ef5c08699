//! Periodic orbits: they map to themselves, and their multipliers are those of the map.

use percuss::dynamics::linear::{eigenvalues, modulus};
use percuss::dynamics::orbit::{LARGEST_PERIOD, Orbit, Reason, scan};
use percuss::dynamics::strobe::{Jacobian, StrobeMap, StrobePoint};
use percuss::{Instant, Model, Parameters, Phase};
use std::sync::OnceLock;

/// A strobe's and a phase's roundings, carried to the end of one forcing period with a derivative
/// of about ten; the largest met is 3 eps.
const CLOSURE_TOLERANCE: f64 = 16.0 * f64::EPSILON;

fn map_of(parameters: Parameters, angle: f64) -> StrobeMap {
    let model = Model::new(parameters).unwrap();
    StrobeMap::new(model, Instant::at(1.0, angle, 0))
}

fn map(xi: f64, omega: f64) -> StrobeMap {
    map_of(Parameters { xi, omega, ..Parameters::default() }, 0.0)
}

fn image(map: &StrobeMap, point: StrobePoint, periods: u64) -> StrobePoint {
    map.passage(&map.entry(point).unwrap(), periods).point()
}

fn distance(a: StrobePoint, b: StrobePoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max)
}

/// xi, omega and period of the paper's periodic attractors.
const PAPER_ORBITS: [(f64, f64, u32); 7] = [
    (0.1, 1.4, 4),
    (0.1, 1.45, 12),
    (0.1, 1.6, 5),
    (0.1, 1.6, 6),
    (0.1, 1.7, 3),
    (0.1, 1.7, 9),
    (0.01, 0.1, 2),
];

/// Their maps, and what a scan finds there.
fn papers() -> &'static [(StrobeMap, u32, Vec<Orbit>)] {
    static FOUND_ORBITS: OnceLock<Vec<(StrobeMap, u32, Vec<Orbit>)>> = OnceLock::new();
    FOUND_ORBITS.get_or_init(|| {
        let found = PAPER_ORBITS.map(|(xi, omega, period)| {
            let map = map(xi, omega);
            let mut orbits = scan(&map, period, &mut |_| {});
            orbits.retain(|it| it.period() == period);
            (map, period, orbits)
        });
        found.to_vec()
    })
}

#[test]
fn the_papers_attractors_are_found_and_stable_and_unstable_ones_beside_them() {
    let mut unstable = 0;
    for (map, period, orbits) in papers() {
        assert!(orbits[0].is_stable(), "{:?} {period}: {orbits:?}", map.model().parameters());
        unstable += orbits.iter().filter(|it| !it.is_stable()).count();
    }
    assert!(unstable >= 10, "{unstable}");
}

#[test]
fn an_orbit_maps_to_itself_strobe_by_strobe() {
    for (map, period, orbits) in papers() {
        for orbit in orbits {
            let next = orbit.points.iter().cycle().skip(1);
            let worst = orbit
                .points
                .iter()
                .zip(next)
                .map(|(point, next)| distance(image(map, *point, 1), *next))
                .fold(0.0, f64::max);
            assert!(
                worst <= CLOSURE_TOLERANCE && orbit.residual <= CLOSURE_TOLERANCE,
                "{worst:e} {orbit:?}"
            );
            // No sooner: the first strobe is not met again before the period is over.
            for n in 1..*period {
                assert!(distance(orbit.points[n as usize], orbit.points[0]) > 1e-6, "{orbit:?}");
            }
        }
    }
}

#[test]
fn multipliers_are_those_of_differences_and_contract() {
    // Central differences: a step squared times a third derivative, and eps over the step.
    const STEP: f64 = 1e-6;
    let mut compared = 0;
    for (map, period, orbits) in papers() {
        for orbit in orbits {
            let [first, second, third] = orbit.multipliers;
            assert_eq!(third, [0.0; 2]);
            // Areas contract where the slider comes to rest between contacts, as it does here.
            let area = first[0] * second[0] - first[1] * second[1];
            assert!(area.abs() < 1.0, "{orbit:?}");
            let in_flight = |it: &StrobePoint| map.entry(*it).unwrap().phase() == Phase::NoContact;
            // Where all sides of a strobe are in the section; growth spoils the differences of
            // others.
            let Some(point) = orbit.points.iter().find(|it| in_flight(it)) else { continue };
            if modulus(first) > 50.0 {
                continue;
            }
            let columns = [0, 1, 2].map(|column| {
                let ends = [STEP, -STEP].map(|step| {
                    let mut beside = *point;
                    beside[column] += step;
                    image(map, beside, u64::from(*period))
                });
                [0, 1, 2].map(|row| (ends[0][row] - ends[1][row]) / (2.0 * STEP))
            });
            let jacobian: Jacobian = [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i]));
            for (ours, theirs) in orbit.multipliers.iter().zip(eigenvalues(&jacobian)) {
                let apart = modulus([ours[0] - theirs[0], ours[1].abs() - theirs[1].abs()]);
                assert!(apart <= 2e-4 * (1.0 + modulus(first)), "{orbit:?} {theirs:?}");
            }
            compared += 1;
        }
    }
    assert!(compared >= 12, "{compared}");
}

/// The orbit does not know where it is looked at.
#[test]
fn another_section_sees_the_same_orbit() {
    for (here, period, orbits) in papers() {
        let orbit = &orbits[0];
        let start = here.entry(orbit.points[0]).unwrap();
        for eighths in [1, 3, 6] {
            let instant = start.instant.after_periods(eighths, 8);
            let run = here.model().trajectory(start);
            let segment = run.into_iter().find(|segment| !segment.ends_by(&instant)).unwrap();
            let there = StrobeMap::new(*here.model(), instant);
            let seen = Orbit::find(&there, segment.entry_at(&instant).point(), *period).unwrap();
            assert_eq!(seen.period(), *period);
            for (a, b) in orbit.multipliers.iter().zip(seen.multipliers) {
                // Rounding of the products, and of the strobes times the map's second derivative.
                assert!(modulus([a[0] - b[0], a[1] - b[1]]) <= 1e-11, "{orbit:?} {seen:?}");
            }
            let drift = (orbit.drift_per_period - seen.drift_per_period).abs();
            assert!(drift <= 1e-12 * (1.0 + orbit.drift_per_period), "{drift:e}");
            let turned = (0..orbit.phases.len())
                .any(|k| [&orbit.phases[k..], &orbit.phases[..k]].concat() == seen.phases);
            assert!(turned, "{:?} {:?}", orbit.phases, seen.phases);
        }
    }
}

#[test]
fn table_1_is_an_orbit_of_eight_phases() {
    let map = map(0.01, 0.1);
    let rest = map.entry([0.0; 3]).unwrap();
    let settled = map.strobes(rest, 400).last().unwrap();
    let orbit = Orbit::find(&map, settled.point(), 8).unwrap();
    // Asked for eight forcing periods, it closes after two.
    assert_eq!((orbit.period(), orbit.phases.len()), (2, 8));
    // The run's own drift over its last periods.
    let drifts: Vec<_> = map.strobes(rest, 402).skip(400).map(|it| it.v()).collect();
    let drift = 0.5 * (drifts[2] - drifts[0]);
    assert!((orbit.drift_per_period - drift).abs() <= 1e-12 * drift, "{drift}");
}

#[test]
fn rest_on_the_slider_is_an_orbit_with_a_zero_multiplier() {
    let parameters = Parameters { a: 0.05, b: 0.5, xi: 0.1, omega: 0.7, ..Parameters::default() };
    let map = map_of(parameters, 0.4);
    let orbit = Orbit::find(&map, [0.5, 0.0, 0.5], 3).unwrap();
    assert_eq!((orbit.period(), orbit.phases.clone()), (1, vec![Phase::Contact]));
    assert!(orbit.is_stable() && orbit.drift_per_period == 0.0);
    // Damped oscillation: two multipliers of modulus exp(-xi T).
    let modulus = modulus(orbit.multipliers[0]);
    assert!((modulus - (-0.1 * map.model().period()).exp()).abs() <= 1e-15, "{modulus}");
}

/// Without a static force and without contact there is a continuum of orbits: nothing to be solved
/// is left alone.
#[test]
fn flights_that_never_touch_are_orbits_where_the_mean_force_vanishes() {
    let map = map_of(Parameters { b: 0.0, ..Parameters::default() }, 0.0);
    let orbit = Orbit::find(&map, [-50.0, 0.2, 0.0], 1).unwrap();
    assert_eq!(orbit.phases, [Phase::NoContact]);
    assert_eq!(orbit.multipliers[0], [1.0, 0.0]);
    // a/omega: the velocity without a mean.
    assert!((orbit.points[0][1] - 0.3 / 1.4).abs() <= 1e-15);
}

#[test]
fn where_there_is_none_it_says_so() {
    let escaping = map_of(Parameters { b: -0.1, ..Parameters::default() }, 0.0);
    assert!(Orbit::find(&escaping, [-1.0, 0.0, 0.0], 3).is_err());
    assert!(scan(&escaping, 2, &mut |_| {}).is_empty());
    let map = map(0.1, 1.4);
    for guess in [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0], [0.0, 0.0, 1e10]] {
        let none = Orbit::find(&map, guess, 1).unwrap_err();
        assert!(matches!(none.reason, Reason::Guess(_)), "{none}");
    }
    for period in [0, LARGEST_PERIOD + 1] {
        let none = Orbit::find(&map, [0.0; 3], period).unwrap_err();
        assert_eq!(none.reason, Reason::Period(period));
    }
}
