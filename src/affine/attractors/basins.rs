//! A grid of starts in two states, and which attractor each of them reaches.

use super::ReturnAttractor;
use super::catalog::AttractorCatalog;
use super::space::Space;
use super::unresolved::UnresolvedReturn;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::StartPoint;
use crate::affine::returns::map::SectionMap;
use crate::affine::run::place::Place;
use crate::dynamics::attractor::{AttractorKind, Label, SearchLimits};

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
    /// What it reaches: orbits first, by period, then by smallest first state; then the others by
    /// kind.
    pub attractors: Vec<ReturnAttractor>,
    /// A label a start, row by row from the lowest on: an index into the attractors.
    pub labels: Vec<Label>,
    /// Some of the starts that were not recognised, described.
    pub unresolved: Vec<UnresolvedReturn>,
}

/// Attractors are first looked for from a grid of so many by so many starts, whatever grid is asked
/// for: so they do not depend on it.
const LATTICE: u32 = 16;

impl Plane {
    /// The centres of the columns, or with 1 of the rows.
    #[must_use]
    pub fn centres(&self, axis: usize) -> Vec<f64> {
        let [from, to] = self.window[axis];
        let count = [self.columns, self.rows][axis];
        let width = (to - from) / f64::from(count);
        (0..count).map(|k| from + (f64::from(k) + 0.5) * width).collect()
    }

    /// The number of starts.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// All starts, row by row from the lowest on, at the place of a start but for the two states.
    fn starts(&self, at: &Place<f64>) -> Vec<Place<f64>> {
        let [across, up] = [0, 1].map(|axis| self.centres(axis));
        let start = |x: f64, y: f64| {
            let mut state = at.state.clone();
            for (axis, value) in self.axes.iter().zip([x, y]) {
                if let Some(entry) = state.get_mut(*axis) {
                    *entry = value;
                }
            }
            at.moved_to(at.time, state)
        };
        up.iter()
            .flat_map(|y| across.iter().map(move |x| (*x, *y)))
            .map(|(x, y)| start(x, y))
            .collect()
    }
}

impl SectionMap<'_, f64> {
    /// Labels every start of a plane. The other states, the mode and the time are those of a start.
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
        let at = self.solver().place_free_in(start, &plane.axes)?;
        let limits = limits.into().clamped();
        let mut catalog = AttractorCatalog { space: Space::of(self), limits, known: Vec::new() };
        let lattice = Plane { columns: LATTICE, rows: LATTICE, ..*plane };
        catalog.label_all(&lattice.starts(&at), &|_| ());
        let starts = plane.starts(&at);
        let labels = catalog.label_all(&starts, seen);
        let known: Vec<_> = catalog.known.iter().map(|it| it.attractor.clone()).collect();
        let mut basins = ReturnBasins::sorted(*plane, &known, labels);
        basins.unresolved = super::unresolved::examples(&catalog, &starts, &basins.labels);
        Ok(basins)
    }
}

impl ReturnBasins {
    /// Drops attractors that no start reaches and puts the others in order.
    fn sorted(plane: Plane, known: &[ReturnAttractor], labels: Vec<Label>) -> Self {
        let is_reached = |id: usize| labels.contains(&Label::Attractor(id));
        let listed = |id: &usize| known[*id].kind != AttractorKind::Unidentified && is_reached(*id);
        let mut order: Vec<usize> = (0..known.len()).filter(listed).collect();
        order.sort_by(|a, b| known[*a].order(&known[*b]));
        let place = |label: Label| match label {
            Label::Attractor(id) => {
                order.iter().position(|it| *it == id).map_or(Label::Unresolved, Label::Attractor)
            }
            other => other,
        };
        let attractors = order.iter().map(|id| known[*id].clone()).collect();
        let labels = labels.iter().map(|it| place(*it)).collect();
        Self { plane, attractors, labels, unresolved: Vec::new() }
    }

    /// The share of all starts that have a label.
    #[must_use]
    pub fn fraction(&self, label: Label) -> f64 {
        let count = self.labels.iter().filter(|it| **it == label).count();
        count as f64 / self.labels.len() as f64
    }

    /// The standard error of a share, as of independent starts.
    #[must_use]
    pub fn fraction_error(&self, label: Label) -> f64 {
        let share = self.fraction(label);
        (share * (1.0 - share) / self.labels.len() as f64).sqrt()
    }
}
