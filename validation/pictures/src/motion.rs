//! A run as time histories of x, p and v and as a phase plane, phases by colour (as in Figs. 2 and
//! 3).

use super::axes::around;
use super::canvas::Canvas;
use super::canvas::Stroke;
use super::frame::{Panel, Ruler};
use super::key::{KeyItem, KeyLayout, key};
use super::piece::MotionPiece;
use super::{Drawing, palette};
use percuss::{Exit, Instant, Phase, Segment};
use percuss_engines::case::Problem;

const SIZE: (u32, u32) = (1500, 860);
/// Points drawn for the whole run.
const RUN_POINTS: f64 = 6000.0;
const TEXT_SIZE: f64 = 20.0;

/// A run ready to be drawn.
pub struct DrawnMotion {
    title: String,
    pieces: Vec<MotionPiece>,
}

/// A figure of a point.
type Measure = fn(&[f64; 5]) -> f64;

/// The content and the place of one panel.
struct MotionPanel {
    below: &'static str,
    beside: &'static str,
    x: Measure,
    y: Measure,
    /// The panel's left, top, right and bottom edge.
    edges: [f64; 4],
    /// The vertical axis has at most about so many ticks.
    ticks: f64,
}

const PANELS: [MotionPanel; 4] = [
    MotionPanel {
        below: "",
        beside: "x = p + v",
        x: |at| at[0],
        y: |at| at[1] + at[4],
        edges: [124.0, 96.0, 816.0, 278.0],
        ticks: 5.0,
    },
    MotionPanel {
        below: "",
        beside: "p",
        x: |at| at[0],
        y: |at| at[1],
        edges: [124.0, 336.0, 816.0, 518.0],
        ticks: 5.0,
    },
    MotionPanel {
        below: "\u{3c4} (time)",
        beside: "v (drift)",
        x: |at| at[0],
        y: |at| at[4],
        edges: [124.0, 576.0, 816.0, 782.0],
        ticks: 5.0,
    },
    MotionPanel {
        below: "p (displacement)",
        beside: "y (velocity)",
        x: |at| at[1],
        y: |at| at[2],
        edges: [964.0, 96.0, 1476.0, 782.0],
        ticks: 10.0,
    },
];

impl Drawing for DrawnMotion {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.title(&self.title);
        let names = Phase::ALL.map(|phase| (phase, phase.as_str().replace('-', " ")));
        let items = names.iter().map(|(phase, name)| {
            let colour = palette::phase(*phase);
            KeyItem::new(name, move |canvas, (x, y)| {
                canvas.line((x, y), (x + 36.0, y), 5.0, colour);
            })
        });
        key(canvas, (24.0, 64.0), KeyLayout::Row, TEXT_SIZE, items);
        PANELS.iter().for_each(|panel| self.panel(canvas, panel));
    }
}

impl DrawnMotion {
    /// The phases of a run up to `last`.
    #[must_use]
    pub fn new(problem: &Problem, segments: &[Segment], last: &Instant) -> Self {
        let parameters = problem.model.parameters();
        let percuss::Parameters { a, b, xi, omega, g, .. } = *parameters;
        let begins = problem.entry.instant;
        let span = last.since(&begins, omega).value();
        let pieces = segments.iter().map(|segment| {
            let since = segment.entry().instant.since(&begins, omega).value();
            let lasts = match segment.exit() {
                Exit::Switch(_) | Exit::Undecidable => segment.duration(),
                _ => last.since(&segment.entry().instant, omega).value(),
            };
            MotionPiece::new(segment, begins.tau(omega) + since, lasts, RUN_POINTS * lasts / span)
        });
        Self {
            title: format!("a = {a}, b = {b}, \u{3be} = {xi}, \u{3c9} = {omega}, g = {g}"),
            pieces: pieces.collect(),
        }
    }

    fn panel(&self, canvas: &mut Canvas, panel: &MotionPanel) {
        let MotionPanel { below, beside, x, y, edges, ticks } = *panel;
        let [left, top, right, bottom] = edges;
        let ruler = |measure: Measure| {
            let range = around(self.pieces.iter().flat_map(|piece| &piece.points).map(measure));
            Ruler::between(range.start, range.end)
        };
        let (from, to) = ((left, top), (right, bottom));
        let panel = Panel { from, to, x: ruler(x), y: ruler(y).with_ticks(ticks) };
        panel.draw(canvas, below, beside);
        for piece in &self.pieces {
            let places: Vec<_> =
                piece.points.iter().map(|at| panel.place((x(at), y(at)))).collect();
            canvas.trace(&places, 2.0, Stroke::Solid, palette::phase(piece.phase));
        }
    }
}
