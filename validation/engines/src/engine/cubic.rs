//! Hermite's cubic between the ends of a step: an interpolant for methods that have none.

/// A time and the state at it.
pub(super) type CubicEnd = (f64, [f64; 4]);

/// The cubic through two states with their derivatives.
pub(super) struct Cubic {
    left: CubicEnd,
    right: CubicEnd,
    slopes: [[f64; 4]; 2],
}

impl Cubic {
    /// The cubic between two points, whose derivatives `rates` writes.
    pub(super) fn between(
        ends: [CubicEnd; 2],
        mut rates: impl FnMut(CubicEnd, &mut [f64; 4]),
    ) -> Self {
        let slopes = ends.map(|end| {
            let mut slope = [0.0; 4];
            rates(end, &mut slope);
            slope
        });
        let [left, right] = ends;
        Self { left, right, slopes }
    }

    /// Whether this is where it begins.
    pub(super) fn begins_at(&self, t: f64) -> bool {
        self.left.0 == t
    }

    pub(super) fn at(&self, t: f64) -> [f64; 4] {
        let width = self.right.0 - self.left.0;
        let s = (t - self.left.0) / width;
        [0, 1, 2, 3].map(|i| {
            let (begin, end) = (self.left.1[i], self.right.1[i]);
            let (first, last) = (self.slopes[0][i] * width, self.slopes[1][i] * width);
            let rise = end - begin;
            begin + s * (rise + (1.0 - s) * ((1.0 - s) * (first - rise) - s * (last - rise)))
        })
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
        let cubic = Cubic::between(ends, |(t, _), rates| *rates = [slope(t); 4]);
        for t in [1.0, 1.1, 1.3, 1.5] {
            assert!((cubic.at(t)[2] - f(t)).abs() < 1e-14);
        }
    }
}
