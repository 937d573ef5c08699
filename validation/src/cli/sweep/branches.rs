//! `continue` at the points of a sweep.

use crate::cli::orbits::follow::{Arguments, Reporting, family, follow_branch};
use crate::cli::orbits::json::{BranchJson, Followed, JsonPlace, Special};
use crate::sweep::{Array, SweepPoint, SweepVerb, records};
use anyhow::Result;

/// A branch at each point; a point is one tile.
pub(super) struct BranchWork {
    arguments: Arguments,
}

impl BranchWork {
    pub(super) fn new(arguments: Arguments) -> Result<Self> {
        arguments.check_of_oscillator()?;
        arguments.check_varied()?;
        Ok(Self { arguments })
    }
}

impl SweepVerb for BranchWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        family(&self.arguments, &self.arguments.model.at(point)).map(drop)
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let model = self.arguments.model.at(point);
        let (followed, _) = follow_branch(&self.arguments, &model, Reporting::Alone)?;
        records::bytes(&arrays(&followed)?)
    }
}

/// What the verb writes as JSON: its numbers as arrays, and all of it as text.
fn arrays(followed: &Followed) -> Result<Vec<Array>> {
    let BranchJson { complete, branch, bifurcations } = &followed.branch;
    let count = branch.len();
    let numbers = |of: fn(&JsonPlace) -> f64| branch.iter().map(of).collect::<Vec<f64>>();
    let special = |of: fn(&Special) -> f64| bifurcations.iter().map(of).collect::<Vec<f64>>();
    let kinds = bifurcations.iter().map(|it| kind(it.r#type)).collect();
    let multipliers = branch.iter().flat_map(|it| it.multipliers).flatten().collect();
    let stable = branch.iter().map(|it| i32::from(it.stable)).collect();
    Ok(vec![
        Array::i4("complete", &[], vec![i32::from(*complete)]),
        Array::i4("period", &[], vec![followed.period.map_or(-1, u32::cast_signed)]),
        Array::f8("parameter", &[count], numbers(|it| it.parameter)),
        Array::f8("point", &[count, 3], branch.iter().flat_map(|it| it.point).collect()),
        Array::f8("multipliers", &[count, 3, 2], multipliers),
        Array::i4("stable", &[count], stable),
        Array::f8("drift_per_period", &[count], numbers(|it| it.drift_per_period)),
        Array::i4("bifurcation_type", &[bifurcations.len()], kinds),
        Array::f8("bifurcation_value", &[bifurcations.len()], special(|it| it.value)),
        Array::f8("bifurcation_error", &[bifurcations.len()], special(|it| it.error)),
        Array::text("meta", serde_json::to_vec(followed)?),
    ])
}

/// The number of a bifurcation's type in files.
pub(super) fn kind(name: &str) -> i32 {
    let names =
        ["fold", "flip", "neimark-sacker", "grazing", "corner", "event-gained", "event-lost"];
    names.iter().position(|it| *it == name).map_or(-1, |place| place as i32)
}
