//! Median, 99 % quantile and maximum of errors.

use serde::Serialize;

/// Statistics of a set of errors; all NaN for an empty set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The 99th percentile.
    pub q99: f64,
    /// The largest.
    pub max: f64,
}

impl Spread {
    /// The statistics where nothing was measured.
    pub const NONE: Self = Self { median: f64::NAN, q99: f64::NAN, max: f64::NAN };

    /// The spread of some errors, by nearest rank; a NaN among them is the largest.
    #[must_use]
    pub fn new(mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let rank = |share: f64| nearest_rank(&errors, share);
        Self { median: rank(0.5), q99: rank(0.99), max: rank(1.0) }
    }
}

/// The value that a share of some errors, which are sorted, are at most; NaN of none.
#[must_use]
pub fn nearest_rank(sorted: &[f64], share: f64) -> f64 {
    let index = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(index.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

/// The largest error, at least 0; a NaN among them is the largest.
#[must_use]
pub fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors
        .fold(0.0, |worst: f64, error| if error > worst || error.is_nan() { error } else { worst })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_rank() {
        let spread = Spread::new((1..=200).map(f64::from).collect());
        assert_eq!(spread, Spread { median: 100.0, q99: 198.0, max: 200.0 });
        assert_eq!(Spread::new(vec![3.0]), Spread { median: 3.0, q99: 3.0, max: 3.0 });
    }

    #[test]
    fn a_nan_is_never_lost() {
        assert!(Spread::new(vec![1.0, f64::NAN.abs(), 2.0]).max.is_nan());
        assert!(Spread::new(Vec::new()).median.is_nan());
    }
}
