//! A canvas for plotters, whose shapes become the text of an SVG.
//!
//! Some things are written beside it, because plotters' SVG has no words for them: what a group
//! says of its shapes (dashes, sharp edges, a turn), the outlines of letters, which have curves and
//! holes, and clouds of dots, which would be an element each.

use super::colour::{Colour, WHITE};
use super::font::{self, FAMILY};
use super::look::Marker;
use super::palette;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::{self, Write};

/// A place in pixels, from the left and from the top.
pub(super) type At = (f64, f64);

/// The dash pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// The line is whole.
    Solid,
    /// The line is drawn as dashes.
    Dashed,
    /// The line is drawn as dashes and dots in turn.
    DashDotted,
    /// The line is drawn as dots.
    Dotted,
}

impl Stroke {
    /// Lengths of dashes and gaps in turn, in hundredths of a pixel; `None` for a whole line.
    pub(super) const fn dashes(self) -> Option<&'static str> {
        match self {
            Self::Solid => None,
            Self::Dashed => Some("900 600"),
            Self::DashDotted => Some("1100 400 200 400"),
            Self::Dotted => Some("200 400"),
        }
    }
}

/// A white canvas for a [`super::Drawing`].
#[derive(Debug)]
pub struct Canvas {
    size: (u32, u32),
    svg: String,
    letters: Letters,
}

/// The form of text in a picture.
#[derive(Clone, Copy, Debug)]
pub(super) enum Letters {
    /// Text, which can be searched and is shown in a font of the viewer.
    Text,
    /// Outlines, which need no font.
    Outlines,
}

/// The side of its place on which a text stands.
#[derive(Clone, Copy)]
pub(super) enum TextSide {
    Left,
    Middle,
    Right,
}

impl TextSide {
    const fn anchor(self) -> HPos {
        match self {
            Self::Left => HPos::Left,
            Self::Middle => HPos::Center,
            Self::Right => HPos::Right,
        }
    }

    /// The part of its text that stands left of its place.
    const fn share(self) -> f64 {
        match self {
            Self::Left => 0.0,
            Self::Middle => 0.5,
            Self::Right => 1.0,
        }
    }
}

/// Units of the coordinates in a pixel: plotters places shapes on whole units, and no eye tells
/// hundredths apart.
const UNITS_PER_PIXEL: f64 = 100.0;
/// Half the height of a capital letter, as a share of the text's size.
const HALF_CAPITAL_HEIGHT: f64 = 0.31;
/// Half the height of a small letter, which plotters puts at a text's place.
const HALF_SMALL_HEIGHT: f64 = 0.235;
/// Plotters divides the size of a font by it.
const FONT_SHARE: f64 = 1.24;
/// Dots are placed on a grid of so many units, and drawn once where they coincide.
const DOT_STEP_UNITS: f64 = 25.0;
/// The most dots of one path: a renderer sorts the edges of a whole path.
const MAX_DOTS_PER_PATH: usize = 500;
/// The most lines of one path.
const MAX_LINES_PER_PATH: usize = 250;

fn units(pixels: f64) -> i32 {
    (UNITS_PER_PIXEL * pixels).round() as i32
}

fn place((x, y): At) -> (i32, i32) {
    (units(x), units(y))
}

fn style(colour: Colour, width: f64) -> ShapeStyle {
    RGBColor::from(colour).stroke_width(units(width).unsigned_abs())
}

/// The size of a canvas in pixels, and where it is printed in millimetres.
#[derive(Clone, Copy)]
pub(super) struct Sheet {
    pub(super) size: (u32, u32),
    pub(super) size_mm: Option<[f64; 2]>,
}

impl Canvas {
    pub(super) fn new(size: (u32, u32), letters: Letters) -> Self {
        Self::on(Sheet { size, size_mm: None }, letters)
    }

