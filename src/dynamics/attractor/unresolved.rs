//! Starts that are not recognised, described: what a reader needs to judge why.

use super::grid::Basins;
use super::horizon;
use super::known::Label;
use super::limits::SearchLimits;
use super::settle::repeats;
use super::thresholds::{EXAMPLE_RETURNS, EXAMPLES, EXTENSIONS};
use crate::dynamics::lyapunov::Spectrum;
use crate::dynamics::section::Section;
use crate::dynamics::strobe::{StrobeMap, StrobePoint};
use crate::model::entry::Entry;

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

impl Basins {
    /// The first, the middle and the last of the starts that were not recognised.
    #[must_use]
    pub fn unresolved_examples(
        &self,
        map: &StrobeMap,
        limits: impl Into<SearchLimits>,
    ) -> Vec<UnresolvedStart> {
        let limits = limits.into();
        let labels = self.labels.iter().enumerate();
        let open: Vec<usize> =
            labels.filter(|it| *it.1 == Label::Unresolved).map(|it| it.0).collect();
        let mut places: Vec<usize> = (0..EXAMPLES)
            .filter_map(|k| open.get(k * open.len().saturating_sub(1) / (EXAMPLES - 1)))
            .copied()
            .collect();
        places.dedup();
        let starts = self.grid.starts();
        places.into_iter().map(|place| described(map, limits, starts[place])).collect()
    }
}

fn described(map: &StrobeMap, limits: SearchLimits, point: StrobePoint) -> UnresolvedStart {
    let mut start = UnresolvedStart { point, lyapunov_per_period: f64::NAN, recurrence: None };
    let followed = (0..=EXTENSIONS).map(|it| limits.transient << it).sum();
    let Some(late) = map.entry(point).ok().and_then(|entry| after(map, entry, followed)) else {
        return start;
    };
    let spectrum = Spectrum::within(
        map.model(),
        late,
        EXAMPLE_RETURNS,
        horizon(&late.instant, EXAMPLE_RETURNS),
    );
    start.lyapunov_per_period = spectrum.exponents_per_period[0];
    let settled = after(map, late, EXAMPLE_RETURNS);
    let strobes = settled.into_iter().flat_map(|it| map.strobes(it, limits.strobes() - 1));
    let points: Vec<StrobePoint> = strobes.map(|strobe| strobe.point()).collect();
    start.recurrence = repeats(&points, limits.max_period as usize);
    start
}

/// The motion so many forcing periods later; none where it is not decided so far.
fn after(map: &StrobeMap, from: Entry, periods: u64) -> Option<Entry> {
    let later = from.instant.after_periods(periods, 1);
    Section::along(map.model().trajectory(from).until(later), later).next()
}
