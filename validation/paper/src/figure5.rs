//! Fig. 5: the chaotic phase portrait.

use super::claim::{Claim, ClaimVerdict};
use super::curve::{self, HEADER};
use super::item_work::{Findings, ItemWork, from_rest};
use super::paper::chaotic_model;
use crate::engine::Failure;
use crate::picture::{Figure, Layer, MotionPiece, Plot, caption};
use percuss::{Parameters, Phase};

const TRANSIENT: u64 = 100;
const PERIODS: u64 = 40;
const POINTS_PER_PERIOD: f64 = 200.0;
/// Rounding of p on the surface, and what the slider still has to close after an impact.
const SURFACE_TOLERANCE: f64 = 1e-12;

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let parameters = chaotic_model();
    let (model, rest) = from_rest(parameters)?;
    let begin = rest.instant.after_periods(TRANSIENT, 1);
    let end = begin.after_periods(PERIODS, 1);
    let segments: Vec<_> =
        model.trajectory(rest).until(end).filter(|segment| !segment.ends_by(&begin)).collect();
    let pieces = curve::pieces(&segments, &end, parameters.omega, POINTS_PER_PERIOD);
    let mut findings = Findings::default();
    findings.claims.push(settle(work, &pieces, &parameters)?);
    findings.picture("figure-5", &drawing(&pieces, &parameters))?;
    findings.csv("figure-5", &HEADER, curve::rows(&pieces))?;
    Ok(findings)
}

fn settle(
    work: &ItemWork<'_>,
    pieces: &[MotionPiece],
    parameters: &Parameters,
) -> Result<Claim, Failure> {
    let g = parameters.g;
    let of = |phase: Phase| {
        pieces.iter().filter(move |piece| piece.phase == phase).flat_map(|piece| &piece.points)
    };
    let count = of(Phase::NoContact).count();
    let right = of(Phase::NoContact).filter(|at| at[1] > g + SURFACE_TOLERANCE).count();
    let farthest = of(Phase::NoContact).map(|at| at[1] - g).fold(0.0, f64::max);
    let between = of(Phase::Contact)
        .filter(|at| !(g - SURFACE_TOLERANCE..=g + 1.0 + SURFACE_TOLERANCE).contains(&at[1]))
        .count();
    let settled = of(Phase::Progression).map(|at| at[1]).fold(0.0, f64::max);
    let share = right as f64 / count.max(1) as f64;
    let reached = (g + 1.0 - settled).abs() < 1e-3;
    // The slider's top still returns just after separation: p = g + q there, q > 0.
    let holds = share < 0.1 && between == 0 && reached;
    let computed = format!(
        "no contact lies left of p = g but for {:.1} % of its points, just after separation, which reach p = g + {farthest:.4} \
         while the slider's top returns; contact between p = g and g + 1; progression reaches p = {settled:.6}",
        100.0 * share
    );
    Ok(Claim::settle(&work.paper, "fig5", ClaimVerdict::new(holds), computed)?
        .note(format!("from rest, after {TRANSIENT} periods"))
        .evidence("exact solver, every phase sampled", "each phase's range of p"))
}

fn drawing(pieces: &[MotionPiece], parameters: &Parameters) -> Figure {
    let mut layers = curve::lines(pieces, |at| [at[1], at[2]]);
    layers.extend([Layer::Guide(parameters.g), Layer::Guide(parameters.g + 1.0)]);
    layers.push(curve::key());
    Figure {
        title: "Fig. 5: chaotic motion on the phase plane".to_owned(),
        caption: format!(
            "{}; {PERIODS} forcing periods after {TRANSIENT}, from rest. Dashed: p = g and p = g + 1.",
            caption(parameters)
        ),
        columns: 1,
        panel: (760, 620),
        plots: vec![Plot {
            title: String::new(),
            axes: ["p".to_owned(), "y".to_owned()],
            window: None,
            layers,
        }],
    }
}
