//! A system in CSV: every line is a row over (z, cos theta, sin theta, 1).

use crate::wire::samples;
use percuss_engines::engine::Task;
use percuss_engines::number::shortest;
use percuss_engines::system::{Mode, Row, System};

/// The rates of every mode, and its events: guard, reset and successors.
pub(super) fn rows(system: &System) -> String {
    let header = ["mode", "event", "row", "of"].map(str::to_owned).into_iter();
    let forms = ["cos", "sin", "one"].map(str::to_owned);
    let mut lines = vec![header.chain(system.states.iter().cloned()).chain(forms).collect()];
    for mode in &system.modes {
        rates(system, mode, &mut lines);
        events(system, mode, &mut lines);
    }
    text(&lines)
}

type Fields = Vec<String>;

fn line(words: [&str; 4], row: &[f64]) -> Fields {
    let words = words.into_iter().map(str::to_owned);
    words.chain(row.iter().map(|value| shortest(*value))).collect()
}

fn rates(system: &System, mode: &Mode, lines: &mut Vec<Fields>) {
    for (i, state) in system.states.iter().enumerate() {
        lines.push(line([&mode.name, "", "rate", state], &mode.rate(i)));
    }
}

fn events(system: &System, mode: &Mode, lines: &mut Vec<Fields>) {
    for until in &mode.until {
        lines.push(line([&mode.name, &until.name, "guard", "rising"], &until.guard));
        for (state, row) in system.states.iter().zip(until.reset.iter().flatten()) {
            lines.push(line([&mode.name, &until.name, "reset", state], row));
        }
        for (when, next) in &until.next {
            // What has no condition has the row that is 1.
            let always = || [vec![0.0; system.states.len() + 2], vec![1.0]].concat();
            let when: Row = when.clone().unwrap_or_else(always);
            let next = &system.modes[*next].name;
            lines.push(line([&mode.name, &until.name, "successor", next], &when));
        }
    }
    for watch in &mode.watch {
        let direction = watch.direction.as_str();
        lines.push(line([&mode.name, &watch.name, "guard", direction], &watch.guard));
    }
}

/// The lines of a run's start and horizon.
pub(super) fn start(task: &Task) -> String {
    let system = task.system.system();
    let header = ["mode", "horizon", "omega", "phi", "backward"].map(str::to_owned).into_iter();
    let numbers = [task.span, system.omega, system.phi].map(shortest).into_iter();
    let line = [system.modes[task.mode].name.clone()].into_iter().chain(numbers);
    let line = line.chain([u8::from(task.system.is_backward()).to_string()]);
    text(&[
        header.chain(system.states.iter().cloned()).collect(),
        line.chain(task.state.iter().map(|value| shortest(*value))).collect(),
    ])
}

fn text(lines: &[Fields]) -> String {
    lines.iter().map(|line| line.join(",") + "\n").collect()
}

/// The instants at which the state is compared, and the horizon.
pub(super) fn sample_times(task: &Task) -> Vec<f64> {
    let mut times = samples(task);
    if times.last() != Some(&task.span) {
        times.push(task.span);
    }
    times
}
