//! The attractors of Figs. 7 to 10 at one forcing frequency.

use super::item_work::model;
use super::paper::attractors_model;
use crate::engine::Failure;
use percuss::dynamics::attractor::{Attractor, AttractorKind, Basins, Grid, Window};
use percuss::dynamics::strobe::{StrobeMap, StrobePoint};
use percuss::{Instant, Start};

/// A window that holds every attractor of Figs. 7 to 10; the paper prints none.
pub(super) const WINDOW: Window = Window { p: [-3.0, 1.2], y: [-1.5, 1.5] };
/// Forcing periods that a start is first followed for.
pub(super) const TRANSIENT_PERIODS: u64 = 200;
/// Starts along a side where attractors are only looked for.
const SEARCH_STARTS: u32 = 64;

/// The strobe map at omega tau = 0.
pub(super) fn map(omega: f64) -> Result<StrobeMap, Failure> {
    Ok(StrobeMap::new(model(attractors_model(omega))?, Instant::at(omega, 0.0, 0)))
}

/// The start at a strobe.
pub(super) fn start([p, y, q]: StrobePoint) -> Start {
    Start { p, y, q: Some(q), ..Start::default() }
}

/// Square cells over the window; the slider's top at rest, or on the surface where p >= g.
pub(super) const fn grid(cells: u32) -> Grid {
    Grid { window: WINDOW, columns: cells, rows: cells, q: 0.0 }
}

/// The attractors that a coarse grid of starts reaches.
pub(super) fn found(omega: f64) -> Result<Vec<Attractor>, Failure> {
    Ok(Basins::new(&map(omega)?, &grid(SEARCH_STARTS), TRANSIENT_PERIODS, &|_| {}).attractors)
}

/// The one of a period.
pub(super) fn of_period(all: &[Attractor], period: u32) -> Result<&Attractor, Failure> {
    let missing = || Failure::new(format!("no attractor of period {period} was found"));
    all.iter().find(|it| it.period() == Some(period)).ok_or_else(missing)
}

/// The chaotic one with the largest exponent.
pub(super) fn strange(all: &[Attractor]) -> Result<&Attractor, Failure> {
    let missing = || Failure::new("no chaotic attractor was found");
    all.iter()
        .filter(|it| it.kind == AttractorKind::Chaotic)
        .max_by(|a, b| a.lyapunov_per_period.total_cmp(&b.lyapunov_per_period))
        .ok_or_else(missing)
}

/// An attractor in words.
pub(super) fn described(attractor: &Attractor) -> String {
    match &attractor.orbit {
        Some(orbit) => {
            let [re, im] = orbit.multipliers[0];
            format!("period {}, |mu| = {:.4}", orbit.period(), re.hypot(im))
        }
        None => format!(
            "{}, exponent {:.4} +- {:.4} per period",
            attractor.kind.as_str(),
            attractor.lyapunov_per_period,
            attractor.lyapunov_error
        ),
    }
}
