//! Roots of parabolas and cubics, as guesses and proofs of a crossing need them.

/// Squares below this have lost digits to underflow.
pub const MIN_EXACT_SQUARE: f64 = 1e-290;

/// The smallest r > 0 with excess + slope r + bend r^2/2 = 0, for excess <= 0.
pub fn safe_step(excess: f64, slope: f64, bend: f64) -> f64 {
    if excess == f64::NEG_INFINITY {
        return f64::INFINITY;
    }
    let excess = excess.min(0.0);
    // The squares of forces of 1e-200 are no numbers.
    let root = slope.hypot((2.0 * bend).sqrt() * (-excess).sqrt());
    if slope > 0.0 { -2.0 * excess / (slope + root) } else { (root - slope) / bend }
}

/// The first t > 0 with value + rising t + curvature t^2/2 = 0, for value < 0.
pub fn first_root(value: f64, rising: f64, curvature: f64) -> Option<f64> {
    let discriminant = rising * rising - 2.0 * curvature * value;
    if discriminant.abs() < MIN_EXACT_SQUARE && curvature > 0.0 {
        return first_root_without_squares(value, rising, curvature);
    }
    if discriminant < 0.0 {
        return None; // curvature < 0 and the crest stays below zero
    }
    let root = discriminant.sqrt();
    // One of the root's two forms subtracts numbers that may be close; this takes the other.
    let time =
        if rising >= 0.0 { -2.0 * value / (rising + root) } else { (root - rising) / curvature };
    (time >= 0.0 && time.is_finite()).then_some(time)
}

/// The first root of a parabola that opens upwards, where the squares in its discriminant
/// underflow.
#[cold]
#[inline(never)]
fn first_root_without_squares(value: f64, rising: f64, curvature: f64) -> Option<f64> {
    let time = safe_step(value, rising, curvature);
    (value < 0.0 && time.is_finite()).then_some(time)
}

/// The last t >= 0 with value + rising t + curvature t^2/2 = 0, for value >= 0 and a parabola that
/// opens downwards or a falling line.
pub fn last_root(value: f64, rising: f64, curvature: f64) -> Option<f64> {
    let root = (rising * rising - 2.0 * curvature * value).sqrt();
    let time =
        if rising < 0.0 { 2.0 * value / (root - rising) } else { (rising + root) / -curvature };
    time.is_finite().then_some(time)
}

/// The place at which the cubic through two values with these slopes, all in units of the step, is
/// zero.
pub fn zero_between(left: f64, right: f64, (left_slope, right_slope): (f64, f64)) -> f64 {
    let rise = right - left;
    let second = 3.0 * rise - 2.0 * left_slope - right_slope;
    let third = left_slope + right_slope - 2.0 * rise;
    // Halley's method from the chord: one step where Newton's takes two, with a division less.
    let chord = -left / rise;
    let value = left + chord * (left_slope + chord * (second + chord * third));
    let slope = left_slope + chord * (2.0 * second + chord * (3.0 * third));
    let half_bend = second + chord * (3.0 * third);
    let t = chord - value * slope / (slope * slope - value * half_bend);
    if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 }
}

/// A cubic by its value and its three derivatives at zero.
#[derive(Clone, Copy, Debug)]
pub struct CubicPolynomial {
    /// Value.
    pub value: f64,
    /// First derivative.
    pub slope: f64,
    /// Second derivative.
    pub bend: f64,
    /// Third derivative.
    pub third: f64,
}

impl CubicPolynomial {
    /// The value at a step from zero.
    pub fn at(&self, step: f64) -> f64 {
        let Self { value, slope, bend, third } = *self;
        value + step * (slope + step * (0.5 * bend + step * (third * (1.0 / 6.0))))
    }

    /// The cubic's zero by reversion of the series, with one division, where that zero is so near
    /// that the guard is almost straight. What is left is the third power of 0.02, and is put right
    /// with the series' own remainder.
    pub fn near_zero(&self) -> Option<f64> {
        /// The largest change of the slope over half the step, beside the slope, at which the
        /// series is taken.
        const MAX_BEND: f64 = 0.02;
        let inverse = 1.0 / self.slope;
        let newton = -self.value * inverse;
        let (b, c) = (0.5 * self.bend * inverse, self.third * inverse * (1.0 / 6.0));
        let (first, second) = (b * newton, c * newton * newton);
        if !(first.abs() < MAX_BEND && second.abs() < MAX_BEND * MAX_BEND) {
            return None;
        }
        Some(newton * (1.0 - first + 2.0 * first * first - second))
    }

    /// The cubic's zero by Newton's method: three steps do on a transversal crossing; next to a
    /// graze it only halves at first.
    #[cold]
    pub fn zero(&self) -> f64 {
        const MAX_STEPS: usize = 40;
        let Self { value, slope, bend, third } = *self;
        let mut step = -value / slope;
        for _ in 0..MAX_STEPS {
            let change = self.at(step) / (slope + step * (bend + step * 0.5 * third));
            step -= change;
            if change.abs() <= 1e-6 * step.abs() || change.is_nan() {
                break;
            }
        }
        step
    }
}
