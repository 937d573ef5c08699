//! A figure: panels of layers under a title, with a caption; what the paper's figures are drawn as.

mod fitted;
mod layer;
mod names;
mod plot;

pub use super::canvas::Stroke;
pub use layer::{KeyEntry, Layer, Raster};
pub use plot::{Plot, PlotWindow};

use super::axes::around;
use super::canvas::{Canvas, TextSide};
use super::{Drawing, font, palette};

const TEXT_SIZE: f64 = 18.0;
/// Height of a line of the caption.
const LINE_HEIGHT: u32 = 26;
const HEAD_HEIGHT: u32 = 56;
/// Room on either side of the caption.
const MARGIN: f64 = 24.0;

/// Panels under a title, row by row.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The title of the picture.
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
    /// The caption in lines that are no longer than the figure is wide.
    fn lines(&self) -> Vec<String> {
        font::wrap(&self.caption, TEXT_SIZE, f64::from(self.size_of_panels().0) - 2.0 * MARGIN)
    }

    fn size_of_panels(&self) -> (u32, u32) {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let width = self.panel.0.saturating_mul(count(self.columns.max(1)));
        (width, self.panel.1.saturating_mul(count(self.rows())))
    }

    fn rows(&self) -> usize {
        self.plots.len().div_ceil(self.columns.max(1))
    }

    /// The number of marks that the figure takes to draw, which decides whether an SVG stays small.
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
    fn least_size(&self) -> (u32, u32) {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let (columns, rows) = (count(self.columns.max(1)), count(self.rows()));
        (fitted::MIN_SIZE.0.saturating_mul(columns), fitted::MIN_SIZE.1.saturating_mul(rows))
    }

    /// Draws the panels alone: a paper has its own caption.
    fn draw_within(&self, canvas: &mut Canvas, size: (u32, u32)) {
        let columns = self.columns.max(1);
        let width = f64::from(size.0) / columns as f64;
        let height = f64::from(size.1) / self.rows().max(1) as f64;
        for (i, plot) in self.plots.iter().enumerate() {
            let corner = (width * (i % columns) as f64, height * (i / columns) as f64);
            plot.draw_within(canvas, corner, (width, height));
        }
    }

    fn size(&self) -> (u32, u32) {
        let (width, height) = self.size_of_panels();
        let lines = u32::try_from(self.lines().len()).unwrap_or(u32::MAX);
        (
            width,
            height
                .saturating_add(HEAD_HEIGHT + 20)
                .saturating_add(LINE_HEIGHT.saturating_mul(lines)),
        )
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.title(&self.title);
        let (width, height) = (f64::from(self.panel.0), f64::from(self.panel.1));
        for (i, plot) in self.plots.iter().enumerate() {
            let (row, column) = (i / self.columns.max(1), i % self.columns.max(1));
            let corner = (width * column as f64, f64::from(HEAD_HEIGHT) + height * row as f64);
            plot.draw(canvas, corner, (width, height));
        }
        let below = f64::from(HEAD_HEIGHT) + height * self.rows() as f64 + 14.0;
        for (i, line) in self.lines().iter().enumerate() {
            let at = (MARGIN, below + f64::from(LINE_HEIGHT) * i as f64);
            canvas.text(line, at, TEXT_SIZE, TextSide::Left, palette::INK);
        }
    }
}
