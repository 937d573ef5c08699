//! Curves with markers in one panel, their key beside it.

use super::canvas::{At, Canvas, TextSide};
use super::figure::Stroke;
use super::frame::{Axis, Panel, Ruler};
use super::{DrawError, Drawing, Marker, palette};
use plotters::coord::Shift;
use plotters::prelude::*;

const SIZE: (u32, u32) = (1500, 900);
const TEXT: f64 = 20.0;

/// A curve with its name, its colour and its points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The curve's name; without one it is not in the key.
    pub name: String,
    /// The curve's colour.
    pub colour: RGBColor,
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

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError> {
        let canvas = Canvas { area, scale };
        canvas.paper()?;
        canvas.text(&self.title, (24.0, 32.0), TEXT + 4.0, TextSide::Left, palette::INK)?;
        let points = || self.curves.iter().flat_map(|curve| &curve.points).filter(|it| finite(it));
        let x = Ruler::over(self.x.scale, points().map(|point| point.0));
        let y = Ruler::over(self.y.scale, points().map(|point| point.1));
        let (Some(x), Some(y)) = (x, y) else {
            return canvas.text(
                "nothing was measured",
                (130.0, 120.0),
                TEXT,
                TextSide::Left,
                palette::INK,
            );
        };
        let panel = Panel { from: (130.0, 64.0), to: (1110.0, 816.0), x, y };
        panel.draw(&canvas, &self.x.label, &self.y.label)?;
        for curve in &self.curves {
            curve.draw(&canvas, &panel)?;
        }
        let named = self.curves.iter().filter(|curve| !curve.name.is_empty());
        let step = (740.0 / named.clone().count().max(1) as f64).min(30.0);
        for (i, curve) in named.enumerate() {
            curve.key(&canvas, (1136.0, 80.0 + i as f64 * step), (step - 4.0).min(TEXT - 1.0))?;
        }
        Ok(())
    }
}

fn finite(point: &(f64, f64)) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

impl Curve {
    fn draw<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        panel: &Panel,
    ) -> Result<(), DrawError> {
        let places = self.points.iter().filter(|it| finite(it)).filter_map(|it| panel.at(*it));
        let places: Vec<_> = places.collect();
        self.line(canvas, &places)?;
        match self.marker {
            Some(marker) => {
                places.iter().try_for_each(|at| canvas.marker(marker, *at, 6.0, self.colour))
            }
            None => Ok(()),
        }
    }

    fn line<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        places: &[At],
    ) -> Result<(), DrawError> {
        let stretches = self.stroke.cut(places);
        stretches.iter().try_for_each(|stretch| canvas.trace(stretch, self.width, self.colour))
    }

    fn key<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        (x, y): (f64, f64),
        size: f64,
    ) -> Result<(), DrawError> {
        self.line(canvas, &[(x, y), (x + 38.0, y)])?;
        if let Some(marker) = self.marker {
            canvas.marker(marker, (x + 19.0, y), 6.0, self.colour)?;
        }
        canvas.text(&self.name, (x + 44.0, y), size, TextSide::Left, palette::INK)
    }
}