    pub(super) fn on(sheet: Sheet, letters: Letters) -> Self {
        let size = sheet.size;
        let mut canvas = Self { size, svg: String::new(), letters };
        let to = place((f64::from(size.0), f64::from(size.1)));
        let [width, height] = match sheet.size_mm {
            Some(size_mm) => size_mm.map(|it| format!("{it}mm")),
            None => [size.0, size.1].map(|it| it.to_string()),
        };
        canvas.add(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {} {}\" stroke-linejoin=\"round\">",
            to.0, to.1
        ));
        canvas.plot(|it| it.draw_rect((0, 0), to, &style(WHITE, 0.0), true));
        canvas
    }

    pub(super) fn finish(self) -> String {
        self.svg + "</svg>\n"
    }

    /// Draws with plotters and keeps the shapes without the root around them.
    fn plot<T>(&mut self, draw: impl FnOnce(&mut SVGBackend<'_>) -> T) {
        let mut piece = String::new();
        // A string takes all that is written.
        let _ = draw(&mut SVGBackend::with_string(&mut piece, self.size));
        let shapes = piece.split_once('\n').and_then(|it| it.1.strip_suffix("</svg>\n"));
        self.svg.push_str(shapes.unwrap_or_default());
    }

    /// Gives all that is drawn an attribute that plotters does not write.
    fn with(&mut self, attribute: fmt::Arguments<'_>, draw: impl FnOnce(&mut Self)) {
        self.add(format_args!("<g {attribute}>"));
        draw(self);
        self.add(format_args!("</g>"));
    }

    /// Draws larger or smaller by a factor.
    pub(super) fn draw_scaled(&mut self, factor: f64, draw: impl FnOnce(&mut Self)) {
        self.with(format_args!("transform=\"scale({factor})\""), draw);
    }

    fn add(&mut self, element: fmt::Arguments<'_>) {
        // A string takes all that is written.
        let _ = writeln!(self.svg, "{element}");
    }

    /// The picture's title, in its upper left corner.
    pub(super) fn title(&mut self, text: &str) {
        self.text(text, (24.0, 30.0), 24.0, TextSide::Left, palette::INK);
    }

    pub(super) fn line(&mut self, from: At, to: At, width: f64, colour: Colour) {
        self.trace(&[from, to], width, Stroke::Solid, colour);
    }

    /// Draws a line through several places; nothing where there are fewer than two.
    pub(super) fn trace(&mut self, places: &[At], width: f64, stroke: Stroke, colour: Colour) {
        if places.len() < 2 {
            return;
        }
        let draw = |canvas: &mut Self| {
            let places = places.iter().map(|at| place(*at));
            canvas.plot(|it| it.draw_path(places, &style(colour, width)));
        };
        match stroke.dashes() {
            None => draw(self),
            Some(dashes) => self.with(format_args!("stroke-dasharray=\"{dashes}\""), draw),
        }
    }

    /// Draws lines with round ends as few paths, which stays small where they are many; a line
    /// through one place is a disc.
    pub(super) fn strokes(
        &mut self,
        lines: impl IntoIterator<Item = Vec<At>>,
        width: f64,
        colour: Colour,
    ) {
        let lines: Vec<Vec<At>> = lines.into_iter().filter(|line| !line.is_empty()).collect();
        for lines in lines.chunks(MAX_LINES_PER_PATH) {
            self.svg.push_str("<path d=\"");
            for line in lines {
                let mut last = place(line[0]);
                let _ = write!(self.svg, "M{} {}l", last.0, last.1);
                for at in if line.len() > 1 { &line[1..] } else { &line[..] } {
                    let next = place(*at);
                    // A renderer leaves out a line of no length.
                    let across = next.0 - last.0 + i32::from(line.len() == 1);
                    let _ = write!(self.svg, "{across} {} ", next.1 - last.1);
                    last = next;
                }
                self.svg.truncate(self.svg.trim_end().len());
            }
            let width = units(width);
            self.add(format_args!(
                "\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
                 stroke-linecap=\"round\"/>"
            ));
        }
    }

    /// Fills upright bands between two heights, given by their sides, up to whole pixels.
    pub(super) fn bands(
        &mut self,
        sides: impl IntoIterator<Item = (f64, f64)>,
        (top, bottom): (f64, f64),
        colour: Colour,
    ) {
        let height = units(bottom - top);
        self.svg.push_str("<path d=\"");
        for (left, right) in sides {
            let (x, y) = place((left, top));
            let width = units(right) - x;
            let _ = write!(self.svg, "M{x} {y}h{width}v{height}h-{width}z");
        }
        self.add(format_args!("\" fill=\"{colour}\" shape-rendering=\"crispEdges\"/>"));
    }

    /// Fills a rectangle up to whole pixels, so that nothing shows between neighbours.
    pub(super) fn fill(&mut self, from: At, to: At, colour: Colour) {
        self.draw_crisply(|canvas| canvas.rectangle(from, to, colour));
    }

    fn draw_crisply(&mut self, draw: impl FnOnce(&mut Self)) {
        self.with(format_args!("shape-rendering=\"crispEdges\""), draw);
    }

    fn rectangle(&mut self, from: At, to: At, colour: Colour) {
        self.plot(|it| it.draw_rect(place(from), place(to), &style(colour, 0.0), true));
    }

    /// Fills the rectangle between two corners with rows of cells, the lowest row first.
    pub(super) fn cells<'a>(
        &mut self,
        from: At,
        to: At,
        rows: impl ExactSizeIterator<Item = &'a [Colour]>,
    ) {
        let height = (to.1 - from.1) / rows.len() as f64;
        self.draw_crisply(|canvas| {
            for (i, row) in rows.enumerate() {
                let bottom = to.1 - height * i as f64;
                canvas.row((from.0, bottom - height), (to.0, bottom), row);
            }
        });
    }

    /// Fills the rectangle between two corners with cells from left to right.
    fn row(&mut self, from: At, to: At, cells: &[Colour]) {
        let width = (to.0 - from.0) / cells.len() as f64;
        let x = |cell: usize| from.0 + width * cell as f64;
        let mut begin = 0;
        // Neighbours of one colour are one rectangle.
        for run in cells.chunk_by(|a, b| a == b) {
            let end = begin + run.len();
            self.rectangle((x(begin), from.1), (x(end), to.1), run[0]);
            begin = end;
        }
    }

    pub(super) fn frame(&mut self, from: At, to: At) {
        let corners = [from, (to.0, from.1), to, (from.0, to.1), from];
        self.trace(&corners, 1.0, Stroke::Solid, palette::INK);
    }

    /// Fills a small square around each place; `half` is half its width.
    pub(super) fn dots(&mut self, places: impl Iterator<Item = At>, half: f64, colour: Colour) {
        let step = |value: f64| (UNITS_PER_PIXEL * (value - half) / DOT_STEP_UNITS).round() as i32;
        let mut corners: Vec<_> = places.map(|(x, y)| (step(y), step(x))).collect();
        corners.sort_unstable();
        corners.dedup();
        let (width, step) = (units(2.0 * half), DOT_STEP_UNITS as i32);
        // Plotters writes an element for each square, and resvg refuses a million elements.
        for corners in corners.chunks(MAX_DOTS_PER_PATH) {
            self.svg.push_str("<path d=\"");
            for (y, x) in corners {
                let (x, y) = (x * step, y * step);
                let _ = write!(self.svg, "M{x} {y}h{width}v{width}h-{width}z");
            }
            self.add(format_args!("\" fill=\"{colour}\"/>"));
        }
    }

    pub(super) fn text(&mut self, text: &str, at: At, size: f64, side: TextSide, colour: Colour) {
        if text.is_empty() {
            return;
        }
        match self.letters {
            Letters::Text => self.letters(text, at, size, side, colour),
            Letters::Outlines => self.outlines(text, at, size, side, colour),
        }
    }

    fn letters(&mut self, text: &str, at: At, size: f64, side: TextSide, colour: Colour) {
        let at = (at.0, at.1 + (HALF_CAPITAL_HEIGHT - HALF_SMALL_HEIGHT) * size);
        let size = FONT_SHARE * f64::from(units(font::EM * size));
        let colour = RGBColor::from(colour);
        let style = TextStyle::from((FAMILY, size).into_font())
            .color(&colour)
            .pos(Pos::new(side.anchor(), VPos::Center));
        self.plot(|it| it.draw_text(text, &style, place(at)));
    }

    /// Draws the outlines of letters, whose curves and holes are no shapes of plotters'.
    fn outlines(&mut self, text: &str, at: At, size: f64, side: TextSide, colour: Colour) {
        let (outline, width) = font::outline(text, UNITS_PER_PIXEL * size);
        let (x, y) = place((at.0, at.1 + HALF_CAPITAL_HEIGHT * size));
        let x = x - (side.share() * width).round() as i32;
        self.add(format_args!(
            "<path transform=\"translate({x} {y})\" fill=\"{colour}\" d=\"{outline}\"/>"
        ));
    }

    /// Writes from below to above, with the text's middle at `at`.
    pub(super) fn upright(&mut self, text: &str, at: At, size: f64) {
        let (x, y) = place(at);
        self.with(format_args!("transform=\"rotate(-90 {x} {y})\""), |canvas| {
            canvas.text(text, at, size, TextSide::Middle, palette::INK);
        });
    }

    fn polygon(&mut self, corners: &[At], colour: Colour) {
        let corners = corners.iter().map(|at| place(*at));
        self.plot(|it| it.fill_polygon(corners, &RGBColor::from(colour)));
    }

    pub(super) fn disc(&mut self, at: At, radius: f64, colour: Colour) {
        let radius = units(radius).unsigned_abs();
        self.plot(|it| it.draw_circle(place(at), radius, &style(colour, 0.0), true));
    }

    /// A marker of which only the outline shows; one of lines, which has none, in a ring.
    pub(super) fn hollow(&mut self, marker: Marker, at: At, size: f64, colour: Colour) {
        if matches!(marker, Marker::Cross | Marker::Plus) {
            self.disc(at, size + 4.0, colour);
            self.disc(at, size + 2.0, WHITE);
            return self.marker(marker, at, size - 1.0, colour);
        }
        self.marker(marker, at, size + 2.0, colour);
        self.marker(marker, at, size - 1.5, WHITE);
    }

    pub(super) fn marker(&mut self, marker: Marker, at: At, size: f64, colour: Colour) {
        let corner = |(x, y): At| (at.0 + size * x, at.1 + size * y);
        let mut shape = |corners: &[At]| {
            let corners: Vec<_> = corners.iter().map(|it| corner(*it)).collect();
            self.polygon(&corners, colour);
        };
        match marker {
            Marker::Circle => self.disc(at, size, colour),
            Marker::Square => shape(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            Marker::Triangle => shape(&[(0.0, -1.2), (1.15, 0.9), (-1.15, 0.9)]),
            Marker::Nabla => shape(&[(0.0, 1.2), (1.15, -0.9), (-1.15, -0.9)]),
            Marker::Diamond => shape(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
            Marker::Cross => {
                for (from, to) in [((-0.95, -0.95), (0.95, 0.95)), ((-0.95, 0.95), (0.95, -0.95))] {
                    self.line(corner(from), corner(to), size / 2.5, colour);
                }
            }
            Marker::Plus => {
                for (from, to) in [((0.0, -1.25), (0.0, 1.25)), ((-1.25, 0.0), (1.25, 0.0))] {
                    self.line(corner(from), corner(to), size / 2.5, colour);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_dots_are_drawn_once() {
        let mut canvas = Canvas::new((10, 10), Letters::Text);
        canvas.dots([(3.0, 4.0), (3.01, 4.0), (5.0, 4.0)].into_iter(), 0.5, WHITE);
        let svg = canvas.finish();
        assert!(svg.contains("d=\"M250 350h100v100h-100zM450 350h100v100h-100z\""), "{svg}");
    }

    #[test]
    fn many_lines_are_one_path() {
        let mut canvas = Canvas::new((10, 10), Letters::Text);
        canvas.strokes([vec![(1.0, 2.0), (3.0, 1.0)], vec![], vec![(5.0, 5.0)]], 2.0, WHITE);
        canvas.bands([(1.0, 2.0), (4.0, 6.0)], (0.0, 3.0), WHITE);
        let svg = canvas.finish();
        assert!(svg.contains("d=\"M100 200l200 -100M500 500l1 0\" fill=\"none\""), "{svg}");
        assert!(svg.contains("M100 0h100v300h-100zM400 0h200v300h-200z"), "{svg}");
    }

    #[test]
    fn text_is_escaped() {
        let mut canvas = Canvas::new((10, 10), Letters::Text);
        canvas.text("a < b & c", (0.0, 0.0), 10.0, TextSide::Left, WHITE);
        assert!(canvas.finish().contains(">\na &lt; b &amp; c\n</text>"));
    }
}
