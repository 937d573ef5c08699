//! Times at equal accuracy, read off a work-precision curve.
//!
//! An engine's settings, from loose to tight, are the vertices of its curve of time against error.
//! Between two neighbouring settings whose answers are both right, the logarithm of the time is
//! linear in the logarithm of the error. The time at errors of at most E is the least time on the
//! curve where the error is at most E. A curve is never extended: one that stays above E has no
//! such time, and one whose loosest setting errs less than E already has that setting's own.

/// The basis on which engines are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Basis {
    /// Each engine at its most accurate setting.
    MostAccurate,
    /// Each engine where its work-precision curve has errors of at most
    /// [`MAX_COMPARABLE_RATIO`] times the exact solver's on the same case.
    Comparable,
    /// Each engine where its work-precision curve has errors of at most [`TIGHT_ERROR`].
    Tight,
    /// Each engine where its work-precision curve has errors of at most [`LOOSE_ERROR`].
    Loose,
}

/// The largest ratio of an error to the exact solver's at which the two are of comparable accuracy:
/// one digit less.
pub const MAX_COMPARABLE_RATIO: f64 = 10.0;
/// The smaller error at which engines are compared.
pub const TIGHT_ERROR: f64 = 1e-9;
/// The larger error at which engines are compared.
pub const LOOSE_ERROR: f64 = 1e-6;

/// Every basis, in the order of tables.
pub const BASES: [Basis; 4] = [Basis::MostAccurate, Basis::Comparable, Basis::Tight, Basis::Loose];

/// The error of a right answer, and its time in any unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccuracyPoint {
    /// The largest error.
    pub error: f64,
    /// The time.
    pub time: f64,
}

/// The least time on a curve where the error is at most `error`; a setting without a right answer
/// is `None` and breaks the curve.
#[must_use]
pub fn time_at(curve: &[Option<AccuracyPoint>], error: f64) -> Option<f64> {
    let vertices = curve.iter().flatten().filter(|it| it.error <= error).map(|it| it.time);
    let crossings = curve.windows(2).filter_map(|pair| match pair {
        [Some(one), Some(other)] => between(one, other, error),
        _ => None,
    });
    vertices.chain(crossings).min_by(f64::total_cmp)
}

/// The time where the straight line between two vertices passes `error`.
fn between(one: &AccuracyPoint, other: &AccuracyPoint, error: f64) -> Option<f64> {
    let share = (error / one.error).ln() / (other.error / one.error).ln();
    let inside = share > 0.0 && share < 1.0;
    inside.then(|| one.time * (other.time / one.time).powf(share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(error: f64, time: f64) -> Option<AccuracyPoint> {
        Some(AccuracyPoint { error, time })
    }

    /// Rounding of two logarithms, their quotient and a power.
    const ROUNDING_TOLERANCE: f64 = 1e-14;

    fn agrees(found: Option<f64>, wanted: f64) -> bool {
        found.is_some_and(|it| (it / wanted - 1.0).abs() < ROUNDING_TOLERANCE)
    }

    #[test]
    fn a_power_law_is_met_everywhere() {
        // A method of order five: the time goes with the fifth root of one over the error.
        let law = |error: f64| 3.0 * error.powf(-0.2);
        let curve: Vec<_> =
            [1e-3, 1e-5, 2e-8, 1e-11].iter().map(|it| corner(*it, law(*it))).collect();
        for error in [1e-4, 1e-6, 1e-8, 1e-9, 1e-10] {
            assert!(agrees(time_at(&curve, error), law(error)), "{error}");
        }
    }

    #[test]
    fn a_curve_is_not_extended() {
        let curve = [corner(1e-5, 10.0), corner(1e-8, 20.0)];
        assert_eq!(time_at(&curve, 1e-9), None);
        assert_eq!(time_at(&curve, 1e-8), Some(20.0));
        // The loosest setting errs less already: its own time.
        assert_eq!(time_at(&curve, 1e-4), Some(10.0));
        assert_eq!(time_at(&[], 1e-4), None);
        assert_eq!(time_at(&[corner(f64::NAN, 1.0)], 1e-4), None);
    }

    #[test]
    fn a_setting_without_a_right_answer_is_not_bridged() {
        let curve = [corner(1e-5, 10.0), None, corner(1e-9, 40.0)];
        assert_eq!(time_at(&curve, 1e-7), Some(40.0));
    }

    #[test]
    fn the_least_time_counts_where_a_curve_turns_back() {
        let curve =
            [corner(1e-5, 10.0), corner(1e-7, 30.0), corner(1e-5, 50.0), corner(1e-9, 70.0)];
        assert!(agrees(time_at(&curve, 1e-6), (10.0_f64 * 30.0).sqrt()));
        // Only the last stretch reaches 1e-8.
        assert!(agrees(time_at(&curve, 1e-8), 50.0 * 1.4_f64.powf(0.75)));
        // An error of zero is a corner, and no line leads to it.
        let exact = [corner(1e-5, 10.0), corner(0.0, 30.0)];
        assert_eq!(time_at(&exact, 1e-6), Some(30.0));
    }
}
