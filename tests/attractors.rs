//! Attractors and basins: the paper's cases, and what must hold of any labelling.

use percuss::dynamics::attractor::{
    Attractor, AttractorCatalog, AttractorKind, Basins, Grid, Label, SearchLimits, UnresolvedStart,
    Window,
};
use percuss::dynamics::lyapunov::Spectrum;
use percuss::dynamics::section::Section;
use percuss::dynamics::strobe::{StrobeMap, StrobePoint};
use percuss::{Instant, Model, Parameters};

/// Holds every attractor of the paper's Fig. 7.
const WINDOW: Window = Window { p: [-3.0, 1.2], y: [-1.5, 1.5] };

fn map_at(parameters: Parameters, cycle: i64) -> StrobeMap {
    let instant = Instant::at(parameters.omega, 0.0, cycle);
    StrobeMap::new(Model::new(parameters).unwrap(), instant)
}

fn fig7(omega: f64) -> StrobeMap {
    map_at(Parameters { xi: 0.1, omega, ..Parameters::default() }, 0)
}

fn survey(map: &StrobeMap, columns: u32, rows: u32) -> Basins {
    Basins::new(map, &Grid { window: WINDOW, columns, rows, q: 0.0 }, 400, &|_| {})
}

fn kinds(basins: &Basins) -> Vec<(AttractorKind, Option<u32>)> {
    basins.attractors.iter().map(|it| (it.kind, it.period())).collect()
}

fn after(map: &StrobeMap, start: StrobePoint, periods: u64) -> StrobePoint {
    let entry = map.entry(start).unwrap();
    let first = entry.instant.after_periods(periods, 1);
    Section::along(map.model().trajectory(entry), first).next().unwrap().point()
}

/// What coexists at xi = 0.1. The paper finds two chaotic attractors at omega = 1.56; here the
/// smaller one is a stable orbit of period 24, whose strobes repeat from period to period 24.
#[test]
fn the_attractors_of_fig_7() {
    let orbit = |period| (AttractorKind::Periodic, Some(period));
    let chaos = (AttractorKind::Chaotic, None);
    let expected = [
        (1.4, vec![orbit(4), chaos]),
        (1.45, vec![orbit(4), orbit(12), chaos]),
        (1.56, vec![orbit(4), orbit(24), chaos]),
        (1.58, vec![orbit(6), chaos]),
        (1.6, vec![orbit(5), orbit(6), chaos]),
        (1.7, vec![orbit(3), orbit(9), chaos]),
    ];
    for (omega, expected) in expected {
        let basins = survey(&fig7(omega), 40, 40);
        assert_eq!(kinds(&basins), expected, "{omega}");
        assert_eq!(basins.fraction(Label::Unresolved), 0.0);
        for attractor in &basins.attractors {
            confirm(&fig7(omega), attractor);
        }
    }
}

/// A multiple of every period of Fig. 7.
const PERIODS: u64 = 36_000;

/// An orbit by following it from one of its strobes, and its exponent from errors carried along;
/// chaos by an exponent over another part of the run.
fn confirm(map: &StrobeMap, attractor: &Attractor) {
    let first = attractor.points[0];
    let from = map.entry(first).unwrap();
    let spectrum = Spectrum::new(map.model(), from, 200, PERIODS);
    let [largest, ..] = spectrum.exponents_per_period;
    if let Some(orbit) = &attractor.orbit {
        let period = u64::from(orbit.period());
        let image = after(map, first, 40 * period);
        let apart = (0..3).map(|i| (image[i] - first[i]).abs()).fold(0.0, f64::max);
        // Rounding on a stable orbit, with room for its slowest multiplier, 0.92.
        assert!(apart < 1e-11, "{period}: {apart:e}");
        for divisor in (1..period).filter(|it| period % it == 0) {
            let sooner = after(map, first, divisor);
            assert!((0..3).any(|i| (sooner[i] - first[i]).abs() > 1e-4), "{period}: {divisor}");
        }
        assert!(orbit.is_stable() && attractor.points.iter().all(|it| it[0] >= first[0]));
        // Of a complex pair the first error turns on an ellipse and tells little; but both
        // exponents are half the contraction then, which is a sum over whole turns.
        let turns = orbit.multipliers[0][1] != 0.0;
        let followed = if turns { spectrum.contraction_per_period / 2.0 } else { largest };
        // A real one's first direction is good to about one logarithm of order 1 over the run.
        let allowed = if turns { 1e-10 } else { 2.0 / PERIODS as f64 };
        assert!((followed - attractor.lyapunov_per_period).abs() < allowed, "{period}");
        assert!((spectrum.drift_per_period - attractor.drift_per_period).abs() < 1e-12);
    } else {
        assert!(spectrum.is_chaotic(20.0));
        let apart = (largest - attractor.lyapunov_per_period).abs();
        assert!(apart < 5.0 * (spectrum.standard_error[0] + attractor.lyapunov_error));
    }
}

/// The label of a start is that of its image, after a few periods and after a long time. Not at
/// omega = 1.56: there some starts wander for hundreds of periods on what is left of the chaotic
/// attractor around the orbit of period 24, and a rounding decides where they leave it.
#[test]
fn a_label_is_invariant_under_the_map() {
    for omega in [1.45, 1.6, 1.7] {
        let map = fig7(omega);
        let mut catalog = AttractorCatalog::new(map, 400);
        let grid = Grid { window: WINDOW, columns: 23, rows: 17, q: 0.0 };
        let labels = catalog.label_all(&grid.starts(), &|_| {});
        let mut seen = std::collections::BTreeSet::new();
        for (n, (start, label)) in grid.starts().iter().zip(&labels).enumerate() {
            seen.insert(*label);
            assert_eq!(catalog.label(*start), *label, "{omega} {start:?}");
            let later = after(&map, *start, [1, 7, 50, 700][n % 4]);
            assert_eq!(catalog.label(later), *label, "{omega} {start:?}");
        }
        assert!(seen.len() >= 3, "{omega}: {seen:?}");
    }
}

