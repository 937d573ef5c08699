//! A guard between two looks, as the cubic that has its values and rates there.
//!
//! Where both looks show nothing, the cubic says whether the guard could have crossed zero between
//! them. In the middle it errs by theta^2/48 of its own departure from the chord, where the guard
//! is a harmonic of which the looks are an angle theta apart. Half of the departure is allowed for
//! between two looks inside, in the shape s^2 (1 - s)^2 of the error of Hermite's cubic: that is
//! enough up to theta = 4.9, three quarters of a turn between two looks. Where the guard is not
//! inside at both, a quarter is: enough for half a turn, and it lets a guard go that leaves a
//! double zero.

/// A guard at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct GuardPoint {
    pub(super) t: f64,
    pub(super) value: f64,
    pub(super) rate: f64,
}

/// The factor that turns a share of the departure from the chord into an allowance: s^2 (1 - s)^2
/// is a sixteenth in the middle, and the departure there at most an eighth of both ends' together.
const ALLOWANCE_SCALE: f64 = 16.0 / 8.0;
/// The allowance between two evaluations inside.
const WIDE_ALLOWANCE: f64 = 0.5 * ALLOWANCE_SCALE;
/// The allowance elsewhere.
const ALLOWANCE: f64 = 0.25 * ALLOWANCE_SCALE;
/// The largest rise above both ends, over the departure: s (1 - s)^2 of the cubic, and the
/// allowance above it.
const MAX_RISE: f64 = 4.0 / 27.0 + WIDE_ALLOWANCE / 16.0;
/// Intervals whose ends are tried.
const TRIAL_INTERVALS: u32 = 8;
/// A division is no closer to an end than this share of the interval.
const MIN_DIVISION_SHARE: f64 = 1.0 / 64.0;
/// The most steps of Newton's method in the search for the cubic's own root.
const MAX_NEWTON_STEPS: u32 = 40;

/// The cubic; s runs from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct GuardCubic {
    left: GuardPoint,
    right: GuardPoint,
    /// How much the rates at both ends differ from the chord's.
    first: f64,
    last: f64,
}

impl GuardCubic {
    pub(super) fn between(left: GuardPoint, right: GuardPoint) -> Self {
        let (width, rise) = (right.t - left.t, right.value - left.value);
        Self { left, right, first: width * left.rate - rise, last: width * right.rate - rise }
    }

    fn departure(&self) -> f64 {
        self.first.abs() + self.last.abs()
    }

    fn at(&self, s: f64) -> f64 {
        let rest = 1.0 - s;
        let rise = self.right.value - self.left.value;
        self.left.value + s * (rise + rest * (rest * self.first - s * self.last))
    }

    /// What the guard may differ from the cubic.
    fn allowance(&self, s: f64, share: f64) -> f64 {
        share * self.departure() * (s * (1.0 - s)).powi(2)
    }

    fn could_be_outside(&self, s: f64) -> bool {
        self.at(s) + self.allowance(s, ALLOWANCE) >= 0.0
    }

    fn could_be_inside(&self, s: f64) -> bool {
        self.at(s) - self.allowance(s, ALLOWANCE) < 0.0
    }

    /// Whether the guard is surely negative all along.
    pub(super) fn stays_inside(&self) -> bool {
        self.left.value < 0.0 && self.right.value < 0.0 && !self.could_reach()
    }

    /// Whether a guard could rise to zero between two looks at which it is negative.
    pub(super) fn could_reach(&self) -> bool {
        let highest = self.left.value.max(self.right.value);
        if highest + MAX_RISE * self.departure() < 0.0 {
            return false;
        }
        let reaches = |s: f64| self.at(s) + self.allowance(s, WIDE_ALLOWANCE) >= 0.0;
        self.turn(1.0).is_some_and(reaches) || parts().any(reaches)
    }

    /// Whether the rates at both looks show one peak between them.
    pub(super) fn peaks(&self) -> bool {
        self.left.rate > 0.0 && self.right.rate <= 0.0
    }

