//! A case as equations, for people.

use percuss_engines::engine::Task;
use percuss_engines::number::shortest;
use percuss_engines::system::{Mode, System, Until};

/// The equations, events, start and horizon of a case.
pub(super) fn equations(case: &str, task: &Task) -> String {
    let system = task.system.system();
    let start = &system.modes[task.mode].name;
    let states = system.states.iter().zip(task.state.iter());
    let states: Vec<_> =
        states.map(|(name, value)| format!("{name} = {}", shortest(*value))).collect();
    let mut lines = vec![
        format!("case {case} of the system {}", system.name),
        format!("time t from 0 to {}{}", shortest(task.span), backward(task)),
        theta(system),
        format!("start in mode {start}: {}", states.join(", ")),
    ];
    system.modes.iter().for_each(|it| mode(system, it, &mut lines));
    lines.join("\n") + "\n"
}

fn backward(task: &Task) -> &'static str {
    if !task.system.is_backward() {
        return "";
    }
    ", of a system turned back in time: where a mode would end the run ends, with leaves-domain"
}

fn theta(system: &System) -> String {
    if system.omega == 0.0 {
        return "no forcing".to_owned();
    }
    format!("theta = {} t + {}", shortest(system.omega), shortest(system.phi))
}

fn mode(system: &System, mode: &Mode, lines: &mut Vec<String>) {
    lines.push(format!("\nmode {}", mode.name));
    for (i, state) in system.states.iter().enumerate() {
        lines.push(format!("  {state}' = {}", form(system, &mode.rate(i))));
    }
    mode.until.iter().for_each(|it| until(system, it, lines));
    for watch in &mode.watch {
        let verb = match watch.direction.as_str() {
            "rising" => "rises through 0",
            "falling" => "falls through 0",
            _ => "passes through 0 either way",
        };
        lines.push(format!("  event {}, which is only counted:", watch.name));
        lines.push(format!("    where {} {verb}", form(system, &watch.guard)));
    }
}

fn until(system: &System, until: &Until, lines: &mut Vec<String>) {
    lines.push(format!("  event {}, which ends the mode:", until.name));
    lines.push(format!("    where {} rises through 0", form(system, &until.guard)));
    for (i, (state, row)) in system.states.iter().zip(until.reset.iter().flatten()).enumerate() {
        let is_kept = row.iter().enumerate().all(|(j, it)| *it == f64::from(u8::from(i == j)));
        if !is_kept {
            lines.push(format!("    {state} becomes {}", form(system, row)));
        }
    }
    for (when, next) in &until.next {
        let condition = match when {
            Some(when) => format!(" where {} > 0, or else", form(system, when)),
            None => String::new(),
        };
        lines.push(format!("    mode {} follows{condition}", system.modes[*next].name));
    }
}

/// A row as a sum.
fn form(system: &System, row: &[f64]) -> String {
    let names = system.states.iter().map(String::as_str).chain(["cos(theta)", "sin(theta)", ""]);
    let mut text = String::new();
    for (value, name) in row.iter().zip(names).filter(|(value, _)| **value != 0.0) {
        let sign = match (text.is_empty(), *value < 0.0) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        let size = shortest(value.abs());
        let term = match (name, size.as_str()) {
            ("", _) => size,
            (_, "1") => name.to_owned(),
            _ => format!("{size} {name}"),
        };
        text += &format!("{sign}{term}");
    }
    if text.is_empty() { "0".to_owned() } else { text }
}
