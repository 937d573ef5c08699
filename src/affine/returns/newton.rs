//! Newton's method for a periodic orbit of a return map, damped, and over the corners of the map.

use super::shooting::{ReturnMap, Shots};

/// Steps before it is given up: near a fold they halve the distance at worst, 52 times.
const STEPS: usize = 60;
/// The shortest share of a step that is tried.
const SHORTEST: f64 = 1.0 / 64.0;
/// Steps in a row that may lead away: beyond a corner of the map another derivative holds.
const WILD: usize = 6;
/// Steps without a better residual that end the polishing.
const IDLE: usize = 3;
/// Orbits further apart than this are never taken for one: at a flip the residual of the doubled
/// orbit is cubic in its width, and rounding hides (1e-15)^(1/3).
const NEAR: f64 = 1e-4;

/// The shots of a map.
pub type ShotsOf<M> = Shots<<M as ReturnMap>::Point, <M as ReturnMap>::Way>;

/// The orbit that is reached from these points, or the least residual that was.
pub fn solved<M: ReturnMap>(map: &M, start: ShotsOf<M>) -> Result<ShotsOf<M>, f64> {
    let mut best = start.clone();
    let mut shots = start;
    let mut wild = 0;
    for _ in 0..STEPS {
        if shots.residual < best.residual {
            best = shots.clone();
        }
        if best.is_closed() {
            return Ok(polished(map, best));
        }
        let next = damped(map, &shots).or_else(|| {
            wild += 1;
            shots.moved(map, 1.0).filter(|_| wild <= WILD)
        });
        let Some(next) = next else { break };
        shots = next;
    }
    Err(best.residual)
}

/// The longest share of the step that comes closer.
fn damped<M: ReturnMap>(map: &M, shots: &ShotsOf<M>) -> Option<ShotsOf<M>> {
    let halved = |share: &f64| Some(0.5 * share).filter(|it| *it >= SHORTEST);
    let mut shares = std::iter::successors(Some(1.0), halved);
    shares.find_map(|share| {
        let limit = (1.0 - 0.1 * share) * shots.residual;
        shots.moved(map, share).filter(|next| next.residual <= limit)
    })
}

/// Newton's steps as long as they gain anything.
pub fn polished<M: ReturnMap>(map: &M, start: ShotsOf<M>) -> ShotsOf<M> {
    let mut best = start.clone();
    let mut shots = start;
    let mut idle = 0;
    while idle < IDLE && best.residual > 0.0 {
        let Some(next) = shots.moved(map, 1.0) else { break };
        idle += 1;
        if next.residual < best.residual && next.is_closed() {
            best = next.clone();
            idle = 0;
        }
        shots = next;
    }
    best
}

/// The orbit with the least number of points that it needs.
pub fn least<M: ReturnMap>(map: &M, orbit: ShotsOf<M>) -> ShotsOf<M> {
    let period = orbit.points.len();
    let divisors = (1..=period / 2).filter(|it| period.is_multiple_of(*it));
    let mut shorter = divisors.filter_map(|it| shortened(map, &orbit, it));
    shorter.next().unwrap_or(orbit)
}

/// The orbit of so few points that cannot be told from this one.
fn shortened<M: ReturnMap>(map: &M, orbit: &ShotsOf<M>, count: usize) -> Option<ShotsOf<M>> {
    if orbit.distance(map, &orbit.points[..count]) > NEAR {
        return None;
    }
    let first = Shots::of(map, orbit.points[..count].to_vec())?;
    let shorter = solved(map, first).ok()?;
    if orbit.distance(map, &shorter.points) > NEAR {
        return None;
    }
    // Two that differ have something between them that does not close.
    let pairs = orbit.points.iter().zip(shorter.points.iter().cycle());
    let between = pairs.map(|(one, other)| {
        let half = map.apart(one, other).map(|it| 0.5 * it);
        map.moved(one, &half, one)
    });
    Shots::of(map, between.collect())?.is_closed().then_some(shorter)
}
