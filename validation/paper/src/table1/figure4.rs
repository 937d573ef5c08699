//! Fig. 4: the progression over Table 1, by Eqs. (19) and (20) with the sign that Eq. (20) needs.

use super::super::claim::{Claim, ClaimVerdict};
use super::super::curve;
use super::super::item_work::ItemWork;
use super::Table1Run;
use crate::engine::Failure;
use crate::picture::{Figure, MotionPiece, Plot, caption};
use percuss::{Parameters, Phase};

/// Eq. (20) from a row of the table, `d` later; `sign` is that of its exponential term.
fn equation_20(parameters: &Parameters, row: [f64; 3], d: f64, sign: f64) -> f64 {
    let Parameters { a, b, xi, omega, g, phi } = *parameters;
    let [tau0, p0, y0] = row;
    let left = p0 - g - 1.0;
    let angle = |tau: f64| omega * tau + phi;
    let bracket = angle(tau0 + d).cos() - angle(tau0).cos() + omega * d * angle(tau0).sin();
    let exponential = left * (-d / (2.0 * xi)).exp();
    left + sign * exponential + y0 * d + (b - 1.0) / 2.0 * d * d - a / (omega * omega) * bracket
}

/// What is left of the digits of rows printed to five decimals, after a progression some 7 long: an
/// error of half a unit in tau0 and y0 times it.
const PRINTED_ROW_TOLERANCE: f64 = 1e-4;

pub(super) fn settle(
    work: &ItemWork<'_>,
    told: &Table1Run,
    pieces: &[MotionPiece],
) -> Result<Claim, Failure> {
    let printed = &work.paper.table1;
    let (mut worst, mut jump) = (0.0_f64, 0.0_f64);
    let mut gains = Vec::new();
    for (i, segment) in told.segments[..told.segments.len() - 1].iter().enumerate() {
        let gained = told.segments[i + 1].entry().v() - segment.entry().v();
        if segment.phase() != Phase::Progression {
            worst = worst.max(gained.abs());
            continue;
        }
        let row = [printed[i].tau, printed[i].p, printed[i].y];
        let lasts = printed[i + 1].tau - printed[i].tau;
        worst = worst.max((equation_20(told.parameters(), row, lasts, -1.0) - gained).abs());
        jump = jump.max(equation_20(told.parameters(), row, 0.0, 1.0).abs());
        gains.push(gained);
    }
    let total: f64 = gains.iter().sum();
    let risers = pieces.iter().filter(|piece| piece.phase == Phase::Progression).count();
    let holds = worst <= PRINTED_ROW_TOLERANCE && gains.len() == risers;
    let gains: Vec<_> = gains.iter().map(|gain| format!("{gain:.4}")).collect();
    let computed = format!(
        "v rises by {} in the progressions of Table 1, {total:.4} together, and is level between",
        gains.join(" and ")
    );
    Ok(Claim::settle(&work.paper, "fig4", ClaimVerdict::new(holds), computed)?
        .note(format!(
            "Eq. (20) needs - (p0 - g - 1) exp(...): as printed, with +, v would jump by up to {jump:.4} where progression begins"
        ))
        .evidence("Eqs. (19) and (20), that sign mended, from the printed rows", format!("within {worst:.0e} of the exact solver"))
        .evidence("Eq. (20) as printed", format!("v(tau0) is off v0 by {jump:.4}")))
}

pub(super) fn drawing(told: &Table1Run, pieces: &[MotionPiece]) -> Figure {
    let start = told.segments[0].entry().v();
    let mut layers = curve::lines(pieces, |at| [at[0], at[4] - start]);
    layers.push(curve::key());
    Figure {
        title: "Fig. 4: reconstructed progression".to_owned(),
        caption: format!(
            "{}; over Table 1, counted from its row 1. Eq. (20) with the sign of its exponential term mended.",
            caption(told.parameters())
        ),
        columns: 1,
        panel: (760, 560),
        plots: vec![Plot {
            title: String::new(),
            axes: ["\u{3c4}".to_owned(), "v".to_owned()],
            window: None,
            layers,
        }],
    }
}
