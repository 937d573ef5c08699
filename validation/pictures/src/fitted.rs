//! The margins of panels that fill a given size, and axes with as many ticks as have room.

use super::canvas::At;
use super::font;
use super::frame::{Panel, Ruler};

/// Room above a panel and right of it.
pub(super) const MARGIN: f64 = 18.0;
/// The margin below a panel for labels and a name.
pub(super) const BOTTOM_MARGIN: f64 = 66.0;
/// The distance of the horizontal axis's name from the panel.
pub(super) const NAME_DISTANCE: f64 = 48.0;
/// The margin for the name of the vertical axis, and between its labels and the panel.
const LEFT_MARGIN: f64 = 44.0;
/// The least gap between labels beside each other.
const LABEL_GAP: f64 = 16.0;
/// The height of a label with the room around it.
const LABEL_HEIGHT: f64 = 30.0;

/// The size of an axis's labels.
const TEXT_SIZE: f64 = 20.0;

/// The largest number of ticks that is tried.
const MAX_TICKS: u32 = 8;

/// The panel between two corners that leaves room for the labels and the name beside it.
pub(super) fn panel([x, y]: [Ruler; 2], from: At, to: At) -> Panel {
    let width = |it: &(f64, String)| font::width(&it.1, TEXT_SIZE);
    let y = fewer_ticks(y, |ticks| (to.1 - from.1) / ticks.len().max(1) as f64 > LABEL_HEIGHT);
    let left = from.0 + LEFT_MARGIN + y.ticks.iter().map(width).fold(0.0, f64::max);
    let x = fewer_ticks(x, |ticks| {
        let room = (to.0 - left) / ticks.len().max(1) as f64;
        ticks.iter().all(|it| width(it) + LABEL_GAP < room)
    });
    Panel { from: (left, from.1), to, x, y }
}

/// The axis with the most ticks that have room.
fn fewer_ticks(ruler: Ruler, has_room: impl Fn(&[(f64, String)]) -> bool) -> Ruler {
    let mut ruler = ruler.with_ticks(f64::from(MAX_TICKS));
    for most in (2..MAX_TICKS).rev() {
        if has_room(&ruler.ticks) {
            break;
        }
        ruler = ruler.with_ticks(f64::from(most));
    }
    ruler
}
