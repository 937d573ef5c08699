//! The font travels with the program: no system library is asked for one.

use std::fmt::Write;
use std::sync::LazyLock;
use ttf_parser::{Face, OutlineBuilder};

/// The one family used, and what stands in for it.
pub(super) const FAMILY: &str = "DejaVu Sans, sans-serif";

static FACE: LazyLock<Option<Face<'static>>> =
    LazyLock::new(|| Face::parse(dejavu::sans::regular(), 0).ok());

/// The size of the font as a share of a text's size, which is the height of its lines.
pub(super) const EM: f64 = 0.859;

/// The width of a text of this size, in pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    outline(text, size).1
}

/// A text in lines that are no longer than `room` pixels, broken at spaces where that is possible.
pub(super) fn wrap(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (longer, lines.last_mut()) {
            (Some(longer), Some(line)) if width(&longer, size) <= room => *line = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A name, cut with an ellipsis where it is longer than `room` pixels.
pub(super) fn shorten(name: &str, size: f64, room: f64) -> String {
    if width(name, size) <= room {
        return name.to_owned();
    }
    let cut = |letters: usize| name.chars().take(letters).chain(['\u{2026}']).collect::<String>();
    let letters = (1..name.chars().count()).rev().find(|n| width(&cut(*n), size) <= room);
    cut(letters.unwrap_or(0))
}

/// A text's letters as the data of an SVG's path that begins at the origin, and its width.
pub(super) fn outline(text: &str, size: f64) -> (String, f64) {
    let mut path = Outline { data: String::new(), scale: 0.0, x: 0.0 };
    let Some(face) = &*FACE else { return (path.data, path.x) };
    path.scale = EM * size / f64::from(face.units_per_em());
    for letter in text.chars() {
        let glyph = face.glyph_index(letter).unwrap_or_default();
        // A glyph without an outline is a space.
        let _ = face.outline_glyph(glyph, &mut path);
        path.x += path.scale * f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    (path.data, path.x)
}

/// Letters that have been drawn, and where the next one begins.
struct Outline {
    data: String,
    scale: f64,
    x: f64,
}

impl Outline {
    fn add(&mut self, command: char, places: &[(f32, f32)]) {
        self.data.push(command);
        for (x, y) in places {
            let (x, y) = (self.x + self.scale * f64::from(*x), -self.scale * f64::from(*y));
            // A string takes all that is written.
            let _ = write!(self.data, "{x:.0} {y:.0} ");
        }
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.add('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.add('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.add('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.data.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_cut_to_the_room_that_they_have() {
        assert_eq!(shorten("impact", 20.0, 200.0), "impact");
        let cut = shorten("second-slips-behind", 20.0, 100.0);
        assert!(cut.starts_with("second") && cut.ends_with('\u{2026}'), "{cut}");
        assert!(width(&cut, 20.0) <= 100.0);
        assert_eq!(shorten("ab", 20.0, 1.0), "\u{2026}");
        assert_eq!(wrap("one two three", 20.0, width("one two", 20.0)), ["one two", "three"]);
    }

    #[test]
    fn every_letter_that_pictures_use_has_an_outline() {
        for letter in "aZ0\u{2212}\u{2026}\u{3be}\u{3c9}\u{3c6}\u{3c4}⁻⁹×".chars() {
            assert!(!outline(&letter.to_string(), 20.0).0.is_empty(), "{letter}");
        }
        assert!((width("ii", 20.0) - 2.0 * width("i", 20.0)).abs() < 1e-9);
    }
}
