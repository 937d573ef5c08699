//! A sign change of a test along a smooth piece of the curve, found and held against rounding.

/// The point of a curve at which a test function vanishes.
pub(crate) struct LocatedPoint<P> {
    pub(crate) point: P,
    /// Distance from the point that was searched from.
    pub(crate) distance: f64,
    /// Bound on the error of the located point along the curve.
    pub(crate) bracket: f64,
}

/// Iterations of regula falsi (Illinois), of which about eight are used.
const ITERATIONS: usize = 60;
/// A sixteenth of f64's digits of the distance: beyond it rounding decides.
const RESOLUTION: f64 = 1e-15;
/// Distances at which the test is sampled about its zero, in units of the bracket searched: at
/// these its curvature is below rounding.
const SAMPLE_DISTANCE: f64 = 1e-6;

/// The zero of `test` on a curve between `base` and a distance along its tangent, at which
/// `corrected` has the curve's points.
pub(crate) fn zero_along<P: Clone>(
    base: &P,
    distance: f64,
    corrected: &dyn Fn(f64) -> Option<P>,
    test: &dyn Fn(&P) -> f64,
) -> Option<LocatedPoint<P>> {
    let end = corrected(distance)?;
    let (mut low, mut f_low) = (0.0, test(base));
    let (mut high, mut f_high) = (distance, test(&end));
    let mut best = if f_low.abs() < f_high.abs() { (0.0, base.clone()) } else { (distance, end) };
    if f_low * f_high > 0.0 {
        return None;
    }
    let mut sided = 0;
    for _ in 0..ITERATIONS {
        let at = (low * f_high - high * f_low) / (f_high - f_low);
        if !at.is_finite() || (high - low).abs() <= RESOLUTION * (1.0 + distance.abs()) {
            break;
        }
        let point = corrected(at)?;
        let f = test(&point);
        let ended = at == low || at == high || f == 0.0;
        best = (at, point);
        if ended {
            break;
        }
        if f * f_low > 0.0 {
            (low, f_low) = (at, f);
            f_high *= if sided == -1 { 0.5 } else { 1.0 };
            sided = -1;
        } else {
            (high, f_high) = (at, f);
            f_low *= if sided == 1 { 0.5 } else { 1.0 };
            sided = 1;
        }
    }
    let (at, point) = best;
    let (slope, scatter) = scatter(at, SAMPLE_DISTANCE * distance, corrected, test)?;
    let bracket = if slope == 0.0 { distance.abs() } else { 3.0 * scatter / slope.abs() };
    Some(LocatedPoint { point, distance: at, bracket })
}

/// Slope of the test about a distance, and how far it scatters about that line: what its rounding
/// and the corrector's leave of it, measured.
fn scatter<P>(
    at: f64,
    spread: f64,
    corrected: &dyn Fn(f64) -> Option<P>,
    test: &dyn Fn(&P) -> f64,
) -> Option<(f64, f64)> {
    let mut samples = [0.0; 5];
    for (k, sample) in samples.iter_mut().enumerate() {
        *sample = test(&corrected(at + spread * (k as f64 - 2.0))?);
    }
    let mean = samples.iter().sum::<f64>() / 5.0;
    let places = || samples.iter().zip([-2.0, -1.0, 0.0, 1.0, 2.0]);
    let slope = places().map(|(f, x)| f * x).sum::<f64>() / 10.0;
    let off = places().map(|(f, x)| (f - mean - slope * x).abs()).fold(mean.abs(), f64::max);
    Some((slope / spread, off))
}
