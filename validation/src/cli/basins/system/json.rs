//! The attractors of a system as JSON.

use super::super::json::{BOX_CELLS, EntropyJson, MAX_POINTS, UncertaintyJson};
use super::Survey;
use crate::cli::shared::drift;
use percuss::System;
use percuss::affine::{Return, ReturnAttractor, UnresolvedReturn};
use percuss::dynamics::attractor::{Label, entropy_of_labels, uncertainty_of_labels};
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
pub(in crate::cli) struct Json<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    parameters: &'a BTreeMap<String, f64>,
    states: &'a [String],
    section: &'a str,
    axes: [&'a str; 2],
    grid: [u32; 2],
    window: [f64; 4],
    transient: u64,
    attractors: Vec<AttractorJson<'a>>,
    unresolved: f64,
    inadmissible: f64,
    ended: f64,
    unresolved_examples: Vec<UnresolvedJson<'a>>,
    uncertainty: UncertaintyJson,
    basin_entropy: EntropyJson,
}

#[derive(Serialize)]
struct AttractorJson<'a> {
    id: i32,
    kind: &'static str,
    period: Option<usize>,
    fraction: f64,
    fraction_error: f64,
    points: Vec<PointJson<'a>>,
    multipliers: Vec<[f64; 2]>,
    /// Null is minus infinity; of what rests or escapes it is not known.
    lyapunov_per_return: f64,
    lyapunov_error: f64,
    /// Null of what rests or escapes.
    drift_per_return: BTreeMap<&'a str, f64>,
    /// Null where the drift is not a mean over a run.
    drift_standard_error: BTreeMap<&'a str, f64>,
}

#[derive(Serialize)]
struct PointJson<'a> {
    mode: &'a str,
    state: &'a [f64],
}

/// A start that was not recognised.
#[derive(Serialize)]
struct UnresolvedJson<'a> {
    point: PointJson<'a>,
    lyapunov_per_return: f64,
    recurrence: Option<u32>,
}

impl<'a> Json<'a> {
    pub(in crate::cli) fn new(survey: &'a Survey) -> Self {
        let Survey { system, limits, basins, section } = survey;
        let plane = &basins.plane;
        let listed = basins.attractors.iter().enumerate();
        let mut attractors: Vec<_> =
            listed.map(|(id, it)| AttractorJson::new(survey, id, it)).collect();
        if basins.fraction(Label::Escaping) > 0.0 {
            attractors.push(AttractorJson::escaping(survey));
        }
        let [[left, right], [low, high]] = plane.window;
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION"),
            system: &system.name,
            parameters: &system.parameters,
            states: &system.states,
            section,
            axes: survey.axes(),
            grid: [plane.columns, plane.rows],
            window: [left, right, low, high],
            transient: limits.transient,
            attractors,
            unresolved: basins.fraction(Label::Unresolved),
            inadmissible: basins.fraction(Label::Inadmissible),
            ended: basins.fraction(Label::Ended),
            unresolved_examples: {
                let of = |it| UnresolvedJson::new(system, it);
                basins.unresolved.iter().map(of).collect()
            },
            uncertainty: UncertaintyJson::new(&uncertainty_of_labels(
                &basins.labels,
                plane.columns as usize,
            )),
            basin_entropy: EntropyJson::new(&entropy_of_labels(
                &basins.labels,
                plane.columns as usize,
                BOX_CELLS,
            )),
        }
    }
}

impl<'a> AttractorJson<'a> {
    fn new(survey: &'a Survey, id: usize, attractor: &'a ReturnAttractor) -> Self {
        let points = &attractor.points;
        let from =
            if attractor.orbit.is_some() { 0 } else { points.len().saturating_sub(MAX_POINTS) };
        let label = Label::Attractor(id);
        let orbit = attractor.orbit.iter();
        Self {
            id: label.number(),
            kind: attractor.kind.as_str(),
            period: attractor.period(),
            fraction: survey.basins.fraction(label),
            fraction_error: survey.basins.fraction_error(label),
            points: points[from..].iter().map(|it| PointJson::new(&survey.system, it)).collect(),
            multipliers: orbit.flat_map(|it| it.multipliers.iter().copied()).collect(),
            lyapunov_per_return: attractor.lyapunov_per_return,
            lyapunov_error: attractor.lyapunov_error,
            drift_per_return: drift::by_name(&survey.system, &attractor.drift_per_return),
            drift_standard_error: drift::by_name(&survey.system, &attractor.drift_standard_error),
        }
    }

    fn escaping(survey: &'a Survey) -> Self {
        Self {
            id: Label::Escaping.number(),
            kind: "escaping",
            period: None,
            fraction: survey.basins.fraction(Label::Escaping),
            fraction_error: survey.basins.fraction_error(Label::Escaping),
            points: Vec::new(),
            multipliers: Vec::new(),
            lyapunov_per_return: f64::NAN,
            lyapunov_error: f64::NAN,
            drift_per_return: drift::by_name(&survey.system, &[]),
            drift_standard_error: drift::by_name(&survey.system, &[]),
        }
    }
}

impl<'a> PointJson<'a> {
    fn new(system: &'a System, point: &'a Return<f64>) -> Self {
        Self { mode: &system.modes[point.mode].name, state: &point.state }
    }
}

impl<'a> UnresolvedJson<'a> {
    fn new(system: &'a System, start: &'a UnresolvedReturn) -> Self {
        let UnresolvedReturn { point, lyapunov_per_return, recurrence } = start;
        let point = PointJson::new(system, point);
        Self { point, lyapunov_per_return: *lyapunov_per_return, recurrence: *recurrence }
    }
}
