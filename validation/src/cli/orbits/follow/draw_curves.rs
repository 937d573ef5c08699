//! Curves of bifurcations in the plane of two parameters as a picture: one colour for each type,
//! and each curve by its number and event.

use super::Arguments;
use crate::picture::{Colour, Figure, KeyEntry, Layer, Plot, Stroke};
use percuss::affine::{BifurcationCurve, System};
use percuss::dynamics::continuation::BifurcationKind;

/// The colour of a type of bifurcation, from those that eyes of every kind tell apart.
const fn colour(kind: BifurcationKind) -> Colour {
    match kind {
        BifurcationKind::Fold => Colour(0, 114, 178),
        BifurcationKind::Flip => Colour(205, 115, 0),
        BifurcationKind::NeimarkSacker => Colour(105, 75, 170),
        BifurcationKind::Grazing => Colour(160, 20, 80),
        BifurcationKind::Corner => Colour(0, 135, 100),
        BifurcationKind::EventGained => Colour(95, 95, 95),
        BifurcationKind::EventLost => Colour(120, 70, 30),
    }
}

/// A picture of curves over both parameters.
pub(super) fn figure(
    system: &System,
    arguments: &Arguments,
    names: [&str; 2],
    window: [[f64; 2]; 2],
    curves: &[BifurcationCurve],
) -> Figure {
    let mut layers: Vec<Layer> = curves.iter().map(line).collect();
    let numbered = curves.iter().enumerate();
    layers.extend(numbered.filter_map(|(n, curve)| name(system, [n, curves.len()], curve)));
    let is_there = |kind: &BifurcationKind| curves.iter().any(|it| it.kind == *kind);
    let entry = |kind: BifurcationKind| KeyEntry {
        name: kind.to_string(),
        colour: colour(kind),
        stroke: Some(Stroke::Solid),
    };
    layers.push(Layer::Key(BifurcationKind::ALL.into_iter().filter(is_there).map(entry).collect()));
    let caption = format!(
        "bifurcations of orbits of period {} in returns to {}, followed in {} and {}",
        arguments.period,
        arguments.section.text(),
        names[0],
        names[1]
    );
    let window = window.map(|[a, b]| (a.min(b), a.max(b)));
    let axes = names.map(str::to_owned);
    let plots = vec![Plot { title: String::new(), axes, window: Some(window), layers }];
    Figure { title: system.name.clone(), caption, columns: 1, panel: (1200, 800), plots }
}

fn line(curve: &BifurcationCurve) -> Layer {
    let points = curve.points.iter().map(|it| it.values).collect();
    Layer::Line { points, colour: colour(curve.kind), width: 2.4, stroke: Stroke::Solid }
}

/// The number of a curve and its event, each of several further along its curve: they are apart
/// where curves run side by side.
fn name(system: &System, [n, count]: [usize; 2], curve: &BifurcationCurve) -> Option<Layer> {
    let at = curve.points.get(curve.points.len() * (n + 1) / (count + 1))?.values;
    let event = event(system, curve).map(|it| format!(" {it}")).unwrap_or_default();
    Some(Layer::Named { at, name: format!("{n}{event}"), colour: colour(curve.kind) })
}

/// The event of a curve by its name.
pub(super) fn event(system: &System, curve: &BifurcationCurve) -> Option<String> {
    curve.event.map(|it| it.name(system))
}
