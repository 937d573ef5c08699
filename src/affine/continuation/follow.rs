//! The curve of a return map's orbits, as step control sees it.

use super::super::returns::orbit::Orbit;
use super::super::returns::shooting::{ReturnMap, Shots};
use super::ReturnBifurcation;
use super::curve::Curve;
use super::family::is_near_touch;
use super::point::{CurvePoint, are_on_one_piece};
use super::refusal::Refusal;
use super::touch::TouchAhead;
use super::words::Meaning;
use crate::dynamics::continuation::steps::{Accepts, Corner, Noted, OrbitCurve, OrbitPoint};
use crate::dynamics::linear::ReIm;
use crate::dynamics::orbit::newton::polish;

/// A corner lies within so many times the step that has led to another piece. Where the piece goes
/// on for longer, the corrector has left the curve: next to a touch it leads to the orbit without
/// the event where a step is too long.
const MAX_LENGTH_TO_CORNER: f64 = 2.0;

impl OrbitPoint for CurvePoint {
    fn value(&self) -> f64 {
        self.value
    }

    fn rate(&self) -> f64 {
        self.tangent.rate
    }

    fn multipliers(&self) -> &[ReIm] {
        &self.orbit.multipliers
    }

    fn is_on_piece_of(&self, other: &Self) -> bool {
        are_on_one_piece(&self.shots, &other.shots)
    }

    /// The change of the multipliers' sums of first and second powers.
    fn change_of_multipliers(&self, other: &Self) -> f64 {
        let sums = |point: &Self| {
            let multipliers = &point.orbit.multipliers;
            let first: f64 = multipliers.iter().map(|it| it[0]).sum();
            [first, multipliers.iter().map(|[re, im]| re * re - im * im).sum()]
        };
        let changes = sums(self).into_iter().zip(sums(other));
        changes.map(|(a, b)| (a - b).abs() / (1.0 + a.abs().min(b.abs()))).fold(0.0, f64::max)
    }
}

impl Curve<'_> {
    /// Whether the end to which a step leads has been refused, and would be again. Were it another
    /// end, it would be passed by the shortest step.
    fn is_refused(
        &self,
        base: &CurvePoint,
        distance: f64,
        most: f64,
        accepts: Accepts<'_, CurvePoint>,
    ) -> bool {
        let refusal = self.refusal.borrow();
        let Some(refusal) = refusal.as_ref() else { return false };
        let leads_to = |end: &CurvePoint| {
            let ahead = OrbitCurve::distance_along(self, base, end);
            end.is_on_piece_of(base)
                && ahead > 0.0
                && (ahead > most || refusal.is_lost || !accepts(end))
        };
        refusal.is_of(base, distance) || refusal.end.as_ref().is_some_and(leads_to)
    }
}

