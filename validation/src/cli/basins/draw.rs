//! The basins as a picture.

use super::Survey;
use crate::picture::{self, BASIN_COLOURS, BasinMap, ShownAttractor};
use percuss::dynamics::attractor::{Attractor, AttractorKind, Basins, Label};

pub(super) fn map(survey: &Survey) -> BasinMap {
    let Survey { problem, limits, basins, .. } = survey;
    let transient = limits.transient;
    let grid = &basins.grid;
    let colours = colours(basins.attractors.iter().map(|it| it.kind));
    let shown = basins.attractors.iter().enumerate().zip(colours);
    BasinMap {
        title: picture::caption(problem.model.parameters()),
        note: format!(
            "{} x {} starts at the centres of cells, q = {} or on the slider where p > q + g;\n\
             strobes at \u{3c4} = {} and whole forcing periods later; at first {transient} periods a start",
            grid.columns, grid.rows, grid.q, problem.start.tau
        ),
        axes: ["p (displacement)", "y (velocity)"].map(str::to_owned),
        window: [grid.window.p, grid.window.y],
        columns: grid.columns as usize,
        cells: basins.labels.clone(),
        attractors: shown.map(|((id, it), colour)| shown_as(basins, id, it, colour)).collect(),
    }
}

/// The first chaotic attractor is orange on yellow, as in the paper; all others take the colours
/// that follow.
pub(super) fn colours(kinds: impl Iterator<Item = AttractorKind>) -> Vec<usize> {
    let kinds: Vec<_> = kinds.collect();
    let first = kinds.iter().position(|it| *it == AttractorKind::Chaotic);
    let mut next = 0;
    let colour = |id: usize| {
        if Some(id) == first {
            return 0;
        }
        next += 1;
        1 + (next - 1) % (BASIN_COLOURS - 1)
    };
    (0..kinds.len()).map(colour).collect()
}

fn shown_as(basins: &Basins, id: usize, attractor: &Attractor, colour: usize) -> ShownAttractor {
    let what = match attractor.period() {
        Some(period) => format!("{id}: period {period}"),
        None => format!("{id}: {}", attractor.kind.as_str()),
    };
    let share = 100.0 * basins.fraction(Label::Attractor(id));
    ShownAttractor {
        name: format!("{what}\n{share:.2} % of starts"),
        colour,
        points: attractor.points.iter().map(|[p, y, _]| [*p, *y]).collect(),
        is_orbit: attractor.orbit.is_some(),
    }
}
