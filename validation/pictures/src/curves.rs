//! Curves with markers in one panel, their key beside it.

use super::canvas::Stroke;
use super::canvas::{At, Canvas, TextSide};
use super::frame::{Axis, Panel, Ruler};
use super::key::{KeyItem, KeyLayout, key};
use super::{Colour, Drawing, Marker, font, palette};

const SIZE: (u32, u32) = (1500, 900);
const TEXT: f64 = 20.0;
/// Room for names in the key.
const KEY_WIDTH: f64 = 306.0;

/// A curve with its name, its colour and its points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The curve's name; without one it is not in the key.
    pub name: String,
    /// The curve's colour.
    pub colour: Colour,
    /// The shape of its points; without one it is a line only.
    pub marker: Option<Marker>,
    /// The line's width in pixels.
    pub width: f64,
    /// How the line is broken.
    pub stroke: Stroke,
    /// The curve's points; those that are not finite are left out.
    pub points: Vec<(f64, f64)>,
}

/// A picture of curves.
#[derive(Clone, Debug)]
pub struct Curves {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves, later ones above earlier ones.
    pub curves: Vec<Curve>,
}

impl Drawing for Curves {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.title(&self.title);
        let points = || self.curves.iter().flat_map(|curve| &curve.points).filter(|it| finite(it));
        let x = Ruler::over(self.x.scale, points().map(|point| point.0));
        let y = Ruler::over(self.y.scale, points().map(|point| point.1));
        let (Some(x), Some(y)) = (x, y) else {
            let at = (130.0, 120.0);
            return canvas.text("nothing was measured", at, TEXT, TextSide::Left, palette::INK);
        };
        let panel = Panel { from: (130.0, 64.0), to: (1110.0, 816.0), x, y };
        panel.draw(canvas, &self.x.label, &self.y.label);
        self.curves.iter().for_each(|curve| curve.draw(canvas, &panel));
        let named = || self.curves.iter().filter(|curve| !curve.name.is_empty());
        let step = (740.0 / named().count().max(1) as f64).min(30.0);
        let size = (step - 4.0).min(TEXT - 1.0);
        let widest = named().map(|curve| font::width(&curve.name, size)).fold(KEY_WIDTH, f64::max);
        let size = size * KEY_WIDTH / widest;
        key(canvas, (1136.0, 80.0), KeyLayout::Column(step), size, named().map(Curve::key));
    }
}

fn finite(point: &(f64, f64)) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

impl Curve {
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        let places = self.points.iter().filter(|it| finite(it)).filter_map(|it| panel.at(*it));
        let places: Vec<_> = places.collect();
        self.line(canvas, &places);
        self.markers(canvas, &places);
    }

    fn line(&self, canvas: &mut Canvas, places: &[At]) {
        canvas.trace(places, self.width, self.stroke, self.colour);
    }

    fn markers(&self, canvas: &mut Canvas, places: &[At]) {
        if let Some(marker) = self.marker {
            places.iter().for_each(|at| canvas.marker(marker, *at, 6.0, self.colour));
        }
    }

    fn key(&self) -> KeyItem<'_> {
        KeyItem::new(&self.name, |canvas, (x, y)| {
            self.line(canvas, &[(x, y), (x + 38.0, y)]);
            self.markers(canvas, &[(x + 19.0, y)]);
        })
    }
}
