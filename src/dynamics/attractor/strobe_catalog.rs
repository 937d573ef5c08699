//! The attractors of a strobe map that have been met, and the description of starts that lead to
//! none of them.

use super::Attractor;
use super::catalog::Catalog;
use super::grid::Basins;
use super::known::Label;
use super::limits::SearchLimits;
use super::strobes::{Known, StrobeMotions};
use super::unresolved::{described, examples};
use crate::dynamics::strobe::{StrobeMap, StrobePoint};

/// The attractors of a strobe map that have been met.
#[derive(Clone, Debug)]
pub struct AttractorCatalog(Catalog<StrobeMotions>);

/// A start that was not recognised, and its motion after the last extension of its transient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnresolvedStart {
    /// The start, as the grid has it.
    pub point: StrobePoint,
    /// The largest exponent per forcing period; NaN where the motion is not decided so far.
    pub lyapunov_per_period: f64,
    /// The least number of forcing periods, up to the longest period that was looked for, after
    /// which its strobes repeat to a thousandth of their size.
    pub recurrence: Option<u32>,
}

impl AttractorCatalog {
    /// A catalog that has no attractor yet.
    #[must_use]
    pub fn new(map: StrobeMap, limits: impl Into<SearchLimits>) -> Self {
        Self(Catalog::new(StrobeMotions { map }, limits.into()))
    }

    /// The map whose attractors they are.
    #[must_use]
    pub const fn map(&self) -> &StrobeMap {
        &self.0.motions.map
    }

    /// The attractors, in the order in which they were met.
    pub fn attractors(&self) -> impl Iterator<Item = &Attractor> {
        self.0.known.iter().map(|it| &it.attractor)
    }

    /// The attractors with what motions near them are recognised by, in the same order.
    pub(super) fn known(&self) -> &[Known] {
        &self.0.known
    }

    /// The label of a start, as far as the attractors met so far tell.
    #[must_use]
    pub fn label(&self, start: StrobePoint) -> Label {
        self.0.label(&start)
    }

    /// The labels of many starts; attractors not met before are added. `seen` is told how many
    /// starts more are done.
    pub fn label_all(&mut self, starts: &[StrobePoint], seen: &(dyn Fn(u64) + Sync)) -> Vec<Label> {
        self.0.label_all(starts, seen)
    }
}

impl Basins {
    /// The first, the middle and the last of the starts that were not recognised.
    #[must_use]
    pub fn unresolved_examples(
        &self,
        map: &StrobeMap,
        limits: impl Into<SearchLimits>,
    ) -> Vec<UnresolvedStart> {
        let (motions, limits) = (StrobeMotions { map: *map }, limits.into());
        let starts = self.grid.starts();
        let example = |place: usize| {
            let point = *starts.get(place)?;
            let late = described(&motions, limits, &point);
            let (lyapunov_per_period, recurrence) = (late.exponent, late.recurrence);
            Some(UnresolvedStart { point, lyapunov_per_period, recurrence })
        };
        examples(&self.labels).into_iter().filter_map(example).collect()
    }
}
