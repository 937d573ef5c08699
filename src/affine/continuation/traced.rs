//! Step control in the plane of two parameters: a curve of bifurcations, line by line.

use super::again::{Expected, OnLine, Sought};
use super::curve::Curve;
use super::plane::{Axis, ReturnPlane, Way, cosine, length};
use super::point::{CurvePoint, Direction};
use crate::affine::returns::shooting::{MAX_COORDINATES, ReturnMap};
use crate::dynamics::continuation::BifurcationKind;

/// A bifurcation in the plane.
#[derive(Clone)]
pub(super) struct Traced {
    pub at: [f64; 2],
    /// The parameter along which it was found.
    pub axis: Axis,
    /// Bound on the error of that parameter's value.
    pub error: f64,
    /// The orbit on the line on which that parameter varies.
    pub point: CurvePoint,
    /// An orbit before that on this line, where that one is too near to a touch to be followed.
    pub clear: Option<CurvePoint>,
}

/// One way along a curve.
pub(super) struct Trace {
    pub points: Vec<Traced>,
    pub ending: CurveEnding,
}

/// How one way along a curve of bifurcations ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveEnding {
    /// The curve leaves the window.
    Left,
    /// The curve comes back to the place where it began.
    Closed,
    /// The bifurcation was not found beyond the last place.
    Lost,
    /// The curve has more points than are kept.
    Long,
}

impl CurveEnding {
    /// The name used in files.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Closed => "closed",
            Self::Lost => "lost",
            Self::Long => "long",
        }
    }
}

/// The first step, in widths of the window.
const FIRST_STEP: f64 = 1e-3;
/// The longest step, in widths of the window.
const MAX_STEP: f64 = 0.03;
/// The shortest step, in widths of the window.
const MIN_STEP: f64 = 1e-6;
/// Lengths of the first steps that are tried, in widths of the window: the first that leads
/// anywhere tells the curve's direction.
const TRIAL_STEPS: [f64; 3] = [1e-3, 1e-4, 1e-5];
/// The longest step that is a rounding of a place on the window's edge, in widths of the window.
const EDGE_TOLERANCE: f64 = 8.0 * f64::EPSILON;
/// Places on a curve before it is given up.
const MAX_POINTS: usize = 5_000;
/// Cosine of the largest turn of the curve in a step.
const MIN_TURN_COSINE: f64 = 0.95;
/// The reaches along the branch within which a bifurcation is looked for, in steps: the step's
/// error, which is of second order, has to be smaller, and all else that the branch has further
/// away.
const REACHES: [f64; 3] = [1.0, 0.2, 0.04];
/// The reaches of a first step, whose direction is not known, in steps.
const FIRST_REACHES: [f64; 4] = [1.0, 4.0, 0.2, 16.0];
/// A touch that orbits do not reach lies within so many reaches of the place where it is expected.
const MAX_REACHES: f64 = 4.0;
/// A curve passes a place that is within this share of a step.
const PASSING_TOLERANCE: f64 = 0.3;

/// The tracer of one curve.
#[derive(Clone)]
pub(super) struct Tracer<'a> {
    pub plane: ReturnPlane<'a>,
    pub sought: Sought,
}

/// A step from one place to another, in a direction of length 1.
struct Step<'a> {
    from: &'a Traced,
    /// The place before, if there was one.
    before: Option<&'a Traced>,
    way: Way,
    length: f64,
}

/// Where a way along a curve has come to, as the tracer sees it by which it goes on.
struct Here<'a> {
    /// The tracer at another strobe, if it is one.
    beside: Option<Tracer<'a>>,
    /// The place at which the way began.
    start: Traced,
    from: Traced,
    before: Option<Traced>,
}

impl<'a> Here<'a> {
    /// This place as a tracer at another strobe sees it, if an event is near that of the tracer.
    fn at_another_strobe(&self, tracer: &Tracer<'a>) -> Option<Self> {
        let beside = tracer.beside(&self.from)?;
        let seen = |place: &Traced| beside.seen(tracer, place);
        let (start, from) = (seen(&self.start)?, seen(&self.from)?);
        let before = self.before.as_ref().and_then(seen);
        Some(Self { beside: Some(beside), start, from, before })
    }
}

