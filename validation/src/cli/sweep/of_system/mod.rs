//! Verbs with a SYSTEM at the points of a sweep.

mod basins;
mod branches;
mod diagrams;
mod exponents;

pub(super) use basins::SystemBasinWork;
pub(super) use branches::SystemBranchWork;
pub(super) use diagrams::SystemDiagramWork;
pub(super) use exponents::SystemExponentWork;

use crate::cli::shared::section::{SectionFlags, is_told_by_model};
use crate::cli::shared::system_choice::{ChosenSystem, SystemChoice};
use crate::sweep::{Plan, SweepPoint};
use anyhow::{Result, bail};
use percuss::System;
use percuss::affine::{LeftOut, NoReturn, Return, Solver};

/// A system whose parameters are a plan's axes.
pub(super) struct SweptSystem {
    chosen: ChosenSystem,
    /// The system at the plan's first point.
    first: System,
}

impl SweptSystem {
    /// Refuses an axis that is no parameter of the system, or that the plan sets as well.
    pub(super) fn new(chosen: ChosenSystem, choice: &SystemChoice, plan: &Plan) -> Result<Self> {
        let axes = || plan.axes.iter().map(|it| it.parameter.as_str());
        if let Some(name) = axes().find(|it| choice.sets(it)) {
            bail!("{name} is both an axis and in [fixed] set: accepted is one of them");
        }
        let first = chosen.at(&plan.point(0))?.system()?;
        Ok(Self { chosen, first })
    }

    fn at(&self, point: &SweepPoint) -> Result<ChosenSystem> {
        self.chosen.at(point)
    }

    fn system(&self, point: &SweepPoint) -> Result<System> {
        self.at(point)?.system()
    }

    /// Refuses a section that the system has not, before any point is computed.
    fn check(&self, section: &SectionFlags) -> Result<()> {
        section.map(&Solver::new(&self.first)?).map(drop)
    }

    /// The names of modes and states, to which numbers of arrays refer.
    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        let modes = self.first.modes.iter().map(|it| it.name.clone()).collect();
        vec![("modes", modes), ("states", self.first.states.clone())]
    }

    /// The names of the states on which nothing else depends.
    fn drifts(&self) -> Vec<String> {
        self.first.drifts().into_iter().map(|it| self.first.states[it].clone()).collect()
    }
}

/// The number in files of the reason for which a motion is left out; -1 of one that is not.
fn number_of(left_out: Option<LeftOut>) -> i32 {
    match left_out {
        None => -1,
        Some(LeftOut::Escapes) => 0,
        Some(LeftOut::NoReturn(NoReturn::Equilibrium)) => 1,
        Some(LeftOut::NoReturn(why)) if is_told_by_model(why) => 2,
        Some(LeftOut::NoReturn(_)) => 3,
    }
}

/// A number of ties and touches in files, which hold no larger ones than this type.
fn count_in_file(number: u64) -> i32 {
    i32::try_from(number).unwrap_or(i32::MAX)
}

/// The modes of some returns and their states, one after the other, as many as `count`: -1 and NaN
/// where there are fewer.
fn columns(returns: &[Return<f64>], count: usize, states: usize) -> (Vec<i32>, Vec<f64>) {
    let mut modes: Vec<i32> = returns.iter().map(|it| it.mode as i32).collect();
    let mut all: Vec<f64> = returns.iter().flat_map(|it| it.state.iter().copied()).collect();
    modes.resize(count, -1);
    all.resize(count * states, f64::NAN);
    (modes, all)
}
