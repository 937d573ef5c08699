//! A panel that fills a given size: its margins are as large as its labels are.

use super::super::canvas::{At, Canvas, TextSide};
use super::super::fitted::{self, BOTTOM_MARGIN, MARGIN, NAME_DISTANCE};
use super::super::{font, palette};
use super::layer::{KeyEntry, Layer};
use super::plot::Plot;

/// The smallest panel with its labels, width and height in pixels.
pub(super) const MIN_SIZE: (u32, u32) = (220, 180);

const TEXT_SIZE: f64 = 20.0;
/// Height of a line of the title or of the key.
const LINE_HEIGHT: f64 = 26.0;
/// The width of a key's sample with the space after a name.
const KEY_SAMPLE_WIDTH: f64 = 76.0;

impl Plot {
    /// Draws the panel so that it fills a rectangle.
    pub(super) fn draw_within(&self, canvas: &mut Canvas, corner: At, (width, height): At) {
        let (Some(x), Some(y)) = (self.ruler(0), self.ruler(1)) else {
            let at = (corner.0 + MARGIN, corner.1 + MARGIN + TEXT_SIZE);
            return canvas.text("nothing to show", at, TEXT_SIZE, TextSide::Left, palette::INK);
        };
        let keys = self.key_rows(width - 2.0 * MARGIN);
        let titles = usize::from(!self.title.is_empty());
        let head = MARGIN + LINE_HEIGHT * (titles + keys.len()) as f64;
        let to = (corner.0 + width - MARGIN, corner.1 + height - BOTTOM_MARGIN);
        let panel = fitted::panel([x, y], (corner.0, corner.1 + head), to);
        let (wide, tall) = (to.0 - panel.from.0, to.1 - panel.from.1);
        let at = (panel.from.0, corner.1 + MARGIN + 0.4 * TEXT_SIZE);
        canvas.text(&self.title, at, TEXT_SIZE, TextSide::Left, palette::INK);
        let below = font::shorten(&self.axes[0], TEXT_SIZE + 2.0, wide);
        // The name is centred on the panel, and ends below what is above it.
        let beside = font::shorten(&self.axes[1], TEXT_SIZE + 2.0, tall + 2.0 * MARGIN);
        let bare = Self { layers: self.without_keys(), ..self.clone() };
        bare.fill(canvas, &panel, |canvas| {
            panel.draw_named(
                canvas,
                (&below, NAME_DISTANCE),
                (&beside, panel.from.0 - corner.0 - MARGIN),
            );
        });
        let first = head - LINE_HEIGHT * keys.len() as f64 + 0.4 * TEXT_SIZE;
        for (n, row) in keys.into_iter().enumerate() {
            let at = (corner.0 + MARGIN, corner.1 + first + LINE_HEIGHT * n as f64);
            KeyEntry::draw_row(&row, canvas, at);
        }
    }

    fn without_keys(&self) -> Vec<Layer> {
        let others = self.layers.iter().filter(|it| !matches!(it, Layer::Key(_)));
        others.cloned().collect()
    }

    /// The entries of all keys in rows that are no wider than the room.
    fn key_rows(&self, room: f64) -> Vec<Vec<KeyEntry>> {
        let entries = self.layers.iter().filter_map(|it| match it {
            Layer::Key(entries) => Some(entries),
            _ => None,
        });
        let (mut rows, mut used): (Vec<Vec<KeyEntry>>, f64) = (Vec::new(), 0.0);
        for entry in entries.flatten() {
            let width = KEY_SAMPLE_WIDTH + font::width(&entry.name, TEXT_SIZE);
            match rows.last_mut() {
                Some(row) if used + width <= room => row.push(entry.clone()),
                _ => {
                    rows.push(vec![entry.clone()]);
                    used = 0.0;
                }
            }
            used += width;
        }
        rows
    }
}
