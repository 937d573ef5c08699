//! The instants at which a guard touches zero that never crosses, as exact arithmetic has found.
//!
//! Exact arithmetic decides that the guard turns at zero; the instant itself is computed in f64,
//! and compared with room for that.

use std::f64::consts::TAU;

/// The instants after an origin at which a guard touches zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touch {
    /// The top of a parabola.
    Once(f64),
    /// The tops of an oscillation: the first of them, and the time from one to the next.
    Again { first: f64, period: f64 },
}

/// Room for the rounding of times in f64, which add up to less.
const TIME_TOLERANCE: f64 = 1e-9;

impl Touch {
    /// The tops of an oscillation of a frequency that is at its top at an angle, where zero is not
    /// counted: a guard that is zero at the origin itself has its next touch a period later.
    pub fn of_angle(angle: f64, frequency: f64, is_at_origin: bool) -> Self {
        let period = TAU / frequency;
        let first = if is_at_origin { period } else { angle.rem_euclid(TAU) / frequency };
        Self::Again { first, period }
    }

    /// Whether a touch may lie between two times after the origin, these included.
    pub fn may_lie_in(self, [from, to]: [f64; 2]) -> bool {
        let room = TIME_TOLERANCE * to.abs();
        let [from, to] = [from - room, to + room];
        let next = match self {
            Self::Once(time) => time,
            Self::Again { first, period } => {
                first + period * ((from - first) / period).ceil().max(0.0)
            }
        };
        // What is not a number excludes nothing.
        !(next < from || next > to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_touch_lies_where_its_turns_do() {
        let top = Touch::Once(2.0);
        assert!(top.may_lie_in([0.0, 2.0]) && top.may_lie_in([2.0, 3.0]));
        assert!(!top.may_lie_in([0.0, 1.999]) && !top.may_lie_in([2.001, 3.0]));
        let tops = Touch::Again { first: 0.5, period: 2.0 };
        assert!(tops.may_lie_in([0.0, 1.0]) && tops.may_lie_in([2.0, 3.0]));
        assert!(!tops.may_lie_in([0.6, 2.4]) && !tops.may_lie_in([0.0, 0.4]));
        assert!(Touch::Once(f64::NAN).may_lie_in([0.0, 1.0]));
        assert_eq!(Touch::of_angle(0.0, 2.0, true), Touch::of_angle(TAU, 2.0, true));
        assert!(!Touch::of_angle(0.0, 1.0, true).may_lie_in([0.0, 6.2]));
        assert!(Touch::of_angle(0.0, 1.0, true).may_lie_in([0.0, 6.3]));
    }
}
