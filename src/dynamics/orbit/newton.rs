//! Newton's method on a sequence of strobes, damped, and over the corners of the map.

use super::shooting::ShootingIterate;
use super::{NoOrbit, Reason};
use crate::dynamics::strobe::StrobeMap;

/// Steps before it is given up: near a fold they halve the distance at worst, 52 times.
const STEPS: usize = 60;
/// The shortest share of a step that is tried.
const SHORTEST: f64 = 1.0 / 64.0;
/// Steps in a row that may lead away: beyond a corner of the map another derivative holds, and the
/// way down may begin by a way up.
const WILD: usize = 6;
/// Steps without a better residual that end the polishing.
const IDLE: usize = 3;

/// The closed iterate that is reached from this one.
pub(crate) fn solved(map: &StrobeMap, start: ShootingIterate) -> Result<ShootingIterate, NoOrbit> {
    let mut best = start.clone();
    let mut iterate = start;
    let mut wild = 0;
    for _ in 0..STEPS {
        if iterate.residual < best.residual {
            best = iterate.clone();
        }
        if best.is_closed() {
            return Ok(polished(map, best));
        }
        let step = iterate.newton_step();
        if let Some(next) = damped(map, &iterate, &step) {
            iterate = next;
            continue;
        }
        wild += 1;
        let blind = iterate.moved(map, &step, 1.0).filter(|_| wild <= WILD);
        let Some(next) = blind else {
            return Err(NoOrbit { residual: best.residual, reason: Reason::Stalled });
        };
        iterate = next;
    }
    Err(NoOrbit { residual: best.residual, reason: Reason::Slow })
}

/// The longest share of the step that comes closer.
fn damped(
    map: &StrobeMap,
    iterate: &ShootingIterate,
    step: &[[f64; 3]],
) -> Option<ShootingIterate> {
    let mut share = 1.0;
    while share >= SHORTEST {
        let next = iterate.moved(map, step, share);
        let closer =
            |next: &ShootingIterate| next.residual <= (1.0 - 0.1 * share) * iterate.residual;
        if let Some(next) = next.filter(closer) {
            return Some(next);
        }
        share *= 0.5;
    }
    None
}

/// Newton's steps as long as they gain anything.
pub(crate) fn polished(map: &StrobeMap, start: ShootingIterate) -> ShootingIterate {
    let mut best = start.clone();
    let mut iterate = start;
    let mut idle = 0;
    while idle < IDLE && best.residual > 0.0 {
        let Some(next) = iterate.moved(map, &iterate.newton_step(), 1.0) else { break };
        idle += 1;
        if next.residual < best.residual {
            best = next.clone();
            idle = 0;
        }
        iterate = next;
    }
    best
}
