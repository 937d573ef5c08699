//! A sheet: panels of layers under a title, with a caption; what the paper's figures are drawn as.

mod layer;
mod plot;

pub use layer::{KeyEntry, Layer, Raster, Stroke};
pub use plot::{Plot, PlotWindow};

use super::axes::around;
use super::canvas::{Canvas, TextSide};
use super::{DrawError, Drawing, palette};
use plotters::coord::Shift;
use plotters::prelude::*;

const TITLE: f64 = 24.0;
const TEXT: f64 = 18.0;
/// Height of a line of the caption.
const LINE: u32 = 26;
const HEAD: u32 = 56;
/// Mean width of a letter of the caption, on the generous side.
const LETTER: usize = 9;

/// A sheet of panels, row by row.
#[derive(Clone, Debug)]
pub struct Figure {
    /// What it shows.
    pub title: String,
    /// Parameters, axes, what is assumed: wrapped under the panels.
    pub caption: String,
    /// Panels beside each other.
    pub columns: usize,
    /// Width and height of a panel with its axes' names, pixels.
    pub panel: (u32, u32),
    /// The panels.
    pub plots: Vec<Plot>,
}

impl Figure {
    fn lines(&self) -> Vec<String> {
        let width = (self.panel.0 as usize * self.columns.max(1)).saturating_sub(48) / LETTER;
        let mut lines = vec![String::new()];
        for word in self.caption.split_whitespace() {
            let full = lines
                .last()
                .is_some_and(|line| line.chars().count() + word.chars().count() >= width);
            if full {
                lines.push(String::new());
            }
            if let Some(line) = lines.last_mut() {
                if !line.is_empty() {
                    line.push(' ');
                }
                line.push_str(word);
            }
        }
        lines
    }

    fn rows(&self) -> usize {
        self.plots.len().div_ceil(self.columns.max(1))
    }

    /// How many marks it takes to draw: what decides whether an SVG of it stays small.
    #[must_use]
    pub fn points(&self) -> usize {
        self.plots.iter().flat_map(|plot| &plot.layers).map(Layer::points).sum()
    }

    /// The figure with all panels over the same ranges.
    #[must_use]
    pub fn on_the_same_axes(mut self) -> Self {
        let extent = |axis: usize| {
            let layers = self.plots.iter().flat_map(|plot| &plot.layers);
            let range = around(layers.flat_map(|layer| layer.extent(axis)));
            (range.start, range.end)
        };
        let window = [extent(0), extent(1)];
        self.plots.iter_mut().for_each(|plot| plot.window = Some(window));
        self
    }
}

impl Drawing for Figure {
    fn size(&self) -> (u32, u32) {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let width = self.panel.0.saturating_mul(count(self.columns.max(1)));
        let panels = self.panel.1.saturating_mul(count(self.rows()));
        (width, HEAD + panels + 20 + LINE * count(self.lines().len()))
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError> {
        let canvas = Canvas { area, scale };
        canvas.paper()?;
        canvas.text(&self.title, (24.0, 30.0), TITLE, TextSide::Left, palette::INK)?;
        let (width, height) = (f64::from(self.panel.0), f64::from(self.panel.1));
        for (i, plot) in self.plots.iter().enumerate() {
            let (row, column) = (i / self.columns.max(1), i % self.columns.max(1));
            let corner = (width * column as f64, f64::from(HEAD) + height * row as f64);
            plot.draw(&canvas, corner, (width, height))?;
        }
        let below = f64::from(HEAD) + height * self.rows() as f64 + 14.0;
        for (i, line) in self.lines().iter().enumerate() {
            let at = (24.0, below + f64::from(LINE) * i as f64);
            canvas.text(line, at, TEXT, TextSide::Left, palette::INK)?;
        }
        Ok(())
    }
}
