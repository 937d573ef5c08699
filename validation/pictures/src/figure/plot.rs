//! One panel of a figure.

use super::super::canvas::{At, Canvas, TextSide};
use super::super::frame::{AxisScale, Panel, Ruler};
use super::super::{axes::around, palette};
use super::layer::Layer;
use super::names;

/// The window of a panel; where an end is not finite the data decide.
pub type PlotWindow = [(f64, f64); 2];

/// A panel.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Stands above it.
    pub title: String,
    /// Names of the axes.
    pub axes: [String; 2],
    /// Ranges of both axes; `None` shows all data.
    pub window: Option<PlotWindow>,
    /// The layers, later ones above earlier ones.
    pub layers: Vec<Layer>,
}

const TEXT_SIZE: f64 = 20.0;
const LEFT_MARGIN: f64 = 126.0;
const RIGHT_MARGIN: f64 = 24.0;
const TOP_MARGIN: f64 = 40.0;
const BOTTOM_MARGIN: f64 = 84.0;

impl Plot {
    pub(super) fn draw(&self, canvas: &mut Canvas, corner: At, (width, height): At) {
        let from = (corner.0 + LEFT_MARGIN, corner.1 + TOP_MARGIN);
        let to = (corner.0 + width - RIGHT_MARGIN, corner.1 + height - BOTTOM_MARGIN);
        canvas.text(&self.title, (from.0, from.1 - 18.0), TEXT_SIZE, TextSide::Left, palette::INK);
        let (Some(x), Some(y)) = (self.ruler(0), self.ruler(1)) else {
            return canvas.text("nothing to show", from, TEXT_SIZE, TextSide::Left, palette::INK);
        };
        let panel = Panel { from, to, x, y };
        let [below, beside] = &self.axes;
        self.fill(canvas, &panel, |canvas| panel.draw_over(canvas, below, beside));
    }

    /// The axis of the panel: over its window, and where that has no end over the data.
    pub(super) fn ruler(&self, axis: usize) -> Option<Ruler> {
        let all = || self.layers.iter().flat_map(|layer| layer.extent(axis));
        let Some(window) = self.window else { return Ruler::over(AxisScale::Linear, all()) };
        let (mut from, mut to) = window[axis];
        if !from.is_finite() || !to.is_finite() {
            let range = around(all());
            from = if from.is_finite() { from } else { range.start };
            to = if to.is_finite() { to } else { range.end };
        }
        (from < to).then(|| Ruler::between(from, to))
    }

    /// Draws the layers, with the frame between those that fill the panel and those above it.
    pub(super) fn fill(&self, canvas: &mut Canvas, panel: &Panel, frame: impl FnOnce(&mut Canvas)) {
        let (below, above): (Vec<&Layer>, Vec<&Layer>) =
            self.layers.iter().partition(|layer| matches!(layer, Layer::Raster(_)));
        // A raster fills the panel: it would hide the grid.
        below.iter().for_each(|layer| layer.draw(canvas, panel));
        if below.is_empty() {
            panel.grid(canvas);
        }
        frame(canvas);
        let named: Vec<_> = above.iter().filter_map(|layer| layer.named(panel)).collect();
        let mut names = named.iter().zip(names::places(&named, panel));
        for layer in above {
            match layer.named(panel).and_then(|_| names.next()) {
                Some((mark, place)) => mark.draw(canvas, place),
                None => layer.draw(canvas, panel),
            }
        }
    }
}
