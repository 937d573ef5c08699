//! One frame: its attractors and the label of every start.

use crate::arrays::Npz;
use crate::attractors::{TRANSIENT_PERIODS, WINDOW, described, grid, map};
use crate::engine::Failure;
use crate::integrated::strobes;
use crate::item_work::ItemWork;
use crate::picture::Colour;
use crate::picture::{Layer, Plot, Raster, basin_colours};
use percuss::dynamics::attractor::{Attractor, Basins, Label};
use percuss::dynamics::orbit::Orbit;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU64, Ordering};

/// The place of an attractor's colours among those of basin pictures.
pub(super) type ColourPlace = usize;

/// Attractors and labels, as they are kept when work is interrupted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Frame {
    pub omega: f64,
    cells: u32,
    pub attractors: Vec<KeptAttractor>,
    /// The share of starts of which it is not known where they lead.
    pub unresolved: String,
    /// The number of a start's label ([`Label::number`]), rows from the lowest y on.
    labels: Vec<i32>,
}

/// The kept figures of an attractor.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct KeptAttractor {
    pub kind: String,
    pub period: Option<u32>,
    pub said: String,
    /// The share of starts that lead there, and its standard error.
    pub share: String,
    pub points: Vec<[f64; 3]>,
}

/// The steps of progress that a frame tells.
const STEPS: u64 = 10;
/// Starts that lead to no attractor.
const UNRESOLVED: Colour = Colour(150, 150, 150);

impl Frame {
    /// Takes a frame from an interrupted run, or computes and keeps it.
    pub(super) fn kept(
        work: &ItemWork<'_>,
        letter: &str,
        omega: f64,
        cells: u32,
    ) -> Result<Self, Failure> {
        let name = format!("figure-7{letter}");
        if let Some(frame) = work.recall(&name).filter(|it: &Self| it.cells == cells) {
            (0..STEPS).for_each(|_| (work.step)());
            return Ok(frame);
        }
        let frame = Self::computed(work, omega, cells)?;
        work.keep(&name, &frame)?;
        Ok(frame)
    }

    fn computed(work: &ItemWork<'_>, omega: f64, cells: u32) -> Result<Self, Failure> {
        let (done, all) = (AtomicU64::new(0), u64::from(cells) * u64::from(cells));
        let seen = |more: u64| {
            let before = done.fetch_add(more, Ordering::Relaxed);
            let steps = |count: u64| count * STEPS / all;
            (steps(before)..steps(before + more)).for_each(|_| (work.step)());
        };
        let basins = Basins::new(&map(omega)?, &grid(cells), TRANSIENT_PERIODS, &seen);
        let share = |label| 100.0 * basins.fraction(label);
        let error = |label| 100.0 * basins.fraction_error(label);
        let kept = |(place, it): (usize, &Attractor)| {
            let label = Label::Attractor(place);
            KeptAttractor {
                kind: it.kind.as_str().to_owned(),
                period: it.period(),
                said: described(it),
                share: format!("{:.2} +- {:.2} %", share(label), error(label)),
                points: it.points.clone(),
            }
        };
        Ok(Self {
            omega,
            cells,
            attractors: basins.attractors.iter().enumerate().map(kept).collect(),
            unresolved: format!("{:.2} %", share(Label::Unresolved)),
            labels: basins.labels.iter().map(|label| label.number()).collect(),
        })
    }

    /// Each orbit integrated over its period.
    pub(super) fn integrated(
        &self,
        attractors: &[Attractor],
    ) -> Result<Vec<(String, String)>, Failure> {
        const TOLERANCE: f64 = 1e-11;
        let back = |orbit: &Orbit| {
            let (first, period) = (orbit.points[0], orbit.period());
            let (integrator, strobes) = strobes(self.omega, first, period, TOLERANCE)?;
            let last = strobes[strobes.len() - 1];
            let apart = (last[0] - first[0]).abs().max((last[1] - first[1]).abs());
            Ok((
                format!("{integrator}, from the orbit of period {period}"),
                format!("after one period it is back within {apart:.1e}"),
            ))
        };
        attractors.iter().filter_map(|it| it.orbit.as_ref()).map(back).collect()
    }

    /// Labels and grid for NumPy.
    pub(super) fn npz(&self) -> Result<Vec<u8>, Failure> {
        let (grid, cells) = (grid(self.cells), self.cells as usize);
        let mut archive = Npz::new(Vec::new());
        let written = archive
            .add("labels", &[cells, cells], self.labels.iter().copied())
            .and_then(|()| archive.add("p", &[cells], grid.p()))
            .and_then(|()| archive.add("y", &[cells], grid.y()));
        written.and_then(|()| archive.finish()).map_err(Failure::new)
    }

    /// The basins with their attractors.
    pub(super) fn plot(&self, title: &str, colours: &[ColourPlace]) -> Plot {
        let colour = |label: &i32| {
            usize::try_from(*label)
                .ok()
                .and_then(|id| colours.get(id))
                .map_or(UNRESOLVED, |it| basin_colours(*it).0)
        };
        let rows = self.labels.chunks(self.cells as usize);
        let raster = Raster {
            window: [(WINDOW.p[0], WINDOW.p[1]), (WINDOW.y[0], WINDOW.y[1])],
            rows: rows.map(|row| row.iter().map(colour).collect()).collect(),
        };
        let mut layers = vec![Layer::Raster(raster)];
        for (attractor, place) in self.attractors.iter().zip(colours) {
            layers.push(Layer::Dots {
                points: attractor.points.iter().map(|[p, y, _]| [*p, *y]).collect(),
                colour: basin_colours(*place).1,
                size: if attractor.period.is_some() { 4.0 } else { 0.9 },
            });
        }
        Plot {
            title: title.to_owned(),
            axes: ["p".to_owned(), "y".to_owned()],
            window: Some([(WINDOW.p[0], WINDOW.p[1]), (WINDOW.y[0], WINDOW.y[1])]),
            layers,
        }
    }
}
