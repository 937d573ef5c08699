//! A run of a piecewise-affine system: its states against time over the modes, the instants of its
//! events by name, and the plane of its first two states.

mod layout;
mod sampled;

use super::axes::around;
use super::axis_unit::AxisUnit;
use super::canvas::{At, Canvas};
use super::frame::{Panel, Ruler};
use super::key::{KeyItem, KeyLayout, key};
use super::simplify::simplify_line;
use super::{Drawing, font, palette};
use layout::Layout;
use percuss::affine::{Event, Solver, System};
use percuss::number::Number;
pub use sampled::SampledSegment;
use sampled::{Mark, event_names, marks, pieces};
use std::collections::BTreeMap;

/// The largest number of states that one picture shows.
pub const MAX_STATES: usize = 6;

const WIDTH: f64 = 1500.0;
const MARGIN: f64 = 24.0;
const TEXT_SIZE: f64 = 20.0;
/// Text of the values of parameters.
const SMALL_TEXT_SIZE: f64 = 17.0;
/// Height of a line of text.
const LINE_HEIGHT: f64 = 28.0;
/// The baseline of the title.
const TITLE_BASELINE: f64 = 30.0;
/// The width of a key's sample with the space after a name.
const KEY_SAMPLE_WIDTH: f64 = 70.0;
/// The width of the curves.
const CURVE_WIDTH: f64 = 2.0;

/// The motion of a run between its events, with all states.
#[must_use]
pub fn sampled<T: Number>(solver: &Solver<T>, run: &[Event<T>]) -> Vec<SampledSegment> {
    let all: Vec<usize> = (0..solver.system().states.len()).collect();
    pieces(solver, run, &all)
}

/// A run ready to be drawn.
pub struct SystemMotion {
    title: String,
    /// The values of its parameters, in lines.
    caption: Vec<String>,
    /// The states that are shown.
    states: Vec<String>,
    modes: Vec<String>,
    /// The names of the events that occur.
    events: Vec<String>,
    /// The units of time and of the states.
    units: Vec<AxisUnit>,
    pieces: Vec<SampledSegment>,
    marks: Vec<Mark>,
}

impl SystemMotion {
    /// A run of a solver, given by its start and all its events, with the states of these indices.
    #[must_use]
    pub fn new<T: Number>(solver: &Solver<T>, run: &[Event<T>], shown: &[usize]) -> Self {
        let system = solver.system();
        let events = event_names(system, run);
        let motion = Self {
            title: system.name.clone(),
            caption: font::wrap(&values(system), SMALL_TEXT_SIZE, WIDTH - 2.0 * MARGIN),
            states: shown.iter().map(|n| system.states[*n].clone()).collect(),
            modes: system.modes.iter().map(|mode| mode.name.clone()).collect(),
            pieces: pieces(solver, run, shown),
            marks: marks(solver, run, shown, &events),
            units: vec![AxisUnit::default(); shown.len() + 1],
            events,
        };
        motion.in_units()
    }

    /// The run with all figures in units in which the labels of their axes are short.
    fn in_units(mut self) -> Self {
        self.units = (0..self.units.len()).map(|n| AxisUnit::new(self.column(n))).collect();
        let points = self.pieces.iter_mut().flat_map(|piece| &mut piece.points);
        let marks = self.marks.iter_mut().flat_map(|mark| [&mut mark.before, &mut mark.after]);
        for point in points.chain(marks) {
            let figures = point.iter_mut().zip(&self.units);
            figures.for_each(|(figure, unit)| *figure = unit.shown(*figure));
        }
        self
    }

    /// The name of the axis of time.
    fn time(&self) -> String {
        self.units[0].named("time", WIDTH)
    }

    fn layout(&self) -> Layout {
        let head =
            TITLE_BASELINE + LINE_HEIGHT * (1 + self.caption.len() + self.key_rows().len()) as f64;
        let widest =
            self.events.iter().map(|name| font::width(name, TEXT_SIZE)).fold(0.0, f64::max);
        Layout::new(head, self.states.len(), self.events.len(), widest)
    }

