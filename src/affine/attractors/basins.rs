//! A grid of starts in two states, and which attractor each of them reaches.

use super::ReturnAttractor;
use super::motions::SectionMotions;
use crate::affine::model::error::SystemError;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::returns::map::SectionMap;
use crate::affine::returns::walk::Return;
use crate::affine::run::place::Place;
use crate::affine::solver::Solver;
use crate::dynamics::attractor::catalog::Catalog;
use crate::dynamics::attractor::thresholds::LATTICE_SIDE;
use crate::dynamics::attractor::unresolved::{described, examples};
use crate::dynamics::attractor::{Label, SearchLimits, grid};
use crate::dynamics::parallel;
use std::collections::BTreeSet;

/// A rectangle of two states, in cells at whose centres starts lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The indices of the states across and up.
    pub axes: [usize; 2],
    /// The range of each, from and to.
    pub window: [[f64; 2]; 2],
    /// Cells across.
    pub columns: u32,
    /// Cells up.
    pub rows: u32,
}

/// The attractor that each start of a plane reaches.
#[derive(Clone, Debug)]
pub struct ReturnBasins {
    /// The plane.
    pub plane: Plane,
    /// The attractors that it reaches: orbits first, by period, then by smallest first state; then
    /// the others by kind.
    pub attractors: Vec<ReturnAttractor>,
    /// A label a start, row by row from the lowest on: an index into the attractors.
    pub labels: Vec<Label>,
    /// Some of the starts that were not recognised, described.
    pub unresolved: Vec<UnresolvedReturn>,
}

/// A start that was not recognised, and its motion after the last extension of its transient.
#[derive(Clone, Debug, PartialEq)]
pub struct UnresolvedReturn {
    /// The start, as the grid has it.
    pub point: Return<f64>,
    /// The largest exponent per return, that along the flow included; NaN where the motion does
    /// not return as often.
    pub lyapunov_per_return: f64,
    /// The least number of returns, up to the longest period that was looked for, after which they
    /// repeat to a thousandth of their size.
    pub recurrence: Option<u32>,
}

impl UnresolvedReturn {
    fn new(catalog: &Catalog<SectionMotions<'_>>, start: &Place<f64>) -> Self {
        let late = described(&catalog.motions, catalog.limits, start);
        let (mode, time, state) = (start.mode, start.time.value(), start.state.clone());
        let point = Return { mode, time, state };
        Self { point, lyapunov_per_return: late.exponent, recurrence: late.recurrence }
    }
}

impl Plane {
    /// The centres of the columns for the axis 0, and of the rows for any other.
    #[must_use]
    pub fn centres(&self, axis: usize) -> Vec<f64> {
        let axis = axis.min(1);
        grid::centres(self.window[axis], [self.columns, self.rows][axis])
    }

    /// The number of starts.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// All starts, row by row from the lowest on, at a start but for the two states. `seen` hears
    /// of no start before each row: who waits may end the work.
    pub(super) fn starts(
        &self,
        at: &PlaneStart<'_>,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Result<Vec<Place<f64>>, SystemError> {
        let [across, up] = [0, 1].map(|axis| self.centres(axis));
        let row = |y: &f64| {
            seen(0);
            across.iter().map(|x| at.with(self.axes, [*x, *y])).collect()
        };
        let rows: Vec<Result<Vec<_>, _>> = parallel::map(&up, row);
        let rows: Vec<_> = rows.into_iter().collect::<Result<_, _>>()?;
        Ok(rows.concat())
    }
}

/// The start of which two states are moved, in each of the modes in which it may lie.
pub(super) struct PlaneStart<'a> {
    solver: &'a Solver<f64>,
    system: &'a System,
    start: &'a StartPoint,
    places: Vec<Place<f64>>,
    /// Whether other states hang on the two as the expressions of the system's start say.
    follows: bool,
}

impl<'a> PlaneStart<'a> {
    pub(super) fn new(
        solver: &'a Solver<f64>,
        start: &'a StartPoint,
        axes: &[usize],
    ) -> Result<Self, SystemError> {
        let system = solver.system();
        let listed = system.start_modes.iter().map(|it| it.mode);
        let modes: BTreeSet<usize> = listed.chain([start.mode]).collect();
        let place = |mode| solver.place_free_in(&StartPoint { mode, ..start.clone() }, axes);
        let places = modes.into_iter().map(place).collect::<Result<_, _>>()?;
        let follows = !system.start_rows.is_empty() && system.follows_start(start, axes);
        Ok(Self { solver, system, start, places, follows })
    }

