//! Curves of bifurcations in two parameters.

use super::super::returns::orbit::Orbit;
use super::super::returns::section::Guard;
use super::again::Sought;
use super::plane::ReturnPlane;
use super::traced::{CurveEnding, Trace, Traced, Tracer};
use super::{ReturnBifurcation, ReturnBranch};
use crate::dynamics::continuation::BifurcationKind;

/// A curve of bifurcations of one kind in the plane of two parameters.
#[derive(Clone, Debug)]
pub struct BifurcationCurve {
    /// The kind of the bifurcations.
    pub kind: BifurcationKind,
    /// The event that is touched, gained, lost, or at once with another.
    pub event: Option<Guard>,
    /// The curve's places from one of its ends to the other; the last of a closed curve is the
    /// first again.
    pub points: Vec<BifurcationPoint>,
    /// The endings of the curve at its first place and at its last.
    pub endings: [CurveEnding; 2],
}

/// A place on a curve of bifurcations.
#[derive(Clone, Debug)]
pub struct BifurcationPoint {
    /// The values of both parameters.
    pub values: [f64; 2],
    /// Bound on the error of the first parameter's value where the second has its value.
    pub error: f64,
    /// The orbit there; at a corner as it is on the side from which the branch came. Of a touch
    /// that no orbit reaches it is the last one through which the touch was extrapolated.
    pub orbit: Orbit,
}

impl BifurcationCurve {
    /// The curves of all bifurcations of a branch, which was followed in the plane's first
    /// parameter at a value of its second. Two bifurcations on one curve have it once. `progress`
    /// is told how far it has come, 0 to 1.
    #[must_use]
    pub fn all(
        plane: &ReturnPlane<'_>,
        branch: &ReturnBranch,
        second: f64,
        progress: &mut dyn FnMut(f64),
    ) -> Vec<Self> {
        let mut curves: Vec<(Vec<Traced>, Self)> = Vec::new();
        let count = branch.bifurcations.len() as f64;
        for (n, found) in branch.bifurcations.iter().enumerate() {
            let mut share = |share: f64| progress((n as f64 + share) / count);
            let tracer = Tracer { plane: plane.clone(), sought: Sought::new(found) };
            let start = traced_point(plane, found, second);
            let is_known = curves.iter().any(|(points, curve)| {
                (curve.kind, curve.event) == (found.kind, found.event)
                    && points.windows(2).any(|it| tracer.passes([&it[0], &it[1]], &start))
            });
            if !is_known {
                let (points, endings) = whole_curve(&tracer, start, &mut share);
                let own = Self::new(plane, found, &points, endings);
                curves.push((points, own));
            }
            share(1.0);
        }
        curves.into_iter().map(|(_, curve)| curve).collect()
    }

    fn new(
        plane: &ReturnPlane<'_>,
        found: &ReturnBifurcation,
        points: &[Traced],
        endings: [CurveEnding; 2],
    ) -> Self {
        let ReturnBifurcation { kind, event, .. } = *found;
        let point = |(n, it): (usize, &Traced)| BifurcationPoint {
            values: it.at,
            error: error_across(plane, points, n),
            orbit: it.point.orbit.clone(),
        };
        let points = points.iter().enumerate().map(point).collect();
        Self { kind, event, points, endings }
    }
}

fn traced_point(plane: &ReturnPlane<'_>, found: &ReturnBifurcation, second: f64) -> Traced {
    let ReturnBifurcation { value, error, point, is_lost, .. } = found;
    let (at, axis) = ([*value, second], 0);
    let clear = || plane.on_line(axis, at, |curve| curve.clear_orbit(point, point, *value));
    let clear = if *is_lost { clear() } else { None };
    Traced { at, axis, error: *error, point: point.clone(), clear }
}

/// Places after which half of a way along a curve is said to be done: its length is not known.
const HALFWAY_POINTS: f64 = 40.0;

/// The curve through a place, from one end to the other.
fn whole_curve(
    tracer: &Tracer<'_>,
    start: Traced,
    progress: &mut dyn FnMut(f64),
) -> (Vec<Traced>, [CurveEnding; 2]) {
    let beside = || {
        let beside = tracer.beside(&start)?;
        beside.ways(&beside.seen(tracer, &start)?)
    };
    let Some(way) = tracer.ways(&start).or_else(beside) else {
        return (vec![start], [CurveEnding::Lost; 2]);
    };
    let share =
        |half: f64, count: usize| half + 0.5 * count as f64 / (count as f64 + HALFWAY_POINTS);
    let Trace { points: ahead, ending: last } =
        tracer.trace(&start, way, &mut |count| progress(share(0.0, count)));
    if last == CurveEnding::Closed {
        return ([vec![start], ahead].concat(), [last; 2]);
    }
    let Trace { points: mut whole, ending: first } =
        tracer.trace(&start, way.map(|it| -it), &mut |count| progress(share(0.5, count)));
    whole.reverse();
    whole.push(start);
    whole.extend(ahead);
    (whole, [first, last])
}

/// The error of the first parameter's value at a place of a curve where the second has its value.
///
/// A place that was found along the second parameter has an error in that: the first is uncertain
/// by as much as it changes along the curve until the second has changed by its error. Where the
/// curve turns in the second that grows as the root of the error.
fn error_across(plane: &ReturnPlane<'_>, points: &[Traced], n: usize) -> f64 {
    let Traced { at, axis, error, .. } = &points[n];
    if *axis == 0 {
        return *error;
    }
    let ways: Vec<[f64; 2]> = [n.wrapping_sub(1), n + 1]
        .iter()
        .filter_map(|k| points.get(*k).map(|it| plane.way(*at, it.at)))
        .collect();
    let slopes: Vec<f64> = ways.iter().map(|[across, up]| up / across).collect();
    let (slope, bend) = match (&slopes[..], &ways[..]) {
        ([one, other], [before, after]) => {
            let bend = 2.0 * (other - one) / (after[0] - before[0]);
            // The chords' slopes, each at its middle, taken to the place between them.
            ((one * after[0] - other * before[0]) / (after[0] - before[0]), bend.abs())
        }
        ([one], _) => (*one, 0.0),
        _ => return f64::INFINITY,
    };
    let error = error / plane.width(1);
    let steep = slope.abs();
    // A parabola changes by its error within these: near its top, and where its slope decides.
    let is_steep = steep * steep >= 4.0 * bend * error;
    let far = if is_steep { 1.2 * error / steep } else { 4.5 * libm::sqrt(error / bend) };
    far * plane.width(0)
}
