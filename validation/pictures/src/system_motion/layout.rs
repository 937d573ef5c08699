//! The layout of a picture of a run.

use super::super::canvas::At;
use super::{MARGIN, WIDTH};

/// The corners of a panel, the upper left one first.
type Corners = (At, At);

/// The width of the labels and the name of a vertical axis.
const AXIS_WIDTH: f64 = 124.0;
/// The largest width of the names of events.
const MAX_NAMES_WIDTH: f64 = 260.0;
/// The right edge of what is drawn against time, where the plane of two states stands beside it.
const TIME_PANEL_RIGHT: f64 = 850.0;
/// The gap between two panels that stand below each other.
const PANEL_GAP: f64 = 16.0;
/// Height of a row of events.
const ROW_HEIGHT: f64 = 26.0;
/// The height of the labels and the name of a horizontal axis.
const FOOT_HEIGHT: f64 = 78.0;

/// The edges of a picture's panels.
pub(super) struct Layout {
    left: f64,
    right: f64,
    top: f64,
    /// Height of the panel of a state.
    panel: f64,
    states: usize,
    events: usize,
}

impl Layout {
    /// The layout below `head`, for so many states and names of events, the widest of which takes
    /// `widest` pixels.
    pub fn new(head: f64, states: usize, events: usize, widest: f64) -> Self {
        Self {
            left: AXIS_WIDTH.max(widest.min(MAX_NAMES_WIDTH) + MARGIN),
            right: if states > 1 { TIME_PANEL_RIGHT } else { WIDTH - MARGIN },
            top: head,
            panel: match states {
                0 | 1 => 340.0,
                2 => 240.0,
                3 => 180.0,
                4 => 150.0,
                _ => 130.0,
            },
            states,
            events,
        }
    }

    /// The panel of a state against time.
    pub fn state(&self, n: usize) -> Corners {
        let top = self.top + (self.panel + PANEL_GAP) * n as f64;
        ((self.left, top), (self.right, top + self.panel))
    }

    /// The panel of the events, where there are any.
    pub fn events(&self) -> Option<Corners> {
        let top = self.top + (self.panel + PANEL_GAP) * self.states as f64;
        let bottom = top + ROW_HEIGHT * self.events as f64;
        (self.events > 0).then_some(((self.left, top), (self.right, bottom)))
    }

    /// The plane of the first two states, where there are two.
    pub fn plane(&self) -> Option<Corners> {
        let from = (TIME_PANEL_RIGHT + AXIS_WIDTH + MARGIN, self.top);
        (self.states > 1).then_some((from, (WIDTH - MARGIN, self.bottom())))
    }

    /// The lower edge of the lowest panel.
    pub fn bottom(&self) -> f64 {
        let last = self.state(self.states.saturating_sub(1)).1.1;
        self.events().map_or(last, |(_, to)| to.1)
    }

    pub fn height(&self) -> f64 {
        self.bottom() + FOOT_HEIGHT
    }
}
