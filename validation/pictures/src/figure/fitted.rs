//! A panel that fills a given size: its margins are as large as its labels are.

use super::super::canvas::{At, Canvas, TextSide};
use super::super::fitted::{APART, BELOW, BESIDE, MARGIN, NAME_BELOW, TALL, fewer_ticks};
use super::super::frame::Panel;
use super::super::{font, palette};
use super::layer::{KeyEntry, Layer};
use super::plot::Plot;

/// The smallest panel with its labels, width and height in pixels.
pub(super) const LEAST: (u32, u32) = (220, 180);

const TEXT: f64 = 20.0;
/// Height of a line of the title or of the key.
const LINE: f64 = 26.0;
/// The width of a key's sample with the space after a name.
const KEY_ROOM: f64 = 76.0;

impl Plot {
    /// Draws the panel so that it fills a rectangle.
    pub(super) fn draw_within(&self, canvas: &mut Canvas, corner: At, (width, height): At) {
        let (Some(x), Some(y)) = (self.ruler(0), self.ruler(1)) else {
            let at = (corner.0 + MARGIN, corner.1 + MARGIN + TEXT);
            return canvas.text("nothing to show", at, TEXT, TextSide::Left, palette::INK);
        };
        let keys = self.key_rows(width - 2.0 * MARGIN);
        let titles = usize::from(!self.title.is_empty());
        let head = MARGIN + LINE * (titles + keys.len()) as f64;
        let tall = height - head - BELOW;
        let y = fewer_ticks(y, |ticks| tall / ticks.len().max(1) as f64 > TALL);
        let widest = y.ticks.iter().map(|it| font::width(&it.1, TEXT)).fold(0.0, f64::max);
        let left = BESIDE + widest;
        let wide = width - left - MARGIN;
        let x = fewer_ticks(x, |ticks| {
            let room = wide / ticks.len().max(1) as f64;
            ticks.iter().all(|it| font::width(&it.1, TEXT) + APART < room)
        });
        let from = (corner.0 + left, corner.1 + head);
        let panel = Panel { from, to: (from.0 + wide, from.1 + tall), x, y };
        let at = (from.0, corner.1 + MARGIN + 0.4 * TEXT);
        canvas.text(&self.title, at, TEXT, TextSide::Left, palette::INK);
        let below = font::shortened(&self.axes[0], TEXT + 2.0, wide);
        // The name is centred on the panel, and ends below what is above it.
        let beside = font::shortened(&self.axes[1], TEXT + 2.0, tall + 2.0 * MARGIN);
        let bare = Self { layers: self.without_keys(), ..self.clone() };
        bare.fill(canvas, &panel, |canvas| {
            panel.draw_named(canvas, (&below, NAME_BELOW), (&beside, left - MARGIN));
        });
        let first = head - LINE * keys.len() as f64 + 0.4 * TEXT;
        for (n, row) in keys.into_iter().enumerate() {
            let at = (corner.0 + MARGIN, corner.1 + first + LINE * n as f64);
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
            let width = KEY_ROOM + font::width(&entry.name, TEXT);
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
