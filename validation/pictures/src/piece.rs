//! A phase's motion as points to be drawn.

use percuss::{Phase, Segment};

/// The sampled motion of one phase.
#[derive(Clone, Debug)]
pub struct MotionPiece {
    /// The phase.
    pub phase: Phase,
    /// tau, p, y, q, v.
    pub points: Vec<[f64; 5]>,
}

/// The fewest points of a phase, however short.
const MIN_POINTS: usize = 12;

impl MotionPiece {
    /// A phase from where it `begins` for as long as it `lasts`, both in tau, in about so many
    /// `points`.
    #[must_use]
    pub fn new(segment: &Segment, begins: f64, lasts: f64, points: f64) -> Self {
        let count = points.ceil();
        let count = if count.is_finite() { (count as usize).max(MIN_POINTS) } else { MIN_POINTS };
        let point = |i: usize| {
            let elapsed = lasts * (i as f64 / count as f64);
            let at = segment.at(elapsed);
            [begins + elapsed, at.state.p, at.state.y, at.state.q, at.v]
        };
        Self { phase: segment.phase(), points: (0..=count).map(point).collect() }
    }
}