    /// The modes that occur, in rows that are no wider than the picture.
    fn key_rows(&self) -> Vec<Vec<usize>> {
        let mut occurring: Vec<usize> = self.pieces.iter().map(|piece| piece.mode).collect();
        occurring.sort_unstable();
        occurring.dedup();
        let (mut rows, mut used) = (vec![Vec::new()], 0.0);
        for mode in occurring {
            let width = KEY_SAMPLE_WIDTH + font::width(&self.modes[mode], TEXT_SIZE);
            let mut last = rows.pop().unwrap_or_default();
            if used + width > WIDTH - 2.0 * MARGIN && !last.is_empty() {
                rows.push(std::mem::take(&mut last));
                used = 0.0;
            }
            last.push(mode);
            used += width;
            rows.push(last);
        }
        rows
    }

    /// The figures of one column of all points: time, or a state.
    fn column(&self, n: usize) -> impl Iterator<Item = f64> {
        let sampled = self.pieces.iter().flat_map(|piece| &piece.points);
        sampled.chain(self.marks.iter().map(|mark| &mark.after)).map(move |at| at[n])
    }

    fn ruler(&self, n: usize) -> Ruler {
        let range = around(self.column(n));
        Ruler::between(range.start, range.end)
    }

    /// The axis of time, which is as long as the run.
    fn times(&self) -> Ruler {
        let ends = |it: (f64, f64), t: f64| (it.0.min(t), it.1.max(t));
        let (from, to) = self.column(0).fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        if from < to { Ruler::between(from, to) } else { self.ruler(0) }
    }

    fn key(&self, canvas: &mut Canvas, mut y: f64) {
        for row in self.key_rows() {
            let items = row.into_iter().map(|mode| {
                let (dark, light) = palette::mode(mode);
                KeyItem::new(&self.modes[mode], move |canvas, (x, y)| {
                    canvas.fill((x, y - 9.0), (x + 38.0, y + 9.0), light);
                    canvas.line((x, y), (x + 38.0, y), 3.0, dark);
                })
            });
            key(canvas, (MARGIN, y), KeyLayout::Row, TEXT_SIZE, items);
            y += LINE_HEIGHT;
        }
    }

    /// Shades the modes behind all that is drawn against time.
    fn shade(&self, canvas: &mut Canvas, panel: &Panel, heights: (f64, f64)) {
        let mut bands: BTreeMap<usize, Vec<(f64, f64)>> = BTreeMap::new();
        for piece in &self.pieces {
            let side = |at: Option<&Vec<f64>>| at.map(|at| panel.place((at[0], 0.0)).0.round());
            let sides = (side(piece.points.first()), side(piece.points.last()));
            let (Some(from), Some(to)) = sides else { continue };
            let (left, right) = (from.min(to), from.max(to));
            let own = bands.entry(piece.mode).or_default();
            match own.last_mut() {
                Some(last) if last.1 == left => last.1 = right,
                _ if left < right => own.push((left, right)),
                _ => {}
            }
        }
        for (mode, sides) in bands {
            canvas.bands(sides, heights, palette::mode(mode).1);
        }
    }

    /// Draws each state against time.
    fn histories(&self, canvas: &mut Canvas, layout: &Layout) {
        for (n, name) in self.states.iter().enumerate() {
            let (from, to) = layout.state(n);
            let panel = Panel { from, to, x: self.times(), y: self.ruler(n + 1).with_ticks(4.0) };
            if n == 0 {
                self.shade(canvas, &panel, (from.1, layout.bottom()));
            }
            let lowest = self.events.is_empty() && n + 1 == self.states.len();
            let panel = if lowest { panel } else { without_labels(panel) };
            let name = self.units[n + 1].named(name, to.1 - from.1);
            let below = if lowest { self.time() } else { String::new() };
            panel.draw(canvas, &below, &name);
            self.trace(canvas, &panel, 0, n + 1);
        }
    }

    /// Draws a row for the events of each name.
    fn event_rows(&self, canvas: &mut Canvas, layout: &Layout) {
        let Some((from, to)) = layout.events() else { return };
        let count = self.events.len() as f64;
        let mut y = Ruler::between(0.0, count);
        let label = |name: &String| font::shorten(name, TEXT_SIZE, from.0 - MARGIN);
        let named = self.events.iter().enumerate();
        y.ticks = named.map(|(n, name)| (count - 0.5 - n as f64, label(name))).collect();
        let panel = Panel { from, to, x: self.times(), y };
        panel.draw(canvas, &self.time(), "");
        self.ticks(canvas, &panel);
    }

