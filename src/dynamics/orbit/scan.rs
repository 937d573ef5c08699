//! Orbits found without a guess: Newton's method from many starts.

use super::{Orbit, ShootingIterate};
use crate::dynamics::strobe::{StrobeMap, StrobePoint};
use std::cmp::Ordering;

/// Starts along each side of the window, at most and at least.
const SIDE_STARTS: [u32; 2] = [12, 3];
/// Starts times period: beyond it there are fewer starts.
const MAX_START_PERIODS: u32 = 10_000;
/// Forcing periods after which a motion counts as settled.
pub(crate) const SETTLING_PERIODS: u64 = 300;
/// Forcing periods of settled motion that are searched for the closest return.
pub(crate) const WATCHED_PERIODS: u64 = 60;
/// Two orbits whose strobes are this close are one: they were found to their last digits.
pub(crate) const ORBIT_TOLERANCE: f64 = 1e-9;

/// The orbits of `period` forcing periods, or of a divisor of it, that Newton's method reaches from
/// a grid of starts, from where the motions from there settle, and from their closest returns.
/// Orbits of the whole period come first; among these, stable ones; then the least leading
/// multiplier, then the least p. `progress` is told how much is done, 0 to 1.
///
/// What it finds is there; what it does not find may be there too.
#[must_use]
pub fn scan(map: &StrobeMap, period: u32, progress: &mut dyn FnMut(f64)) -> Vec<Orbit> {
    let mut found: Vec<Orbit> = Vec::new();
    let starts = starts(map, side(period));
    for (done, start) in starts.iter().enumerate() {
        progress(done as f64 / starts.len() as f64);
        for guess in guesses(map, *start, period) {
            let Ok(orbit) = Orbit::find(map, guess, period) else { continue };
            if !found.iter().any(|it| is_same(it, &orbit)) {
                found.push(orbit);
            }
        }
    }
    let mut found: Vec<_> = found.into_iter().map(|it| from_least(map, it)).collect();
    found.sort_by(|a, b| rank(a).preference(&rank(b), period));
    found
}

/// What the order of preference of orbits goes by.
pub(crate) struct Rank {
    pub period: usize,
    pub is_stable: bool,
    /// The modulus of the leading multiplier.
    pub leading: f64,
    /// The first co-ordinate of the first point.
    pub first: f64,
}

impl Rank {
    /// The order of preference in a search for orbits of this period: first the orbits of exactly
    /// this period, then those of its divisors, the longest first.
    pub(crate) fn preference(&self, other: &Self, period: u32) -> Ordering {
        let is_shorter = |it: &Self| it.period != period as usize;
        is_shorter(self)
            .cmp(&is_shorter(other))
            .then(other.period.cmp(&self.period))
            .then(other.is_stable.cmp(&self.is_stable))
            .then(self.leading.total_cmp(&other.leading))
            .then(self.first.total_cmp(&other.first))
    }
}

fn rank(orbit: &Orbit) -> Rank {
    Rank {
        period: orbit.points.len(),
        is_stable: orbit.is_stable(),
        leading: super::super::linear::modulus(orbit.multipliers[0]),
        first: orbit.points[0][0],
    }
}

fn side(period: u32) -> u32 {
    let [most, least] = SIDE_STARTS;
    (MAX_START_PERIODS / period.max(1)).isqrt().clamp(least, most)
}

/// Cell centres of a window that holds the settled motion from rest with as much again around it,
/// at least one on each side of rest.
fn starts(map: &StrobeMap, side: u32) -> Vec<StrobePoint> {
    let mut window = [[-1.0_f64, 1.0_f64]; 2];
    if let Ok(rest) = map.entry([0.0; 3]) {
        for strobe in map.strobes(rest, SETTLING_PERIODS).skip(SETTLING_PERIODS as usize / 2) {
            for (range, x) in window.iter_mut().zip(strobe.point()) {
                *range = [range[0].min(2.0 * x), range[1].max(2.0 * x)];
            }
        }
    }
    let cell = |[low, high]: [f64; 2], k: u32| {
        // Written so that nothing overflows.
        let share = (f64::from(k) + 0.5) / f64::from(side);
        low * (1.0 - share) + high * share
    };
    let [p, y] = window;
    let cells = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
    cells.map(|(row, column)| [cell(p, column), cell(y, row), 0.0]).collect()
}

/// The start, its settled motion, and where that comes closest to itself.
fn guesses(map: &StrobeMap, start: StrobePoint, period: u32) -> Vec<StrobePoint> {
    let Ok(entry) = map.entry(start) else { return Vec::new() };
    let watched = WATCHED_PERIODS + u64::from(period);
    let settled = map.strobes(entry, SETTLING_PERIODS + watched).skip(SETTLING_PERIODS as usize);
    let strobes: Vec<_> = settled.map(|strobe| strobe.point()).collect();
    let returns = strobes.iter().zip(strobes.iter().skip(period as usize));
    let closest = returns.min_by(|(a, b), (c, d)| distance(a, b).total_cmp(&distance(c, d)));
    let settled = strobes.first().copied();
    [Some(start), settled, closest.map(|(from, _)| *from)].into_iter().flatten().collect()
}

fn distance(a: &StrobePoint, b: &StrobePoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Whether two orbits are one, wherever they begin.
pub(crate) fn are_one<P>(one: &[P], other: &[P], is_near: impl Fn(&P, &P) -> bool) -> bool {
    let count = other.len();
    let agree =
        |turn: usize| one.iter().zip(other.iter().cycle().skip(turn)).all(|(a, b)| is_near(a, b));
    one.len() == count && (0..count).any(agree)
}

fn is_same(a: &Orbit, b: &Orbit) -> bool {
    are_one(&a.points, &b.points, |a, b| {
        distance(a, b) <= ORBIT_TOLERANCE * (1.0 + distance(a, &[0.0; 3]))
    })
}

/// The orbit from its strobe of least p on: what is found does not depend on which start found it.
fn from_least(map: &StrobeMap, orbit: Orbit) -> Orbit {
    let mut points = orbit.points.clone();
    let least =
        |(_, a): &(usize, &StrobePoint), (_, b): &(usize, &StrobePoint)| a[0].total_cmp(&b[0]);
    let first = points.iter().enumerate().min_by(least).map_or(0, |(first, _)| first);
    points.rotate_left(first);
    ShootingIterate::new(map, &points).map_or(orbit, |iterate| Orbit::new(&iterate))
}