/// The model depends on time through the forcing angle alone.
#[test]
fn labels_are_the_same_at_every_cycle() {
    let parameters = Parameters { xi: 0.1, omega: 1.6, ..Parameters::default() };
    let [early, late] = [0, 1 << 50].map(|cycle| survey(&map_at(parameters, cycle), 12, 12));
    assert_eq!(early.labels, late.labels);
    assert_eq!(early.attractors, late.attractors);
}

/// Attractors do not depend on the grid, nor their places; nor do the labels of starts that two
/// grids share.
#[test]
fn a_finer_grid_finds_the_same() {
    let map = fig7(1.45);
    let coarse = survey(&map, 25, 25);
    let fine = survey(&map, 75, 75);
    assert_eq!(coarse.attractors, fine.attractors);
    for (row, column) in (0..25).flat_map(|row| (0..25).map(move |column| (row, column))) {
        let middle = fine.labels[(3 * row + 1) * 75 + 3 * column + 1];
        let [p, y, _] = coarse.grid.starts()[row * 25 + column];
        let [same_p, same_y, _] = fine.grid.starts()[(3 * row + 1) * 75 + 3 * column + 1];
        // Where rounding moves a start by its last digit and a boundary runs between, labels may
        // differ: that has a probability of about 1e-3 at an uncertainty exponent near 0.1.
        if p == same_p && y == same_y {
            assert_eq!(coarse.labels[row * 25 + column], middle);
        }
    }
}

/// Regimes without chaos: rest on the slider, a mass that leaves, a slider that never stops, an
/// orbit wholly on the slider, drift.
#[test]
fn regimes_beyond_the_papers() {
    let paper = Parameters::default();
    let rests = Parameters { a: 0.05, b: 0.5, xi: 0.1, omega: 0.7, ..paper };
    let basins = survey(&map_at(rests, 0), 9, 9);
    assert_eq!(kinds(&basins), [(AttractorKind::Periodic, Some(1))]);
    let decay = -0.1 * std::f64::consts::TAU / 0.7;
    assert!((basins.attractors[0].lyapunov_per_period - decay).abs() < 1e-9);
    for b in [-0.1, 1.5] {
        let basins = survey(&map_at(Parameters { b, ..paper }, 0), 9, 9);
        assert_eq!(basins.fraction(Label::Escaping), 1.0, "{b}");
        assert!(basins.attractors.is_empty());
    }
    // The orbit of Table 1: period two, with drift.
    let table1 = survey(&map_at(Parameters { omega: 0.1, ..paper }, 0), 9, 9);
    assert_eq!(kinds(&table1), [(AttractorKind::Periodic, Some(2))]);
    assert!((table1.attractors[0].drift_per_period - 13.910_576).abs() < 1e-5);
}

/// Next to a flip an orbit attracts too slowly to be recognised: its starts are unresolved, and not
/// called something else.
#[test]
fn what_cannot_be_told_is_unresolved() {
    let basins = survey(&fig7(1.57), 20, 20);
    assert_eq!(
        kinds(&basins),
        [(AttractorKind::Periodic, Some(4)), (AttractorKind::Chaotic, None)]
    );
    let unresolved = basins.fraction(Label::Unresolved);
    assert!(unresolved > 0.01 && unresolved < 0.1, "{unresolved}");
}

/// Chaos of some 30,000 periods, and then an orbit of period 240 that passes so near a graze that
/// its traps are 1e-8 wide. It is found; below its period its starts are described.
#[test]
fn an_orbit_of_a_long_period_after_long_chaos() {
    let parameters =
        Parameters { a: 0.42, b: 0.18, xi: 0.08, g: 0.05, omega: 0.74, ..Parameters::default() };
    let map = map_at(parameters, 0);
    let window = Window { p: [-1.0, 1.0], y: [-1.0, 1.0] };
    let grid = Grid { window, columns: 3, rows: 2, q: 0.0 };
    let basins = Basins::new(&map, &grid, 200, &|_| {});
    assert_eq!(kinds(&basins), [(AttractorKind::Periodic, Some(240))]);
    assert_eq!(basins.fraction(Label::Unresolved), 0.0);
    assert!(basins.unresolved_examples(&map, 200).is_empty());
    let limits = SearchLimits { transient: 200, max_period: 239 };
    let short = Basins::new(&map, &grid, limits, &|_| {});
    assert_eq!(short.fraction(Label::Unresolved), 1.0);
    let examples = short.unresolved_examples(&map, limits);
    assert_eq!(examples.len(), 3);
    for (example, start) in examples.iter().zip([0, 2, 5]) {
        assert_eq!((example.point, example.recurrence), (grid.starts()[start], None));
    }
    // Some are in chaos still after 3,000 periods; after 300,000 all are on the orbit.
    assert!(examples.iter().any(|it| it.lyapunov_per_period > 0.01), "{examples:?}");
    let late = SearchLimits { transient: 20_000, max_period: 240 };
    let settled = short.unresolved_examples(&map, late);
    let on_orbit = |it: &UnresolvedStart| {
        it.recurrence == Some(240) && (it.lyapunov_per_period + 0.004_213).abs() < 0.001
    };
    assert!(settled.iter().all(on_orbit), "{settled:?}");
}