    /// Whether the guard may change its sign between the looks otherwise than they show by their
    /// values, or by the rates of one peak or valley. A guard that ends its mode, and was on the
    /// surface at the first look, must not come back to it.
    pub(super) fn hides(&self, ends: bool) -> bool {
        match (self.left.value < 0.0, self.right.value < 0.0) {
            (true, true) => !self.peaks() && self.could_reach(),
            (true, false) => returns(|s| self.could_be_outside(s), |s| self.could_be_inside(s)),
            (false, true) if ends => parts().any(|s| self.could_be_outside(s)),
            (false, true) => returns(|s| self.could_be_inside(s), |s| self.could_be_outside(s)),
            (false, false) if ends => self.right.rate <= 0.0,
            (false, false) => {
                let mirrored = self.mirrored();
                !mirrored.peaks() && mirrored.could_reach()
            }
        }
    }

    /// The same cubic of the guard's negative.
    pub(super) fn mirrored(&self) -> Self {
        let Self { left, right, first, last } = *self;
        let [left, right] =
            [left, right].map(|it| GuardPoint { t: it.t, value: -it.value, rate: -it.rate });
        Self { left, right, first: -first, last: -last }
    }

    /// Where to look inside: at the cubic's highest point between two looks inside, at its lowest
    /// between two outside, else in the middle.
    pub(super) fn division(&self) -> f64 {
        let turn = match (self.left.value < 0.0, self.right.value < 0.0) {
            (true, true) => self.turn(1.0),
            (false, false) => self.turn(-1.0),
            _ => None,
        };
        let s = turn.unwrap_or(0.5).clamp(MIN_DIVISION_SHARE, 1.0 - MIN_DIVISION_SHARE);
        self.left.t + s * (self.right.t - self.left.t)
    }

    /// The cubic's coefficients in s.
    fn coefficients(&self) -> [f64; 4] {
        let Self { left, right, first, last } = self;
        [left.value, first + right.value - left.value, -(2.0 * first + last), first + last]
    }

    /// The cubic's own peak, or its valley where `sign` is -1, if it lies inside.
    fn turn(&self, sign: f64) -> Option<f64> {
        let [_, slope, bend, twist] = self.coefficients().map(|it| sign * it);
        let root = (bend * bend - 3.0 * twist * slope).sqrt();
        let s = if bend < 0.0 { slope / (root - bend) } else { (-bend - root) / (3.0 * twist) };
        (s > 0.0 && s < 1.0).then_some(s)
    }

    /// The root of the cubic, negative at the left and not at the right, from the end that is
    /// nearer to zero.
    pub(super) fn root(&self) -> f64 {
        let Self { left, right, .. } = *self;
        let width = right.t - left.t;
        if self.is_nearer_at_the_left() {
            left.t + width * root_from(self.coefficients())
        } else {
            right.t - width * root_from(self.reversed().coefficients())
        }
    }

    /// Whether the guard is nearer to zero at the left.
    pub(super) fn is_nearer_at_the_left(&self) -> bool {
        self.left.value.abs() <= self.right.value.abs()
    }

    /// The same cubic from the right to the left.
    fn reversed(&self) -> Self {
        let Self { left, right, first, last } = *self;
        Self { left: right, right: left, first: -last, last: -first }
    }
}

/// The ends of the parts, without those of the interval.
fn parts() -> impl Iterator<Item = f64> {
    (1..TRIAL_INTERVALS).map(|k| f64::from(k) / f64::from(TRIAL_INTERVALS))
}

/// Whether the one may hold and later the other.
fn returns(one: impl Fn(f64) -> bool, other: impl Fn(f64) -> bool) -> bool {
    let mut held = false;
    parts().any(|s| {
        let back = held && other(s);
        held |= one(s);
        back
    })
}

