//! A run as time histories of x, p and v and as a phase plane, phases by colour (as in Figs. 2 and
//! 3).

use super::axes::{around, label};
use super::font::FAMILY;
use super::piece::MotionPiece;
use super::{DrawError, Drawing, palette};
use percuss::{Exit, Instant, Phase, Segment};
use percuss_engines::case::Problem;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const SIZE: (u32, u32) = (1500, 860);
/// Points drawn for the whole run.
const POINTS: f64 = 6000.0;
/// Cosine of a turn between neighbouring pieces of a curve that counts as sharp.
const SHARP: f64 = 0.9;

const TEXT: u32 = 22;
const TITLE: u32 = 24;

/// A run ready to be drawn.
pub struct DrawnMotion {
    title: String,
    pieces: Vec<MotionPiece>,
}

/// A figure of a point.
type Measure = fn(&[f64; 5]) -> f64;

/// What one panel shows.
struct MotionPanel {
    below: &'static str,
    beside: &'static str,
    x: Measure,
    y: Measure,
    /// About how many labels the vertical axis has.
    ticks: usize,
}

const HISTORIES: [MotionPanel; 3] = [
    MotionPanel { below: "", beside: "x = p + v", x: |at| at[0], y: |at| at[1] + at[4], ticks: 5 },
    MotionPanel { below: "", beside: "p", x: |at| at[0], y: |at| at[1], ticks: 5 },
    MotionPanel {
        below: "\u{3c4} (time)",
        beside: "v (drift)",
        x: |at| at[0],
        y: |at| at[4],
        ticks: 5,
    },
];
const PHASE_PLANE: MotionPanel = MotionPanel {
    below: "p (displacement)",
    beside: "y (velocity)",
    x: |at| at[1],
    y: |at| at[2],
    ticks: 10,
};

impl Drawing for DrawnMotion {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError> {
        area.fill(&WHITE).map_err(DrawError::new)?;
        let (head, body) = area.split_vertically(84 * scale);
        self.heading(&head, scale)?;
        let (left, right) = body.split_horizontally(840 * scale);
        let rows = [240 * scale, 480 * scale];
        for (area, panel) in left.split_by_breakpoints(&[] as &[u32], rows).iter().zip(&HISTORIES) {
            self.panel(area, panel, scale)?;
        }
        self.panel(&right, &PHASE_PLANE, scale)
    }
}

impl DrawnMotion {
    /// The phases of a run up to `last`.
    #[must_use]
    pub fn of(problem: &Problem, segments: &[Segment], last: &Instant) -> Self {
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
            MotionPiece::of(segment, begins.tau(omega) + since, lasts, POINTS * lasts / span)
        });
        Self {
            title: format!("a = {a}, b = {b}, \u{3be} = {xi}, \u{3c9} = {omega}, g = {g}"),
            pieces: pieces.collect(),
        }
    }

    fn heading<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError> {
        let at = |x: i32, y: i32| (x * scale.cast_signed(), y * scale.cast_signed());
        let style = (FAMILY, TITLE * scale).into_font().color(&palette::INK);
        area.draw_text(&self.title, &style, at(24, 12)).map_err(DrawError::new)?;
        let text = (FAMILY, TEXT * scale)
            .into_font()
            .color(&palette::INK)
            .pos(Pos::new(HPos::Left, VPos::Center));
        let mut x = 24;
        for phase in Phase::ALL {
            let key = Rectangle::new([at(x, 56), at(x + 36, 61)], palette::phase(phase).filled());
            area.draw(&key).map_err(DrawError::new)?;
            let token = phase.as_str().replace('-', " ");
            area.draw_text(&token, &text, at(x + 46, 58)).map_err(DrawError::new)?;
            x += 90 + 13 * i32::try_from(token.len()).unwrap_or(0);
        }
        Ok(())
    }

    fn panel<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        panel: &MotionPanel,
        scale: u32,
    ) -> Result<(), DrawError> {
        let MotionPanel { below, beside, x, y, ticks } = *panel;
        let all = || self.pieces.iter().flat_map(|piece| &piece.points);
        let (horizontal, vertical) = (around(all().map(x)), around(all().map(y)));
        let (ticks_x, ticks_y) = (horizontal.clone(), vertical.clone());
        let mut chart = ChartBuilder::on(area)
            .margin(12 * scale)
            .margin_right(24 * scale)
            .x_label_area_size(if below.is_empty() { 34 } else { 66 } * scale)
            .y_label_area_size(112 * scale)
            .build_cartesian_2d(horizontal, vertical)
            .map_err(DrawError::new)?;
        let text = (FAMILY, TEXT * scale).into_font().color(&palette::INK);
        chart
            .configure_mesh()
            .bold_line_style(palette::GRID.stroke_width(scale))
            .light_line_style(TRANSPARENT)
            .axis_style(palette::INK.stroke_width(scale))
            .set_all_tick_mark_size(6 * scale)
            .x_labels(6)
            .y_labels(ticks)
            .x_label_formatter(&|value| label(*value, &ticks_x))
            .y_label_formatter(&|value| label(*value, &ticks_y))
            .label_style(text.clone())
            .axis_desc_style(text)
            .x_desc(below)
            .y_desc(beside)
            .draw()
            .map_err(DrawError::new)?;
        let size = [ticks_x.end - ticks_x.start, ticks_y.end - ticks_y.start];
        for piece in &self.pieces {
            let points: Vec<_> = piece.points.iter().map(|at| (x(at), y(at))).collect();
            let style = palette::phase(piece.phase).stroke_width(2 * scale);
            for stretch in smooth(&points, size) {
                let series = LineSeries::new(stretch.iter().copied(), style);
                chart.draw_series(series).map_err(DrawError::new)?;
            }
        }
        Ok(())
    }
}

/// A curve cut where it turns sharply: the drawing library leaves gaps there in a thick line.
fn smooth(points: &[(f64, f64)], [width, height]: [f64; 2]) -> Vec<&[(f64, f64)]> {
    let heading = |i: usize| {
        let (dx, dy) =
            ((points[i].0 - points[i - 1].0) / width, (points[i].1 - points[i - 1].1) / height);
        let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
        (dx / length, dy / length)
    };
    let mut stretches = Vec::new();
    let mut begin = 0;
    for i in 1..points.len().saturating_sub(1) {
        let (before, after) = (heading(i), heading(i + 1));
        if before.0 * after.0 + before.1 * after.1 < SHARP {
            stretches.push(&points[begin..=i]);
            begin = i;
        }
    }
    stretches.push(&points[begin..]);
    stretches
}
