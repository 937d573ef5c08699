//! A curve of touches that orbits do not reach, from line to line.
//!
//! Next to such a touch the orbits' derivative grows without bound, and the orbit of one line is no
//! start for Newton's method on the next. Further away it is: so the curve is followed by an orbit
//! that is clear of the touch, and moved beside the curve by its changes with both parameters.
//! These are large, and nearly cancel along the curve.

use super::again::Expected;
use super::plane::{Axis, Way};
use super::point::CurvePoint;
use super::traced::{Traced, Tracer};
use crate::affine::returns::shooting::ReturnMap;

/// The way to a touch is so many times as long as its direction says: the branch is a parabola in
/// the event's rate there, and the touch is its top.
const TOP_OF_PARABOLA: f64 = 2.0;

impl Tracer<'_> {
    /// The orbit before the touch that is expected at a place, on the line on which one parameter
    /// varies: `clear`, which is before that of another place, moved along a way.
    pub(super) fn before_touch(
        &self,
        from: &Traced,
        clear: &CurvePoint,
        way: Way,
        target: [f64; 2],
        axis: Axis,
    ) -> Option<Expected> {
        let mut at = from.at;
        at[from.axis] = clear.value;
        let across = self.turned(clear, at, way, 1 - from.axis)?;
        let lines = if from.axis == 0 { [clear, &across] } else { [&across, clear] };
        // As far aside of the curve, along one parameter or the other.
        let aside = (clear.value - from.at[from.axis]) / self.plane.width(from.axis);
        let share = if axis == from.axis { 1.0 } else { -way[axis] / way[from.axis] };
        let offset = aside * share * self.plane.width(axis);
        let mut there = target;
        there[axis] += offset;
        let shares: [f64; 2] = std::array::from_fn(|n| (there[n] - at[n]) / lines[n].tangent.rate);
        let changes = lines[0].tangent.points.iter().zip(&lines[1].tangent.points);
        let carried = self.plane.on_line(axis, at, |curve| {
            curve.family.at(at[axis], |map| {
                let moved = clear.carried.iter().zip(changes).map(|(place, (one, other))| {
                    let change = std::array::from_fn(|n| shares[0] * one[n] + shares[1] * other[n]);
                    let place = map.take_up(place);
                    map.carry(&map.moved(&place, &change, &place))
                });
                Some(moved.collect())
            })
        })?;
        let ahead = TOP_OF_PARABOLA * (offset / lines[axis].tangent.rate).abs();
        Some(Expected {
            point: CurvePoint { value: there[axis], carried, ..lines[axis].clone() },
            ahead,
        })
    }
}
