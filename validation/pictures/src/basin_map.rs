//! Basins of attraction: every cell in its attractor's light colour, the attractors on top in dark.

use super::canvas::{At, Canvas, TextSide};
use super::colour::{Colour, WHITE};
use super::frame::{Panel, Ruler};
use super::key::{KeyItem, KeyLayout, key};
use super::look::Marker;
use super::{Drawing, palette};
use percuss::dynamics::attractor::Label;

/// A basin picture.
#[derive(Clone, Debug)]
pub struct BasinMap {
    /// The parameters for which the basins were found.
    pub title: String,
    /// A note on how the picture was made, and on what is assumed.
    pub note: String,
    /// The names of the axes, across and up.
    pub axes: [String; 2],
    /// The ranges of the axes, from and to.
    pub window: [[f64; 2]; 2],
    /// Cells across.
    pub columns: usize,
    /// The place to which each cell leads, row by row from the lowest on: an attractor by its
    /// place in `attractors`.
    pub cells: Vec<Label>,
    /// The attractors.
    pub attractors: Vec<ShownAttractor>,
}

/// An attractor in a basin picture.
#[derive(Clone, Debug)]
pub struct ShownAttractor {
    /// The name in the key.
    pub name: String,
    /// The attractor's colours, by their place in a palette of [`BASIN_COLOURS`].
    pub colour: usize,
    /// The attractor's points, across and up.
    pub points: Vec<[f64; 2]>,
    /// Drawn point by point as large markers.
    pub is_orbit: bool,
}

/// Colours after which they begin again.
pub const BASIN_COLOURS: usize = palette::BASINS.len();

/// A basin's light colour and its attractor's dark one, by their place.
#[must_use]
pub const fn basin_colours(place: usize) -> (Colour, Colour) {
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

    fn draw(&self, canvas: &mut Canvas) {
        canvas.title(&self.title);
        for (k, line) in self.note.lines().enumerate() {
            let at = (24.0, 916.0 + 26.0 * k as f64);
            canvas.text(line, at, TEXT - 2.0, TextSide::Left, palette::INK);
        }
        self.cells(canvas);
        let [x, y] = self.window.map(|[from, to]| Ruler::between(from, to));
        let panel = Panel { from: FROM, to: TO, x, y };
        let [across, up] = &self.axes;
        panel.draw_over(canvas, across, up);
        for shown in &self.attractors {
            shown.draw(canvas, &panel);
        }
        self.key(canvas);
    }
}

impl BasinMap {
    fn paper(&self, cell: Label) -> Colour {
        match cell {
            Label::Attractor(k) => self.attractors.get(k).map_or(WHITE, |it| it.colours().0),
            Label::Escaping => WHITE,
            Label::Unresolved => palette::UNRESOLVED,
            Label::Inadmissible => palette::NO_START,
            Label::Ended => palette::ENDED,
        }
    }

    fn cells(&self, canvas: &mut Canvas) {
        let colours: Vec<_> = self.cells.iter().map(|cell| self.paper(*cell)).collect();
        canvas.cells(FROM, TO, colours.chunks_exact(self.columns.max(1)));
    }

    fn key(&self, canvas: &mut Canvas) {
        let attractors = self.attractors.iter().map(|shown| {
            let (light, dark) = shown.colours();
            KeyItem::new(&shown.name, move |canvas, at| {
                swatch(canvas, at, light);
                canvas.marker(Marker::Circle, (at.0 + 13.0, at.1), 5.0, dark);
            })
        });
        let others = [
            (Label::Unresolved, "unresolved", palette::UNRESOLVED),
            (Label::Escaping, "escaping (white)", WHITE),
            (Label::Inadmissible, "no start", palette::NO_START),
            (Label::Ended, "the run ends", palette::ENDED),
        ];
        let others = others.into_iter().filter(|(cell, ..)| self.cells.contains(cell));
        let others = others.map(|(_, name, colour)| {
            KeyItem::new(name, move |canvas, at| swatch(canvas, at, colour))
        });
        key(canvas, KEY, KeyLayout::Column(40.0), TEXT - 3.0, attractors.chain(others));
    }
}

fn swatch(canvas: &mut Canvas, at: At, colour: Colour) {
    canvas.fill((at.0, at.1 - 13.0), (at.0 + 26.0, at.1 + 13.0), colour);
}

impl ShownAttractor {
    fn colours(&self) -> (Colour, Colour) {
        basin_colours(self.colour)
    }

    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        let dark = self.colours().1;
        let places = self.points.iter().filter_map(|[p, y]| panel.at((*p, *y)));
        if self.is_orbit {
            for at in places {
                canvas.marker(Marker::Circle, at, 6.0, WHITE);
                canvas.marker(Marker::Circle, at, 4.5, dark);
            }
        } else {
            canvas.dots(places, 0.7, dark);
        }
    }
}
