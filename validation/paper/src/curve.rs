//! A run as lines in the paper's notation: no contact dash-dotted, contact solid, progression
//! dotted.

use crate::number::shortest;
use crate::picture::{KeyEntry, Layer, MotionPiece, Stroke, phase_colour};
use percuss::{Exit, Instant, Phase, Segment};

/// The phases of a run up to `last`, some `per_period` points a forcing period.
pub(super) fn pieces(
    segments: &[Segment],
    last: &Instant,
    omega: f64,
    per_period: f64,
) -> Vec<MotionPiece> {
    let spacing = std::f64::consts::TAU / omega / per_period;
    let piece = |segment: &Segment| {
        let lasts = match segment.exit() {
            Exit::Switch(next) if next.instant <= *last => segment.duration(),
            _ => segment.elapsed_at(last),
        };
        let begins = segment.entry().instant.tau(omega);
        MotionPiece::new(segment, begins, lasts, lasts / spacing)
    };
    segments.iter().map(piece).collect()
}

/// The paper's line for a phase.
pub(super) const fn stroke(phase: Phase) -> Stroke {
    match phase {
        Phase::NoContact => Stroke::DashDotted,
        Phase::Contact => Stroke::Solid,
        Phase::Progression => Stroke::Dotted,
    }
}

/// Lines of the figures that `of` makes of a point.
pub(super) fn lines(pieces: &[MotionPiece], of: impl Fn(&[f64; 5]) -> [f64; 2]) -> Vec<Layer> {
    let line = |piece: &MotionPiece| Layer::Line {
        points: piece.points.iter().map(&of).collect(),
        colour: phase_colour(piece.phase),
        width: if piece.phase == Phase::Progression { 3.0 } else { 2.0 },
        stroke: stroke(piece.phase),
    };
    pieces.iter().map(line).collect()
}

/// The phases' key.
pub(super) fn key() -> Layer {
    let entry = |phase: Phase| KeyEntry {
        name: phase.as_str().replace('-', " "),
        colour: phase_colour(phase),
        stroke: Some(stroke(phase)),
    };
    Layer::Key(Phase::ALL.map(entry).to_vec())
}

/// Rows of a data file: phase, tau, p, y, q, v.
pub(super) fn rows(pieces: &[MotionPiece]) -> impl Iterator<Item = Vec<String>> {
    pieces.iter().flat_map(|piece| {
        piece.points.iter().map(|point| {
            let numbers = point.iter().copied().map(shortest);
            std::iter::once(piece.phase.as_str().to_owned()).chain(numbers).collect()
        })
    })
}

/// The header of the rows.
pub(super) const HEADER: [&str; 6] = ["phase", "tau", "p", "y", "q", "v"];
