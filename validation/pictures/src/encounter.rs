//! A guard against time around one event, as it truly is and as an engine had it, in a wide panel
//! and a close one. Steps, evaluations of the guard and events are marks, phases or modes bands
//! above.

use super::canvas::Stroke;
use super::canvas::{At, Canvas, TextSide};
use super::colour::{Colour, WHITE};
use super::frame::{AxisScale, Panel, Ruler, power_of_ten};
use super::key::{KeyItem, KeyLayout, key};
use super::{Drawing, Marker, palette};
use percuss::Phase;

/// A picture of an event.
#[derive(Clone, Debug)]
pub struct Encounter {
    /// The title, which says whose event it is.
    pub title: String,
    /// The error of the event, in words.
    pub subtitle: String,
    /// The engine's name.
    pub engine: String,
    /// The engine's colour.
    pub colour: Colour,
    /// The name of the guard that is drawn against time.
    pub guard: String,
    /// The time from which times are counted.
    pub centre: f64,
    /// The stretches, from the wide one to the close one.
    pub stretches: Vec<TimeStretch>,
}

/// A stretch of time.
#[derive(Clone, Debug)]
pub struct TimeStretch {
    /// The time at which the stretch begins.
    pub from: f64,
    /// The time at which the stretch ends.
    pub to: f64,
    /// The truth.
    pub truth: Trail,
    /// The engine.
    pub engine: Trail,
    /// Ends of the engine's steps.
    pub steps: Vec<f64>,
    /// The times at which the engine's root finder evaluated the guard, and what it found.
    pub looks: Vec<[f64; 2]>,
}

/// A run through a stretch.
#[derive(Clone, Debug)]
pub struct Trail {
    /// Values of the guard, evenly spread over the stretch.
    pub values: Vec<f64>,
    /// The phase or mode at the beginning of the stretch.
    pub stage: Stage,
    /// The time at which each later stage begins, the stage, and whether both runs have that event.
    pub events: Vec<(f64, Stage, bool)>,
}

/// A phase of the oscillator, or a mode of another system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stage {
    name: String,
    colours: (Colour, Colour),
}

impl Stage {
    /// A phase.
    #[must_use]
    pub fn phase(phase: Phase) -> Self {
        let ink = if phase == Phase::Contact { palette::INK } else { WHITE };
        Self { name: phase.as_str().replace('-', " "), colours: (palette::phase(phase), ink) }
    }

    /// A mode, by its name and its place in its system.
    #[must_use]
    pub fn mode(name: &str, place: usize) -> Self {
        Self { name: name.to_owned(), colours: (palette::mode(place).0, WHITE) }
    }
}

const SIZE: (u32, u32) = (1500, 700);
const WIDTH: f64 = 1500.0;
const TEXT_SIZE: f64 = 19.0;
const TOP: f64 = 164.0;
const BOTTOM: f64 = 550.0;
const BAND_HEIGHT: f64 = 24.0;
/// An event that only one of the two has; no engine is yellow.
const WRONG_COLOUR: Colour = Colour(255, 217, 47);
const TRUTH_COLOUR: Colour = Colour(160, 164, 170);

impl Drawing for Encounter {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw(&self, canvas: &mut Canvas) {
        canvas.title(&self.title);
        canvas.text(&self.subtitle, (24.0, 64.0), TEXT_SIZE, TextSide::Left, palette::INK);
        let width = WIDTH / self.stretches.len().max(1) as f64;
        for (i, stretch) in self.stretches.iter().enumerate() {
            let left = width * i as f64;
            self.stretch(canvas, stretch, (left + 132.0, left + width - 26.0));
        }
        self.key(canvas);
    }
}

