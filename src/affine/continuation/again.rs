//! A bifurcation that is known on one line, found again on another.

use super::super::returns::section::Guard;
use super::ReturnBifurcation;
use super::curve::Curve;
use super::point::CurvePoint;
use super::words::cyclic;
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
}

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
    pub fn find_again(&self, sought: &Sought, expected: &CurvePoint, reach: f64) -> Option<OnLine> {
        let start = self.corrected_point(expected, -reach)?;
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
        Some(OnLine { value: located.point.value, point: located.point, error })
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
        let corner = match sought.is_lost {
            true => self.lost_corner(start, distance),
            false => Self::corner(self, start, distance),
        };
        let found = self.of_corner(start, &corner)?;
        let is_same = found.kind == sought.kind && found.event == sought.event;
        let ReturnBifurcation { value, error, .. } = found;
        is_same.then_some(OnLine { point: corner.before, value, error })
    }
}
