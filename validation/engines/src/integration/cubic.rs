//! Hermite's cubic between the ends of a step: an interpolant for methods that have none.

use crate::equations::Numbers;

/// A time and the state at that time.
pub(crate) type CubicEnd<S> = (f64, S);

/// The cubic through two states with their derivatives.
pub(crate) struct Cubic<S> {
    left: CubicEnd<S>,
    right: CubicEnd<S>,
    slopes: [S; 2],
}

impl<S: Numbers> Cubic<S> {
    /// The cubic between two points, whose derivatives `rates` writes.
    pub(crate) fn between(
        ends: [CubicEnd<S>; 2],
        mut rates: impl FnMut(CubicEnd<S>, &mut [f64]),
    ) -> Self {
        let slopes = ends.map(|end| {
            let mut slope = end.1;
            rates(end, slope.as_mut());
            slope
        });
        let [left, right] = ends;
        Self { left, right, slopes }
    }

    /// Whether the cubic begins at time `t`.
    pub(crate) fn begins_at(&self, t: f64) -> bool {
        self.left.0 == t
    }

    pub(crate) fn at(&self, t: f64) -> S {
        let width = self.right.0 - self.left.0;
        let s = (t - self.left.0) / width;
        let [first, last] = self.slopes.each_ref().map(S::as_ref);
        let (begins, ends) = (self.left.1.as_ref(), self.right.1.as_ref());
        let mut state = self.left.1;
        for (i, value) in state.as_mut().iter_mut().enumerate() {
            let (begin, end) = (begins[i], ends[i]);
            let (first, last) = (first[i] * width, last[i] * width);
            let rise = end - begin;
            *value =
                begin + s * (rise + (1.0 - s) * ((1.0 - s) * (first - rise) - s * (last - rise)));
        }
        state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_reproduced() {
        let f = |t: f64| t * t * t - 2.0 * t + 1.0;
        let slope = |t: f64| 3.0 * t * t - 2.0;
        let ends = [(1.0, [f(1.0); 4]), (1.5, [f(1.5); 4])];
        let cubic = Cubic::between(ends, |(t, _), rates| rates.fill(slope(t)));
        for t in [1.0, 1.1, 1.3, 1.5] {
            assert!((cubic.at(t)[2] - f(t)).abs() < 1e-14);
        }
    }
}
