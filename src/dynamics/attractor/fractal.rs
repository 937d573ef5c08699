//! How fractal the boundary between basins is.
//!
//! **Uncertainty exponent** (McDonald, Grebogi, Ott and Yorke 1985): the share of starts that
//! another start nearer than epsilon, along p, does not follow falls as epsilon^alpha; in the plane
//! (p, y) the boundary's dimension is 2 - alpha, so alpha = 1 of a smooth one and alpha < 1 of a
//! fractal one.
//!
//! **Basin entropy** (Daza, Wagemakers, Georgeot, Guery-Odelin and Sanjuan 2016): the mean entropy
//! of the labels in small boxes, and the mean over those boxes only that hold a boundary. Where the
//! latter exceeds ln 2 the boundary is fractal: along a smooth one nearly all boxes hold two
//! labels. It needs three labels, and is sufficient, not necessary.

use super::grid::{Basins, Window};
use super::known::Label;
use crate::dynamics::parallel;
use crate::dynamics::strobe::StrobePoint;
use std::collections::BTreeMap;

/// How uncertain starts are.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// The scales, largest first.
    pub scales: Vec<Scale>,
    /// The exponent alpha; NaN where fewer than three scales tell.
    pub exponent: f64,
    /// The standard error of the exponent, larger where the scales scatter by more than chance.
    pub error: f64,
}

/// The starts looked at on one scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Distance along p, as a share of the window's width.
    pub epsilon: f64,
    /// How many starts were compared with their two neighbours at that distance.
    pub starts: u64,
    /// How many of them have another label than one of the two.
    pub uncertain: u64,
}

/// Basin entropy of labels in boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entropy {
    /// The number of cells along each side of a box.
    pub side: u32,
    /// The mean entropy over all boxes, in natural units.
    pub all: f64,
    /// The mean entropy over the boxes that hold more than one label; NaN where there is none.
    pub boundary: f64,
    /// The standard error of `boundary`; NaN for a single box.
    pub boundary_error: f64,
    /// How many boxes hold more than one label.
    pub boundary_boxes: u64,
}

impl Uncertainty {
    /// Dimension of the boundary in the plane (p, y).
    #[must_use]
    pub fn dimension(&self) -> f64 {
        2.0 - self.exponent
    }

    /// Whether the exponent is below one by more than so many standard errors.
    #[must_use]
    pub fn is_fractal(&self, errors: f64) -> bool {
        self.exponent + errors * self.error < 1.0
    }

    fn fit(scales: Vec<Scale>, saturated: f64) -> Self {
        let (exponent, error) = slope(&scales, saturated).unwrap_or((f64::NAN, f64::NAN));
        Self { scales, exponent, error }
    }
}

impl Entropy {
    /// Whether the boundary's entropy exceeds ln 2 by more than so many standard errors.
    #[must_use]
    pub fn is_fractal(&self, errors: f64) -> bool {
        self.boundary - errors * self.boundary_error > std::f64::consts::LN_2
    }
}

/// The uncertainty exponent of any labelling: `starts` fresh starts on each of the scales
/// 2^-first .. 2^-last of the window's width, evenly spread and the same every time.
pub fn uncertainty_of(
    label: impl Fn(StrobePoint) -> Label + Sync + Send,
    window: &Window,
    q: f64,
    scales: std::ops::RangeInclusive<u32>,
    starts: u32,
) -> Uncertainty {
    let width = window.p[1] - window.p[0];
    let mut counts = BTreeMap::new();
    let mut seen = Vec::new();
    for scale in scales {
        let epsilon = 0.5_f64.powi(scale.cast_signed());
        let indices: Vec<u64> =
            (0..u64::from(starts)).map(|k| u64::from(scale) * u64::from(starts) + k).collect();
        let triples = parallel::map(&indices, |index| {
            let [p, y] = spread_point(*index, window);
            [0.0, -1.0, 1.0].map(|side| label([p + side * epsilon * width, y, q]))
        });
        triples.iter().for_each(|triple| *counts.entry(triple[0]).or_insert(0) += 1);
        let uncertain = triples.iter().filter(|[here, left, right]| left != here || right != here);
        let uncertain = uncertain.count() as u64;
        seen.push(Scale { epsilon, starts: u64::from(starts), uncertain });
    }
    Uncertainty::fit(seen, saturation(&counts))
}

/// The uncertainty exponent from the labels of a grid, at distances of 1, 2, 4... up to an eighth
/// of its columns. Starts that lack neighbours at the largest distance are not compared at any:
/// what is near the window's sides would count more the smaller the distance.
#[must_use]
pub fn uncertainty(basins: &Basins) -> Uncertainty {
    uncertainty_of_labels(&basins.labels, basins.grid.columns as usize)
}

