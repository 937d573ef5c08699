//! Distances between two sections.

use super::section::Section;
use std::collections::{BTreeMap, BTreeSet};

/// The distances by name.
pub type Distances = BTreeMap<&'static str, f64>;

/// Names of what is measured, by what its unit is.
pub const STATISTICS: [&str; 17] = [
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
];

/// Number of series that both one-dimensional distances are taken of.
const SERIES: usize = 7;

/// All distances: Wasserstein and Kolmogorov-Smirnov of p, y and q and of the sums and differences
/// of successive p and y (their delay pairs, along the diagonals), total variation of the phase
/// words, differences of exponent and drift per period.
#[must_use]
pub fn distances(section: &Section, reference: &Section) -> Distances {
    let mut result = Distances::new();
    let pairs = series(section).into_iter().zip(series(reference));
    for (k, (ours, theirs)) in pairs.enumerate() {
        let (wasserstein, ks) = one_dimensional(ours, theirs);
        result.insert(STATISTICS[k], wasserstein);
        result.insert(STATISTICS[SERIES + k], ks);
    }
    result.insert("phase_words", total_variation(&section.words, &reference.words));
    result.insert("lyapunov", (section.lyapunov - reference.lyapunov).abs());
    result.insert("drift", (section.drift - reference.drift).abs());
    result
}

fn series(section: &Section) -> [Vec<f64>; SERIES] {
    let points = &section.points;
    let of = |i: usize| points.iter().map(|point| point[i]).collect();
    let pairs = |i: usize, sign: f64| {
        points.windows(2).map(|pair| pair[1][i] + sign * pair[0][i]).collect()
    };
    [of(0), of(1), of(2), pairs(0, 1.0), pairs(0, -1.0), pairs(1, 1.0), pairs(1, -1.0)]
}

/// Wasserstein-1 and Kolmogorov-Smirnov distance of two samples: the integral and the largest value
/// of the difference of their distribution functions.
fn one_dimensional(mut a: Vec<f64>, mut b: Vec<f64>) -> (f64, f64) {
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    let (mut i, mut j) = (0, 0);
    let (mut area, mut largest) = (0.0, 0.0_f64);
    let mut last = f64::NAN;
    while i < a.len() || j < b.len() {
        let here = match (a.get(i), b.get(j)) {
            (Some(x), Some(y)) => x.min(*y),
            (Some(x), None) => *x,
            (None, Some(y)) => *y,
            (None, None) => break,
        };
        let apart = (i as f64 / a.len() as f64 - j as f64 / b.len() as f64).abs();
        if !last.is_nan() {
            area += apart * (here - last);
        }
        largest = largest.max(apart);
        while a.get(i).is_some_and(|x| *x <= here) {
            i += 1;
        }
        while b.get(j).is_some_and(|y| *y <= here) {
            j += 1;
        }
        last = here;
    }
    (area, largest)
}

fn total_variation(a: &BTreeMap<String, f64>, b: &BTreeMap<String, f64>) -> f64 {
    let words: BTreeSet<_> = a.keys().chain(b.keys()).collect();
    let share = |of: &BTreeMap<String, f64>, word: &String| of.get(word).copied().unwrap_or(0.0);
    0.5 * words.into_iter().map(|word| (share(a, word) - share(b, word)).abs()).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_is_its_own_wasserstein_distance() {
        let a: Vec<f64> = (0..100).map(f64::from).collect();
        let b = a.iter().map(|x| x + 2.5).collect();
        let (wasserstein, ks) = one_dimensional(a, b);
        approx::assert_relative_eq!(wasserstein, 2.5, max_relative = 1e-12);
        approx::assert_relative_eq!(ks, 0.03, max_relative = 1e-12);
    }

    #[test]
    fn samples_of_different_size_with_the_same_distribution_are_not_apart() {
        let a = vec![1.0, 2.0, 3.0];
        let b = vec![1.0, 1.0, 2.0, 2.0, 3.0, 3.0];
        let (wasserstein, ks) = one_dimensional(a, b);
        assert!(wasserstein < 1e-15 && ks < 1e-15);
    }

    #[test]
    fn words_that_never_meet_are_one_apart() {
        let a = BTreeMap::from([("cn".to_owned(), 1.0)]);
        let b = BTreeMap::from([("cpcn".to_owned(), 0.25), (String::new(), 0.75)]);
        approx::assert_relative_eq!(total_variation(&a, &b), 1.0, max_relative = 1e-12);
    }
}
