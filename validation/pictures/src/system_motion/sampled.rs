//! What a picture shows of a run, as numbers: the motion between events from its closed form, and
//! the events.

use percuss::affine::{Event, Solver, System, What};
use percuss::number::Number;

/// The fewest points of the whole run.
const MIN_POINTS: f64 = 6000.0;
/// Points in 2 pi units of the system's time, unless that makes too many.
const POINTS_PER_TURN: f64 = 40.0;
/// The most points of the whole run.
const MAX_POINTS: f64 = 200_000.0;
/// The fewest points of a piece, however short.
const MIN_PIECE_POINTS: f64 = 8.0;
/// The most rows of events by name, of which the last has the others where there are more.
const MAX_NAMES: usize = 12;
const OTHER_EVENTS: &str = "other events";

/// The motion between two events: time and the states that are shown, several times.
pub struct SampledSegment {
    /// The mode of the motion.
    pub mode: usize,
    /// Time and states, from the one event to the other.
    pub points: Vec<Vec<f64>>,
}

/// An event: its row, and time and states just before and after it.
pub(super) struct Mark {
    pub row: usize,
    pub before: Vec<f64>,
    pub after: Vec<f64>,
}

/// The names of the events that occur, in the order of the system's file.
pub(super) fn event_names<T: Number>(system: &System, run: &[Event<T>]) -> Vec<String> {
    let mut named: Vec<&str> = Vec::new();
    for mode in &system.modes {
        let until = mode.until.iter().map(|it| it.name.as_str());
        for name in until.chain(mode.watch.iter().map(|it| it.name.as_str())) {
            if !named.contains(&name) {
                named.push(name);
            }
        }
    }
    let occurs = |name: &&str| run.iter().any(|event| name_of(system, event) == Some(*name));
    let mut names: Vec<String> = named.into_iter().filter(occurs).map(str::to_owned).collect();
    if names.len() > MAX_NAMES {
        names.truncate(MAX_NAMES - 1);
        names.push(OTHER_EVENTS.to_owned());
    }
    names
}

fn name_of<'a, T: Number>(system: &'a System, event: &Event<T>) -> Option<&'a str> {
    match event.what {
        What::Until(mode, n) => Some(&system.modes[mode].until[n].name),
        What::Watch(mode, n) => Some(&system.modes[mode].watch[n].name),
        What::Start | What::Limit(..) | What::End(_) => None,
    }
}

/// The motion from each event to the next that is not at the same instant.
pub(super) fn pieces<T: Number>(
    solver: &Solver<T>,
    run: &[Event<T>],
    shown: &[usize],
) -> Vec<SampledSegment> {
    let whole = match run {
        [first, .., last] => between(first, last).to_f64().abs(),
        _ => 0.0,
    };
    let turns = whole / (std::f64::consts::TAU * solver.system().time_scale);
    let wanted = (POINTS_PER_TURN * turns).clamp(MIN_POINTS, MAX_POINTS);
    let piece = |ends: &[Event<T>]| {
        let lasts = between(&ends[0], &ends[1]);
        let share = lasts.to_f64().abs() / whole;
        let count = (wanted * share).ceil().max(MIN_PIECE_POINTS);
        let point = |n: u32| {
            let time = ends[0].time.after(lasts * T::exact(f64::from(n) / count));
            let state = solver.state_at(&ends[0], &time);
            figures(time.value(), &state, shown)
        };
        let points = (0..=count as u32).map(point).collect();
        (share > 0.0).then_some(SampledSegment { mode: ends[0].mode, points })
    };
    run.windows(2).filter_map(piece).collect()
}

/// All events that have a name.
pub(super) fn marks<T: Number>(
    solver: &Solver<T>,
    run: &[Event<T>],
    shown: &[usize],
    names: &[String],
) -> Vec<Mark> {
    let mark = |ends: &[Event<T>]| {
        let (begin, event) = (&ends[0], &ends[1]);
        let name = name_of(solver.system(), event)?;
        let row = names.iter().position(|it| it == name).unwrap_or(MAX_NAMES - 1);
        let time = event.time.value();
        let before = solver.state_at(begin, &event.time);
        Some(Mark {
            row,
            before: figures(time, &before, shown),
            after: figures(time, &event.state, shown),
        })
    };
    run.windows(2).filter_map(mark).collect()
}

fn between<T: Number>(from: &Event<T>, to: &Event<T>) -> T {
    (to.time.high - from.time.high) + (to.time.low - from.time.low)
}

fn figures<T: Number>(time: T, state: &[T], shown: &[usize]) -> Vec<f64> {
    let states = shown.iter().map(|n| state[*n].to_f64());
    std::iter::once(time.to_f64()).chain(states).collect()
}
