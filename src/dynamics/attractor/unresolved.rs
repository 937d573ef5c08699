//! Starts that are not recognised, described: what a reader needs to judge why.

use super::known::Label;
use super::limits::SearchLimits;
use super::motions::{Motions, StopOf};
use super::search::repeats;
use super::thresholds::{EXAMPLE_RETURNS, EXTENSIONS, MAX_EXAMPLES};

/// The motion of a start that was not recognised, after the last extension of its transient.
pub(crate) struct UnresolvedMotion {
    /// The largest exponent per return; NaN where the motion does not return as often.
    pub exponent: f64,
    /// The least number of returns after which they repeat, as [`repeats`] tells.
    pub recurrence: Option<u32>,
}

/// The places of the first, the middle and the last of the labels that were not resolved.
pub(crate) fn examples(labels: &[Label]) -> Vec<usize> {
    let labels = labels.iter().enumerate();
    let open: Vec<usize> = labels.filter(|it| *it.1 == Label::Unresolved).map(|it| it.0).collect();
    let mut places: Vec<usize> = (0..MAX_EXAMPLES)
        .filter_map(|k| open.get(k * open.len().saturating_sub(1) / (MAX_EXAMPLES - 1)))
        .copied()
        .collect();
    places.dedup();
    places
}

/// The late motion of a start.
pub(crate) fn described<M: Motions>(
    motions: &M,
    limits: SearchLimits,
    start: &M::Start,
) -> UnresolvedMotion {
    let mut late = UnresolvedMotion { exponent: f64::NAN, recurrence: None };
    if let Ok(place) = motions.begin(start) {
        // A motion that ends has no more to tell.
        let _ = describe(motions, limits, &place, &mut late);
    }
    late
}

fn describe<M: Motions>(
    motions: &M,
    limits: SearchLimits,
    from: &M::Place,
    late: &mut UnresolvedMotion,
) -> Result<(), StopOf<M>> {
    let followed = (0..=EXTENSIONS).map(|it| limits.transient << it).sum();
    let settled = motions.after(from, followed)?;
    late.exponent = motions.exponent(&settled, EXAMPLE_RETURNS);
    let settled = motions.after(&settled, EXAMPLE_RETURNS)?;
    let mut spots = Vec::new();
    motions.follow(&settled, limits.returns(), &mut |_, _, spot| {
        spots.push(spot.clone());
        None
    })?;
    late.recurrence = repeats(motions.coordinates(), &spots, limits.max_period as usize);
    Ok(())
}
