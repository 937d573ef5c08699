//! Where a branch ends because its orbits close after half their period.

use super::super::returns::shooting::{Change, MAX_COORDINATES, ReturnMap, Shots};
use super::curve::Curve;
use super::point::{CurvePoint, Direction};
use crate::dynamics::orbit::newton::solve;

impl Curve<'_> {
    /// An orbit of half the period midway between the halves of a point's, if the curve runs into
    /// its flip before the next point. It goes on beyond: as the same orbits, half a period later,
    /// so that the difference of their halves changes sign.
    pub fn half(&self, point: &CurvePoint, next: &CurvePoint) -> Option<CurvePoint> {
        let (here, there) = (self.differences(point)?, self.differences(next)?);
        let direction = |points| Direction { points, rate: 0.0 };
        let [here_too, there] = [here.clone(), there].map(|it| direction(vec![it[0]]));
        if self.product(&here_too, &there, &point.shots) >= 0.0 {
            return None;
        }
        let half = point.shots.points.len() / 2;
        let middle = self.family.at(point.value, |map| {
            let points = point.carried[..half].iter().zip(&here).map(|(it, change)| {
                let place = map.take_up(it);
                map.moved(&place, &change.map(|by| 0.5 * by), &place)
            });
            solve(map, Shots::new(map, points.collect())?).ok()
        })?;
        let along = Direction { points: vec![[0.0; MAX_COORDINATES]; half], rate: self.unit };
        self.point(point.value, middle, &along)
    }

    /// The changes from points to those half a period later; none of an odd number of points.
    fn differences(&self, point: &CurvePoint) -> Option<Vec<Change>> {
        let points = &point.shots.points;
        let (first, second) = points.split_at(points.len() / 2);
        let changes = self.family.at(point.value, |map| {
            Some(first.iter().zip(second).map(|(a, b)| map.change_between(a, b)).collect())
        });
        changes.filter(|_| points.len().is_multiple_of(2))
    }
}
