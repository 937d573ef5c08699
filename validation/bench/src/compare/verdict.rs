//! The verdict on a version's speed: a warning at 1 %, a failure at 2 % twice in a row.
//!
//! A quotient that interleaved rounds give repeats within half a percent on a busy machine, so 1 %
//! is seldom noise and 2 % hardly ever; but among a dozen workloads something rare happens now and
//! then. A whole second measurement, of processes started anew, has to say the same.

/// The quotient from which on a slowdown is said.
pub const WARNING_QUOTIENT: f64 = 1.01;
/// The quotient from which on a slowdown, seen twice in a row, fails.
pub const FAILURE_QUOTIENT: f64 = 1.02;

/// The verdict on one workload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorkloadVerdict {
    /// The new version is as fast as the old one, or faster.
    Pass,
    /// Slower by 1 % or more, or by 2 % once.
    Warn,
    /// Slower by 2 % or more, twice in a row.
    Fail,
}

impl WorkloadVerdict {
    /// The verdict on successive quotients of new to old.
    #[must_use]
    pub fn new(quotients: &[f64]) -> Self {
        if quotients.windows(2).any(|pair| pair.iter().all(|it| is_doubtful(*it))) {
            Self::Fail
        } else if quotients.iter().all(|it| *it < WARNING_QUOTIENT) {
            Self::Pass
        } else {
            Self::Warn
        }
    }

    /// The verdict's word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Warn => "warn",
            Self::Fail => "fail",
        }
    }
}

/// Whether a first quotient has to be measured again.
#[must_use]
pub fn is_doubtful(quotient: f64) -> bool {
    quotient >= FAILURE_QUOTIENT || quotient.is_nan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slower_by_two_percent_twice_in_a_row_fails() {
        assert_eq!(WorkloadVerdict::new(&[1.03, 1.03]), WorkloadVerdict::Fail);
        assert_eq!(WorkloadVerdict::new(&[1.02, 1.02]), WorkloadVerdict::Fail);
        assert_eq!(WorkloadVerdict::new(&[1.0, 1.05, 1.021]), WorkloadVerdict::Fail);
    }

    #[test]
    fn once_or_not_in_a_row_is_a_warning() {
        assert_eq!(WorkloadVerdict::new(&[1.03]), WorkloadVerdict::Warn);
        assert_eq!(WorkloadVerdict::new(&[1.03, 1.0]), WorkloadVerdict::Warn);
        assert_eq!(WorkloadVerdict::new(&[1.03, 1.0, 1.03]), WorkloadVerdict::Warn);
    }

    #[test]
    fn slower_by_one_and_a_half_percent_is_a_warning_however_often() {
        assert_eq!(WorkloadVerdict::new(&[1.015, 1.015, 1.015]), WorkloadVerdict::Warn);
        assert_eq!(WorkloadVerdict::new(&[1.01]), WorkloadVerdict::Warn);
    }

    #[test]
    fn faster_or_the_same_passes() {
        assert_eq!(WorkloadVerdict::new(&[1.009]), WorkloadVerdict::Pass);
        assert_eq!(WorkloadVerdict::new(&[0.5, 0.5]), WorkloadVerdict::Pass);
    }

    #[test]
    fn a_nan_passes_nothing() {
        assert_eq!(WorkloadVerdict::new(&[f64::NAN]), WorkloadVerdict::Warn);
        assert_eq!(WorkloadVerdict::new(&[f64::NAN, f64::NAN]), WorkloadVerdict::Fail);
        assert!(is_doubtful(f64::NAN) && is_doubtful(1.02) && !is_doubtful(1.0199));
    }
}