/// The root in (0, 1) of a cubic that changes its sign there, by Newton's iterations that stay
/// between the two signs.
fn root_from([value, slope, bend, twist]: [f64; 4]) -> f64 {
    let negative_first = value < 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    let mut s = -value / slope;
    for _ in 0..MAX_NEWTON_STEPS {
        if !(s > low && s < high) {
            s = 0.5 * (low + high);
        }
        let here = value + s * (slope + s * (bend + s * twist));
        if (here < 0.0) == negative_first {
            low = s
        } else {
            high = s
        }
        let move_by = here / (slope + s * (2.0 * bend + 3.0 * s * twist));
        if move_by.abs() <= f64::EPSILON * s || high - low <= f64::EPSILON * high {
            break;
        }
        s -= move_by;
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic_of(
        ends: [f64; 2],
        value: impl Fn(f64) -> f64,
        rate: impl Fn(f64) -> f64,
    ) -> GuardCubic {
        let [left, right] = ends.map(|t| GuardPoint { t, value: value(t), rate: rate(t) });
        GuardCubic::between(left, right)
    }

    #[test]
    fn a_cubics_root_and_peak_are_its_own() {
        let value = |t: f64| (t - 0.3) * (t * t + 1.0);
        let rate = |t: f64| 3.0 * t * t - 0.6 * t + 1.0;
        for ends in [[0.0, 1.0], [-2.0, 0.4], [0.25, 5.0]] {
            let root = cubic_of(ends, value, rate).root();
            assert!((root - 0.3).abs() < 4.0 * f64::EPSILON, "{ends:?}: {root}");
        }
        let arch = cubic_of([0.0, 2.0], |t| t * (1.0 - t * t) - 9.0, |t| 1.0 - 3.0 * t * t);
        let peak = arch.division();
        assert!((peak - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15, "{peak}");
    }

    /// A harmonic that rises above zero between two looks, of which it is seen at neither, is
    /// looked for up to three quarters of a turn; one that stays well below is not.
    #[test]
    fn what_a_harmonic_hides_is_suspected_up_to_three_quarters_of_a_turn() {
        for theta in [0.1, 0.5, 1.0, 2.0, 3.0, 4.0, 4.7] {
            for k in 0..64 {
                let begin = -std::f64::consts::PI * f64::from(k) / 32.0;
                let ends = [begin, begin + theta];
                let highest = (0..=1000)
                    .map(|i| (begin + theta * f64::from(i) / 1000.0).cos())
                    .fold(f64::NEG_INFINITY, f64::max);
                let [first, last] = ends.map(f64::cos);
                let hidden = highest - first.max(last);
                let of = |level: f64| cubic_of(ends, |t| t.cos() - level, |t| -t.sin());
                if hidden > 1e-9 {
                    assert!(of(highest - 0.5 * hidden).could_reach(), "{theta} {k}");
                }
                let depth = 2.0 * theta * theta;
                assert!(of(highest + depth).stays_inside(), "{theta} {k}");
            }
        }
    }

    /// Both rates are positive, and yet there are a peak and a valley between the looks.
    #[test]
    fn two_turns_between_looks_are_suspected() {
        let value = |level: f64| move |t: f64| (3.0 * t).sin() + 0.1 * t - level;
        let rate = |t: f64| 3.0 * (3.0 * t).cos() + 0.1;
        let [begin, end] = [0.2, 1.8];
        assert!(rate(begin) > 0.0 && rate(end) > 0.0);
        let of = |level| cubic_of([begin, end], value(level), rate);
        assert!(of(1.0).hides(true) && !of(2.0).hides(true));
    }

    #[test]
    fn a_double_zero_that_is_left_hides_nothing() {
        for theta in [0.1, 1.0, 2.0, 3.0] {
            let of = cubic_of([0.0, theta], |t| t.cos() - 1.0, |t| -t.sin());
            assert!(!of.hides(true) && !of.hides(false), "{theta}");
        }
    }
}
