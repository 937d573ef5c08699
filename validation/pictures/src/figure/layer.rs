//! The layers of a figure's panel.

use super::super::canvas::{At, Canvas, Stroke, TextSide};
use super::super::frame::Panel;
use super::super::key::{KeyItem, KeyLayout, key};
use super::super::{Colour, palette};
use super::names::NamedMark;

/// Cells of equal size over a window, coloured by label.
#[derive(Clone, Debug)]
pub struct Raster {
    /// Horizontal and vertical range that the cells fill.
    pub window: super::PlotWindow,
    /// Rows from the bottom up, all of the same length.
    pub rows: Vec<Vec<Colour>>,
}

/// A layer of a panel.
#[derive(Clone, Debug)]
pub enum Layer {
    /// A line.
    Line {
        /// The line's points.
        points: Vec<[f64; 2]>,
        /// The line's colour.
        colour: Colour,
        /// The line's width in pixels.
        width: f64,
        /// The dash pattern of the line.
        stroke: Stroke,
    },
    /// Points.
    Dots {
        /// The points' places.
        points: Vec<[f64; 2]>,
        /// The points' colour.
        colour: Colour,
        /// Half their width in pixels.
        size: f64,
    },
    /// Cells.
    Raster(Raster),
    /// A vertical line through the whole panel.
    Guide(f64),
    /// Words beside a place.
    Text {
        /// The place.
        at: [f64; 2],
        /// The words.
        text: String,
        /// The colour of the words.
        colour: Colour,
    },
    /// A mark with a name beside it, on the side that has the room.
    Named {
        /// The place.
        at: [f64; 2],
        /// The name.
        name: String,
        /// The colour of both.
        colour: Colour,
    },
    /// The panel's key, above it where it hides nothing: names in a row.
    Key(Vec<KeyEntry>),
}

/// A name in a key, with its line or, without a stroke, its points.
#[derive(Clone, Debug)]
pub struct KeyEntry {
    /// The name.
    pub name: String,
    /// The colour of what it names.
    pub colour: Colour,
    /// The dash pattern of the entry's line.
    pub stroke: Option<Stroke>,
}

const TEXT_SIZE: f64 = 18.0;

impl Layer {
    /// Points as small as their number asks for: few are drawn so that they show.
    #[must_use]
    pub fn cloud(points: Vec<[f64; 2]>, colour: Colour) -> Self {
        let size = match points.len() {
            0..2_000 => 1.6,
            2_000..30_000 => 0.8,
            30_000..300_000 => 0.5,
            _ => 0.34,
        };
        Self::Dots { points, colour, size }
    }

    /// The number of marks that the layer takes to draw.
    pub(super) fn points(&self) -> usize {
        match self {
            Self::Line { points, .. } | Self::Dots { points, .. } => points.len(),
            Self::Raster(raster) => raster.rows.iter().map(Vec::len).sum(),
            _ => 1,
        }
    }

    /// The values of the layer along one axis.
    pub(super) fn extent(&self, axis: usize) -> Vec<f64> {
        match self {
            Self::Line { points, .. } | Self::Dots { points, .. } => {
                points.iter().map(|point| point[axis]).collect()
            }
            Self::Raster(raster) => vec![raster.window[axis].0, raster.window[axis].1],
            Self::Guide(x) if axis == 0 => vec![*x],
            Self::Named { at, .. } => vec![at[axis]],
            _ => Vec::new(),
        }
    }

    /// The mark with its name that the layer is, if the panel has its place.
    pub(super) fn named(&self, panel: &Panel) -> Option<NamedMark<'_>> {
        let Self::Named { at, name, colour } = self else { return None };
        Some(NamedMark { at: panel.at((at[0], at[1]))?, name, colour: *colour })
    }

    pub(super) fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        match self {
            Self::Line { points, colour, width, stroke } => {
                for stretch in stretches(points, panel) {
                    canvas.trace(&stretch, *width, *stroke, *colour);
                }
            }
            Self::Dots { points, colour, size } => {
                let places = points.iter().filter_map(|[x, y]| panel.at((*x, *y)));
                canvas.dots(places, *size, *colour);
            }
            Self::Raster(raster) => raster.draw(canvas, panel),
            Self::Guide(x) => {
                let x = panel.from.0 + panel.x.place(*x) * (panel.to.0 - panel.from.0);
                if (panel.from.0..=panel.to.0).contains(&x) {
                    let line = [(x, panel.from.1), (x, panel.to.1)];
                    canvas.trace(&line, 1.2, Stroke::Dashed, palette::INK);
                }
            }
            Self::Text { at, text, colour } => {
                if let Some(at) = panel.at((at[0], at[1])) {
                    canvas.text(
                        text,
                        (at.0 + 8.0, at.1 - 12.0),
                        TEXT_SIZE,
                        TextSide::Left,
                        *colour,
                    );
                }
            }
            Self::Key(entries) => {
                KeyEntry::draw_row(entries, canvas, (panel.from.0, panel.from.1 - 18.0));
            }
            // Names are drawn where others leave them room.
            Self::Named { .. } => {}
        }
    }
}

impl KeyEntry {
    /// Draws entries beside each other, from the place of the first sample on.
    pub(super) fn draw_row(entries: &[Self], canvas: &mut Canvas, from: At) {
        let items = entries
            .iter()
            .map(|entry| KeyItem::new(&entry.name, |canvas, at| entry.sample(canvas, at)));
        key(canvas, from, KeyLayout::Row, TEXT_SIZE, items);
    }

    fn sample(&self, canvas: &mut Canvas, (x, y): At) {
        match self.stroke {
            None => canvas.fill((x + 24.0, y - 4.0), (x + 32.0, y + 4.0), self.colour),
            Some(stroke) => canvas.trace(&[(x, y), (x + 40.0, y)], 2.0, stroke, self.colour),
        }
    }
}

/// The pieces of a line inside the panel, in pixels.
fn stretches(points: &[[f64; 2]], panel: &Panel) -> Vec<Vec<At>> {
    let mut pieces = vec![Vec::new()];
    for [x, y] in points {
        match (panel.at((*x, *y)), pieces.last_mut()) {
            (Some(at), Some(piece)) => piece.push(at),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Vec::new()),
            _ => {}
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

impl Raster {
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        let [(left, right), (bottom, top)] = self.window;
        let rows = self.rows.iter().map(Vec::as_slice);
        canvas.cells(panel.place((left, top)), panel.place((right, bottom)), rows);
    }
}
