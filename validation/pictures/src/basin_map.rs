//! Basins of attraction: every cell in its attractor's light colour, the attractors on top in dark.

use super::canvas::{At, Canvas, TextSide};
use super::frame::{Panel, Ruler};
use super::look::Marker;
use super::{DrawError, Drawing, palette};
use percuss::dynamics::attractor::Label;
use plotters::coord::Shift;
use plotters::prelude::*;

/// A basin picture.
#[derive(Clone, Debug)]
pub struct BasinMap {
    /// Which parameters it belongs to.
    pub title: String,
    /// How it was made, and what is assumed.
    pub note: String,
    /// The ranges of p and of y, from and to.
    pub window: [[f64; 2]; 2],
    /// Cells along p.
    pub columns: usize,
    /// The place to which each cell leads, row by row from the lowest y on: an attractor by its
    /// place in `attractors`.
    pub cells: Vec<Label>,
    /// The attractors.
    pub attractors: Vec<Shown>,
}

/// An attractor in a basin picture.
#[derive(Clone, Debug)]
pub struct Shown {
    /// What it is, for the key.
    pub name: String,
    /// The attractor's colours, by their place in a palette of [`BASIN_COLOURS`].
    pub colour: usize,
    /// The attractor's strobes in (p, y).
    pub points: Vec<[f64; 2]>,
    /// Drawn point by point as large markers.
    pub is_orbit: bool,
}

/// Colours after which they begin again.
pub const BASIN_COLOURS: usize = palette::BASINS.len();

/// A basin's light colour and its attractor's dark one, by their place.
#[must_use]
pub const fn basin_colours(place: usize) -> (RGBColor, RGBColor) {
    palette::BASINS[place % BASIN_COLOURS]
}

const SIZE: (u32, u32) = (1200, 980);
const FROM: At = (140.0, 64.0);
const TO: At = (900.0, 824.0);
const KEY: At = (926.0, 84.0);
const TEXT: f64 = 20.0;

impl Drawing for BasinMap {
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
        canvas.text(&self.title, (24.0, 30.0), TEXT + 4.0, TextSide::Left, palette::INK)?;
        for (k, line) in self.note.lines().enumerate() {
            let at = (24.0, 916.0 + 26.0 * k as f64);
            canvas.text(line, at, TEXT - 2.0, TextSide::Left, palette::INK)?;
        }
        self.cells(&canvas)?;
        let [[p_from, p_to], [y_from, y_to]] = self.window;
        let (x, y) = (Ruler::between(p_from, p_to), Ruler::between(y_from, y_to));
        let panel = Panel { from: FROM, to: TO, x, y };
        panel.draw_over(&canvas, "p (displacement)", "y (velocity)")?;
        for shown in &self.attractors {
            shown.draw(&canvas, &panel)?;
        }
        self.key(&canvas)
    }
}

impl BasinMap {
    fn paper(&self, cell: Label) -> RGBColor {
        match cell {
            Label::Attractor(k) => self.attractors.get(k).map_or(WHITE, |it| it.colours().0),
            Label::Escaping => WHITE,
            Label::Unresolved => palette::UNRESOLVED,
        }
    }

    /// Equal neighbours in one stroke.
    fn cells<B: DrawingBackend>(&self, canvas: &Canvas<'_, B>) -> Result<(), DrawError> {
        let columns = self.columns.max(1);
        let rows = self.cells.len() / columns;
        let x = |k: usize| FROM.0 + (TO.0 - FROM.0) * k as f64 / columns as f64;
        let y = |k: usize| TO.1 - (TO.1 - FROM.1) * k as f64 / rows as f64;
        for (row, cells) in self.cells.chunks_exact(columns).enumerate() {
            let mut begin = 0;
            for run in cells.chunk_by(|a, b| a == b) {
                let end = begin + run.len();
                canvas.fill((x(begin), y(row + 1)), (x(end), y(row)), self.paper(run[0]))?;
                begin = end;
            }
        }
        Ok(())
    }

    fn key<B: DrawingBackend>(&self, canvas: &Canvas<'_, B>) -> Result<(), DrawError> {
        let mut at = KEY;
        for shown in &self.attractors {
            let (light, dark) = shown.colours();
            canvas.fill((at.0, at.1 - 13.0), (at.0 + 26.0, at.1 + 13.0), light)?;
            canvas.marker(Marker::Circle, (at.0 + 13.0, at.1), 5.0, dark)?;
            for (k, line) in shown.name.lines().enumerate() {
                let place = (at.0 + 36.0, at.1 + 24.0 * k as f64);
                canvas.text(line, place, TEXT - 3.0, TextSide::Left, palette::INK)?;
            }
            at.1 += 20.0 + 24.0 * shown.name.lines().count() as f64;
        }
        let others = [
            (Label::Unresolved, "unresolved", palette::UNRESOLVED),
            (Label::Escaping, "escaping (white)", WHITE),
        ];
        for (cell, name, colour) in others {
            if self.cells.contains(&cell) {
                canvas.fill((at.0, at.1 - 13.0), (at.0 + 26.0, at.1 + 13.0), colour)?;
                canvas.text(name, (at.0 + 36.0, at.1), TEXT - 3.0, TextSide::Left, palette::INK)?;
                at.1 += 40.0;
            }
        }
        Ok(())
    }
}

impl Shown {
    fn colours(&self) -> (RGBColor, RGBColor) {
        basin_colours(self.colour)
    }

    fn draw<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        panel: &Panel,
    ) -> Result<(), DrawError> {
        let dark = self.colours().1;
        for at in self.points.iter().filter_map(|[p, y]| panel.at((*p, *y))) {
            if self.is_orbit {
                canvas.marker(Marker::Circle, at, 6.0, WHITE)?;
                canvas.marker(Marker::Circle, at, 4.5, dark)?;
            } else {
                canvas.fill((at.0 - 0.7, at.1 - 0.7), (at.0 + 0.7, at.1 + 0.7), dark)?;
            }
        }
        Ok(())
    }
}
