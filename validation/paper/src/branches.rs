//! The continuation diagram that explains Fig. 10: stable and unstable orbits, and where they turn,
//! double and graze.

use super::attractors::{found, of_period};
use super::continued::branch;
use super::item_work::{Findings, ItemWork};
use crate::engine::Failure;
use crate::number::shortest;
use crate::picture::Colour;
use crate::picture::{Figure, INK, KeyEntry, Layer, Plot, Stroke};
use percuss::dynamics::continuation::{Bifurcation, BifurcationKind, Branch, BranchPoint};
use percuss::dynamics::orbit::Orbit;

const OMEGA_RANGE: (f64, f64) = (1.35, 1.72);

/// A family of orbits: its period, where it is taken up, and its colour.
const FAMILIES: [(u32, f64, Colour); 6] = [
    (4, 1.4, Colour(0, 0, 0)),
    (12, 1.45, Colour(200, 0, 30)),
    (6, 1.58, Colour(0, 114, 178)),
    (3, 1.7, Colour(0, 158, 115)),
    (5, 1.6, Colour(213, 94, 0)),
    (9, 1.7, Colour(170, 90, 150)),
];

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let mut branches = Vec::new();
    for (period, omega, colour) in FAMILIES {
        let attractors = found(omega)?;
        let first = of_period(&attractors, period)?.points[0];
        let down = branch(first, period, omega, OMEGA_RANGE.0)?;
        // From the low end up, so that a branch that turns is seen all the way back.
        let low = down.points.last().filter(|_| down.is_complete());
        let (from, guess) = low.map_or((omega, first), |it| (it.value, it.orbit.points[0]));
        branches.push((period, colour, branch(guess, period, from, OMEGA_RANGE.1)?));
        if !down.is_complete() {
            branches.push((period, colour, down));
        }
        (work.step)();
    }
    let mut findings = Findings::default();
    findings.picture("figure-10-branches", &drawing(&branches))?;
    let rows = branches.iter().flat_map(|(period, _, branch)| {
        branch.points.iter().flat_map(move |point| rows(*period, point))
    });
    findings.csv("figure-10-branches", &["family", "omega", "stable", "p", "y", "q"], rows)?;
    let met = branches.iter().flat_map(|(period, _, branch)| {
        branch.bifurcations.iter().map(move |it| {
            let numbers = [it.value, it.error].map(shortest);
            [period.to_string(), it.kind.as_str().to_owned()].into_iter().chain(numbers).collect()
        })
    });
    findings.csv("figure-10-bifurcations", &["family", "type", "omega", "error"], met)?;
    Ok(findings)
}

fn rows(period: u32, point: &BranchPoint) -> impl Iterator<Item = Vec<String>> + '_ {
    point.orbit.points.iter().map(move |[p, y, q]| {
        let stable = point.orbit.is_stable().to_string();
        let numbers = [*p, *y, *q].map(shortest);
        [period.to_string(), shortest(point.value), stable].into_iter().chain(numbers).collect()
    })
}

/// One line per strobe and stretch of equal stability, up to where that changes.
fn lines(branch: &Branch, colour: Colour) -> Vec<Layer> {
    let alike = |a: &BranchPoint, b: &BranchPoint| {
        a.orbit.is_stable() == b.orbit.is_stable() && a.orbit.points.len() == b.orbit.points.len()
    };
    let stretches: Vec<&[BranchPoint]> = branch.points.chunk_by(alike).collect();
    let mut layers = Vec::new();
    for (k, stretch) in stretches.iter().enumerate() {
        let before =
            k.checked_sub(1).and_then(|k| change(branch, stretches[k].last(), stretch.first()));
        let after =
            stretches.get(k + 1).and_then(|next| change(branch, stretch.last(), next.first()));
        let stable = stretch[0].orbit.is_stable();
        for strobe in 0..stretch[0].orbit.points.len() {
            let at =
                |(value, orbit): (f64, &Orbit)| orbit.points.get(strobe).map(|it| [value, it[0]]);
            let inner = stretch.iter().map(|it| (it.value, &it.orbit));
            let whole = before.into_iter().chain(inner).chain(after);
            layers.push(Layer::Line {
                points: whole.filter_map(at).collect(),
                colour,
                width: if stable { 2.2 } else { 1.1 },
                stroke: if stable { Stroke::Solid } else { Stroke::Dashed },
            });
        }
    }
    layers
}

/// The orbit at which stability changes between two neighbours on a branch.
fn change<'a>(
    branch: &'a Branch,
    last: Option<&BranchPoint>,
    next: Option<&BranchPoint>,
) -> Option<(f64, &'a Orbit)> {
    let (last, next) = (last?, next?);
    let far = |it: &Bifurcation| (it.value - last.value).abs() + (it.value - next.value).abs();
    let smooth = branch.bifurcations.iter().filter(|it| it.kind != BifurcationKind::Grazing);
    let nearest = smooth.min_by(|a, b| far(a).total_cmp(&far(b)))?;
    Some((nearest.value, &nearest.orbit))
}

/// Squares where a branch turns, doubles or grazes.
fn marks(branch: &Branch) -> Vec<Layer> {
    let colour = |kind: BifurcationKind| match kind {
        BifurcationKind::Fold => Colour(0, 0, 0),
        BifurcationKind::Flip => Colour(200, 0, 30),
        BifurcationKind::NeimarkSacker => Colour(0, 158, 115),
        BifurcationKind::Grazing
        | BifurcationKind::Corner
        | BifurcationKind::EventGained
        | BifurcationKind::EventLost => Colour(130, 130, 130),
    };
    let mark = |it: &Bifurcation| Layer::Dots {
        points: it.orbit.points.iter().map(|point| [it.value, point[0]]).collect(),
        colour: colour(it.kind),
        size: 3.2,
    };
    branch.bifurcations.iter().map(mark).collect()
}

fn drawing(branches: &[(u32, Colour, Branch)]) -> Figure {
    let mut layers: Vec<Layer> =
        branches.iter().flat_map(|(_, colour, branch)| lines(branch, *colour)).collect();
    layers.extend(branches.iter().flat_map(|(.., branch)| marks(branch)));
    let key = |(period, _, colour): (u32, f64, Colour)| KeyEntry {
        name: format!("P{period}"),
        colour,
        stroke: Some(Stroke::Solid),
    };
    layers.push(Layer::Key(FAMILIES.map(key).to_vec()));
    layers.push(Layer::Text {
        at: [OMEGA_RANGE.0, -3.25],
        text: "black squares: fold; red: flip; grey: graze".to_owned(),
        colour: INK,
    });
    Figure {
        title: "Orbits behind Figs. 7 and 10, stable and unstable".to_owned(),
        caption: "a = 0.3, b = 0.1, \u{3be} = 0.1, g = 0.02, \u{3c6} = \u{3c0}/2; strobes at \u{3c9}\u{3c4} = 0 (mod 2\u{3c0}) of orbits \
                  followed by pseudo-arclength continuation. Solid: stable; dashed: unstable. What looks like one branch in a \
                  diagram made by brute force ends in folds, and its doublings are others."
            .to_owned(),
        columns: 1,
        panel: (760, 900),
        plots: vec![Plot {
            title: String::new(),
            axes: ["\u{3c9}".to_owned(), "p".to_owned()],
            window: Some([OMEGA_RANGE, (-3.4, 1.2)]),
            layers,
        }],
    }
}
