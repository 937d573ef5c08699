//! `continue SYSTEM` at the points of a sweep.

use super::{SweptSystem, columns};
use crate::cli::orbits::follow::Arguments;
use crate::cli::orbits::follow::of_system;
use crate::cli::shared::system_choice::ChosenSystem;
use crate::cli::sweep::branches::kind;
use crate::returns;
use crate::sweep::{Array, SweepPoint, SweepVerb, records};
use anyhow::{Result, anyhow};
use percuss::System;
use percuss::affine::{NoOrbit, Orbit, ReturnBifurcation, ReturnBranch, Solver};

/// A branch at each point; a point is one tile.
pub(in crate::cli::sweep) struct SystemBranchWork {
    swept: SweptSystem,
    arguments: Arguments,
}

impl SystemBranchWork {
    pub(in crate::cli::sweep) fn new(swept: SweptSystem, arguments: Arguments) -> Result<Self> {
        of_system::check(&arguments, &swept.chosen)?;
        arguments.refuse_second()?;
        swept.check(&arguments.section)?;
        Ok(Self { swept, arguments })
    }

    /// The system at the verb's own first value.
    fn first(&self, chosen: &ChosenSystem) -> Result<System> {
        let Arguments { parameter, from, .. } = &self.arguments;
        let first = chosen.system_at(parameter, from.value);
        first.map_err(|error| anyhow!("--from {from}: {error}"))
    }

    fn follow_branch(
        &self,
        chosen: &ChosenSystem,
        first: &System,
    ) -> Result<Result<ReturnBranch, NoOrbit>> {
        let solver = Solver::<f64>::new(first)?;
        let map = self.arguments.section.map(&solver)?;
        let (guess, _) = returns::guess(&map, self.arguments.transient.unwrap_or(0), || ())?;
        let at = |value| chosen.system_at(&self.arguments.parameter, value);
        of_system::branch(&self.arguments, guess, &at, &mut |_| ())
    }

    /// What the verb writes as JSON: its numbers as arrays, and all of it as text.
    fn arrays(&self, first: &System, branch: Option<&ReturnBranch>) -> Result<Vec<Array>> {
        let told = of_system::json(first, &self.arguments.parameter, branch);
        let points = branch.map(|it| it.points.as_slice()).unwrap_or_default();
        let found = branch.map(|it| it.bifurcations.as_slice()).unwrap_or_default();
        let (count, states) = (points.len(), first.states.len());
        let orbits = || points.iter().map(|it| &it.1);
        let begun = |it: &Orbit| columns(&it.points[..it.points.len().min(1)], 1, states);
        let (modes, begun): (Vec<_>, Vec<_>) = orbits().map(begun).unzip();
        let most = orbits().map(|it| it.multipliers.len()).max().unwrap_or(0);
        let multipliers = |it: &Orbit| {
            let mut padded = it.multipliers.clone();
            padded.resize(most, [f64::NAN; 2]);
            padded.concat()
        };
        let special = |of: fn(&ReturnBifurcation) -> f64| found.iter().map(of).collect();
        let kinds = found.iter().map(|it| kind(it.kind.as_str())).collect();
        let period = points.first().map_or(-1, |it| it.1.period() as i32);
        let complete = branch.is_some_and(ReturnBranch::is_complete);
        Ok(vec![
            Array::i4("complete", &[], vec![i32::from(complete)]),
            Array::i4("period", &[], vec![period]),
            Array::f8("parameter", &[count], points.iter().map(|it| it.0).collect()),
            Array::f8("time", &[count], orbits().map(|it| it.time).collect()),
            Array::i4("mode", &[count], modes.concat()),
            Array::f8("state", &[count, states], begun.concat()),
            Array::f8("multipliers", &[count, most, 2], orbits().flat_map(multipliers).collect()),
            Array::i4("stable", &[count], orbits().map(|it| i32::from(it.is_stable())).collect()),
            Array::i4("bifurcation_type", &[found.len()], kinds),
            Array::f8("bifurcation_value", &[found.len()], special(|it| it.value)),
            Array::f8("bifurcation_error", &[found.len()], special(|it| it.error)),
            Array::text("meta", serde_json::to_vec(&told)?),
        ])
    }
}

impl SweepVerb for SystemBranchWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        let (chosen, Arguments { parameter, to, .. }) = (self.swept.at(point)?, &self.arguments);
        self.first(&chosen)?;
        let last = chosen.system_at(parameter, to.value);
        last.map(drop).map_err(|error| anyhow!("--to {to}: {error}"))
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let chosen = self.swept.at(point)?;
        let first = self.first(&chosen)?;
        let branch = self.follow_branch(&chosen, &first)?.ok();
        records::bytes(&self.arrays(&first, branch.as_ref())?)
    }

    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        self.swept.names()
    }
}
