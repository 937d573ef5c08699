//! A system at a start, made ready once for all engines.

use super::given::rounded;
use super::{CheckedSystem, System, Values};
use crate::equations::Numbers;
use crate::failure::Failure;
use percuss::affine::{self, Solver, StartPoint};
use std::sync::Arc;

/// A system at a start, in one direction of time.
#[derive(Clone, Debug)]
pub struct SystemProblem {
    /// The system with its exact coefficients, forward in time.
    pub exact: affine::System,
    /// The system's closed forms in f64, in the direction of the run.
    pub solver: Solver<f64>,
    /// The system in plain numbers, in the direction of the run.
    pub checked: Arc<CheckedSystem>,
    /// The point at which the run begins.
    pub start: StartPoint,
    /// Whether the run goes back in time.
    pub backward: bool,
}

impl SystemProblem {
    /// Makes a system that has a start ready to be run.
    ///
    /// # Errors
    /// A system without a start, or one that the solver or the engines do not take.
    pub fn new(exact: affine::System, backward: bool) -> Result<Self, Failure> {
        let start = exact.start.clone();
        let start = start.ok_or_else(|| Failure::new("the system has no [start]"))?;
        let solver = if backward { Solver::backward(&exact) } else { Solver::new(&exact) };
        let solver = solver.map_err(Failure::new)?;
        let checked = checked(&exact, backward)?;
        Ok(Self { exact, solver, checked, start, backward })
    }

    /// The system from another start.
    ///
    /// # Errors
    /// A start that the engines do not take.
    pub fn from_start(&self, start: StartPoint) -> Result<Self, Failure> {
        let mut exact = self.exact.clone();
        exact.start = Some(start.clone());
        let checked = checked(&exact, self.backward)?;
        Ok(Self { exact, solver: self.solver.clone(), checked, start, backward: self.backward })
    }

    /// The clock's time at the start, rounded.
    #[must_use]
    pub fn begin(&self) -> f64 {
        rounded(&self.start.time)
    }

    /// The clock's time when this much has elapsed.
    #[must_use]
    pub fn clock(&self, elapsed: f64) -> f64 {
        self.begin() + if self.backward { -elapsed } else { elapsed }
    }

    /// The state at the start, rounded.
    #[must_use]
    pub fn state(&self) -> Values {
        let (sin, cos) = self.checked.system().phi.sin_cos();
        let value = |[c, s, one]: &[affine::Rational; 3]| {
            rounded(c) * cos + rounded(s) * sin + rounded(one)
        };
        Values::from_slice(&self.start.state.iter().map(value).collect::<Vec<_>>())
    }

    /// The time that stands for a forcing period: that of the forcing, or as many of the system's
    /// units of time as there are radians in a turn.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.checked.period()
    }

    /// The shortest time of a full turn: a period, or an oscillation in one of the modes.
    #[must_use]
    pub fn turn(&self) -> f64 {
        self.checked.turn().min(self.period())
    }
}

/// A system in plain numbers, in the direction of a run.
fn checked(exact: &affine::System, backward: bool) -> Result<Arc<CheckedSystem>, Failure> {
    let forward = CheckedSystem::new(System::from(exact))?;
    Ok(Arc::new(if backward { forward.backward()? } else { forward }))
}