/// The uncertainty exponent of labels in rows of so many columns, as [`uncertainty`] takes it.
#[must_use]
pub fn uncertainty_of_labels(labels: &[Label], columns: usize) -> Uncertainty {
    let mut scales = Vec::new();
    let largest = (columns / 8).checked_ilog2().map_or(0, |log| 1 << log);
    let mut step: usize = largest;
    while step > 0 {
        let mut scale = Scale { epsilon: step as f64 / columns as f64, starts: 0, uncertain: 0 };
        for row in labels.chunks(columns) {
            // A last row may be short.
            for at in largest..row.len().saturating_sub(largest) {
                scale.starts += 1;
                let here = row[at];
                scale.uncertain += u64::from(row[at - step] != here || row[at + step] != here);
            }
        }
        scales.push(scale);
        step /= 2;
    }
    let mut counts = BTreeMap::new();
    labels.iter().for_each(|label| *counts.entry(*label).or_insert(0) += 1);
    Uncertainty::fit(scales, saturation(&counts))
}

/// Basin entropy in boxes of `side` by `side` cells; cells that fill no box are left out.
#[must_use]
pub fn entropy(basins: &Basins, side: u32) -> Entropy {
    entropy_of_labels(&basins.labels, basins.grid.columns as usize, side)
}

/// Basin entropy of labels in rows of so many columns, as [`entropy`] takes it.
#[must_use]
pub fn entropy_of_labels(labels: &[Label], columns: usize, side: u32) -> Entropy {
    let wide = side.max(1) as usize;
    let rows = labels.len() / columns.max(1);
    let mut boxes = Vec::new();
    for (i, j) in (0..rows / wide).flat_map(|i| (0..columns / wide).map(move |j| (i, j))) {
        let mut counts = BTreeMap::new();
        for row in 0..wide {
            let from = (i * wide + row) * columns + j * wide;
            for label in &labels[from..from + wide] {
                *counts.entry(*label).or_insert(0_u32) += 1;
            }
        }
        let cells = (wide * wide) as f64;
        let parts = counts.values().map(|count| f64::from(*count) / cells);
        // From 0 on: a sum of nothing but -0 is -0.
        let entropy = parts.fold(0.0, |sum, share| sum - share * libm::log(share));
        boxes.push((counts.len(), entropy));
    }
    let all = boxes.iter().map(|it| it.1).sum::<f64>() / boxes.len() as f64;
    let mixed: Vec<f64> = boxes.iter().filter(|it| it.0 > 1).map(|it| it.1).collect();
    let count = mixed.len() as f64;
    let boundary = mixed.iter().sum::<f64>() / count;
    let scatter: f64 = mixed.iter().map(|it| (it - boundary).powi(2)).sum();
    let boundary_error = (scatter / (count * (count - 1.0))).sqrt();
    Entropy { side, all, boundary, boundary_error, boundary_boxes: mixed.len() as u64 }
}

/// The share of uncertain starts if labels were thrown at random: that three are not all equal.
/// Terms are summed in the labels' order, so that the last bits are the same every time.
fn saturation(counts: &BTreeMap<Label, u64>) -> f64 {
    let all = counts.values().sum::<u64>() as f64;
    1.0 - counts.values().map(|count| (*count as f64 / all).powi(3)).sum::<f64>()
}

/// Slope of ln(share) over ln(epsilon), weighted by the binomial errors, over the scales on which
/// something is seen and the share is at most half of what it saturates at.
fn slope(scales: &[Scale], saturated: f64) -> Option<(f64, f64)> {
    let telling = |scale: &&Scale| {
        scale.uncertain > 0 && scale.uncertain as f64 <= 0.5 * saturated * scale.starts as f64
    };
    let points: Vec<[f64; 3]> = scales
        .iter()
        .filter(telling)
        .map(|scale| {
            let share = scale.uncertain as f64 / scale.starts as f64;
            let weight = scale.uncertain as f64 / (1.0 - share);
            [libm::log(scale.epsilon), libm::log(share), weight]
        })
        .collect();
    if points.len() < 3 {
        return None;
    }
    let sum = |of: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(|it| it[2] * of(it)).sum::<f64>();
    let total = sum(&|_| 1.0);
    let (x, y) = (sum(&|it| it[0]) / total, sum(&|it| it[1]) / total);
    let spread = sum(&|it| (it[0] - x).powi(2));
    let slope = sum(&|it| (it[0] - x) * (it[1] - y)) / spread;
    let chi2 = sum(&|it| (it[1] - y - slope * (it[0] - x)).powi(2));
    let excess = (chi2 / (points.len() - 2) as f64).max(1.0);
    Some((slope, (excess / spread).sqrt()))
}