impl Encounter {
    fn stretch(&self, canvas: &mut Canvas, it: &TimeStretch, (left, right): (f64, f64)) {
        let times = Factor::new([it.from, it.to].into_iter());
        let values = Factor::new(it.shown_values());
        let (from, to) = (times.scaled(it.from), times.scaled(it.to));
        let vertical = Ruler::over(AxisScale::Linear, it.shown_values().map(|v| values.scaled(v)));
        let Some(y) = vertical.filter(|_| from < to) else { return };
        let x = Ruler::between(from, to);
        let panel = Panel { from: (left, TOP), to: (right, BOTTOM), x, y };
        let below = times.with_factor(&format!("time \u{2212} {:.7}", self.centre));
        panel.draw(canvas, &below, &values.with_factor(&self.guard));
        let at = |t: f64, v: f64| panel.at((times.scaled(t), values.scaled(v)));
        let guide = [panel.place((0.0, 0.0)).0, panel.place((0.0, 0.0)).1];
        canvas.line((left, guide[1]), (right, guide[1]), 1.4, palette::INK);
        canvas.line((guide[0], TOP), (guide[0], BOTTOM), 1.0, palette::INK);
        let place = |t: f64| panel.place((times.scaled(t), 0.0)).0.clamp(left, right);
        for (trail, name, top) in [(&it.truth, "truth", 96.0), (&it.engine, "engine", 126.0)] {
            trail.band(canvas, place, (left, right, top));
            let at = (left - 10.0, top + BAND_HEIGHT / 2.0);
            canvas.text(name, at, TEXT_SIZE, TextSide::Right, palette::INK);
        }
        let curve = |trail: &Trail| -> Vec<At> {
            trail.places(it.from, it.to).filter_map(|(t, v)| at(t, v)).collect()
        };
        canvas.trace(&curve(&it.truth), 6.0, Stroke::Solid, TRUTH_COLOUR);
        canvas.trace(&curve(&it.engine), 2.4, Stroke::Solid, self.colour);
        let ends =
            it.steps.iter().filter_map(|t| at(*t, it.engine.interpolated(it.from, it.to, *t)?));
        ends.for_each(|at| canvas.marker(Marker::Circle, at, 5.0, self.colour));
        let looks = it.looks.iter().filter_map(|[t, v]| at(*t, *v));
        looks.for_each(|at| hollow(canvas, at, self.colour));
        self.events(canvas, it, |t| at(t, 0.0))
    }

    fn events(&self, canvas: &mut Canvas, it: &TimeStretch, at: impl Fn(f64) -> Option<At>) {
        for (t, _, matched) in &it.truth.events {
            let Some(at) = at(*t) else { continue };
            if *matched {
                canvas.marker(Marker::Circle, at, 4.5, palette::INK);
            } else {
                draw_wrong_event(canvas, at, false);
            }
        }
        for (t, _, matched) in &it.engine.events {
            let Some(at) = at(*t) else { continue };
            if *matched {
                canvas.marker(Marker::Triangle, (at.0, at.1 + 12.0), 6.0, self.colour);
            } else {
                draw_wrong_event(canvas, at, true);
            }
        }
    }

    fn key(&self, canvas: &mut Canvas) {
        let middle = |at: At| (at.0 + 22.0, at.1);
        let line = |width: f64, colour: Colour| {
            move |canvas: &mut Canvas, at: At| canvas.line(at, (at.0 + 34.0, at.1), width, colour)
        };
        let mark = |marker: Marker, size: f64, colour: Colour| {
            move |canvas: &mut Canvas, at: At| canvas.marker(marker, middle(at), size, colour)
        };
        let items = [
            KeyItem::new("truth", line(6.0, TRUTH_COLOUR)),
            KeyItem::new(&self.engine, line(2.4, self.colour)),
            KeyItem::new("step", mark(Marker::Circle, 5.0, self.colour)),
            KeyItem::new("root finder's look", |canvas, at| {
                hollow(canvas, middle(at), self.colour);
            }),
            KeyItem::new("true event", mark(Marker::Circle, 4.5, palette::INK)),
            KeyItem::new("engine's event", mark(Marker::Triangle, 6.0, self.colour)),
            KeyItem::new("missed", |canvas, at| draw_wrong_event(canvas, middle(at), false)),
            KeyItem::new("spurious", |canvas, at| draw_wrong_event(canvas, middle(at), true)),
        ];
        key(canvas, (24.0, 664.0), KeyLayout::Row, TEXT_SIZE - 1.0, items);
    }
}

impl TimeStretch {
    /// All values that the vertical axis has to show, the event's zero among them.
    fn shown_values(&self) -> impl Iterator<Item = f64> + '_ {
        let looks = self.looks.iter().map(|look| look[1]);
        let curves = self.truth.values.iter().chain(&self.engine.values).copied();
        curves.chain(looks).chain([0.0])
    }
}

