//! Distances between two sections, and of a section from the exact map.

use super::section::{RunSection, SERIES};
use crate::score::SCORED_ERROR;
use crate::score::statistics::Spread;
use std::collections::{BTreeMap, BTreeSet};

/// The distances by name.
pub type Distances = BTreeMap<&'static str, f64>;

/// Names of what is measured: distances from the reference section, then from the exact map.
pub const STATISTICS: [&str; 19] = [
    "wasserstein_p",
    "wasserstein_y",
    "wasserstein_q",
    "wasserstein_p_sum",
    "wasserstein_p_step",
    "wasserstein_y_sum",
    "wasserstein_y_step",
    "ks_p",
    "ks_y",
    "ks_q",
    "ks_p_sum",
    "ks_p_step",
    "ks_y_sum",
    "ks_y_step",
    "phase_words",
    "lyapunov",
    "drift",
    MAP_ERROR_MEDIAN,
    MAP_ERROR_SHARE,
];

/// The median of a section's one-period errors.
const MAP_ERROR_MEDIAN: &str = "map_error_median";
/// The share of periods whose error exceeds [`SCORED_ERROR`].
const MAP_ERROR_SHARE: &str = "map_error_share";

/// Whether a distance is one from the reference section, which sampling alone makes larger than
/// zero; the others are distances from the exact map, which rounding alone makes so.
#[must_use]
pub fn is_sampled(name: &str) -> bool {
    ![MAP_ERROR_MEDIAN, MAP_ERROR_SHARE].contains(&name)
}

/// All distances: Wasserstein and Kolmogorov-Smirnov of p, y and q and of the sums and differences
/// of successive p and y (their delay pairs, along the diagonals), total variation of the phase
/// sequences, differences of exponent and drift per period; median and share of large values among
/// the errors of single periods.
#[must_use]
pub fn distances(section: &RunSection, reference: &RunSection) -> Distances {
    let mut result = Distances::new();
    let pairs = section.sorted.iter().zip(&reference.sorted);
    for (k, (ours, theirs)) in pairs.enumerate() {
        let (wasserstein, ks) = one_dimensional(ours, theirs);
        result.insert(STATISTICS[k], wasserstein);
        result.insert(STATISTICS[SERIES + k], ks);
    }
    result.insert(
        "phase_words",
        total_variation(&section.phase_sequences, &reference.phase_sequences),
    );
    result.insert("lyapunov", (section.lyapunov - reference.lyapunov).abs());
    result.insert("drift", (section.drift - reference.drift).abs());
    let errors = &section.map_errors;
    let large = errors.iter().filter(|error| **error > SCORED_ERROR).count();
    result.insert(MAP_ERROR_MEDIAN, Spread::new(errors.clone()).median);
    result.insert(MAP_ERROR_SHARE, large as f64 / errors.len() as f64);
    result
}

/// Wasserstein-1 and Kolmogorov-Smirnov distance of two samples in rising order: the integral and
/// the largest value of the difference of their distribution functions.
fn one_dimensional(a: &[f64], b: &[f64]) -> (f64, f64) {
    (area(a, b), exceeds(a, b).max(exceeds(b, a)))
}

fn area(a: &[f64], b: &[f64]) -> f64 {
    let (mut i, mut j) = (0, 0);
    let mut area = 0.0;
    let mut last = f64::NAN;
    while i < a.len() || j < b.len() {
        let here = match (a.get(i), b.get(j)) {
            (Some(x), Some(y)) => x.min(*y),
            (Some(x), None) => *x,
            (None, Some(y)) => *y,
            (None, None) => break,
        };
        if !last.is_nan() {
            let apart = (i as f64 / a.len() as f64 - j as f64 / b.len() as f64).abs();
            area += apart * (here - last);
        }
        i += a[i..].iter().take_while(|x| **x <= here).count();
        j += b[j..].iter().take_while(|y| **y <= here).count();
        last = here;
    }
    area
}

/// Values nearer than this count as equal for Kolmogorov-Smirnov. Some series have atoms: in a
/// period of free flight y grows by exactly b T, and an integrator's error, however small, moves
/// all of it.
const EQUAL_VALUES_TOLERANCE: f64 = SCORED_ERROR;

