//! What a panel of a sheet is made of.

use super::super::canvas::{At, Canvas, TextSide};
use super::super::frame::Panel;
use super::super::{DrawError, palette};
use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;

/// How a line is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// The line is not dashed.
    Solid,
    /// Into dashes.
    Dashed,
    /// Into dashes and dots.
    DashDotted,
    /// Into dots.
    Dotted,
}

impl Stroke {
    /// Lengths drawn and left out in turn, pixels; none for a whole line.
    const fn pattern(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[9.0, 6.0],
            Self::DashDotted => &[11.0, 4.0, 2.0, 4.0],
            Self::Dotted => &[2.0, 4.0],
        }
    }

    /// What is drawn of a line, in pixels.
    pub(in super::super) fn cut(self, line: &[At]) -> Vec<Vec<At>> {
        match self.pattern() {
            _ if line.len() < 2 => Vec::new(),
            [] => vec![line.to_vec()],
            pattern => broken(line, pattern),
        }
    }
}

/// Cells of equal size over a window, coloured by label.
#[derive(Clone, Debug)]
pub struct Raster {
    /// Horizontal and vertical range that the cells fill.
    pub window: super::PlotWindow,
    /// Rows from the bottom up, all of the same length.
    pub rows: Vec<Vec<RGBColor>>,
}

/// A layer of a panel.
#[derive(Clone, Debug)]
pub enum Layer {
    /// A line.
    Line {
        /// The line's points.
        points: Vec<[f64; 2]>,
        /// The line's colour.
        colour: RGBColor,
        /// The line's width in pixels.
        width: f64,
        /// How it is broken.
        stroke: Stroke,
    },
    /// Points.
    Dots {
        /// The points' places.
        points: Vec<[f64; 2]>,
        /// The points' colour.
        colour: RGBColor,
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
        colour: RGBColor,
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
    pub colour: RGBColor,
    /// How its line is broken.
    pub stroke: Option<Stroke>,
}

const TEXT: f64 = 18.0;
/// Room that a letter takes on average.
const LETTER: f64 = 10.0;

impl Layer {
    /// Points as small as their number asks for: few are drawn so that they show.
    #[must_use]
    pub fn cloud(points: Vec<[f64; 2]>, colour: RGBColor) -> Self {
        let size = match points.len() {
            0..2_000 => 1.6,
            2_000..30_000 => 0.8,
            30_000..300_000 => 0.5,
            _ => 0.34,
        };
        Self::Dots { points, colour, size }
    }

    /// How many marks it takes to draw.
    pub(super) fn points(&self) -> usize {
        match self {
            Self::Line { points, .. } | Self::Dots { points, .. } => points.len(),
            Self::Raster(raster) => raster.rows.iter().map(Vec::len).sum(),
            _ => 1,
        }
    }

    /// What an axis has to show of it.
    pub(super) fn extent(&self, axis: usize) -> Vec<f64> {
        match self {
            Self::Line { points, .. } | Self::Dots { points, .. } => {
                points.iter().map(|point| point[axis]).collect()
            }
            Self::Raster(raster) => vec![raster.window[axis].0, raster.window[axis].1],
            Self::Guide(x) if axis == 0 => vec![*x],
            _ => Vec::new(),
        }
    }

