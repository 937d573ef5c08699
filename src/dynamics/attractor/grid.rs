//! A grid of starts, and which attractor each of them reaches.

use super::known::Label;
use super::{Attractor, AttractorKind};
use crate::dynamics::strobe::StrobePoint;
use crate::error::InputError;
use crate::parameters::within;
use std::cmp::Ordering;
use std::ops::Range;

/// A rectangle of starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The range of the displacement of the mass, from and to.
    pub p: [f64; 2],
    /// The range of the velocity of the mass, from and to.
    pub y: [f64; 2],
}

/// Starts at the centres of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The rectangle of p and y that the cells cover.
    pub window: Window,
    /// Cells along p.
    pub columns: u32,
    /// Cells along y.
    pub rows: u32,
    /// Displacement of the slider's top, lifted to p - g where p > q + g.
    pub q: f64,
}

/// The attractor that each start of a grid reaches.
#[derive(Clone, Debug)]
pub struct Basins {
    /// The grid.
    pub grid: Grid,
    /// What it reaches: orbits first, by period, then by smallest p; then chaotic and
    /// quasi-periodic attractors by smallest p.
    pub attractors: Vec<Attractor>,
    /// A label a start, rows of equal y from the lowest y on: an index into the attractors.
    pub labels: Vec<Label>,
}

impl Window {
    /// Checks that both sides are finite, at most 1e9 in size, and from low to high.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] names the first that is not.
    pub fn check(&self) -> Result<(), InputError> {
        for (name, [from, to]) in [("p", self.p), ("y", self.y)] {
            within(name, from, -1e9, 1e9, "-1e9 to 1e9")?;
            // What rounding leaves of a narrower one is no window.
            within(name, to, from.next_up(), 1e9, "above its low end, to 1e9")?;
        }
        Ok(())
    }
}

impl Grid {
    /// The displacements of the columns' centres.
    #[must_use]
    pub fn p(&self) -> Vec<f64> {
        centres(self.window.p, self.columns)
    }

    /// The velocities of the rows' centres.
    #[must_use]
    pub fn y(&self) -> Vec<f64> {
        centres(self.window.y, self.rows)
    }

    /// All starts, row by row from the lowest y on.
    #[must_use]
    pub fn starts(&self) -> Vec<StrobePoint> {
        self.starts_of(0..self.rows)
    }

    /// The starts of some rows.
    pub(super) fn starts_of(&self, rows: Range<u32>) -> Vec<StrobePoint> {
        let (p, y) = (self.p(), self.y());
        let rows = &y[rows.start as usize..rows.end as usize];
        rows.iter().flat_map(|y| p.iter().map(|p| [*p, *y, self.q])).collect()
    }

    /// How many starts there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Whether there are no starts.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The centres of so many cells of a range.
pub(crate) fn centres([from, to]: [f64; 2], count: u32) -> Vec<f64> {
    let width = (to - from) / f64::from(count);
    (0..count).map(|k| from + (f64::from(k) + 0.5) * width).collect()
}

/// The attractors that some label names, without unidentified ones and in their order, and the
/// labels by their new places.
pub(crate) fn in_order<A: Clone>(
    known: &[A],
    labels: Vec<Label>,
    kind: impl Fn(&A) -> AttractorKind,
    compare: impl Fn(&A, &A) -> Ordering,
) -> (Vec<A>, Vec<Label>) {
    let mut reached = vec![false; known.len()];
    for label in &labels {
        if let Label::Attractor(id) = label {
            reached[*id] = true;
        }
    }
    let listed = |id: &usize| reached[*id] && kind(&known[*id]) != AttractorKind::Unidentified;
    let mut order: Vec<usize> = (0..known.len()).filter(listed).collect();
    order.sort_by(|a, b| compare(&known[*a], &known[*b]));
    let place = |label: Label| match label {
        Label::Attractor(id) => {
            order.iter().position(|it| *it == id).map_or(Label::Unresolved, Label::Attractor)
        }
        other => other,
    };
    let labels = labels.into_iter().map(place).collect();
    (order.iter().map(|id| known[*id].clone()).collect(), labels)
}

/// The share of labels that are this one.
pub(crate) fn fraction(labels: &[Label], label: Label) -> f64 {
    let count = labels.iter().filter(|it| **it == label).count();
    count as f64 / labels.len() as f64
}

/// The standard error of a share, as of independent starts.
pub(crate) fn fraction_error(labels: &[Label], label: Label) -> f64 {
    let share = fraction(labels, label);
    (share * (1.0 - share) / labels.len() as f64).sqrt()
}

impl Basins {
    /// Drops attractors that no start reaches and puts the others in order.
    pub(super) fn sorted(grid: Grid, known: &[Attractor], labels: Vec<Label>) -> Self {
        let (attractors, labels) = in_order(known, labels, |it| it.kind, Attractor::order);
        Self { grid, attractors, labels }
    }

    /// The share of all starts that have a label.
    #[must_use]
    pub fn fraction(&self, label: Label) -> f64 {
        fraction(&self.labels, label)
    }

    /// The standard error of a share, as of independent starts.
    #[must_use]
    pub fn fraction_error(&self, label: Label) -> f64 {
        fraction_error(&self.labels, label)
    }
}