impl OrbitCurve for Curve<'_> {
    type Point = CurvePoint;
    type Bifurcation = ReturnBifurcation;
    type Kept = (f64, Orbit);

    fn corrected_point(&self, base: &CurvePoint, distance: f64) -> Option<CurvePoint> {
        Self::corrected_point(self, base, distance)
    }

    fn cosine(&self, point: &CurvePoint, next: &CurvePoint) -> f64 {
        self.product(&point.tangent, &next.tangent, &point.shots)
    }

    fn between(
        &self,
        [point, next]: [&CurvePoint; 2],
        value: f64,
        share: f64,
    ) -> Option<CurvePoint> {
        let shots = self.family.at(value, |map| {
            let pairs = point.carried.iter().zip(&next.carried);
            let between = pairs.map(|(a, b)| {
                let [a, b] = [a, b].map(|it| map.take_up(it));
                map.moved(&a, &map.change_between(&a, &b).map(|it| share * it), &a)
            });
            let shots = polish(map, Shots::new(map, between.collect())?);
            shots.is_closed().then_some(shots)
        })?;
        self.point(value, shots, &next.tangent)
    }

    fn uncertainty(&self, point: &CurvePoint) -> f64 {
        Self::uncertainty(self, point)
    }

    fn half(&self, point: &CurvePoint, next: &CurvePoint) -> Option<CurvePoint> {
        Self::half(self, point, next)
    }

    fn corner(
        &self,
        base: &CurvePoint,
        distance: f64,
        accepts: Option<Accepts<'_, CurvePoint>>,
    ) -> Option<Corner<CurvePoint>> {
        let Some(accepts) = accepts else { return Some(Self::corner(self, base, distance)) };
        let most = MAX_LENGTH_TO_CORNER * distance;
        if self.is_refused(base, distance, most, accepts) {
            return None;
        }
        let end = self.approach_within(base, distance, most);
        let is_near = end.length <= most;
        let counted = is_near.then(|| end.last.clone());
        let mut refusal = Refusal::new(base, distance, end.first_step, counted);
        if is_near && accepts(&end.last) {
            let corner = self.corner_at(base, end);
            if corner.beyond.is_some() {
                return Some(corner);
            }
            // A touch is expected where the speed of an impact says so, the better the nearer.
            refusal.is_lost = !is_near_touch(&corner.before.shots);
        }
        self.refusal.replace(Some(refusal));
        None
    }

    fn distance_along(&self, base: &CurvePoint, other: &CurvePoint) -> f64 {
        Self::distance_along(self, base, other.value, &other.shots).unwrap_or(f64::NAN)
    }

    fn of_corner(
        &self,
        base: &CurvePoint,
        corner: &Corner<CurvePoint>,
    ) -> Option<ReturnBifurcation> {
        let is_end = corner.beyond.is_none() && !corner.is_of_section;
        if is_end && self.is_rest(&corner.before) {
            return None;
        }
        let touch = if is_end { self.touch_ahead(base, &corner.before) } else { None };
        let meaning = touch.as_ref().map(|it| Meaning::of_touch(it.event));
        let Meaning { kind, event } = meaning.or_else(|| self.meaning(base, corner))?;
        let phase = self.phase(base, corner, event);
        let Corner { before, beyond, error, .. } = corner;
        let noted = Noted { kind, point: before.clone(), error: *error, turns: corner.turns() };
        let (event, is_lost) = (Some(event), beyond.is_none());
        let found = ReturnBifurcation { event, phase, is_lost, ..self.bifurcation(noted) };
        Some(match touch {
            Some(TouchAhead { value, error, .. }) => ReturnBifurcation { value, error, ..found },
            None => found,
        })
    }

    fn bifurcation(&self, noted: Noted<CurvePoint>) -> ReturnBifurcation {
        let Noted { kind, point, error, turns } = noted;
        let point = self.shown_point(&point);
        let (value, orbit) = (point.value, point.orbit.clone());
        let (event, phase, is_lost) = (None, None, false);
        ReturnBifurcation {
            kind,
            value,
            error,
            event,
            turns,
            orbit,
            points_before: 0,
            point,
            phase,
            is_lost,
        }
    }

    fn kept_point(&self, point: &CurvePoint) -> (f64, Orbit) {
        (point.value, self.shown_point(point).orbit)
    }

    fn is_back(&self, [point, next]: [&CurvePoint; 2], start: &CurvePoint) -> bool {
        if (start.value - point.value) * (start.value - next.value) > 0.0 {
            return false;
        }
        let distance = |a: &CurvePoint, b: &CurvePoint| {
            let distance = self.family.at(a.value, |map| {
                let other: Vec<_> = b.carried.iter().map(|it| map.take_up(it)).collect();
                Some(a.shots.distance(map, &other))
            });
            distance.unwrap_or(f64::INFINITY)
        };
        distance(point, start).min(distance(next, start)) <= distance(point, next)
            && self.product(&next.tangent, &start.tangent, &start.shots) > 0.0
    }
}
