//! The text of an SVG, shape by shape.

use super::colour::{Colour, WHITE};
use super::figure::Stroke;
use super::font::{self, FAMILY};
use super::look::Marker;
use super::palette;
use std::fmt::{self, Write};

/// A place in pixels, from the left and from the top.
pub(super) type At = (f64, f64);

/// A white sheet on which a [`super::Drawing`] draws.
#[derive(Debug)]
pub struct Canvas {
    svg: String,
    letters: Letters,
}

/// How a picture has its text.
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
    const fn anchor(self) -> &'static str {
        match self {
            Self::Left => "start",
            Self::Middle => "middle",
            Self::Right => "end",
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

/// Half the height of a capital letter, as a share of the text's size.
const HALF_CAPITAL: f64 = 0.31;
/// Dots are placed on a grid of so many steps in a pixel, and drawn once where they coincide.
const DOT_STEPS: f64 = 4.0;
/// Dots in one path: a renderer sorts the edges of a whole path.
const DOTS_IN_A_PATH: usize = 500;

/// A length in hundredths of a pixel, which no eye tells apart.
struct Px(f64);

impl fmt::Display for Px {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The sum turns a negative zero into zero.
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}

/// Places as the attribute `points` lists them.
struct Places<'a>(&'a [At]);

impl fmt::Display for Places<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|at| write!(f, "{},{} ", Px(at.0), Px(at.1)))
    }
}

impl Canvas {
    pub(super) fn new((width, height): (u32, u32), letters: Letters) -> Self {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FAMILY}, sans-serif\" fill=\"none\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{WHITE}\"/>\n"
        );
        Self { svg, letters }
    }

    pub(super) fn finish(self) -> String {
        self.svg + "</svg>\n"
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
        let (dashes, width, places) = (stroke.dashes(), Px(width), Places(places));
        self.add(format_args!(
            "<polyline points=\"{places}\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\"{dashes}/>"
        ));
    }

    /// Fills a rectangle up to whole pixels, so that nothing shows between neighbours.
    pub(super) fn fill(&mut self, from: At, to: At, colour: Colour) {
        let (x, y, width, height) = (Px(from.0), Px(from.1), Px(to.0 - from.0), Px(to.1 - from.1));
        self.add(format_args!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{colour}\" \
             shape-rendering=\"crispEdges\"/>"
        ));
    }

    /// Fills the rectangle between two corners with rows of cells, the lowest row first.
    pub(super) fn cells<'a>(
        &mut self,
        from: At,
        to: At,
        rows: impl ExactSizeIterator<Item = &'a [Colour]>,
    ) {
        let height = (to.1 - from.1) / rows.len() as f64;
        for (i, row) in rows.enumerate() {
            let width = (to.0 - from.0) / row.len() as f64;
            let bottom = to.1 - height * i as f64;
            let x = |cell: usize| from.0 + width * cell as f64;
            let mut begin = 0;
            // Neighbours of one colour are one rectangle.
            for run in row.chunk_by(|a, b| a == b) {
                let end = begin + run.len();
                self.fill((x(begin), bottom - height), (x(end), bottom), run[0]);
                begin = end;
            }
        }
    }

    pub(super) fn frame(&mut self, from: At, to: At) {
        let corners = [from, (to.0, from.1), to, (from.0, to.1), from];
        self.trace(&corners, 1.0, Stroke::Solid, palette::INK);
    }

    /// Fills a small square around each place; `half` is half its width.
    pub(super) fn dots(&mut self, places: impl Iterator<Item = At>, half: f64, colour: Colour) {
        let step = |value: f64| ((value - half) * DOT_STEPS).round() as i32;
        let mut corners: Vec<_> = places.map(|(x, y)| (step(y), step(x))).collect();
        corners.sort_unstable();
        corners.dedup();
        let width = Px(2.0 * half);
        for corners in corners.chunks(DOTS_IN_A_PATH) {
            self.svg.push_str("<path d=\"");
            for (y, x) in corners {
                let (x, y) = (f64::from(*x) / DOT_STEPS, f64::from(*y) / DOT_STEPS);
                let _ = write!(self.svg, "M{x} {y}h{width}v{width}h-{width}z");
            }
            self.add(format_args!("\" fill=\"{colour}\"/>"));
        }
    }

    pub(super) fn text(&mut self, text: &str, at: At, size: f64, side: TextSide, colour: Colour) {
        if text.is_empty() {
            return;
        }
        let (x, y) = (at.0, at.1 + HALF_CAPITAL * size);
        match self.letters {
            Letters::Text => {
                let (x, y, anchor, text) = (Px(x), Px(y), side.anchor(), Escaped(text));
                let em = Px(font::EM * size);
                self.add(format_args!(
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{em}\" text-anchor=\"{anchor}\" \
                     fill=\"{colour}\">{text}</text>"
                ));
            }
            Letters::Outlines => {
                let (outline, width) = font::outline(text, size);
                let (x, y) = (Px(x - side.share() * width), Px(y));
                self.add(format_args!(
                    "<path transform=\"translate({x} {y})\" fill=\"{colour}\" d=\"{outline}\"/>"
                ));
            }
        }
    }

    /// Writes from below to above, with the text's middle at `at`.
    pub(super) fn upright(&mut self, text: &str, at: At, size: f64) {
        self.add(format_args!("<g transform=\"rotate(-90 {} {})\">", Px(at.0), Px(at.1)));
        self.text(text, at, size, TextSide::Middle, palette::INK);
        self.add(format_args!("</g>"));
    }

    fn polygon(&mut self, corners: &[At], colour: Colour) {
        self.add(format_args!("<polygon points=\"{}\" fill=\"{colour}\"/>", Places(corners)));
    }

    pub(super) fn disc(&mut self, at: At, radius: f64, colour: Colour) {
        let (x, y, radius) = (Px(at.0), Px(at.1), Px(radius));
        self.add(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{colour}\"/>"));
    }

    pub(super) fn marker(&mut self, marker: Marker, at: At, size: f64, colour: Colour) {
        let place = |(x, y): At| (at.0 + size * x, at.1 + size * y);
        let mut shape = |corners: &[At]| {
            let corners: Vec<_> = corners.iter().map(|it| place(*it)).collect();
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
                    self.line(place(from), place(to), size / 2.5, colour);
                }
            }
            Marker::Plus => {
                for (from, to) in [((0.0, -1.25), (0.0, 1.25)), ((-1.25, 0.0), (1.25, 0.0))] {
                    self.line(place(from), place(to), size / 2.5, colour);
                }
            }
        }
    }
}

/// Text in which what SVG would take for its own is replaced.
struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match c {
            '<' => f.write_str("&lt;"),
            '&' => f.write_str("&amp;"),
            _ => f.write_char(c),
        })
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
        assert!(svg.contains("d=\"M2.5 3.5h1v1h-1zM4.5 3.5h1v1h-1z\""), "{svg}");
    }

    #[test]
    fn text_is_escaped() {
        let mut canvas = Canvas::new((10, 10), Letters::Text);
        canvas.text("a < b & c", (0.0, 0.0), 10.0, TextSide::Left, WHITE);
        assert!(canvas.finish().contains(">a &lt; b &amp; c</text>"));
    }
}