/// An evenly spread sequence in the window (Roberts' generalised golden ratio, 2018).
fn spread_point(index: u64, window: &Window) -> [f64; 2] {
    /// The real root of x^3 = x + 1.
    const PLASTIC_NUMBER: f64 = 1.324_717_957_244_746;
    let part = |step: f64| (0.5 + index as f64 * step).fract();
    let [p, y] = [part(1.0 / PLASTIC_NUMBER), part(1.0 / (PLASTIC_NUMBER * PLASTIC_NUMBER))];
    let at = |[from, to]: [f64; 2], share: f64| from + share * (to - from);
    [at(window.p, p), at(window.y, y)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::attractor::Grid;

    const UNIT_WINDOW: Window = Window { p: [0.0, 1.0], y: [0.0, 1.0] };

    fn of_grid(side: u32, label: impl Fn(StrobePoint) -> Label) -> Basins {
        let grid = Grid { window: UNIT_WINDOW, columns: side, rows: side, q: 0.0 };
        let labels = grid.starts().into_iter().map(label).collect();
        Basins { grid, attractors: Vec::new(), labels }
    }

    /// The boundary is a slanted line.
    fn smooth([p, y, _]: StrobePoint) -> Label {
        Label::Attractor(usize::from(p > 0.3 + 0.4 * y))
    }

    /// The boundary is the middle-third Cantor set, of dimension ln 2/ln 3, times a line: labels
    /// alternate from level to level of its gaps.
    fn cantor([p, _, _]: StrobePoint) -> Label {
        let mut x = p.clamp(0.0, 1.0);
        for level in 0..34 {
            if (1.0 / 3.0..2.0 / 3.0).contains(&x) {
                return Label::Attractor(level % 2);
            }
            x = if x < 0.5 { 3.0 * x } else { 3.0 * x - 2.0 };
        }
        Label::Attractor(0)
    }

    #[test]
    fn a_smooth_boundary_has_exponent_one() {
        for found in [
            uncertainty_of(smooth, &UNIT_WINDOW, 0.0, 4..=11, 40_000),
            uncertainty(&of_grid(512, smooth)),
        ] {
            assert!((found.exponent - 1.0).abs() <= 4.0 * found.error.max(0.01), "{found:?}");
            assert!(!found.is_fractal(4.0));
        }
        let entropy = entropy(&of_grid(500, smooth), 5);
        assert!(entropy.boundary < std::f64::consts::LN_2 && !entropy.is_fractal(0.0));
        assert!(entropy.all < 0.01);
    }

    #[test]
    fn a_cantor_sets_exponent_is_its_codimension() {
        let expected = 1.0 - 2.0_f64.ln() / 3.0_f64.ln();
        let found = uncertainty_of(cantor, &UNIT_WINDOW, 0.0, 4..=24, 4000);
        assert!((found.exponent - expected).abs() <= 4.0 * found.error, "{expected} {found:?}");
        assert!(found.error < 0.03 && found.is_fractal(4.0), "{found:?}");
        assert!((found.dimension() - (2.0 - expected)).abs() <= 4.0 * found.error);
    }

    /// Three labels thrown at random: the entropy of a box is that of a sample of 25.
    #[test]
    fn labels_at_random_pass_the_criterion_of_ln_2() {
        let at = |p: f64, y: f64| (1e4 * (78.233 * p + 12.9898 * y).sin()).rem_euclid(3.0) as usize;
        let random = entropy(&of_grid(500, |[p, y, _]| Label::Attractor(at(p, y))), 5);
        assert!(random.is_fractal(3.0), "{random:?}");
        assert!(random.boundary < 3.0_f64.ln());
        // The expected deficit of a sample's entropy is (labels - 1)/(2 cells), to first order.
        assert!((random.all - (3.0_f64.ln() - 2.0 / 50.0)).abs() < 0.01, "{random:?}");
    }

    #[test]
    fn one_label_has_no_boundary() {
        let plain = of_grid(16, |_| Label::Escaping);
        assert!(uncertainty(&plain).exponent.is_nan());
        let entropy = entropy(&plain, 5);
        assert!(entropy.all == 0.0 && entropy.boundary.is_nan() && !entropy.is_fractal(0.0));
        let single = of_grid(1, |_| Label::Unresolved);
        assert!(uncertainty(&single).exponent.is_nan());
    }
}
