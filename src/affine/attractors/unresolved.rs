//! Starts that are not recognised, described: what a reader needs to judge why.

use super::catalog::AttractorCatalog;
use super::search::repeats;
use super::space::Stop;
use crate::affine::returns::walk::Return;
use crate::affine::run::place::Place;
use crate::dynamics::attractor::Label;
use crate::dynamics::attractor::thresholds::{EXAMPLE_RETURNS, EXAMPLES, EXTENSIONS};

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

/// The first, the middle and the last of the starts that were not recognised.
pub(super) fn examples(
    catalog: &AttractorCatalog<'_>,
    starts: &[Place<f64>],
    labels: &[Label],
) -> Vec<UnresolvedReturn> {
    let labels = labels.iter().enumerate();
    let open: Vec<usize> = labels.filter(|it| *it.1 == Label::Unresolved).map(|it| it.0).collect();
    let mut places: Vec<usize> = (0..EXAMPLES)
        .filter_map(|k| open.get(k * open.len().saturating_sub(1) / (EXAMPLES - 1)))
        .copied()
        .collect();
    places.dedup();
    places.into_iter().map(|n| described(catalog, &starts[n])).collect()
}

fn described(catalog: &AttractorCatalog<'_>, start: &Place<f64>) -> UnresolvedReturn {
    let (mode, time, state) = (start.mode, start.time.value(), start.state.clone());
    let point = Return { mode, time, state };
    let mut told = UnresolvedReturn { point, lyapunov_per_return: f64::NAN, recurrence: None };
    // A motion that ends has no more to tell.
    let _ = described_further(catalog, start, &mut told);
    told
}

fn described_further(
    catalog: &AttractorCatalog<'_>,
    start: &Place<f64>,
    told: &mut UnresolvedReturn,
) -> Result<(), Stop> {
    let AttractorCatalog { space, limits, .. } = catalog;
    let followed = (0..=EXTENSIONS).map(|it| limits.transient << it).sum();
    let late = space.follow(start, followed, &mut |_, _, _| None)?;
    if let Ok(found) = space.map.exponents(&late, 0, EXAMPLE_RETURNS, &mut |_| ()) {
        told.lyapunov_per_return = found.per_return.first().copied().unwrap_or(f64::NAN);
    }
    let mut spots = Vec::new();
    space.follow(&late, EXAMPLE_RETURNS + limits.strobes(), &mut |n, _, spot| {
        if n >= EXAMPLE_RETURNS {
            spots.push(spot.clone());
        }
        None
    })?;
    told.recurrence = repeats(space, &spots, limits.max_period as usize);
    Ok(())
}
