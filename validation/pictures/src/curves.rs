//! Curves with markers in one panel, their key beside it.

use super::canvas::Stroke;
use super::canvas::{At, Canvas, TextSide};
use super::frame::{Axis, Panel, Ruler};
use super::key::{KeyItem, KeyLayout, key};
use super::{Colour, Drawing, Marker, font, palette};

const SIZE: (u32, u32) = (1500, 900);
const TEXT_SIZE: f64 = 20.0;
/// The size of the note's text.
const NOTE_TEXT_SIZE: f64 = 17.0;
/// The height of the note's lines.
const NOTE_LINE_HEIGHT: f64 = 24.0;
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
    /// The dash pattern of the line.
    pub stroke: Stroke,
    /// The curve's points; those that are not finite are left out.
    pub points: Vec<(f64, f64)>,
    /// Points that are not to be compared with the others: hollow, and joined by no line.
    pub apart: Vec<(f64, f64)>,
}

/// A picture of curves.
#[derive(Clone, Debug)]
pub struct Curves {
    /// The title of the picture.
    pub title: String,
    /// A note on how to read the picture, below the title.
    pub note: String,
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
        let points = || self.curves.iter().flat_map(Curve::points).filter(|it| finite(it));
        let x = Ruler::over(self.x.scale, points().map(|point| point.0));
        let y = Ruler::over(self.y.scale, points().map(|point| point.1));
        let (Some(x), Some(y)) = (x, y) else {
            let at = (130.0, 120.0);
            return canvas.text(
                "nothing was measured",
                at,
                TEXT_SIZE,
                TextSide::Left,
                palette::INK,
            );
        };
        let note = font::wrap(&self.note, NOTE_TEXT_SIZE, f64::from(SIZE.0) - 48.0);
        for (n, line) in note.iter().enumerate() {
            let at = (24.0, 62.0 + NOTE_LINE_HEIGHT * n as f64);
            canvas.text(line, at, NOTE_TEXT_SIZE, TextSide::Left, palette::INK);
        }
        let top = 64.0 + NOTE_LINE_HEIGHT * note.len() as f64;
        let panel = Panel { from: (130.0, top), to: (1110.0, 816.0), x, y };
        panel.draw(canvas, &self.x.label, &self.y.label);
        self.curves.iter().for_each(|curve| curve.draw(canvas, &panel));
        let named = || self.curves.iter().filter(|curve| !curve.name.is_empty());
        let step = ((804.0 - top) / named().count().max(1) as f64).min(30.0);
        let size = (step - 4.0).min(TEXT_SIZE - 1.0);
        let widest = named().map(|curve| font::width(&curve.name, size)).fold(KEY_WIDTH, f64::max);
        let size = size * KEY_WIDTH / widest;
        key(canvas, (1136.0, top + 16.0), KeyLayout::Column(step), size, named().map(Curve::key));
    }
}

fn finite(point: &(f64, f64)) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

impl Curve {
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        let places = |points: &[(f64, f64)]| {
            let finite = points.iter().filter(|it| finite(it));
            finite.filter_map(|it| panel.at(*it)).collect::<Vec<_>>()
        };
        let joined = places(&self.points);
        self.line(canvas, &joined);
        self.markers(canvas, &joined);
        if let Some(marker) = self.marker {
            for at in places(&self.apart) {
                canvas.hollow(marker, at, 6.0, self.colour);
            }
        }
    }

    /// All its points.
    fn points(&self) -> impl Iterator<Item = &(f64, f64)> {
        self.points.iter().chain(&self.apart)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AxisScale, svg};

    #[test]
    fn points_apart_are_hollow_and_not_joined() {
        let axis = || Axis { label: String::new(), scale: AxisScale::Linear };
        let drawn = |points: Vec<(f64, f64)>, apart: Vec<(f64, f64)>| {
            let curve = Curve {
                name: String::new(),
                colour: Colour(1, 2, 3),
                marker: Some(Marker::Circle),
                width: 2.0,
                stroke: Stroke::Solid,
                points,
                apart,
            };
            let curves = vec![curve];
            svg(&Curves { title: String::new(), note: String::new(), x: axis(), y: axis(), curves })
        };
        let two = vec![(0.0, 0.0), (1.0, 2.0)];
        let own = |svg: &str, shape: &str| {
            svg.lines().filter(|it| it.contains("#010203") && it.contains(shape)).count()
        };
        let (joined, apart) = (drawn(two.clone(), Vec::new()), drawn(Vec::new(), two));
        assert_eq!((own(&joined, "<circle"), own(&apart, "<circle")), (2, 2));
        assert_eq!((own(&joined, "<poly") + own(&joined, "<path"), own(&apart, "<poly")), (1, 0));
        // White discs of what is hollow lie on those of its colour.
        let white = |svg: &str| svg.lines().filter(|it| it.contains("<circle")).count();
        assert_eq!((white(&joined), white(&apart)), (2, 4));
    }
}
