//! Sets of points side by side on the same axes.

use super::frame::{Panel, Ruler, Scale};
use super::pen::{Pen, Side};
use super::{DrawError, Drawing, palette};
use plotters::coord::Shift;
use plotters::prelude::*;

const WIDTH: u32 = 1500;
const HEIGHT: u32 = 780;
const TEXT: f64 = 20.0;
const FEW: usize = 5000;

/// One set of points.
#[derive(Clone, Debug)]
pub struct Cloud {
    /// What it is.
    pub name: String,
    /// Its points.
    pub points: Vec<[f64; 2]>,
}

/// Two sets side by side.
#[derive(Clone, Debug)]
pub struct Clouds {
    /// What they are.
    pub title: String,
    /// What is said below: how far they lie apart.
    pub note: String,
    /// Names of the axes.
    pub axes: [String; 2],
    /// Left and right.
    pub pair: [Cloud; 2],
}

impl Drawing for Clouds {
    fn size(&self) -> (u32, u32) {
        (WIDTH, HEIGHT)
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError> {
        let pen = Pen { area, scale };
        pen.paper()?;
        pen.text(&self.title, (24.0, 30.0), TEXT + 4.0, Side::Left, palette::INK)?;
        pen.text(&self.note, (24.0, 756.0), TEXT - 2.0, Side::Left, palette::INK)?;
        let ruler = |k: usize| {
            let all = self.pair.iter().flat_map(|cloud| &cloud.points);
            Ruler::over(Scale::Linear, all.map(|point| point[k]))
        };
        for (i, cloud) in self.pair.iter().enumerate() {
            let (Some(x), Some(y)) = (ruler(0), ruler(1)) else {
                return pen.text("no points", (24.0, 80.0), TEXT, Side::Left, palette::INK);
            };
            let left = 130.0 + 740.0 * i as f64;
            let panel = Panel { from: (left, 92.0), to: (left + 600.0, 660.0), x, y };
            panel.draw(&pen, &self.axes[0], &self.axes[1])?;
            pen.text(&cloud.name, (left, 72.0), TEXT, Side::Left, palette::INK)?;
            let colour =
                if i == 0 { palette::INK } else { palette::phase(percuss::Phase::NoContact) };
            // Few points are drawn larger, or they do not show.
            let half = if cloud.points.len() < FEW { 1.1 } else { 0.5 };
            for at in cloud.points.iter().filter_map(|[p, y]| panel.at((*p, *y))) {
                pen.fill((at.0 - half, at.1 - half), (at.0 + half, at.1 + half), colour)?;
            }
        }
        Ok(())
    }
}
