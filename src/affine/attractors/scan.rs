//! Orbits found without a guess: Newton's method from the starts of a plane.

use super::basins::{Plane, PlaneStart};
use super::coordinates::Spot;
use super::motions::SectionMotions;
use super::{first, from_smallest};
use crate::affine::model::error::SystemError;
use crate::affine::model::system::StartPoint;
use crate::affine::returns::map::SectionMap;
use crate::affine::returns::orbit::Orbit;
use crate::affine::run::place::Place;
use crate::dynamics::attractor::coordinates::Coordinates;
use crate::dynamics::attractor::motions::Motions;
use crate::dynamics::linear::modulus;
use crate::dynamics::orbit::scan::{
    ORBIT_TOLERANCE, Rank, SETTLING_PERIODS, WATCHED_PERIODS, are_one,
};
use crate::dynamics::parallel;

impl SectionMap<'_, f64> {
    /// The orbits of `period` returns, or of a divisor of it, that Newton's method reaches from the
    /// starts of a plane, from where the motions from there settle, and from their closest returns.
    /// The other states, the time and the mode of a start are as [`SectionMap::basins`] has them.
    ///
    /// Orbits of the whole period come first; among these, stable ones; then the least leading
    /// multiplier, then the smallest first state. `seen` is told of how many starts more are done.
    /// An orbit that is found is there; one that is not found may be there too. Results are the
    /// same for any number of threads.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// are more than one can hold.
    pub fn orbits(
        &self,
        start: &StartPoint,
        plane: &Plane,
        period: u32,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Result<Vec<Orbit>, SystemError> {
        let motions = SectionMotions::new(self);
        let starts = plane.starts(&PlaneStart::new(self.solver(), start, &plane.axes)?, seen)?;
        let reached = parallel::map(&starts, |start| {
            // Threads that end the work by unwinding do so before they begin another start.
            seen(0);
            let reached = motions.reached_orbits(start, period);
            seen(1);
            reached
        });
        let mut found: Vec<Orbit> = Vec::new();
        for orbit in reached.into_iter().flatten() {
            // Many orbits take long to tell apart, and who waits may end the work.
            seen(0);
            if !found.iter().any(|it| motions.is_same(it, &orbit)) {
                found.push(orbit);
            }
        }
        found.sort_by(|a, b| rank(a).preference(&rank(b), period));
        Ok(found)
    }
}

impl SectionMotions<'_> {
    /// The orbits that Newton's method reaches from a start's guesses, each from its smallest first
    /// state on: what is found does not depend on which start found it.
    fn reached_orbits(&self, start: &Place<f64>, period: u32) -> Vec<Orbit> {
        let guesses = self.guesses(start, period);
        let found = guesses.iter().filter_map(|it| self.map.orbit_with_places(it, period).ok());
        found.map(|(orbit, places)| from_smallest(self.map, orbit, &places)).collect()
    }

    /// The first return from a start, the settled motion, and where that comes closest to itself.
    fn guesses(&self, start: &Place<f64>, period: u32) -> Vec<Place<f64>> {
        if !self.map.solver().admits(start) {
            return Vec::new();
        }
        let Ok(first) = self.after(start, 1) else { return Vec::new() };
        let Ok(settled) = self.after(&first, SETTLING_PERIODS) else { return vec![first] };
        let closest = self.closest(&settled, period);
        [Some(first), Some(settled), closest].into_iter().flatten().collect()
    }

    /// The place of a settled motion that is nearest to that of so many returns later.
    fn closest(&self, settled: &Place<f64>, period: u32) -> Option<Place<f64>> {
        let next = |place: &Place<f64>| self.after(place, 1).ok();
        let places = std::iter::successors(Some(settled.clone()), next);
        let places: Vec<_> = places.take((WATCHED_PERIODS + u64::from(period)) as usize).collect();
        let later = places.iter().skip(period as usize);
        let apart =
            |a: &Place<f64>, b: &Place<f64>| self.distance(&self.spot_of(a), &self.spot_of(b));
        let pairs = places.iter().zip(later).map(|(a, b)| (apart(a, b), a));
        pairs.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, place)| place.clone())
    }

    /// The largest distance of two spots in a co-ordinate, infinite of different modes.
    fn distance(&self, one: &Spot, other: &Spot) -> f64 {
        if one.mode != other.mode {
            return f64::INFINITY;
        }
        self.coordinates.step(one, other).iter().fold(0.0, |most, it| it.abs().max(most))
    }

    /// Whether two orbits are one, wherever they begin.
    fn is_same(&self, one: &Orbit, other: &Orbit) -> bool {
        let [one, other] = [one, other].map(|it| {
            let spots = it.points.iter().map(|point| self.coordinates.spot(point));
            spots.collect::<Vec<_>>()
        });
        let size = |it: &Spot| it.at.iter().fold(0.0_f64, |most, it| it.abs().max(most));
        are_one(&one, &other, |a, b| self.distance(a, b) <= ORBIT_TOLERANCE * (1.0 + size(a)))
    }
}

fn rank(orbit: &Orbit) -> Rank {
    Rank {
        period: orbit.period(),
        is_stable: orbit.is_stable(),
        leading: orbit.multipliers.first().map_or(0.0, |it| modulus(*it)),
        first: orbit.points.first().map_or(0.0, |it| first(&it.state)),
    }
}
