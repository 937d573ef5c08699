//! A bifurcation that is known on one line, found again on another.

use super::super::returns::section::Guard;
use super::ReturnBifurcation;
use super::curve::Curve;
use super::family::is_near_touch;
use super::point::CurvePoint;
use super::touch::{TouchAhead, leaves_digits};
use super::words::{Meaning, cyclic};
use crate::dynamics::continuation::BifurcationKind;
use crate::dynamics::continuation::steps::{OrbitCurve, OrbitPoint};

/// A kind of bifurcation, and its event, that are looked for on each line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sought {
    pub kind: BifurcationKind,
    pub event: Option<Guard>,
    /// Whether no orbit was found beyond a corner: then none is looked for on other lines.
    pub is_lost: bool,
}

/// A bifurcation on a line.
pub(super) struct OnLine {
    pub point: CurvePoint,
    /// The value of the line's parameter; next to a touch the point's own is that of the last
    /// orbit that was found.
    pub value: f64,
    /// Bound on the error of the value.
    pub error: f64,
    /// The orbit by which a touch that orbits do not reach is found on other lines.
    pub clear: Option<CurvePoint>,
}

/// The orbit that is expected on a line.
pub(super) struct Expected {
    pub point: CurvePoint,
    /// The length along the branch from there to the bifurcation: zero unless the orbit there is
    /// too near to a touch to be found.
    pub ahead: f64,
}

/// The first step on the way to a touch that orbits do not reach: the way is long, and a long step
/// may lead to another branch.
const FIRST_STEP: f64 = 0.02;
/// The least and the greatest distance of an orbit from the touch that is found by it, in units of
/// the parameter. The further it is, the further Newton's method finds it from; but over the
/// distance the curve is to be nearly straight.
const CLEAR_DISTANCES: [f64; 2] = [4e-3, 6.4e-2];
/// Distances beyond the place at which a corner is expected where the piece may have ended.
const END_DISTANCES: [f64; 2] = [2.0, 4.0];

impl Sought {
    pub fn new(found: &ReturnBifurcation) -> Self {
        let ReturnBifurcation { kind, event, is_lost, .. } = *found;
        Self { kind, event, is_lost }
    }
}

impl Curve<'_> {
    /// The bifurcation within a reach of the place where it is expected, along the branch.
    ///
    /// The branch is entered before that place, by the corrector, which holds the distance along
    /// the branch and leaves the parameter free: so it is entered next to a fold, too.
    pub fn find_again(&self, sought: &Sought, expected: &Expected, reach: f64) -> Option<OnLine> {
        let Expected { point: expected, ahead } = expected;
        let start = if *ahead > 0.0 {
            self.corrected_at_value(expected)?
        } else {
            self.corrected_point(expected, -reach)?
        };
        let reach = reach + ahead;
        match sought.kind {
            BifurcationKind::Fold => self.zero(&start, reach, &OrbitPoint::rate),
            BifurcationKind::Flip => self.zero(&start, reach, &OrbitPoint::flip_test),
            BifurcationKind::NeimarkSacker => {
                let (_, pairs) = start.neimark_sacker_test();
                self.zero(&start, reach, &|it| match it.neimark_sacker_test() {
                    (test, count) if count == pairs => test,
                    _ => f64::NAN,
                })
            }
            _ => self.end_of_piece(sought, expected, &start, reach),
        }
    }

    /// The zero of a test along the branch, on the piece of the point that it is looked for from.
    fn zero(
        &self,
        start: &CurvePoint,
        reach: f64,
        test: &dyn Fn(&CurvePoint) -> f64,
    ) -> Option<OnLine> {
        let end = self.corrected_point(start, 2.0 * reach)?;
        let is_between = end.is_on_piece_of(start) && test(start) * test(&end) < 0.0;
        let located =
            if is_between { self.located(start, 2.0 * reach, test)? } else { return None };
        if !located.point.is_on_piece_of(start) {
            return None;
        }
        let error = self.error(&located);
        Some(OnLine { value: located.point.value, point: located.point, error, clear: None })
    }

    /// The end of the piece on which a point lies, if it is the corner that is sought.
    fn end_of_piece(
        &self,
        sought: &Sought,
        expected: &CurvePoint,
        start: &CurvePoint,
        reach: f64,
    ) -> Option<OnLine> {
        // An event that passes the section makes another piece of the same orbits.
        if cyclic(&start.orbit.events) != cyclic(&expected.orbit.events) {
            return None;
        }
        let leaves = |distance: &f64| {
            self.corrected_point(start, *distance).is_none_or(|it| !it.is_on_piece_of(start))
        };
        let distance = END_DISTANCES.map(|it| it * reach).into_iter().find(leaves)?;
        if sought.is_lost
            && let Some(touch) = self.touch_again(sought, start, distance)
        {
            return Some(touch);
        }
        let corner = match sought.is_lost {
            true => self.lost_corner(start, distance),
            false => Self::corner(self, start, distance),
        };
        let found = self.of_corner(start, &corner)?;
        let is_same = found.kind == sought.kind && found.event == sought.event;
        let ReturnBifurcation { value, error, .. } = found;
        if !is_same {
            return None;
        }
        let clear =
            if sought.is_lost { self.clear_orbit(start, &corner.before, value) } else { None };
        Some(OnLine { point: corner.before, value, error, clear })
    }

    /// The touch at the end of the piece on which a point lies, if it is the one that is sought and
    /// no orbit reaches it. Orbits nearer to it than those through which it is extrapolated do not
    /// tell more.
    fn touch_again(&self, sought: &Sought, start: &CurvePoint, distance: f64) -> Option<OnLine> {
        let is_over = |it: &CurvePoint, _: f64| !leaves_digits(it);
        let point = self.approach_until(start, distance.min(FIRST_STEP), &is_over).last;
        let TouchAhead { value, error, event } = self.touch_ahead(start, &point)?;
        let Meaning { kind, event } = Meaning::of_touch(event);
        let is_same = kind == sought.kind && Some(event) == sought.event;
        let clear = self.clear_orbit(start, &point, value);
        is_same.then_some(OnLine { point, value, error, clear })
    }

    /// The orbit by which a touch that orbits do not reach is found on other lines: the one from
    /// which it was found on this line, if it is neither too near nor too far.
    pub fn clear_orbit(
        &self,
        start: &CurvePoint,
        last: &CurvePoint,
        touch: f64,
    ) -> Option<CurvePoint> {
        if !is_near_touch(&last.shots) {
            return None;
        }
        let distance = |it: &CurvePoint| (it.value - touch).abs() / self.unit;
        let is_clear = |it: &CurvePoint| leaves_digits(it) && distance(it) >= CLEAR_DISTANCES[0];
        let is_start = is_clear(start) && distance(start) <= CLEAR_DISTANCES[1];
        let clear = if is_start { None } else { self.clear_of_touch(last, &is_clear) };
        Some(clear.unwrap_or_else(|| if is_start { start.clone() } else { last.clone() }))
    }
}
