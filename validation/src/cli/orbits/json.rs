//! Orbits and branches as JSON.

use crate::cli::shared::model::ParametersJson;
use percuss::dynamics::continuation::{Bifurcation, Branch, BranchPoint};
use percuss::dynamics::orbit::Orbit;
use percuss::dynamics::strobe::StrobePoint;
use percuss::{Model, Parameter, Phase};
use serde::Serialize;

/// The JSON of `orbit`; if no orbit was found, the lists are empty and the numbers null.
#[derive(Serialize)]
pub(super) struct OrbitJson {
    pub(super) schema: u32,
    pub(super) percuss: &'static str,
    pub(super) parameters: ParametersJson,
    pub(super) converged: bool,
    pub(super) period: Option<u32>,
    pub(super) points: Vec<StrobePoint>,
    pub(super) phases: Vec<&'static str>,
    pub(super) multipliers: Vec<[f64; 2]>,
    pub(super) stable: Option<bool>,
    /// The smallest residual that was reached; null where it is not finite.
    pub(super) residual: f64,
    pub(super) drift_per_period: Option<f64>,
}

impl OrbitJson {
    pub(super) fn new(model: &Model, orbit: Result<&Orbit, f64>) -> Self {
        let found = orbit.ok();
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION"),
            parameters: model.parameters().into(),
            converged: found.is_some(),
            period: found.map(Orbit::period),
            points: found.map(|it| it.points.clone()).unwrap_or_default(),
            phases: found.map(tokens).unwrap_or_default(),
            multipliers: found.map(|it| it.multipliers.to_vec()).unwrap_or_default(),
            stable: found.map(Orbit::is_stable),
            residual: orbit.map_or_else(|least| least, |it| it.residual),
            drift_per_period: found.map(|it| it.drift_per_period),
        }
    }
}

/// The JSON of `orbit --all`; no orbits where none was found.
#[derive(Serialize)]
pub(super) struct OrbitsJson {
    schema: u32,
    percuss: &'static str,
    parameters: ParametersJson,
    orbits: Vec<ListedOrbit>,
}

/// An orbit of a list.
#[derive(Serialize)]
struct ListedOrbit {
    period: u32,
    points: Vec<StrobePoint>,
    phases: Vec<&'static str>,
    multipliers: [[f64; 2]; 3],
    stable: bool,
    residual: f64,
    drift_per_period: f64,
}

impl OrbitsJson {
    pub(super) fn new(model: &Model, orbits: &[Orbit]) -> Self {
        let listed = |orbit: &Orbit| ListedOrbit {
            period: orbit.period(),
            points: orbit.points.clone(),
            phases: tokens(orbit),
            multipliers: orbit.multipliers,
            stable: orbit.is_stable(),
            residual: orbit.residual,
            drift_per_period: orbit.drift_per_period,
        };
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION"),
            parameters: model.parameters().into(),
            orbits: orbits.iter().map(listed).collect(),
        }
    }
}

fn tokens(orbit: &Orbit) -> Vec<&'static str> {
    orbit.phases.iter().copied().map(Phase::as_str).collect()
}

/// The JSON of `continue`.
#[derive(Serialize)]
pub(crate) struct Followed {
    pub(crate) schema: u32,
    pub(crate) percuss: &'static str,
    pub(crate) parameters: ParametersJson,
    pub(crate) period: Option<u32>,
    #[serde(flatten)]
    pub(crate) branch: BranchJson,
    /// The doubled orbit, where `--doubled` asks for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) doubled: Option<Option<Doubled>>,
}

/// A branch.
#[derive(Default, Serialize)]
pub(crate) struct BranchJson {
    pub(crate) complete: bool,
    pub(crate) branch: Vec<JsonPlace>,
    pub(crate) bifurcations: Vec<Special>,
}

/// The branch of twice the period at the first flip.
#[derive(Serialize)]
pub(crate) struct Doubled {
    pub(crate) at: f64,
    pub(crate) criticality: &'static str,
    pub(crate) period: u32,
    #[serde(flatten)]
    pub(crate) branch: BranchJson,
}

#[derive(Serialize)]
pub(crate) struct JsonPlace {
    pub(crate) parameter: f64,
    pub(crate) point: StrobePoint,
    pub(crate) multipliers: [[f64; 2]; 3],
    pub(crate) stable: bool,
    pub(crate) drift_per_period: f64,
}

#[derive(Serialize)]
pub(crate) struct Special {
    pub(crate) r#type: &'static str,
    parameter: &'static str,
    pub(crate) value: f64,
    pub(crate) error: f64,
    period: u32,
    pub(crate) point: StrobePoint,
    multipliers: [[f64; 2]; 3],
    multipliers_beyond: Option<[[f64; 2]; 3]>,
    turns: bool,
}

impl BranchJson {
    pub(crate) fn new(branch: &Branch, parameter: Parameter, complete: bool) -> Self {
        Self {
            complete,
            branch: branch.points.iter().map(JsonPlace::new).collect(),
            bifurcations: branch
                .bifurcations
                .iter()
                .map(|it| Special::new(it, parameter))
                .collect(),
        }
    }
}

impl JsonPlace {
    fn new(BranchPoint { value, orbit }: &BranchPoint) -> Self {
        Self {
            parameter: *value,
            point: orbit.points[0],
            multipliers: orbit.multipliers,
            stable: orbit.is_stable(),
            drift_per_period: orbit.drift_per_period,
        }
    }
}

impl Special {
    fn new(found: &Bifurcation, parameter: Parameter) -> Self {
        Self {
            r#type: found.kind.as_str(),
            parameter: parameter.as_str(),
            value: found.value,
            error: found.error,
            period: found.orbit.period(),
            point: found.orbit.points[0],
            multipliers: found.orbit.multipliers,
            multipliers_beyond: found.beyond.as_ref().map(|it| it.multipliers),
            turns: found.turns,
        }
    }
}
