//! Histograms of errors over the powers of two.

/// Counts of errors by the whole part of their binary logarithm.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Histogram {
    /// Errors from 2^`lowest` on are in the first bin, with all that are smaller.
    pub lowest: i32,
    /// Errors in each bin; the last one holds all that are larger, and what is no number.
    pub counts: Vec<usize>,
}

/// The exponent of two, in units, at which the lowest bin begins: a thousandth of a unit.
const LOWEST_BIN: i32 = -10;
/// Up to 2^53 units: no digit is right.
const BINS: usize = 64;

impl Histogram {
    /// The histogram of non-negative errors.
    #[must_use]
    pub fn new(errors: &[f64]) -> Self {
        let mut counts = vec![0; BINS];
        for error in errors {
            counts[bin(*error)] += 1;
        }
        Self { lowest: LOWEST_BIN, counts }
    }
}

fn bin(error: f64) -> usize {
    if error.is_nan() {
        return BINS - 1;
    }
    // As integers the logarithms of zero and of infinity saturate.
    let place = (error.log2().floor() as i64).saturating_sub(i64::from(LOWEST_BIN));
    usize::try_from(place).unwrap_or(0).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_is_in_one_bin() {
        let histogram = Histogram::new(&[0.0, 1e-9, 1.0, 1.9, 2.0, f64::INFINITY, f64::NAN]);
        let filled: Vec<_> =
            (0..).zip(&histogram.counts).filter(|(_, count)| **count > 0).collect();
        assert_eq!(filled, [(0, &2), (10, &2), (11, &1), (63, &2)]);
    }
}