    /// Draws the second state against the first.
    fn plane(&self, canvas: &mut Canvas, layout: &Layout) {
        let (Some((from, to)), [first, second, ..]) = (layout.plane(), &self.states[..]) else {
            return;
        };
        let panel = Panel { from, to, x: self.ruler(1), y: self.ruler(2) };
        let (across, down) = (to.0 - from.0, to.1 - from.1);
        let below = self.units[1].named(first, across);
        panel.draw(canvas, &below, &self.units[2].named(second, down));
        self.trace(canvas, &panel, 1, 2);
    }

    /// Draws one column of all points against another: what resets skip, the motion, the events.
    fn trace(&self, canvas: &mut Canvas, panel: &Panel, x: usize, y: usize) {
        let place = |at: &Vec<f64>| panel.place((at[x], at[y]));
        let far = |(a, b): &(At, At)| (a.0 - b.0).hypot(a.1 - b.1) > 1.0;
        let skips = self.marks.iter().map(|mark| (place(&mark.before), place(&mark.after)));
        let skips = skips.filter(far).map(|(from, to)| vec![from, to]);
        canvas.strokes(skips, 1.0, palette::RESET_JUMP);
        let mut lines: BTreeMap<usize, Vec<Vec<At>>> = BTreeMap::new();
        for piece in &self.pieces {
            let places: Vec<At> = piece.points.iter().map(place).collect();
            lines.entry(piece.mode).or_default().push(simplify_line(&places));
        }
        for (mode, lines) in lines {
            canvas.strokes(lines, CURVE_WIDTH, palette::mode(mode).0);
        }
        let size = match self.marks.len() {
            0..60 => 7.0,
            60..250 => 5.0,
            _ => 3.0,
        };
        let mut discs: Vec<At> = self.marks.iter().map(|mark| place(&mark.after)).collect();
        // Discs in one place are one disc.
        discs.dedup_by(|a, b| !far(&(*a, *b)));
        canvas.strokes(discs.into_iter().map(|at| vec![at]), size, palette::INK);
    }

    /// Draws a tick for each event in the row of its name.
    fn ticks(&self, canvas: &mut Canvas, panel: &Panel) {
        let tick = |mark: &Mark| {
            let (x, y) =
                panel.place((mark.after[0], self.events.len() as f64 - 0.5 - mark.row as f64));
            (x.round(), y)
        };
        let mut ticks: Vec<At> = self.marks.iter().map(tick).collect();
        ticks.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
        ticks.dedup();
        let ticks = ticks.into_iter().map(|(x, y)| vec![(x, y - 8.0), (x, y + 8.0)]);
        canvas.strokes(ticks, 1.6, palette::INK);
    }
}

impl Drawing for SystemMotion {
    fn size(&self) -> (u32, u32) {
        (WIDTH as u32, self.layout().height() as u32)
    }

    fn draw(&self, canvas: &mut Canvas) {
        let layout = self.layout();
        canvas.title(&self.title);
        for (n, line) in self.caption.iter().enumerate() {
            let at = (MARGIN, TITLE_BASELINE + LINE_HEIGHT * (n + 1) as f64);
            canvas.text(line, at, SMALL_TEXT_SIZE, super::canvas::TextSide::Left, palette::INK);
        }
        self.key(canvas, TITLE_BASELINE + LINE_HEIGHT * (1 + self.caption.len()) as f64);
        self.histories(canvas, &layout);
        self.event_rows(canvas, &layout);
        self.plane(canvas, &layout);
    }
}

/// The panel without the labels of its horizontal axis, which stand below another one.
fn without_labels(mut panel: Panel) -> Panel {
    panel.x.ticks.iter_mut().for_each(|tick| tick.1.clear());
    panel
}

/// The values of a system's parameters, and of its forcing where they are none of these.
fn values(system: &System) -> String {
    let named = system.parameters.iter().map(|(name, value)| (name.as_str(), *value));
    let forcing = system.forcing.as_ref().map(|forcing| {
        let number = |it: &percuss::affine::Rational| it.to_f64().abs();
        [("\u{3c9}", number(&forcing.omega)), ("\u{3c6}", number(&forcing.phi))]
    });
    let is_parameter = |value: f64| system.parameters.values().any(|it| *it == value);
    let forcing = forcing.into_iter().flatten().filter(|(_, it)| *it != 0.0 && !is_parameter(*it));
    let shown = named.chain(forcing).map(|(name, value)| format!("{name} = {value}"));
    shown.collect::<Vec<_>>().join(", ")
}
