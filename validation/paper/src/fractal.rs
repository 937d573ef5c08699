//! Whether the basins' boundaries are fractal, and whether erosion grows with the frequency.

use super::attractors::{TRANSIENT_PERIODS, WINDOW, grid, map};
use super::claim::{Claim, ClaimVerdict};
use super::item_work::{Findings, ItemWork};
use crate::engine::Failure;
use crate::number::shortest;
use percuss::dynamics::attractor::{
    AttractorCatalog, Basins, Entropy, Uncertainty, entropy, uncertainty_of,
};

/// The frequencies of Fig. 7.
const OMEGAS: [f64; 6] = [1.4, 1.45, 1.56, 1.58, 1.60, 1.70];
/// Distances 2^-4 to 2^-16 of the window's width, so many starts at each.
const SCALE_EXPONENTS: std::ops::RangeInclusive<u32> = 4..=16;
const STARTS: u32 = 1200;
/// Cells a side for the entropy, and of its boxes.
const CELLS: u32 = 150;
const BOX_CELLS: u32 = 5;
/// Standard errors by which an exponent must be below one.
const STANDARD_ERRORS: f64 = 4.0;

/// The measurements at one frequency.
struct FrequencyMeasured {
    omega: f64,
    uncertainty: Uncertainty,
    entropy: Entropy,
}

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let mut measured = Vec::new();
    for omega in OMEGAS {
        measured.push(measure(omega)?);
        (work.step)();
    }
    let mut findings = Findings::default();
    let header = [
        "omega",
        "uncertainty_exponent",
        "error",
        "basin_entropy",
        "boundary_entropy",
        "boundary_boxes",
    ];
    findings.csv("fractal", &header, measured.iter().map(FrequencyMeasured::row))?;
    findings.claims.push(settle(work, &measured)?);
    Ok(findings)
}

fn measure(omega: f64) -> Result<FrequencyMeasured, Failure> {
    let map = map(omega)?;
    let mut catalog = AttractorCatalog::new(map, TRANSIENT_PERIODS);
    catalog.label_all(&grid(32).starts(), &|_| {});
    let uncertainty =
        uncertainty_of(|start| catalog.label(start), &WINDOW, 0.0, SCALE_EXPONENTS, STARTS);
    let basins = Basins::new(&map, &grid(CELLS), TRANSIENT_PERIODS, &|_| {});
    Ok(FrequencyMeasured { omega, uncertainty, entropy: entropy(&basins, BOX_CELLS) })
}

impl FrequencyMeasured {
    fn row(&self) -> Vec<String> {
        let numbers = [
            self.omega,
            self.uncertainty.exponent,
            self.uncertainty.error,
            self.entropy.all,
            self.entropy.boundary,
            self.entropy.boundary_boxes as f64,
        ];
        numbers.map(shortest).to_vec()
    }
}

fn settle(work: &ItemWork<'_>, measured: &[FrequencyMeasured]) -> Result<Claim, Failure> {
    let fractal = measured.iter().all(|it| it.uncertainty.is_fractal(STANDARD_ERRORS));
    let grows = |of: fn(&FrequencyMeasured) -> f64| {
        measured.windows(2).filter(|pair| of(&pair[1]) > of(&pair[0])).count()
    };
    let all = measured.len() - 1;
    let steps = [
        ("the boundary's dimension", grows(|it| it.uncertainty.dimension())),
        ("the basin entropy", grows(|it| it.entropy.all)),
        ("the share of boxes that hold a boundary", grows(|it| it.entropy.boundary_boxes as f64)),
    ];
    // The paper measures nothing: its words are settled only where all measures say the same.
    let verdict = match steps.iter().filter(|(_, count)| *count == all).count() {
        _ if !fractal => ClaimVerdict::Differs,
        3 => ClaimVerdict::Reproduced,
        0 => ClaimVerdict::Differs,
        _ => ClaimVerdict::NotDetermined,
    };
    let grown: Vec<_> = steps.iter().map(|(what, count)| format!("{what} in {count}")).collect();
    let said: Vec<_> = measured
        .iter()
        .map(|it| {
            format!(
                "{}: {:.3} +- {:.3}",
                it.omega,
                it.uncertainty.dimension(),
                it.uncertainty.error
            )
        })
        .collect();
    let entropies: Vec<_> =
        measured.iter().map(|it| format!("{}: {:.3}", it.omega, it.entropy.all)).collect();
    let computed = format!(
        "boundaries are {} at all six frequencies; of {all} steps of omega grow {}",
        if fractal { "fractal" } else { "not shown to be fractal" },
        grown.join(", ")
    );
    Ok(Claim::settle(&work.paper, "fractal", verdict, computed)?
        .note("the paper does not say how erosion is measured, and three measures do not tell the same of it")
        .evidence(
            format!("uncertainty exponent, {STARTS} starts at each of 13 distances down to 2^-16 of the window"),
            format!("dimension at omega = {}", said.join(", ")),
        )
        .evidence(
            format!("basin entropy, boxes of {BOX_CELLS} x {BOX_CELLS} cells of {CELLS} x {CELLS}"),
            format!("at omega = {}", entropies.join(", ")),
        ))
}