    pub(super) fn draw<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        panel: &Panel,
    ) -> Result<(), DrawError> {
        match self {
            Self::Line { points, colour, width, stroke } => {
                let stretches = stretches(points, panel);
                let dashes = stretches.iter().flat_map(|stretch| stroke.cut(stretch));
                dashes.into_iter().try_for_each(|dash| canvas.trace(&dash, *width, *colour))
            }
            Self::Dots { points, colour, size } => {
                points.iter().filter_map(|[x, y]| panel.at((*x, *y))).try_for_each(|at| {
                    canvas.fill((at.0 - size, at.1 - size), (at.0 + size, at.1 + size), *colour)
                })
            }
            Self::Raster(raster) => raster.draw(canvas, panel),
            Self::Guide(x) => {
                let x = panel.from.0 + panel.x.place(*x) * (panel.to.0 - panel.from.0);
                if !(panel.from.0..=panel.to.0).contains(&x) {
                    return Ok(());
                }
                let line = [(x, panel.from.1), (x, panel.to.1)];
                let dashes = broken(&line, Stroke::Dashed.pattern());
                dashes.iter().try_for_each(|dash| canvas.trace(dash, 1.2, palette::INK))
            }
            Self::Text { at, text, colour } => match panel.at((at[0], at[1])) {
                Some(at) => {
                    canvas.text(text, (at.0 + 8.0, at.1 - 12.0), TEXT, TextSide::Left, *colour)
                }
                None => Ok(()),
            },
            Self::Key(entries) => {
                let mut x = panel.from.0;
                entries.iter().try_for_each(|entry| {
                    entry.draw(canvas, (x, panel.from.1 - 18.0))?;
                    x += 74.0 + LETTER * entry.name.chars().count() as f64;
                    Ok(())
                })
            }
        }
    }
}

impl KeyEntry {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<'_, B>, at: At) -> Result<(), DrawError> {
        let line = [at, (at.0 + 40.0, at.1)];
        match self.stroke {
            None => {
                let middle = at.0 + 28.0;
                let corners = ((middle - 4.0, at.1 - 4.0), (middle + 4.0, at.1 + 4.0));
                canvas.fill(corners.0, corners.1, self.colour)?;
            }
            Some(stroke) => stroke
                .cut(&line)
                .iter()
                .try_for_each(|dash| canvas.trace(dash, 2.0, self.colour))?,
        }
        canvas.text(&self.name, (at.0 + 48.0, at.1), TEXT, TextSide::Left, palette::INK)
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

/// A line cut into what a pattern of lengths draws of it.
fn broken(line: &[At], pattern: &[f64]) -> Vec<Vec<At>> {
    let mut dashes = Vec::new();
    let (mut part, mut left) = (0, pattern[0]);
    let mut dash = vec![line[0]];
    for pair in line.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                dash.push(to);
                break;
            }
            let share = left / length;
            from = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
            dash.push(from);
            if part % 2 == 0 {
                dashes.push(std::mem::take(&mut dash));
            }
            part = (part + 1) % pattern.len();
            left = pattern[part];
            dash = vec![from];
        }
    }
    if part % 2 == 0 && dash.len() > 1 {
        dashes.push(dash);
    }
    dashes
}

impl Raster {
    fn draw<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        panel: &Panel,
    ) -> Result<(), DrawError> {
        let [(left, right), (bottom, top)] = self.window;
        let height = (top - bottom) / self.rows.len() as f64;
        for (i, row) in self.rows.iter().enumerate() {
            let width = (right - left) / row.len() as f64;
            let y = bottom + height * i as f64;
            let mut begin = 0;
            // Neighbours of one colour are one rectangle.
            for run in row.chunk_by(|a, b| a == b) {
                let end = begin + run.len();
                let x = |cell: usize| left + width * cell as f64;
                let corners = (panel.place((x(begin), y + height)), panel.place((x(end), y)));
                canvas.fill(corners.0, corners.1, run[0])?;
                begin = end;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_follow_the_line_and_keep_their_lengths() {
        let line = [(0.0, 0.0), (3.0, 0.0), (3.0, 97.0)];
        let dashes = broken(&line, &[10.0, 5.0]);
        let length = |dash: &Vec<At>| -> f64 {
            dash.windows(2).map(|p| (p[1].0 - p[0].0).hypot(p[1].1 - p[0].1)).sum()
        };
        // 100 = 6 (10 + 5) + 10
        assert_eq!(dashes.len(), 7);
        for dash in &dashes {
            assert!((length(dash) - 10.0).abs() < 1e-9, "{dash:?}");
        }
        assert_eq!(dashes[0][1], (3.0, 0.0));
    }
}
