//! The margins of panels that fill a given size, and axes with as many ticks as have room.

use super::frame::Ruler;

/// Room above a panel and right of it.
pub(super) const MARGIN: f64 = 18.0;
/// Room below a panel for labels and a name.
pub(super) const BELOW: f64 = 66.0;
/// The distance of the horizontal axis's name from the panel.
pub(super) const NAME_BELOW: f64 = 48.0;
/// Room for the name of the vertical axis, and between its labels and the panel.
pub(super) const BESIDE: f64 = 44.0;
/// Room between labels beside each other.
pub(super) const APART: f64 = 16.0;
/// The height of a label with the room around it.
pub(super) const TALL: f64 = 30.0;

/// The largest number of ticks that is tried.
const MOST_TICKS: u32 = 8;

/// The axis with the most ticks that have room.
pub(super) fn fewer_ticks(ruler: Ruler, has_room: impl Fn(&[(f64, String)]) -> bool) -> Ruler {
    let mut ruler = ruler.with_ticks(f64::from(MOST_TICKS));
    for most in (2..MOST_TICKS).rev() {
        if has_room(&ruler.ticks) {
            break;
        }
        ruler = ruler.with_ticks(f64::from(most));
    }
    ruler
}
