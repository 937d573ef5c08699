//! Fig. 3: the phase plane of the motion of Table 1, and the zoom of its stick-slip part.

use super::super::claim::{Claim, ClaimVerdict};
use super::super::curve;
use super::super::item_work::ItemWork;
use super::super::paper::TABLE_1_UNIT;
use super::Table1Run;
use crate::engine::Failure;
use crate::picture::{Figure, INK, Layer, MotionPiece, Plot, PlotWindow, caption};
use percuss::Phase;

/// The zoom: where the slider is met, compressed and left.
const ZOOM_WINDOW: PlotWindow = [(-0.1, 1.15), (-2.0, 6.2)];

/// Rounding of y in progression, in units of eps and of the largest y: it is a sum of four terms,
/// none larger than twice that, and zero where the phase ends.
const VELOCITY_ROUNDINGS: f64 = 8.0;

pub(super) fn settle(
    work: &ItemWork<'_>,
    told: &Table1Run,
    pieces: &[MotionPiece],
) -> Result<Claim, Failure> {
    let g = told.parameters().g;
    let of = |phase: Phase| pieces.iter().filter(move |piece| piece.phase == phase);
    let points = |phase: Phase| of(phase).flat_map(|piece| &piece.points);
    // Just after separation the slider's top is still on its way back.
    let right = points(Phase::NoContact).filter(|at| at[1] > g).count();
    let share = right as f64 / points(Phase::NoContact).count().max(1) as f64;
    let lowest = points(Phase::Progression).map(|at| at[2]).fold(f64::INFINITY, f64::min);
    let highest = points(Phase::Progression).map(|at| at[2]).fold(0.0, f64::max);
    let room = VELOCITY_ROUNDINGS * f64::EPSILON * highest;
    let forward = points(Phase::Progression).all(|at| at[2] >= -room);
    let settled = of(Phase::Progression).flat_map(|piece| piece.points.last());
    let apart = settled.map(|at| (at[1] - (g + 1.0)).abs()).fold(0.0, f64::max);
    let phases = pieces.len();
    let holds = phases == 8 && share < 0.01 && forward && apart < 1e-5;
    let computed = format!(
        "{phases} phases a period; y falls to {:.5} in progression, which ends within {apart:.1e} of p = 1.02; {:.2} % of the points \
         without contact lie right of p = {g}, just after separation",
        // No minus sign before a zero.
        (lowest / TABLE_1_UNIT).round() * TABLE_1_UNIT + 0.0,
        100.0 * share
    );
    Ok(Claim::settle(&work.paper, "fig3", ClaimVerdict::new(holds), computed)?
        .note("drawn over rows 1 to 9 of Table 1, as the paper does")
        .evidence("exact solver, every phase sampled", "figures-3-4.csv")
        .evidence(
            "the least y of all samples in progression",
            format!(
                "{lowest:.1e}: y is zero where progression ends, and rounding accounts for up to {room:.0e}"
            ),
        ))
}

/// A point of Table 1 with its number; points in one place share a label, one below another has its
/// own below.
fn labelled(points: &[[f64; 2]], i: usize) -> Vec<Layer> {
    let [p, y] = points[i];
    let here = |point: &[f64; 2]| (point[0] - p).hypot(point[1] - y) < 0.05;
    let above =
        |point: &[f64; 2]| (point[0] - p).abs() < 0.05 && (0.05..0.5).contains(&(point[1] - y));
    let shared: Vec<_> = (0..points.len()).filter(|j| here(&points[*j])).collect();
    let mut layers = vec![Layer::Dots { points: vec![[p, y]], colour: INK, size: 3.5 }];
    if shared.first() == Some(&i) {
        let numbers: Vec<_> = shared.iter().map(|j| (j + 1).to_string()).collect();
        let lower = if points.iter().any(above) { 0.55 } else { 0.0 };
        layers.push(Layer::Text { at: [p, y - lower], text: numbers.join(", "), colour: INK });
    }
    layers
}

pub(super) fn drawing(told: &Table1Run, pieces: &[MotionPiece]) -> Figure {
    let plane = |at: &[f64; 5]| [at[1], at[2]];
    let mut whole = curve::lines(pieces, plane);
    whole.push(curve::key());
    let mut zoom = curve::lines(pieces, plane);
    let at: Vec<[f64; 2]> = told.segments[..told.segments.len() - 1]
        .iter()
        .map(|segment| [segment.entry().state.p, segment.entry().state.y])
        .collect();
    let numbered = (0..at.len()).flat_map(|i| labelled(&at, i));
    zoom.extend(numbered);
    let plot = |title: &str, window: Option<PlotWindow>, layers: Vec<Layer>| Plot {
        title: title.to_owned(),
        axes: ["p".to_owned(), "y".to_owned()],
        window,
        layers,
    };
    Figure {
        title: "Fig. 3: phase plane of the period-two motion".to_owned(),
        caption: format!(
            "{}; from row 1 to row 9 of Table 1, {:.5} <= \u{3c4} <= {:.5}. Right: the stick-slip part, points 1 to 8 of Table 1.",
            caption(told.parameters()),
            told.tau(0),
            told.tau(told.segments.len() - 1)
        ),
        columns: 2,
        panel: (760, 600),
        plots: vec![plot("", None, whole), plot("zoom", Some(ZOOM_WINDOW), zoom)],
    }
}
