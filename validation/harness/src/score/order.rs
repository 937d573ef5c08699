//! The order at which a method converges, from what it did.
//!
//! The error of a method of order k falls as the k-th power of its number of steps, whether the
//! steps are prescribed or chosen by a tolerance. So the slope of log(error) against log(steps)
//! over several settings is the order in practice: a method below the order it claims is shown as
//! such.

/// The number of steps and the error of a run at one setting.
pub type OrderPoint = (f64, f64);

/// The error below which rounding shows, and no convergence.
const MIN_ERROR: f64 = 1e-12;
/// The error from which on nothing converges yet.
const MAX_ERROR: f64 = 1e-2;
/// The fewest settings from which an order is taken.
const MIN_SETTINGS: usize = 3;
/// The smallest ratio of the steps of the settings from which an order is taken.
const MIN_STEP_RATIO: f64 = 1.5;

/// The slope by least squares; `None` where there are too few settings for one.
#[must_use]
pub fn order(points: &[OrderPoint]) -> Option<f64> {
    let usable =
        |(steps, error): &&OrderPoint| *steps > 0.0 && (MIN_ERROR..MAX_ERROR).contains(error);
    let logarithms: Vec<_> =
        points.iter().filter(usable).map(|(steps, error)| (steps.ln(), error.ln())).collect();
    let count = logarithms.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logarithms.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|it| it.0), mean(|it| it.1));
    let square: f64 = logarithms.iter().map(|it| (it.0 - x).powi(2)).sum();
    let product: f64 = logarithms.iter().map(|it| (it.0 - x) * (it.1 - y)).sum();
    let widest = logarithms.iter().map(|it| (it.0 - x).abs()).fold(0.0, f64::max);
    let enough = logarithms.len() >= MIN_SETTINGS && 2.0 * widest >= MIN_STEP_RATIO.ln();
    enough.then(|| -product / square)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_its_exponent() {
        let points: Vec<OrderPoint> =
            [50.0, 100.0, 200.0, 400.0].map(|n: f64| (n, 3.0 * n.powi(-4))).to_vec();
        let found = order(&points);
        assert!(found.is_some_and(|order| (order - 4.0).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn any_number_of_steps_counts() {
        let points: Vec<OrderPoint> =
            [0.25, 0.5, 1.0].map(|n: f64| (n, 1e-6 * n.powi(-3))).to_vec();
        assert!(order(&points).is_some_and(|order| (order - 3.0).abs() < 1e-12));
    }

    #[test]
    fn rounding_and_divergence_do_not_count() {
        let points = [(10.0, 1.0), (100.0, 1e-4), (200.0, 1e-4 / 16.0), (1e5, 1e-15)];
        assert_eq!(order(&points), None);
        assert_eq!(order(&[(100.0, 1e-5), (101.0, 9e-6), (102.0, 8e-6)]), None);
    }
}
