//! A branch of orbits as a picture: stable and unstable ones, and its bifurcations by name.

use crate::picture::{Colour, Figure, INK, KeyEntry, Layer, Plot, Stroke};

/// An orbit of a branch.
pub(super) struct DrawnOrbit {
    /// The parameter's value.
    pub(super) value: f64,
    /// What is shown of each of its points.
    pub(super) points: Vec<f64>,
    pub(super) is_stable: bool,
}

/// A bifurcation of a branch.
pub(super) struct DrawnBifurcation {
    pub(super) name: String,
    pub(super) value: f64,
    pub(super) points: Vec<f64>,
}

/// The colour of bifurcations, which differs from that of orbits in lightness, too.
const MARK: Colour = Colour(213, 94, 0);

/// A picture of branches over the parameter.
pub(super) fn figure(
    title: String,
    caption: String,
    axes: [String; 2],
    branches: &[Vec<DrawnOrbit>],
    bifurcations: &[DrawnBifurcation],
) -> Figure {
    let mut layers: Vec<Layer> = branches.iter().flat_map(|it| lines(it)).collect();
    layers.extend(bifurcations.iter().flat_map(marks));
    let entry =
        |name: &str, stroke| KeyEntry { name: name.to_owned(), colour: INK, stroke: Some(stroke) };
    let entries = vec![entry("stable", Stroke::Solid), entry("unstable", Stroke::Dashed)];
    layers.push(Layer::Key(entries));
    let plots = vec![Plot { title: String::new(), axes, window: None, layers }];
    Figure { title, caption, columns: 1, panel: (1200, 800), plots }
}

/// One line for each point of the orbits, and each stretch of equal stability.
fn lines(branch: &[DrawnOrbit]) -> Vec<Layer> {
    let alike = |a: &DrawnOrbit, b: &DrawnOrbit| {
        a.is_stable == b.is_stable && a.points.len() == b.points.len()
    };
    let (mut layers, mut begin) = (Vec::new(), 0);
    for stretch in branch.chunk_by(alike) {
        let end = begin + stretch.len();
        // A stretch goes on to the first orbit of the next, so that no gap is between them.
        let next = branch.get(end).filter(|it| it.points.len() == stretch[0].points.len());
        let (width, stroke) =
            if stretch[0].is_stable { (2.4, Stroke::Solid) } else { (1.4, Stroke::Dashed) };
        for n in 0..stretch[0].points.len() {
            let points = stretch.iter().chain(next).map(|it| [it.value, it.points[n]]).collect();
            layers.push(Layer::Line { points, colour: INK, width, stroke });
        }
        begin = end;
    }
    layers
}

/// A mark at each point of the orbit, the first with the name.
fn marks(found: &DrawnBifurcation) -> Vec<Layer> {
    let mark = |(n, it): (usize, &f64)| Layer::Named {
        at: [found.value, *it],
        name: if n == 0 { found.name.clone() } else { String::new() },
        colour: MARK,
    };
    found.points.iter().enumerate().map(mark).collect()
}
