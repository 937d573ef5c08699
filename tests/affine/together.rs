//! Watched guards do not disturb one another: each is crossed when it is watched together with
//! others as it is when it is watched alone, and they change no event that ends a mode.

use super::random;
use percuss::affine::DoubleDouble;
use percuss::affine::{Direction, Rational, Solver, System, SystemFile, Watch, What};
use percuss::number::Number;

/// The number of random systems that are run.
const SYSTEMS: u64 = 60;

/// The number of a system's events that are compared, at most.
const EVENTS: usize = 60;

/// The horizon: at later times many systems have come to rest, where rounding hides the signs of
/// guards.
const HORIZON: f64 = 5.0;

/// The largest distance of two crossings that are the same: far above what 106 bits leave after so
/// many events, and far below the distance of two that are not.
const CROSSING_TOLERANCE: f64 = 1e-9;

#[test]
fn guards_are_crossed_together_as_alone() {
    let compared: usize = (1..=SYSTEMS).map(compare_runs).sum();
    assert!(compared > 500, "{compared} events");
}

/// Compares the runs of a random system, and says how many events were.
fn compare_runs(seed: u64) -> usize {
    let file = SystemFile::read("random.system.toml", &random::system(seed)).unwrap();
    let system = watched_system(file.system().unwrap());
    let Some(together) = events(&system) else { return 0 };
    let mut compared = 0;
    for watch in 0..max_watched(&system) {
        let mut alone = system.clone();
        for mode in &mut alone.modes {
            mode.watch = mode.watch.get(watch).cloned().into_iter().collect();
        }
        let Some(alone) = events(&alone) else { continue };
        // The shorter run of the two ends first.
        let last = |all: &[(What<DoubleDouble>, f64)]| all.last().map_or(0.0, |it| it.1);
        let until = last(&together).min(last(&alone)) - CROSSING_TOLERANCE;
        let own = |all: &[(What<DoubleDouble>, f64)], index: usize| -> Vec<(usize, usize, f64)> {
            let before = all.iter().filter(|it| it.1 < until);
            let kept = before.filter_map(|(what, time)| match *what {
                What::Until(mode, until) => Some((mode, until, *time)),
                What::Watch(mode, of) if of == index => Some((mode, usize::MAX, *time)),
                _ => None,
            });
            kept.collect()
        };
        let (mut a, mut b) = (own(&together, watch), own(&alone, 0));
        // Events of one instant have no order.
        let order = |x: &(usize, usize, f64), y: &(usize, usize, f64)| {
            (x.0, x.1).cmp(&(y.0, y.1)).then(x.2.total_cmp(&y.2))
        };
        a.sort_by(order);
        b.sort_by(order);
        let same = a.len() == b.len()
            && a.iter()
                .zip(&b)
                .all(|(x, y)| (x.0, x.1) == (y.0, y.1) && (x.2 - y.2).abs() < CROSSING_TOLERANCE);
        assert!(same, "seed {seed}, watch {watch}: {a:?} together, {b:?} alone");
        compared += a.len();
    }
    compared
}

/// A system that watches its first two states at three levels each, in both directions.
fn watched_system(mut system: System) -> System {
    let states = system.states.len();
    for mode in &mut system.modes {
        let dimension = mode.matrix.len();
        for (state, level) in (0..states.min(2)).flat_map(|k| [(k, -1), (k, 0), (k, 1)]) {
            let mut guard = vec![Rational::ZERO; dimension];
            guard[state] = Rational::ONE;
            guard[dimension - 1] = Rational::from(1 - 3 * level) / Rational::from(14);
            let name = format!("x{state}-at-level-{}", level + 1);
            mode.watch.push(Watch { name, guard, direction: Direction::Both });
        }
    }
    system
}

fn max_watched(system: &System) -> usize {
    system.modes.iter().map(|mode| mode.watch.len()).max().unwrap_or(0)
}

/// The first events of a run with their times; none where rounding hides one.
fn events(system: &System) -> Option<Vec<(What<DoubleDouble>, f64)>> {
    let solver = Solver::<DoubleDouble>::new(system).unwrap();
    let start = system.start.as_ref().unwrap();
    let mut run = solver.run(start, DoubleDouble::exact(HORIZON)).unwrap();
    let all: Vec<_> =
        run.by_ref().take(EVENTS).map(|it| (it.what, it.time.value().to_f64())).collect();
    (run.work().undecidable == 0).then_some(all)
}
