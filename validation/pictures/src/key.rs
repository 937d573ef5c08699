//! The key of a picture: names beside samples of what they name.

use super::canvas::{At, Canvas, TextSide};
use super::{font, palette};

/// Draws a sample within 40 pixels from the given place on to the right.
type Swatch<'a> = Box<dyn Fn(&mut Canvas, At) + 'a>;

/// A name and its sample.
pub(super) struct KeyItem<'a> {
    name: &'a str,
    sample: Swatch<'a>,
}

impl<'a> KeyItem<'a> {
    pub fn new(name: &'a str, sample: impl Fn(&mut Canvas, At) + 'a) -> Self {
        Self { name, sample: Box::new(sample) }
    }
}

/// The layout of a key.
#[derive(Clone, Copy)]
pub(super) enum KeyLayout {
    /// The entries stand beside each other.
    Row,
    /// The entries stand below each other, at least so many pixels apart.
    Column(f64),
}

/// Height of a line of a name that has several, as a share of the text's size.
const LINE_HEIGHT: f64 = 1.35;
const SAMPLE_WIDTH: f64 = 40.0;

/// Draws a key from the place of its first sample on.
pub(super) fn key<'a>(
    canvas: &mut Canvas,
    mut at: At,
    layout: KeyLayout,
    size: f64,
    items: impl IntoIterator<Item = KeyItem<'a>>,
) {
    for KeyItem { name, sample } in items {
        sample(canvas, at);
        let mut below = 0.0;
        for line in name.lines() {
            let place = (at.0 + SAMPLE_WIDTH + 6.0, at.1 + below);
            canvas.text(line, place, size, TextSide::Left, palette::INK);
            below += LINE_HEIGHT * size;
        }
        match layout {
            KeyLayout::Row => at.0 += SAMPLE_WIDTH + 30.0 + font::width(name, size),
            KeyLayout::Column(step) => at.1 += step.max(below + LINE_HEIGHT * size / 2.0),
        }
    }
}
