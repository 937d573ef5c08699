//! Points in panels one above the other that share their horizontal axis.

use super::frame::{Panel as Frame, Ruler, Scale};
use super::pen::{Pen, Side};
use super::{DrawError, Drawing, palette};
use plotters::coord::Shift;
use plotters::prelude::*;

/// Sections and diagrams.
#[derive(Clone, Debug)]
pub struct Dots {
    /// Which parameters they belong to.
    pub title: String,
    /// How they were made.
    pub note: String,
    /// Name of the horizontal axis.
    pub below: String,
    /// From above to below.
    pub panels: Vec<Panel>,
}

/// Points over the horizontal axis.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Name of the vertical axis.
    pub beside: String,
    /// Its points.
    pub points: Vec<[f64; 2]>,
    /// Its share of the height.
    pub share: f64,
}

const SIZE: (u32, u32) = (1200, 900);
const LEFT: f64 = 140.0;
const RIGHT: f64 = 1170.0;
const TOP: f64 = 64.0;
const BOTTOM: f64 = 776.0;
const BETWEEN: f64 = 44.0;
const TEXT: f64 = 20.0;

/// Half a point's width in pixels: many points are drawn small, few so that they show.
fn half(count: usize) -> f64 {
    match count {
        0..2_000 => 1.6,
        2_000..30_000 => 0.9,
        30_000..300_000 => 0.5,
        _ => 0.34,
    }
}

impl Drawing for Dots {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError> {
        let pen = Pen { area, scale };
        pen.paper()?;
        pen.text(&self.title, (24.0, 30.0), TEXT + 4.0, Side::Left, palette::INK)?;
        pen.text(&self.note, (24.0, 872.0), TEXT - 2.0, Side::Left, palette::INK)?;
        let gaps = BETWEEN * self.panels.len().saturating_sub(1) as f64;
        let height = BOTTOM - TOP - gaps;
        let mut top = TOP;
        for (k, panel) in self.panels.iter().enumerate() {
            let bottom = top + panel.share * height;
            let last = k + 1 == self.panels.len();
            self.panel(&pen, panel, (top, bottom), if last { &self.below } else { "" })?;
            top = bottom + BETWEEN;
        }
        Ok(())
    }
}

impl Dots {
    fn panel<B: DrawingBackend>(
        &self,
        pen: &Pen<'_, B>,
        panel: &Panel,
        (top, bottom): (f64, f64),
        below: &str,
    ) -> Result<(), DrawError> {
        let across = self.panels.iter().flat_map(|panel| &panel.points).map(|point| point[0]);
        let x = Ruler::over(Scale::Linear, across);
        let y = Ruler::over(Scale::Linear, panel.points.iter().map(|point| point[1]));
        let (Some(x), Some(y)) = (x, y) else {
            return pen.text("no points", (LEFT, top + 20.0), TEXT, Side::Left, palette::INK);
        };
        let frame = Frame { from: (LEFT, top), to: (RIGHT, bottom), x, y };
        frame.draw(pen, below, &panel.beside)?;
        let half = half(panel.points.len());
        for at in panel.points.iter().filter_map(|[x, y]| frame.at((*x, *y))) {
            pen.fill((at.0 - half, at.1 - half), (at.0 + half, at.1 + half), palette::INK)?;
        }
        Ok(())
    }
}
