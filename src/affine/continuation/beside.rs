//! A curve of bifurcations at another strobe, where an event of its orbits comes to this one.
//!
//! An event that passes the strobe makes another piece of the map, on which a bifurcation that was
//! known on the piece before is not found again. No bifurcation hangs on the strobe's angle.

use super::point::CurvePoint;
use super::strobe::angle_beside;
use super::traced::{Traced, Tracer};

impl Tracer<'_> {
    /// The tracer at another strobe, if an event of the orbit at a place is near this one.
    pub(super) fn beside(&self, place: &Traced) -> Option<Self> {
        let crossings = self
            .plane
            .on_line(place.axis, place.at, |curve| curve.crossings_with_phases(&place.point))?;
        let phases: Vec<f64> = crossings.iter().map(|(phase, _)| *phase).collect();
        let plane = self.plane.turned(angle_beside(&phases)?)?;
        Some(Self { plane, sought: self.sought })
    }

    /// A place of another tracer's curve as one of this one's, where the strobes differ.
    pub(super) fn seen(&self, by: &Self, place: &Traced) -> Option<Traced> {
        let seen = |point: &CurvePoint| {
            by.plane.on_line(place.axis, place.at, |curve| {
                self.plane.on_line(place.axis, place.at, |own| curve.seen_on(own, point))
            })
        };
        let clear = match &place.clear {
            Some(it) => Some(seen(it)?),
            None => None,
        };
        Some(Traced { point: seen(&place.point)?, clear, ..place.clone() })
    }
}