impl Trail {
    fn places(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let pieces = self.values.len().saturating_sub(1).max(1) as f64;
        let place = move |(k, v): (usize, &f64)| (from + (to - from) * (k as f64 / pieces), *v);
        self.values.iter().enumerate().map(place)
    }

    /// The value between those that are known.
    fn interpolated(&self, from: f64, to: f64, t: f64) -> Option<f64> {
        let last = self.values.len().checked_sub(1).filter(|last| *last > 0)?;
        let place = (t - from) / (to - from) * last as f64;
        let k = (place.max(0.0) as usize).min(last - 1);
        let (left, right) = (self.values[k], self.values[k + 1]);
        Some(left + (place - k as f64) * (right - left))
    }

    /// Stages one after the other, named where there is room.
    fn band(
        &self,
        canvas: &mut Canvas,
        place: impl Fn(f64) -> f64,
        (left, right, top): (f64, f64, f64),
    ) {
        let starts = self.events.iter().map(|(t, stage, _)| (place(*t), stage));
        let starts: Vec<_> = std::iter::once((left, &self.stage)).chain(starts).collect();
        for (i, (from, Stage { name, colours: (fill, ink) })) in starts.iter().enumerate() {
            let to = starts.get(i + 1).map_or(right, |next| next.0);
            let to = to.max(from + 1.0).min(right);
            canvas.fill((*from, top), (to, top + BAND_HEIGHT), *fill);
            if to - from > 11.0 * name.len() as f64 {
                let middle = ((from + to) / 2.0, top + BAND_HEIGHT / 2.0);
                canvas.text(name, middle, TEXT_SIZE - 2.0, TextSide::Middle, *ink);
            }
        }
    }
}

/// A power of ten by which an axis counts, so that its labels stay short.
struct Factor(i32);

impl Factor {
    fn new(values: impl Iterator<Item = f64>) -> Self {
        let largest = values.map(f64::abs).filter(|v| v.is_finite()).fold(0.0, f64::max);
        let exponent = if largest > 0.0 { largest.log10().floor() as i32 } else { 0 };
        Self(if (-1..=3).contains(&exponent) { 0 } else { exponent })
    }

    fn scaled(&self, value: f64) -> f64 {
        value / 10.0_f64.powi(self.0)
    }

    fn with_factor(&self, label: &str) -> String {
        match self.0 {
            0 => label.to_owned(),
            exponent => format!("{label}, in {}", power_of_ten(exponent.into())),
        }
    }
}

/// A disc, with a cross where the engine alone has the event.
fn draw_wrong_event(canvas: &mut Canvas, at: At, spurious: bool) {
    canvas.marker(Marker::Circle, at, 9.0, palette::INK);
    canvas.marker(Marker::Circle, at, 7.4, WRONG_COLOUR);
    if spurious {
        canvas.marker(Marker::Cross, at, 4.6, palette::INK);
    }
}

fn hollow(canvas: &mut Canvas, at: At, colour: Colour) {
    const HALF_DIAGONAL: f64 = 6.0;
    let corner = |(x, y): At| (at.0 + HALF_DIAGONAL * x, at.1 + HALF_DIAGONAL * y);
    let corners = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)];
    canvas.trace(&corners.map(corner), 1.6, Stroke::Solid, colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_stands_on_the_curve() {
        let stage = Stage::phase(Phase::Contact);
        let trail = Trail { values: vec![0.0, 1.0, 4.0], stage, events: Vec::new() };
        assert_eq!(trail.interpolated(2.0, 4.0, 3.5), Some(2.5));
        assert_eq!(trail.interpolated(2.0, 4.0, 4.0), Some(4.0));
        let none = Trail { values: Vec::new(), ..trail };
        assert_eq!(none.interpolated(0.0, 1.0, 0.5), None);
    }

    #[test]
    fn axes_count_in_powers_of_ten_where_that_is_shorter() {
        assert_eq!(Factor::new([-3e-7, 1e-7].into_iter()).with_factor("gap"), "gap, in 10⁻⁷");
        assert_eq!(Factor::new([0.5, f64::NAN].into_iter()).with_factor("gap"), "gap");
    }
}
