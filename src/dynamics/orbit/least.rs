//! The least period: after how many forcing periods an orbit closes for the first time.

use super::newton;
use super::shooting::ShootingIterate;
use crate::dynamics::strobe::{StrobeMap, StrobePoint};

/// Orbits further apart than this are never taken for one: at a flip the residual of the doubled
/// orbit is cubic in its width, and rounding hides (1e-15)^(1/3).
const NEAR: f64 = 1e-4;

/// The orbit with the least number of strobes that it needs.
pub(super) fn closed(map: &StrobeMap, iterate: ShootingIterate) -> ShootingIterate {
    let period = iterate.points.len();
    let divisors = (1..=period / 2).filter(|divisor| period.is_multiple_of(*divisor));
    let mut shorter = divisors.filter_map(|divisor| halved(map, &iterate, divisor));
    shorter.next().unwrap_or(iterate)
}

/// The orbit of `divisor` strobes that cannot be told from this one.
fn halved(map: &StrobeMap, iterate: &ShootingIterate, divisor: usize) -> Option<ShootingIterate> {
    let first = ShootingIterate::of(map, &iterate.points[..divisor])?;
    if iterate.distance(&first) > NEAR {
        return None;
    }
    let orbit = newton::solved(map, first).ok()?;
    if iterate.distance(&orbit) > NEAR {
        return None;
    }
    // Two that differ have something between them that does not close.
    let pairs = iterate.points.iter().zip(orbit.points.iter().cycle());
    let between: Vec<StrobePoint> =
        pairs.map(|(a, b)| std::array::from_fn(|i| 0.5 * (a[i] + b[i]))).collect();
    ShootingIterate::of(map, &between)?.is_closed().then_some(orbit)
}
