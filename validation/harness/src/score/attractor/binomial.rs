//! The exact interval of a share (Clopper and Pearson 1934).

/// The shares that so many hits in so many runs leave possible at 95 %: outside, as many hits or
/// more, or as few or fewer, have a probability below 2.5 %.
#[must_use]
pub fn interval(hits: u32, runs: u32) -> [f64; 2] {
    /// The probability outside each end of the interval, whose level is 95 %.
    const TAIL_PROBABILITY: f64 = 0.025;
    let low = if hits == 0 {
        0.0
    } else {
        crossing(|share| 1.0 - at_most(hits - 1, runs, share) > TAIL_PROBABILITY)
    };
    let high = if hits >= runs {
        1.0
    } else {
        crossing(|share| at_most(hits, runs, share) < TAIL_PROBABILITY)
    };
    [low, high]
}

/// The share from which on a condition holds.
fn crossing(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while low < 0.5 * (low + high) && 0.5 * (low + high) < high {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// The probability of at most so many hits, by the logarithms of its terms, which underflow alone.
fn at_most(hits: u32, runs: u32, share: f64) -> f64 {
    let odds = (share / (1.0 - share)).ln();
    let mut term = f64::from(runs) * (-share).ln_1p();
    let mut sum = term.exp();
    for k in 0..hits {
        term += (f64::from(runs - k) / f64::from(k + 1)).ln() + odds;
        sum += term.exp();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Closed forms: none of n leaves 1 - 0.025^(1/n) possible, all of n the complement.
    #[test]
    fn none_and_all() {
        for runs in [1, 10, 20_000] {
            let edge = 1.0 - 0.025_f64.powf(1.0 / f64::from(runs));
            let [low, high] = interval(0, runs);
            assert_eq!(low, 0.0);
            assert_relative_eq!(high, edge, max_relative = 1e-9);
            let [low, high] = interval(runs, runs);
            assert_relative_eq!(low, 1.0 - edge, max_relative = 1e-9);
            assert_eq!(high, 1.0);
        }
    }

    /// Values of R 4.3, `binom.test(5, 100)` and `binom.test(1, 20)`.
    #[test]
    fn published_intervals() {
        let [low, high] = interval(5, 100);
        assert_relative_eq!(low, 0.016_431_88, max_relative = 1e-6);
        assert_relative_eq!(high, 0.112_834_9, max_relative = 1e-6);
        let [low, high] = interval(1, 20);
        assert_relative_eq!(low, 0.001_265_089, max_relative = 1e-6);
        assert_relative_eq!(high, 0.248_732_8, max_relative = 1e-6);
    }
}