    /// The start with these values of two states, and what hangs on them, in the mode that the
    /// start's conditions choose, or in its own where it has none.
    fn with(&self, axes: [usize; 2], values: [f64; 2]) -> Result<Place<f64>, SystemError> {
        let chooses = !self.system.start_modes.is_empty();
        // Most systems need no exact start for each cell.
        let moved = (chooses || self.follows).then(|| self.moved(axes, values));
        let mode = match &moved {
            Some(moved) if chooses => self.system.mode_by_conditions(moved)?,
            _ => self.start.mode,
        };
        let unknown = || SystemError::UnknownMode {
            item: "start".to_owned(),
            index: mode,
            modes: self.system.modes.len(),
        };
        let place = self.places.iter().find(|it| it.mode == mode).ok_or_else(unknown)?;
        let mut state = match &moved {
            Some(moved) if self.follows => self.solver.states_at(moved),
            _ => place.state.clone(),
        };
        for (axis, value) in axes.into_iter().zip(values) {
            if let Some(entry) = state.get_mut(axis) {
                *entry = value;
            }
        }
        Ok(place.moved_to(place.time, state))
    }

    /// The exact start with these values of two states, and what hangs on them.
    fn moved(&self, axes: [usize; 2], values: [f64; 2]) -> StartPoint {
        let mut moved = self.start.clone();
        for (axis, value) in axes.into_iter().zip(values) {
            let value = Rational::try_from(value).unwrap_or_default();
            if let Some(entry) = moved.state.get_mut(axis) {
                *entry = [Rational::ZERO, Rational::ZERO, value];
            }
        }
        if self.follows {
            self.system.follow_start(&mut moved, &axes);
        }
        moved
    }
}

impl SectionMap<'_, f64> {
    /// Labels every start of a plane. The other states and the time are those of a start, and so is
    /// the mode, unless the system's start chooses it by conditions. A state whose start is an
    /// expression of other states follows these.
    ///
    /// `limits` say how many returns a start is followed at first, and how long orbits may be;
    /// `seen` is told of how many starts more the label is known. Results are the same for any
    /// number of threads.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn basins(
        &self,
        start: &StartPoint,
        plane: &Plane,
        limits: impl Into<SearchLimits>,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Result<ReturnBasins, SystemError> {
        let at = PlaneStart::new(self.solver(), start, &plane.axes)?;
        let mut catalog = Catalog::new(SectionMotions::new(self), limits.into());
        let lattice = Plane { columns: LATTICE_SIDE, rows: LATTICE_SIDE, ..*plane };
        let look = |_| seen(0);
        catalog.label_all(&lattice.starts(&at, seen)?, &look);
        let starts = plane.starts(&at, seen)?;
        let labels = catalog.label_all(&starts, seen);
        let known: Vec<_> = catalog.known.iter().map(|it| it.attractor.clone()).collect();
        let mut basins = ReturnBasins::sorted(*plane, &known, labels);
        let examples = examples(&basins.labels).into_iter();
        basins.unresolved = examples.map(|n| UnresolvedReturn::new(&catalog, &starts[n])).collect();
        Ok(basins)
    }
}

impl ReturnBasins {
    /// Drops attractors that no start reaches and puts the others in order.
    fn sorted(plane: Plane, known: &[ReturnAttractor], labels: Vec<Label>) -> Self {
        let (attractors, labels) =
            grid::in_order(known, labels, |it| it.kind, ReturnAttractor::order);
        Self { plane, attractors, labels, unresolved: Vec::new() }
    }

    /// The share of all starts that have a label.
    #[must_use]
    pub fn fraction(&self, label: Label) -> f64 {
        grid::fraction(&self.labels, label)
    }

    /// The standard error of a share, as of independent starts.
    #[must_use]
    pub fn fraction_error(&self, label: Label) -> f64 {
        grid::fraction_error(&self.labels, label)
    }
}
