//! Bifurcation values by brute force: motions followed to rest on both sides.

use super::attractors::map;
use crate::engine::Failure;
use percuss::dynamics::strobe::StrobePoint;

/// The longest period that is looked for.
const MAX_PERIOD: usize = 64;

/// The period on which the motion from a point has settled after so many forcing periods: the least
/// number after which its strobes repeat to `near`; none up to 64.
pub(super) fn settled(
    omega: f64,
    point: StrobePoint,
    periods: u64,
    near: f64,
) -> Result<(Option<usize>, StrobePoint), Failure> {
    let map = map(omega)?;
    let entry = map.entry(point).map_err(Failure::new)?;
    let late = map.strobes(entry, periods).last().ok_or_else(|| Failure::new("no strobes"))?;
    let last: Vec<StrobePoint> =
        map.strobes(late, 2 * MAX_PERIOD as u64).map(|strobe| strobe.point()).collect();
    let apart = |a: &StrobePoint, b: &StrobePoint| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    let repeats = |k: &usize| last.iter().zip(&last[*k..]).all(|(a, b)| apart(a, b) < near);
    Ok(((1..=MAX_PERIOD).find(repeats), late.point()))
}

/// An interval no wider than `width` at whose ends `keeps` differs: it holds at the first.
pub(super) fn bracket(
    mut holds: f64,
    mut fails: f64,
    width: f64,
    mut keeps: impl FnMut(f64) -> Result<bool, Failure>,
) -> Result<(f64, f64), Failure> {
    if !keeps(holds)? || keeps(fails)? {
        return Err(Failure::new(format!("nothing changes between {holds} and {fails}")));
    }
    while (holds - fails).abs() > width {
        let middle = 0.5 * (holds + fails);
        if keeps(middle)? { holds = middle } else { fails = middle }
    }
    Ok((holds, fails))
}
