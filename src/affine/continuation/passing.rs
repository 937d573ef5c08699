//! An event of an orbit that passes the section's strobe. Nothing happens to the orbit: a strobe of
//! another angle, at which it has no event, sees it on both sides of the map's corner.

use super::super::returns::map::Carried;
use super::super::returns::section::Section;
use super::super::returns::shooting::{ReturnMap, Shots};
use super::corner::MAX_ROOT_MULTIPLE;
use super::curve::Curve;
use super::point::{CurvePoint, are_on_one_piece};
use super::words::{cyclic, events_of};
use crate::dynamics::orbit::newton::polish;

/// The other strobes' angles, in radians from the section's: the first at which no event of the
/// orbit passes serves.
const ANGLES_BESIDE: [f64; 3] = [1.0, 3.0, 5.0];
/// The longest time between a strobe and the event that passes it, in forcing periods: a corner is
/// found to some roundings of the states, and an event may come slowly.
const MAX_TIME_FROM_STROBE: f64 = 1e-5;
/// Distances beyond a corner at which the orbit is looked for. Between the event and the strobe
/// there has to be a time that is no rounding, and no other corner: a graze may be very near.
const DISTANCES_BEYOND: [f64; 6] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-8, 1e-10];

/// An orbit as another strobe sees it.
struct Seen {
    places: Vec<Carried>,
    /// The word from wherever it is least. Where the section cuts a motion of impacts that
    /// accumulate, of which a word has the first ones, the word of the section is another one.
    word: Vec<[usize; 3]>,
}

impl Curve<'_> {
    /// The orbit beyond the end of a piece where that end is an event's passing of the strobe.
    pub(super) fn past_strobe(&self, before: &CurvePoint) -> Option<CurvePoint> {
        if !self.has_event_at_strobe(before)? {
            return None;
        }
        ANGLES_BESIDE.iter().find_map(|angle| {
            let beside = self.family.section().turned(*angle)?;
            let seen = self.seen_at(before, &beside)?;
            let beyond = |step: &f64| self.orbit_beyond(before, *step, &beside, &seen);
            DISTANCES_BEYOND.iter().find_map(beyond)
        })
    }

    /// Whether an event of an orbit is next to a strobe that is a point of it.
    fn has_event_at_strobe(&self, orbit: &CurvePoint) -> Option<bool> {
        let returns = f64::from(self.family.section().count());
        self.family.at(orbit.value, |map| {
            let period = map.forcing_period()?;
            let is_near = |time: f64| {
                let turns = time / period;
                turns.min(returns - turns) <= MAX_TIME_FROM_STROBE
            };
            let mut points = orbit.shots.points.iter();
            Some(
                points.any(|it| {
                    map.crossings(it).is_ok_and(|all| all.iter().any(|it| is_near(it.time)))
                }),
            )
        })
    }

    /// An orbit at another strobe, which comes after each of its points.
    fn seen_at(&self, orbit: &CurvePoint, strobe: &Section) -> Option<Seen> {
        let places = self.family.at_section(orbit.value, &strobe.clone().every(1), |map| {
            let places = orbit.shots.points.iter();
            places.map(|it| Some(map.carry(&map.image(it).ok()?.point))).collect()
        });
        let places: Vec<_> = places?;
        let shots = self.family.at_section(orbit.value, strobe, |map| {
            Shots::new(map, places.iter().map(|it| map.take_up(it)).collect())
        });
        let word = cyclic(&events_of(&shots?));
        Some(Seen { places, word })
    }

    /// The orbit a step beyond a corner, found from its places at another strobe.
    fn orbit_beyond(
        &self,
        before: &CurvePoint,
        step: f64,
        beside: &Section,
        own: &Seen,
    ) -> Option<CurvePoint> {
        let (family, value) = (self.family, before.value + step * before.tangent.rate);
        let seen = family.at_section(value, beside, |map| {
            let places: Vec<_> = own.places.iter().map(|it| map.take_up(it)).collect();
            let seen = polish(map, Shots::new(map, places.clone())?);
            // Near there: at the section itself a reset may have parted the two.
            let is_near = seen.distance(map, &places) <= MAX_ROOT_MULTIPLE * libm::sqrt(step);
            let is_same = cyclic(&events_of(&seen)) == own.word;
            (seen.is_closed() && is_near && is_same).then_some(seen)
        })?;
        let section = family.section();
        let mut points = family.at_section(value, &section.clone().every(1), |map| {
            let next = |from: &_| {
                let mut place = map.rebased(from);
                for _ in 0..section.count() {
                    place = map.rebased(&map.image(&place).ok()?.point);
                }
                Some(place)
            };
            seen.points.iter().map(next).collect::<Option<Vec<_>>>()
        })?;
        // The strobe after the other one is that of the orbit's next point.
        points.rotate_right(1);
        let shots = family.at(value, |map| {
            Some(polish(map, Shots::new(map, points)?)).filter(Shots::is_closed)
        })?;
        // One event alone makes the same word on both sides, and its reset parts the points.
        let is_near = self.is_near(value, &shots, before, step);
        if is_near && are_on_one_piece(&shots, &before.shots) {
            return None;
        }
        let point = self.point(value, shots, &before.tangent)?;
        let is_forward = point.tangent.rate * before.tangent.rate >= 0.0;
        Some(if is_forward { point } else { point.turned() })
    }
}
