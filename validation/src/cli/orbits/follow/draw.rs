//! A branch of orbits as a picture: stable and unstable ones, and its bifurcations by name.

use crate::picture::{Colour, Figure, INK, KeyEntry, Layer, Plot, Stroke};

/// An orbit of a branch.
pub(super) struct DrawnOrbit {
    pub(super) at: DrawnPoints,
    pub(super) is_stable: bool,
}

/// A bifurcation of a branch.
pub(super) struct DrawnBifurcation {
    pub(super) name: String,
    pub(super) at: DrawnPoints,
}

/// A value of the parameter, and what is shown of each point of the orbit there.
pub(super) struct DrawnPoints {
    pub(super) value: f64,
    pub(super) points: Vec<f64>,
}

/// The colour of bifurcations, which differs from that of orbits in lightness, too.
const BIFURCATION_COLOUR: Colour = Colour(213, 94, 0);

/// A picture of branches over the parameter.
pub(super) fn figure(
    title: String,
    caption: String,
    axes: [String; 2],
    branches: &[Vec<DrawnOrbit>],
    bifurcations: &[DrawnBifurcation],
) -> Figure {
    let lines = branches.iter().flat_map(|it| lines(it, bifurcations));
    let mut layers: Vec<Layer> = lines.collect();
    layers.extend(bifurcations.iter().flat_map(marks));
    let entry =
        |name: &str, stroke| KeyEntry { name: name.to_owned(), colour: INK, stroke: Some(stroke) };
    let entries = vec![entry("stable", Stroke::Solid), entry("unstable", Stroke::Dashed)];
    layers.push(Layer::Key(entries));
    let plots = vec![Plot { title: String::new(), axes, window: None, layers }];
    Figure { title, caption, columns: 1, panel: (1200, 800), plots }
}

/// One line for each point of the orbits, and each stretch of equal stability. A stretch ends and
/// the next begins at the bifurcation between them, or at the next orbit where none is there.
fn lines(branch: &[DrawnOrbit], bifurcations: &[DrawnBifurcation]) -> Vec<Layer> {
    let alike = |a: &DrawnOrbit, b: &DrawnOrbit| {
        a.is_stable == b.is_stable && a.at.points.len() == b.at.points.len()
    };
    let span = Span::new(branch);
    let (mut layers, mut begin, mut before) = (Vec::new(), 0, None);
    for stretch in branch.chunk_by(alike) {
        let end = begin + stretch.len();
        let [first, last] = [&stretch[0].at, &stretch[stretch.len() - 1].at];
        let count = first.points.len();
        let next = branch.get(end).map(|it| &it.at).filter(|it| it.points.len() == count);
        let cut = next.and_then(|next| span.bifurcation_between([last, next], bifurcations));
        let (width, stroke) =
            if stretch[0].is_stable { (2.4, Stroke::Solid) } else { (1.4, Stroke::Dashed) };
        for n in 0..count {
            let own = stretch.iter().map(|it| &it.at);
            let whole = before.into_iter().chain(own).chain(cut.or(next));
            let points = whole.map(|it| [it.value, it.points[n]]).collect();
            layers.push(Layer::Line { points, colour: INK, width, stroke });
        }
        (begin, before) = (end, cut);
    }
    layers
}

/// The ranges of a branch, across and up.
struct Span([f64; 2]);

/// A bifurcation lies between two orbits if the way over it is at most this many times as long as
/// that from one to the other: it is longer where the branch turns.
const MAX_DETOUR_RATIO: f64 = 4.0;

impl Span {
    fn new(branch: &[DrawnOrbit]) -> Self {
        let values = branch.iter().map(|it| it.at.value);
        let points = branch.iter().flat_map(|it| it.at.points.iter().copied());
        Self([range(values), range(points)])
    }

    /// The bifurcation between two orbits that follow each other.
    fn bifurcation_between<'a>(
        &self,
        [last, next]: [&DrawnPoints; 2],
        bifurcations: &'a [DrawnBifurcation],
    ) -> Option<&'a DrawnPoints> {
        let fitting = bifurcations.iter().map(|it| &it.at);
        let fitting = fitting.filter(|it| it.points.len() == last.points.len());
        let ways = fitting.map(|it| (self.distance(last, it) + self.distance(it, next), it));
        let (way, nearest) = ways.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        (way <= MAX_DETOUR_RATIO * self.distance(last, next)).then_some(nearest)
    }

    /// The distance of two orbits in shares of the ranges.
    fn distance(&self, one: &DrawnPoints, other: &DrawnPoints) -> f64 {
        let Self([across, up]) = self;
        let pairs = one.points.iter().zip(&other.points);
        let farthest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (one.value - other.value).abs() / across + farthest / up
    }
}

/// The range of numbers, 1 of equal ones.
fn range(values: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = values
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| [low.min(it), high.max(it)]);
    if high > low { high - low } else { 1.0 }
}

/// A mark at each point of the orbit, the first with the name.
fn marks(found: &DrawnBifurcation) -> Vec<Layer> {
    let mark = |(n, it): (usize, &f64)| Layer::Named {
        at: [found.at.value, *it],
        name: if n == 0 { found.name.clone() } else { String::new() },
        colour: BIFURCATION_COLOUR,
    };
    found.at.points.iter().enumerate().map(mark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points_at(value: f64, point: f64) -> DrawnPoints {
        DrawnPoints { value, points: vec![point] }
    }

    fn draw_branch(orbits: &[(f64, f64, bool)], marks: &[(f64, f64)]) -> Vec<Vec<[f64; 2]>> {
        let orbit = |&(value, point, is_stable): &(f64, f64, bool)| DrawnOrbit {
            at: points_at(value, point),
            is_stable,
        };
        let mark = |&(value, point): &(f64, f64)| DrawnBifurcation {
            name: String::new(),
            at: points_at(value, point),
        };
        let orbits: Vec<_> = orbits.iter().map(orbit).collect();
        let marks: Vec<_> = marks.iter().map(mark).collect();
        let points = |it: Layer| match it {
            Layer::Line { points, .. } => points,
            _ => Vec::new(),
        };
        lines(&orbits, &marks).into_iter().map(points).collect()
    }

    #[test]
    fn stability_changes_at_the_bifurcation() {
        let orbits = [(1.0, 0.0, true), (2.0, 0.1, true), (3.0, 0.2, false), (4.0, 0.3, false)];
        let found = draw_branch(&orbits, &[(2.2, 0.12)]);
        assert_eq!(found[0], [[1.0, 0.0], [2.0, 0.1], [2.2, 0.12]]);
        assert_eq!(found[1], [[2.2, 0.12], [3.0, 0.2], [4.0, 0.3]]);
    }

    #[test]
    fn stability_changes_at_a_fold() {
        let orbits = [(1.0, 0.0, true), (2.0, 0.4, true), (2.0, 0.6, false), (1.0, 1.0, false)];
        let found = draw_branch(&orbits, &[(1.0, 0.5), (2.1, 0.5)]);
        assert_eq!(found[0], [[1.0, 0.0], [2.0, 0.4], [2.1, 0.5]]);
        assert_eq!(found[1], [[2.1, 0.5], [2.0, 0.6], [1.0, 1.0]]);
    }

    #[test]
    fn without_a_bifurcation_there_is_no_gap() {
        let orbits = [(1.0, 0.0, true), (2.0, 0.1, false)];
        let found = draw_branch(&orbits, &[(9.0, 3.0)]);
        assert_eq!(found, [vec![[1.0, 0.0], [2.0, 0.1]], vec![[2.0, 0.1]]]);
    }
}
