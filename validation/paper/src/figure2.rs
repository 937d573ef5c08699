//! Fig. 2: the drift is taken out of the motion.

use super::claim::{Claim, ClaimVerdict};
use super::curve::{self, HEADER};
use super::item_work::{Findings, ItemWork, from_rest};
use super::paper::table_1_model;
use crate::engine::Failure;
use crate::picture::{Figure, Layer, MotionPiece, Plot, Stroke, caption};
use percuss::Phase;

const PERIODS: u64 = 12;
/// Points per forcing period.
const POINTS_PER_PERIOD: f64 = 600.0;
/// Rounding of the sampled drift, in units of eps: it is one sum of two words.
const DRIFT_ROUNDINGS: f64 = 4.0;

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    // The paper prints no parameters for Fig. 2, so those of Fig. 3 are assumed.
    let parameters = table_1_model();
    let (model, rest) = from_rest(parameters)?;
    let end = rest.instant.after_periods(PERIODS, 1);
    let segments: Vec<_> = model.trajectory(rest).until(end).collect();
    let pieces = curve::pieces(&segments, &end, parameters.omega, POINTS_PER_PERIOD);
    let mut findings = Findings::default();
    findings.claims.push(settle(work, &pieces)?);
    findings.picture("figure-2", &drawing(&pieces, &caption(&parameters)))?;
    findings.csv("figure-2", &HEADER, curve::rows(&pieces))?;
    Ok(findings)
}

fn settle(work: &ItemWork<'_>, pieces: &[MotionPiece]) -> Result<Claim, Failure> {
    let points = || pieces.iter().flat_map(|piece| &piece.points);
    let range = |of: fn(&[f64; 5]) -> f64| {
        let fold = |(low, high): (f64, f64), it: f64| (low.min(it), high.max(it));
        points().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), fold)
    };
    let (p_low, p_high) = range(|at| at[1]);
    let (_, x_high) = range(|at| at[1] + at[4]);
    let rest = |piece: &&MotionPiece| piece.phase != Phase::Progression;
    let still = |piece: &MotionPiece| {
        let (first, last) = (piece.points[0][4], piece.points[piece.points.len() - 1][4]);
        (first - last).abs() <= DRIFT_ROUNDINGS * f64::EPSILON * first.abs()
    };
    let treads_are_level = pieces.iter().filter(rest).all(still);
    let never_falls = points()
        .zip(points().skip(1))
        .all(|(now, next)| next[4] - now[4] >= -DRIFT_ROUNDINGS * f64::EPSILON * now[4].abs());
    let risers = pieces.iter().filter(|piece| piece.phase == Phase::Progression).count();
    let gained = points().last().map_or(0.0, |at| at[4]);
    // x grows with v while p stays: its range does not grow from the first half to the second.
    let half = pieces.len() / 2;
    let reach = |pieces: &[MotionPiece]| {
        pieces.iter().flat_map(|piece| &piece.points).map(|at| at[1].abs()).fold(0.0, f64::max)
    };
    let bounded = reach(&pieces[half..]) <= 2.0 * reach(&pieces[..half]);
    let drifts = gained > p_high - p_low;
    let holds = treads_are_level && never_falls && bounded && drifts && risers > 1;
    let computed = format!(
        "in {PERIODS} periods v rises by {gained:.4} in {risers} steps, level between; p stays in \
         [{p_low:.3}, {p_high:.3}]; x reaches {x_high:.3}"
    );
    let claim = Claim::settle(&work.paper, "fig2", ClaimVerdict::new(holds), computed)?;
    Ok(claim.note("parameters assumed: those of Figs. 3 and 4, from rest").evidence(
        "exact solver, every phase sampled",
        "v constant outside progression, never falling",
    ))
}

fn drawing(pieces: &[MotionPiece], parameters: &str) -> Figure {
    let plot = |title: &str, label: &str, layers: Vec<Layer>| Plot {
        title: title.to_owned(),
        axes: ["\u{3c4}".to_owned(), label.to_owned()],
        window: None,
        layers,
    };
    let mut drifting = curve::lines(pieces, |at| [at[0], at[1] + at[4]]);
    drifting.push(Layer::Line {
        points: pieces.iter().flat_map(|piece| &piece.points).map(|at| [at[0], at[4]]).collect(),
        colour: crate::picture::INK,
        width: 1.5,
        stroke: Stroke::Dashed,
    });
    Figure {
        title: "Fig. 2: drifting displacement, bounded displacement, progression".to_owned(),
        caption: format!(
            "{parameters}; from rest, {PERIODS} forcing periods. (a) x and, dashed, the slider's bottom v; (b) p = x - v; \
             (c) v. Blue dash-dotted: no contact; orange: contact; purple: progression. \
             The paper prints no parameters for this figure: assumed are those of Fig. 3."
        ),
        columns: 1,
        panel: (760, 330),
        plots: vec![
            plot("(a)", "x, v", drifting),
            plot("(b)", "p", curve::lines(pieces, |at| [at[0], at[1]])),
            plot("(c)", "v", curve::lines(pieces, |at| [at[0], at[4]])),
        ],
    }
}
