//! The paired bootstrap over cases that decides whether one engine is better than another.
//!
//! All engines are compared on the same draws, so a case that is hard for all moves no difference.

use fastrand::Rng;

/// The number of draws.
const DRAWS: usize = 2000;
/// The seed, so that a ranking is the same in every run.
const SEED: u64 = 2004;
/// One engine is better than another if at most one draw in this many says otherwise: 2.5 %.
const DRAWS_PER_CONTRARY: usize = 40;
/// Differences of means below this are rounding.
const MEAN_TOLERANCE: f64 = 1e-9;

/// Draws of as many cases as there are, with replacement.
pub(in crate::report) struct Bootstrap {
    /// The places of the cases that are drawn, for each draw.
    draws: Vec<Vec<u32>>,
}

impl Bootstrap {
    /// The draws from a number of cases.
    pub fn new(cases: usize) -> Self {
        let mut rng = Rng::with_seed(SEED);
        let last = u32::try_from(cases).unwrap_or(u32::MAX);
        let draw = |_| (0..last).map(|_| rng.u32(0..last)).collect();
        Self { draws: (0..DRAWS).map(draw).collect() }
    }

    /// The mean score of each draw.
    pub fn means(&self, scores: &[f64]) -> Vec<f64> {
        let mean = |draw: &Vec<u32>| {
            let drawn = draw.iter().filter_map(|place| scores.get(*place as usize));
            drawn.sum::<f64>() / draw.len().max(1) as f64
        };
        self.draws.iter().map(mean).collect()
    }
}

/// Whether the lower 2.5 % quantile of the differences of two engines' means is above zero.
pub(in crate::report) fn is_ahead(better: &[f64], worse: &[f64]) -> bool {
    let pairs = better.iter().zip(worse);
    let against = pairs.filter(|(better, worse)| **better - **worse <= MEAN_TOLERANCE).count();
    !better.is_empty() && against * DRAWS_PER_CONTRARY < better.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_better(a: &[f64], b: &[f64]) -> bool {
        let draws = Bootstrap::new(a.len());
        is_ahead(&draws.means(a), &draws.means(b))
    }

    #[test]
    fn equals_and_near_equals_are_not_told_apart() {
        let most: Vec<f64> = (0..100).map(|k| f64::from(k % 10 != 0)).collect();
        assert!(!is_better(&most, &most));
        // Right on two cases that the other fails: a draw leaves both out in one of seven.
        let mut more = most.clone();
        (more[0], more[10]) = (1.0, 1.0);
        assert!(!is_better(&more, &most) && !is_better(&most, &more));
    }

    #[test]
    fn one_that_is_better_on_many_cases_is_ahead() {
        let most: Vec<f64> = (0..100).map(|k| f64::from(k % 10 != 0)).collect();
        let half: Vec<f64> = (0..100).map(|k| f64::from(k % 2)).collect();
        assert!(is_better(&most, &half) && !is_better(&half, &most));
        // Better on every one of few cases, and by the same little on all.
        let little: Vec<f64> = most.iter().map(|it| it + 0.1).collect();
        assert!(is_better(&little, &most));
        assert!(!is_better(&[], &[]));
    }
}
