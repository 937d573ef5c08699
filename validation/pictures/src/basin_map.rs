//! Basins of attraction: every cell in its attractor's light colour, the attractors on top in dark.

use super::canvas::{At, Canvas, TextSide};
use super::colour::{Colour, WHITE};
use super::fitted::{self, BOTTOM_MARGIN, MARGIN, NAME_DISTANCE};
use super::frame::{Panel, Ruler};
use super::key::{KeyItem, KeyLayout, key};
use super::look::Marker;
use super::{Drawing, font, palette};
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
const PANEL_FROM: At = (140.0, 64.0);
const PANEL_TO: At = (900.0, 824.0);
const KEY_CORNER: At = (926.0, 84.0);
const TEXT_SIZE: f64 = 20.0;
const KEY_TEXT_SIZE: f64 = TEXT_SIZE - 3.0;

/// The smallest map with its key, and the room around a map that fills a size.
const MIN_SIZE: (u32, u32) = (360, 200);
/// The width of a key's sample, with the space before its name.
const KEY_SAMPLE_WIDTH: f64 = 64.0;

impl Drawing for BasinMap {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.title(&self.title);
        for (k, line) in self.note.lines().enumerate() {
            let at = (24.0, 916.0 + 26.0 * k as f64);
            canvas.text(line, at, TEXT_SIZE - 2.0, TextSide::Left, palette::INK);
        }
        let [x, y] = self.rulers();
        let panel = Panel { from: PANEL_FROM, to: PANEL_TO, x, y };
        let [across, up] = &self.axes;
        self.fill(canvas, &panel, |canvas| panel.draw_over(canvas, across, up));
        self.key(canvas, KEY_CORNER, KeyLayout::Column(40.0), str::to_owned);
    }

    fn least_size(&self) -> (u32, u32) {
        MIN_SIZE
    }

    /// Draws the map and short names of its colours: a paper has its own caption.
    fn draw_within(&self, canvas: &mut Canvas, size: (u32, u32)) {
        let first_line = |name: &str| name.lines().next().unwrap_or_default().to_owned();
        let names = self.attractors.iter().map(|it| first_line(&it.name));
        let others = self.other_labels().into_iter().map(|it| it.0.to_owned());
        let widths = names.chain(others).map(|it| font::width(&it, KEY_TEXT_SIZE));
        let key = KEY_SAMPLE_WIDTH + widths.fold(0.0, f64::max);
        let to = (f64::from(size.0) - key - MARGIN, f64::from(size.1) - BOTTOM_MARGIN);
        let panel = fitted::panel(self.rulers(), (0.0, MARGIN), to);
        let [across, up] = &self.axes;
        self.fill(canvas, &panel, |canvas| {
            panel.draw_named(canvas, (across, NAME_DISTANCE), (up, panel.from.0 - MARGIN));
        });
        let at = (to.0 + MARGIN, MARGIN + MARGIN);
        self.key(canvas, at, KeyLayout::Column(30.0), first_line);
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

    fn rulers(&self) -> [Ruler; 2] {
        self.window.map(|[from, to]| Ruler::between(from, to))
    }

    /// Draws the cells, the frame and the attractors above them.
    fn fill(&self, canvas: &mut Canvas, panel: &Panel, frame: impl FnOnce(&mut Canvas)) {
        let colours: Vec<_> = self.cells.iter().map(|cell| self.paper(*cell)).collect();
        canvas.cells(panel.from, panel.to, colours.chunks_exact(self.columns.max(1)));
        frame(canvas);
        for shown in &self.attractors {
            shown.draw(canvas, panel);
        }
    }

    /// The names and colours of the labels of no attractor that occur.
    fn other_labels(&self) -> Vec<(&'static str, Colour)> {
        let others = [
            (Label::Unresolved, "unresolved", palette::UNRESOLVED),
            (Label::Escaping, "escaping (white)", WHITE),
            (Label::Inadmissible, "no start", palette::NO_START),
            (Label::Ended, "the run ends", palette::ENDED),
        ];
        let occur = others.into_iter().filter(|(cell, ..)| self.cells.contains(cell));
        occur.map(|(_, name, colour)| (name, colour)).collect()
    }

    fn key(
        &self,
        canvas: &mut Canvas,
        from: At,
        layout: KeyLayout,
        shown: impl Fn(&str) -> String,
    ) {
        let names: Vec<_> = self.attractors.iter().map(|it| shown(&it.name)).collect();
        let attractors = self.attractors.iter().zip(&names).map(|(shown, name)| {
            let (light, dark) = shown.colours();
            KeyItem::new(name, move |canvas, at| {
                swatch(canvas, at, light);
                canvas.marker(Marker::Circle, (at.0 + 13.0, at.1), 5.0, dark);
            })
        });
        let others = self
            .other_labels()
            .into_iter()
            .map(|(name, colour)| KeyItem::new(name, move |canvas, at| swatch(canvas, at, colour)));
        key(canvas, from, layout, KEY_TEXT_SIZE, attractors.chain(others));
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