impl Tracer<'_> {
    /// The directions in which a curve leaves a place; none where it was found nowhere near.
    pub fn ways(&self, start: &Traced) -> Option<Way> {
        const TRIAL_WAYS: [Way; 4] = [[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]];
        TRIAL_STEPS.iter().find_map(|length| {
            TRIAL_WAYS.iter().find_map(|way| {
                let step = Step { from: start, before: None, way: *way, length: *length };
                if self.plane.room(start.at, *way) < *length {
                    return None;
                }
                let target = self.plane.moved(start.at, way.map(|it| it * length));
                let found = self.find_near(&step, target, axis_of(*way), &FIRST_REACHES)?;
                Some(self.plane.way(start.at, found.at))
            })
        })
    }

    /// Follows the curve from a place in a direction; `progress` is told how many places there are.
    ///
    /// Where a step fails next to an event at the strobe, the way goes on at another strobe. The
    /// places that are given are those of this one.
    pub fn trace(&self, start: &Traced, way: Way, progress: &mut dyn FnMut(usize)) -> Trace {
        let mut way = way.map(|it| it / length(way));
        let mut points: Vec<Traced> = Vec::new();
        if self.plane.room(start.at, way) <= EDGE_TOLERANCE {
            return Trace { points, ending: CurveEnding::Left };
        }
        let mut step = FIRST_STEP;
        let mut here =
            Here { beside: None, start: start.clone(), from: start.clone(), before: None };
        loop {
            let tracer = here.beside.as_ref().unwrap_or(self);
            let Here { from, before, .. } = &here;
            let next = Step { from, before: before.as_ref(), way, length: step };
            let Some((next, has_left)) = tracer.step(&next) else {
                if let Some(beside) = here.at_another_strobe(tracer) {
                    here = beside;
                } else if step > MIN_STEP {
                    step *= 0.5;
                } else {
                    let is_at_edge = self.plane.room(from.at, way) <= 10.0 * MIN_STEP;
                    let ending = if is_at_edge { CurveEnding::Left } else { CurveEnding::Lost };
                    return Trace { points, ending };
                }
                continue;
            };
            let chord = self.plane.way(from.at, next.at);
            if points.len() > 2 && tracer.passes([from, &next], &here.start) {
                points.push(start.clone());
                return Trace { points, ending: CurveEnding::Closed };
            }
            progress(points.len());
            if length(chord) > 0.0 {
                way = chord.map(|it| it / length(chord));
                let own = here.beside.as_ref().and_then(|it| self.seen(it, &next));
                points.push(own.unwrap_or_else(|| next.clone()));
                here.before = Some(std::mem::replace(&mut here.from, next));
            }
            if has_left || points.len() >= MAX_POINTS {
                let ending = if has_left { CurveEnding::Left } else { CurveEnding::Long };
                return Trace { points, ending };
            }
            step = (1.5 * step).min(MAX_STEP);
        }
    }

    /// The next place, and whether it lies on the window's edge.
    fn step(&self, step: &Step<'_>) -> Option<(Traced, bool)> {
        let Step { from, way, .. } = *step;
        let axis = axis_of(way);
        let mut target = self.plane.moved(from.at, way.map(|it| it * step.length));
        let fixed = 1 - axis;
        let edge = self.plane.passed(fixed, target[fixed]);
        if let Some(edge) = edge {
            target = between(from.at, target, fixed, edge);
        }
        let found = self.find_near(step, target, axis, &REACHES)?;
        let Some(side) = self.plane.passed(axis, found.at[axis]) else {
            return Some((found, edge.is_some()));
        };
        let target = between(from.at, found.at, axis, side);
        let found = self.find_near(step, target, fixed, &REACHES)?;
        self.plane.passed(fixed, found.at[fixed]).is_none().then_some((found, true))
    }

    /// The bifurcation on the line through a place on which one parameter varies, if it lies where
    /// a step may lead.
    fn find_near(
        &self,
        step: &Step<'_>,
        target: [f64; 2],
        axis: Axis,
        reaches: &[f64],
    ) -> Option<Traced> {
        let Step { from, way, .. } = *step;
        self.plane.on_line(axis, target, |curve| {
            let expected = match &from.clear {
                Some(clear) => self.before_touch(from, clear, way, target, axis)?,
                None => {
                    let is_same = from.axis == axis;
                    let turned = || self.turned(&from.point, from.at, way, axis);
                    let own = if is_same { from.point.clone() } else { turned()? };
                    Expected { point: self.expected(curve, step, own, target, axis), ahead: 0.0 }
                }
            };
            reaches.iter().find_map(|reach| {
                let reach = reach * step.length;
                let found = curve.find_again(&self.sought, &expected, reach)?;
                let OnLine { point, value, error, clear } = found;
                // A long way may have led to another one of the same kind.
                let apart = (value - target[axis]).abs() / self.plane.width(axis);
                if expected.ahead > 0.0 && apart > MAX_REACHES * reach {
                    return None;
                }
                let mut at = target;
                at[axis] = value;
                let chord = self.plane.way(step.from.at, at);
                let is_ahead = step.before.is_none() || cosine(chord, step.way) >= MIN_TURN_COSINE;
                is_ahead.then_some(Traced { at, axis, error, point, clear })
            })
        })
    }

    /// An orbit of the line on which one parameter varies as a point of that on which the other one
    /// does. Towards a corner the point's direction leads on this line, too.
    pub(super) fn turned(
        &self,
        point: &CurvePoint,
        at: [f64; 2],
        way: Way,
        axis: Axis,
    ) -> Option<CurvePoint> {
        let CurvePoint { shots, tangent, .. } = point;
        self.plane.on_line(axis, at, |curve| {
            let along = match self.sought.kind {
                BifurcationKind::Fold => Direction { points: tangent.points.clone(), rate: 0.0 },
                _ => {
                    // The corner's other side is on the same side of the curve.
                    let side = -(tangent.rate * way[0] * way[1]).signum();
                    let points = vec![[0.0; MAX_COORDINATES]; shots.points.len()];
                    Direction { points, rate: side * self.plane.width(axis) }
                }
            };
            curve.point(at[axis], shots.clone(), &along)
        })
    }

    /// The orbit that is expected at a place, by the change from the place before.
    fn expected(
        &self,
        curve: &Curve<'_>,
        step: &Step<'_>,
        from: CurvePoint,
        target: [f64; 2],
        axis: Axis,
    ) -> CurvePoint {
        let value = target[axis];
        let ahead = step.before.and_then(|before| {
            let [last, next] = [before.at, target].map(|it| self.plane.way(step.from.at, it));
            let share = length(next) / length(last);
            let pairs = from.carried.iter().zip(&before.point.carried);
            curve.family.at(value, |map| {
                let ahead = pairs.map(|(from, before)| {
                    let [from, before] = [from, before].map(|it| map.take_up(it));
                    let is_same = from.mode == before.mode;
                    let change = map.change_between(&before, &from).map(|it| it * share);
                    is_same.then(|| map.carry(&map.moved(&from, &change, &from)))
                });
                ahead.collect::<Option<Vec<_>>>()
            })
        });
        let carried = ahead.unwrap_or_else(|| from.carried.clone());
        CurvePoint { value, carried, ..from }
    }

    /// Whether a curve passes a bifurcation between two of its places: it is what is found again on
    /// the line on which the other was found.
    pub fn passes(&self, [from, next]: [&Traced; 2], other: &Traced) -> bool {
        let way = self.plane.way(from.at, next.at);
        let to = self.plane.way(from.at, other.at);
        let size = length(way);
        let along = (way[0] * to[0] + way[1] * to[1]) / size;
        let aside = (way[0] * to[1] - way[1] * to[0]).abs() / size;
        let slack = PASSING_TOLERANCE * size;
        if !(aside <= slack && along >= -slack && along <= size + slack) {
            return false;
        }
        let nearer = if along > 0.5 * size { next } else { from };
        let back = self.plane.way(nearer.at, other.at);
        let reach = length(back).max(FIRST_STEP * PASSING_TOLERANCE);
        let step = Step { from: nearer, before: None, way, length: reach };
        let found = self.find_near(&step, other.at, other.axis, &FIRST_REACHES);
        found.is_some_and(|it| {
            (it.at[other.axis] - other.at[other.axis]).abs() <= it.error + other.error
        })
    }
}

/// The parameter that changes less along a way: the curve crosses the lines on which it varies.
fn axis_of(way: Way) -> Axis {
    usize::from(way[0].abs() > way[1].abs())
}

/// The place between two others at which a parameter has a value.
fn between(from: [f64; 2], to: [f64; 2], axis: Axis, value: f64) -> [f64; 2] {
    let share = (value - from[axis]) / (to[axis] - from[axis]);
    let mut there = std::array::from_fn(|n| from[n] + share * (to[n] - from[n]));
    there[axis] = value;
    there
}
