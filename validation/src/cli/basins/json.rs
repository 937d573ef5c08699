//! The attractors as JSON.

use super::Survey;
use crate::cli::shared::model::ParametersJson;
use percuss::dynamics::attractor::{
    Attractor, Basins, Entropy, Label, Uncertainty, UnresolvedStart, entropy, uncertainty,
};
use percuss::dynamics::strobe::StrobePoint;
use serde::Serialize;

#[derive(Serialize)]
pub(in crate::cli) struct Json {
    schema: u32,
    percuss: &'static str,
    parameters: ParametersJson,
    grid: [u32; 2],
    window: [f64; 4],
    q: f64,
    tau: f64,
    cycle: i64,
    transient: u64,
    pub(in crate::cli) attractors: Vec<AttractorJson>,
    pub(in crate::cli) unresolved: f64,
    unresolved_examples: Vec<UnresolvedJson>,
    uncertainty: UncertaintyJson,
    basin_entropy: EntropyJson,
}

#[derive(Serialize)]
pub(in crate::cli) struct AttractorJson {
    pub(in crate::cli) id: i32,
    pub(in crate::cli) kind: &'static str,
    pub(in crate::cli) period: Option<u32>,
    pub(in crate::cli) fraction: f64,
    pub(in crate::cli) fraction_error: f64,
    pub(in crate::cli) points: Vec<StrobePoint>,
    pub(in crate::cli) drift_per_period: f64,
    /// Null where the drift is not a mean over a run.
    pub(in crate::cli) drift_standard_error: Option<f64>,
    multipliers: Vec<[f64; 2]>,
    pub(in crate::cli) lyapunov_per_period: f64,
    pub(in crate::cli) lyapunov_error: f64,
}

/// A start that was not recognised.
#[derive(Serialize)]
struct UnresolvedJson {
    point: StrobePoint,
    lyapunov_per_period: f64,
    recurrence: Option<u32>,
}

#[derive(Serialize)]
pub(super) struct UncertaintyJson {
    epsilon: Vec<f64>,
    uncertain: Vec<f64>,
    exponent: f64,
    error: f64,
    dimension: f64,
}

#[derive(Serialize)]
pub(super) struct EntropyJson {
    side: u32,
    all: f64,
    boundary: f64,
    boundary_error: f64,
    boundary_boxes: u64,
}

/// The most strobes that are written of an attractor that is no orbit.
pub(super) const MAX_POINTS: usize = 1000;
/// Cells along the side of a box of the basin entropy, as in its authors' paper.
pub(super) const BOX_CELLS: u32 = 5;

impl Json {
    pub(in crate::cli) fn new(survey: &Survey) -> Self {
        let Survey { problem, limits, basins, unresolved } = survey;
        let Basins { grid, attractors, .. } = basins;
        let parameters = problem.model.parameters();
        let listed = attractors.iter().enumerate();
        let mut entries: Vec<_> =
            listed.map(|(id, it)| AttractorJson::new(basins, Label::Attractor(id), it)).collect();
        if basins.fraction(Label::Escaping) > 0.0 {
            entries.push(AttractorJson::escaping(basins, parameters.b));
        }
        let [[p_low, p_high], [y_low, y_high]] = [grid.window.p, grid.window.y];
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION"),
            parameters: parameters.into(),
            grid: [grid.columns, grid.rows],
            window: [p_low, p_high, y_low, y_high],
            q: grid.q,
            tau: problem.start.tau,
            cycle: problem.start.cycle,
            transient: limits.transient,
            attractors: entries,
            unresolved: basins.fraction(Label::Unresolved),
            unresolved_examples: unresolved.iter().map(UnresolvedJson::new).collect(),
            uncertainty: UncertaintyJson::new(&uncertainty(basins)),
            basin_entropy: EntropyJson::new(&entropy(basins, BOX_CELLS)),
        }
    }
}

impl AttractorJson {
    fn new(basins: &Basins, label: Label, attractor: &Attractor) -> Self {
        let points = &attractor.points;
        let from =
            if attractor.orbit.is_some() { 0 } else { points.len().saturating_sub(MAX_POINTS) };
        Self {
            id: label.number(),
            kind: attractor.kind.as_str(),
            period: attractor.period(),
            fraction: basins.fraction(label),
            fraction_error: basins.fraction_error(label),
            points: points[from..].to_vec(),
            drift_per_period: attractor.drift_per_period,
            drift_standard_error: attractor
                .orbit
                .is_none()
                .then_some(attractor.drift_standard_error),
            multipliers: attractor.orbit.iter().flat_map(|orbit| orbit.multipliers).collect(),
            lyapunov_per_period: attractor.lyapunov_per_period,
            lyapunov_error: attractor.lyapunov_error,
        }
    }

    /// Below b = 1 the slider always stops, so it is the mass that leaves, and the drift is zero; a
    /// slider that never stops gathers speed.
    fn escaping(basins: &Basins, b: f64) -> Self {
        Self {
            id: Label::Escaping.number(),
            kind: "escaping",
            period: None,
            fraction: basins.fraction(Label::Escaping),
            fraction_error: basins.fraction_error(Label::Escaping),
            points: Vec::new(),
            drift_per_period: if b < 1.0 { 0.0 } else { f64::INFINITY },
            drift_standard_error: None,
            multipliers: Vec::new(),
            // Errors of y stay, and shear p or v: they grow as time, not exponentially.
            lyapunov_per_period: 0.0,
            lyapunov_error: 0.0,
        }
    }
}

impl UnresolvedJson {
    fn new(start: &UnresolvedStart) -> Self {
        let UnresolvedStart { point, lyapunov_per_period, recurrence } = *start;
        Self { point, lyapunov_per_period, recurrence }
    }
}

impl UncertaintyJson {
    pub(super) fn new(uncertainty: &Uncertainty) -> Self {
        let scales = &uncertainty.scales;
        Self {
            epsilon: scales.iter().map(|scale| scale.epsilon).collect(),
            uncertain: scales.iter().map(|it| it.uncertain as f64 / it.starts as f64).collect(),
            exponent: uncertainty.exponent,
            error: uncertainty.error,
            dimension: uncertainty.dimension(),
        }
    }
}

impl EntropyJson {
    pub(super) fn new(entropy: &Entropy) -> Self {
        let Entropy { side, all, boundary, boundary_error, boundary_boxes } = *entropy;
        Self { side, all, boundary, boundary_error, boundary_boxes }
    }
}