/// The largest amount by which the distribution function of `a` exceeds that of `b` a little
/// further on.
fn exceeds(a: &[f64], b: &[f64]) -> f64 {
    let (mut largest, mut below) = (0.0_f64, 0);
    for (k, x) in a.iter().enumerate() {
        below += b[below..].iter().take_while(|y| **y <= x + EQUAL_VALUES_TOLERANCE).count();
        largest = largest.max((k + 1) as f64 / a.len() as f64 - below as f64 / b.len() as f64);
    }
    largest
}

fn total_variation(a: &BTreeMap<String, f64>, b: &BTreeMap<String, f64>) -> f64 {
    let sequences: BTreeSet<_> = a.keys().chain(b.keys()).collect();
    let frequency =
        |of: &BTreeMap<String, f64>, sequence: &String| of.get(sequence).copied().unwrap_or(0.0);
    0.5 * sequences
        .into_iter()
        .map(|sequence| (frequency(a, sequence) - frequency(b, sequence)).abs())
        .sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_is_its_own_wasserstein_distance() {
        let a: Vec<f64> = (0..100).map(f64::from).collect();
        let b: Vec<f64> = a.iter().map(|x| x + 2.5).collect();
        let (wasserstein, ks) = one_dimensional(&a, &b);
        approx::assert_relative_eq!(wasserstein, 2.5, max_relative = 1e-12);
        approx::assert_relative_eq!(ks, 0.03, max_relative = 1e-12);
    }

    #[test]
    fn samples_of_different_size_with_the_same_distribution_are_not_apart() {
        let a = vec![1.0, 2.0, 3.0];
        let b = vec![1.0, 1.0, 2.0, 2.0, 3.0, 3.0];
        let (wasserstein, ks) = one_dimensional(&a, &b);
        assert!(wasserstein < 1e-15 && ks < 1e-15);
    }

    #[test]
    fn an_atom_that_moves_by_rounding_is_the_same_atom() {
        let a = vec![0.4; 100];
        let b: Vec<f64> = (0..100).map(|k| 0.4 + 1e-12 * f64::from(k)).collect();
        let (wasserstein, ks) = one_dimensional(&a, &b);
        assert!(wasserstein < 1e-10 && ks == 0.0);
    }

    #[test]
    fn sequences_that_never_meet_are_one_apart() {
        let a = BTreeMap::from([("cn".to_owned(), 1.0)]);
        let b = BTreeMap::from([("cpcn".to_owned(), 0.25), (String::new(), 0.75)]);
        approx::assert_relative_eq!(total_variation(&a, &b), 1.0, max_relative = 1e-12);
    }

    /// Ten values a unit apart in each series; the second section's are shifted by 0.25 + k.
    #[test]
    fn each_distance_is_the_difference_that_was_put_in() {
        let sorted = |shift: f64| -> [Vec<f64>; SERIES] {
            std::array::from_fn(|k| {
                (0..10).map(|n| f64::from(n) + shift * (0.25 + k as f64)).collect()
            })
        };
        let sequences =
            |share: f64| BTreeMap::from([("cn".to_owned(), share), ("n".to_owned(), 1.0 - share)]);
        let reference = RunSection {
            sorted: sorted(0.0),
            phase_sequences: sequences(0.5),
            lyapunov: 0.1,
            drift: 0.01,
            ..RunSection::default()
        };
        let section = RunSection {
            sorted: sorted(1.0),
            phase_sequences: sequences(0.75),
            lyapunov: -0.2,
            drift: 0.03,
            map_errors: vec![1.0, 2e-9, 5e-9, 2.0 * SCORED_ERROR, 0.5 * SCORED_ERROR],
            ..RunSection::default()
        };
        let mut expected = Distances::new();
        for k in 0..SERIES {
            expected.insert(STATISTICS[k], 0.25 + k as f64);
            // A value of the one section has k + 1 more values of its own below it.
            expected.insert(STATISTICS[SERIES + k], (k + 1) as f64 / 10.0);
        }
        let others = [("phase_words", 0.25), ("lyapunov", 0.3), ("drift", 0.02)];
        expected.extend(others);
        expected.extend([(MAP_ERROR_MEDIAN, 0.5 * SCORED_ERROR), (MAP_ERROR_SHARE, 0.4)]);
        let found = distances(&section, &reference);
        assert!(found.keys().eq(expected.keys()), "{found:?}");
        for (name, value) in expected {
            approx::assert_relative_eq!(found[name], value, max_relative = 1e-12);
        }
    }
}
