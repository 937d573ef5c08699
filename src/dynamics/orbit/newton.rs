//! Newton's method for the points of an orbit of any return map, damped, and over the corners of
//! the map.

/// Steps before it is given up: near a fold they halve the distance at worst, 52 times.
const MAX_STEPS: usize = 60;
/// The shortest share of a step that is tried.
const MIN_STEP_SHARE: f64 = 1.0 / 64.0;
/// The largest number of Newton steps in one solve that may fail to reduce the residual. Beyond a
/// corner the map has another derivative, so that the residual may have to rise before it falls.
const MAX_RISING_STEPS: usize = 6;
/// Steps without a better residual that end the polishing.
const MAX_IDLE_STEPS: usize = 3;
/// Orbits further apart than this are never taken for one: at a flip the residual of the doubled
/// orbit is cubic in its width, and rounding hides (1e-15)^(1/3).
const MAX_ORBIT_DISTANCE: f64 = 1e-4;
/// The units of the last digits to which points between two ends of Newton's method close that are
/// one orbit: no step has brought them closer.
const UNITS_HALF_WAY: f64 = 16.0;

/// Points that are to be an orbit of a map, each with its image.
pub(crate) trait Shooting<M>: Clone {
    /// The number of points.
    fn period(&self) -> usize;

    /// The largest distance of an image to the next point, over 1 + |point|.
    fn residual(&self) -> f64;

    /// Whether the points close to the last digits, or to so many of their units.
    fn closes_to(&self, units: f64) -> bool;

    /// Whether the points close to the last digits.
    fn is_closed(&self) -> bool {
        self.closes_to(1.0)
    }

    /// The points with a share of Newton's step made; none where one is out of range.
    fn stepped(&self, map: &M, share: f64) -> Option<Self>;

    /// The first `count` points alone, which are to be an orbit of their own.
    fn first(&self, map: &M, count: usize) -> Option<Self>;

    /// The largest distance to the points of another orbit, which may close sooner.
    fn orbit_distance(&self, map: &M, other: &Self) -> f64;

    /// The points half way to those of another orbit, which may close sooner.
    fn half_way(&self, map: &M, other: &Self) -> Option<Self>;
}

/// The closed points that are reached from these, or the least residual that was, and whether it
/// still fell.
pub(crate) fn solve<M, S: Shooting<M>>(map: &M, start: S) -> Result<S, Unsolved> {
    let mut best = start.clone();
    let mut shots = start;
    let mut wild = 0;
    for _ in 0..MAX_STEPS {
        if shots.residual() < best.residual() {
            best = shots.clone();
        }
        if best.is_closed() {
            return Ok(polish(map, best));
        }
        let next = damped(map, &shots).or_else(|| {
            wild += 1;
            shots.stepped(map, 1.0).filter(|_| wild <= MAX_RISING_STEPS)
        });
        let Some(next) = next else {
            return Err(Unsolved { residual: best.residual(), still_falls: false });
        };
        shots = next;
    }
    Err(Unsolved { residual: best.residual(), still_falls: true })
}

/// The end of Newton's method without an orbit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unsolved {
    /// The least residual.
    pub residual: f64,
    /// Whether the residual still fell.
    pub still_falls: bool,
}

/// The longest share of the step that comes closer.
fn damped<M, S: Shooting<M>>(map: &M, shots: &S) -> Option<S> {
    let halved = |share: &f64| Some(0.5 * share).filter(|it| *it >= MIN_STEP_SHARE);
    let mut shares = std::iter::successors(Some(1.0), halved);
    shares.find_map(|share| {
        let limit = (1.0 - 0.1 * share) * shots.residual();
        shots.stepped(map, share).filter(|next| next.residual() <= limit)
    })
}

/// Newton's steps as long as they gain anything.
pub(crate) fn polish<M, S: Shooting<M>>(map: &M, start: S) -> S {
    let mut best = start.clone();
    let mut shots = start;
    let mut idle = 0;
    while idle < MAX_IDLE_STEPS && best.residual() > 0.0 {
        let Some(next) = shots.stepped(map, 1.0) else { break };
        idle += 1;
        let is_better = next.residual() < best.residual();
        if is_better && (next.is_closed() || !best.is_closed()) {
            best = next.clone();
            idle = 0;
        }
        shots = next;
    }
    best
}

/// The orbit with the least number of points that it needs.
pub(crate) fn minimal_orbit<M, S: Shooting<M>>(map: &M, orbit: S) -> S {
    let period = orbit.period();
    let divisors = (1..=period / 2).filter(|it| period.is_multiple_of(*it));
    let mut shorter = divisors.filter_map(|it| shortened(map, &orbit, it));
    shorter.next().unwrap_or(orbit)
}

/// The orbit of `count` points that cannot be told from this one.
fn shortened<M, S: Shooting<M>>(map: &M, orbit: &S, count: usize) -> Option<S> {
    let first = orbit.first(map, count)?;
    if orbit.orbit_distance(map, &first) > MAX_ORBIT_DISTANCE {
        return None;
    }
    let shorter = solve(map, first).ok()?;
    if orbit.orbit_distance(map, &shorter) > MAX_ORBIT_DISTANCE {
        return None;
    }
    // Two that differ have something between them that does not close.
    orbit.half_way(map, &shorter)?.closes_to(UNITS_HALF_WAY).then_some(shorter)
}
