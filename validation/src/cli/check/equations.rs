//! A system in equations: as its file writes them, and with all numbers put in.

use super::written::{Written, WrittenUntil};
use super::zeros::{self, ZeroNames};
use crate::number::shortest;
use percuss::System;
use percuss::affine::{Rational, Row, Successor, Until, is_unit};
use std::fmt::Write;

/// The most characters of a fraction; a longer one is printed as the nearest f64.
const MAX_FRACTION_CHARACTERS: usize = 9;

/// A system with the texts of its file.
pub(super) struct Equations<'a> {
    pub(super) system: &'a System,
    pub(super) written: &'a Written,
}

impl Equations<'_> {
    /// The name, states, scales, forcing, parameters and definitions.
    pub(super) fn head(&self) -> String {
        let system = self.system;
        let mut text = format!("{}\n", system.name);
        let mut line = |key: &str, what: String| {
            let _ = writeln!(text, "  {key:<12}{what}");
        };
        if !system.why.is_empty() {
            line("why", system.why.clone());
        }
        let scaled = system.states.iter().zip(&system.scales);
        let states = scaled.map(|(name, scale)| match scale {
            1.0 => name.clone(),
            _ => format!("{name} (scale {})", shortest(*scale)),
        });
        line("states", states.collect::<Vec<_>>().join(", "));
        let drifts = system.drifts();
        if !drifts.is_empty() {
            let found = if system.drift.is_some() { "" } else { " (found: nothing depends on it)" };
            let names = drifts.iter().map(|it| [&system.states[*it], found].concat());
            line("drift", names.collect::<Vec<_>>().join(", "));
        }
        line("time scale", shortest(system.time_scale));
        if let Some(forcing) = &system.forcing {
            let (omega, phi) = (number(&forcing.omega), number(&forcing.phi));
            line("forcing", format!("theta = omega t + phi, omega = {omega}, phi = {phi}"));
        }
        for (name, value) in &system.parameters {
            line("parameter", format!("{name} = {}", shortest(*value)));
        }
        for (name, definition) in &self.written.lets {
            line("let", format!("{name} = {definition}"));
        }
        text
    }

    /// A mode's equations, and its events with their guards, resets and successors.
    pub(super) fn mode(&self, index: usize) -> String {
        let mode = &self.system.modes[index];
        let written = self.written.mode.get(index);
        let mut text = format!("mode {}\n", mode.name);
        for (state, row) in self.system.states.iter().zip(&mode.matrix) {
            let rate = written.and_then(|it| it.rate(state));
            text.push_str(&both_forms("  ", &format!("{state}' = "), rate, &self.form(row)));
        }
        for (n, until) in mode.until.iter().enumerate() {
            let written = written.and_then(|it| it.until.get(n));
            text.push_str(&self.until(until, written));
        }
        for (n, watch) in mode.watch.iter().enumerate() {
            let guard = written.and_then(|it| it.watch.get(n)).map(|it| it.guard.as_str());
            let name = format!("watch {} ({}): ", watch.name, watch.direction);
            text.push_str(&condition("  ", &name, guard, &self.form(&watch.guard)));
        }
        text
    }

    fn until(&self, until: &Until, written: Option<&WrittenUntil>) -> String {
        let guard = written.map(|it| it.guard.as_str());
        let name = format!("until {}: ", until.name);
        let mut text = condition("  ", &name, guard, &self.form(&until.guard));
        let assigned = |state: &str| written.and_then(|it| it.reset(state));
        text.push_str(&self.reset(&until.reset, assigned));
        for (n, successor) in until.next.iter().enumerate() {
            let when = written.and_then(|it| it.when(n));
            text.push_str(&self.choice("to", successor, when));
        }
        text.push_str(&zero_line("    ", "zero after it", &zeros::after(self.system, until)));
        if let Some(limit) = &until.accumulates_to {
            text.push_str("    where it accumulates:\n");
            text.push_str(&self.reset(&limit.reset, |_| None));
            for successor in &limit.next {
                text.push_str(&self.choice("to", successor, None));
            }
        }
        text
    }

    /// The assignments of a reset: those that are written, and those of states that change.
    fn reset<'b>(&self, reset: &[Row], written: impl Fn(&str) -> Option<&'b str>) -> String {
        let mut text = String::new();
        for (n, (state, row)) in self.system.states.iter().zip(reset).enumerate() {
            let assigned = written(state);
            if assigned.is_some() || !is_unit(row, n) {
                text.push_str(&both_forms(
                    "    ",
                    &format!("{state} = "),
                    assigned,
                    &self.form(row),
                ));
            }
        }
        text
    }

    /// A mode that follows, with its condition if it has one.
    fn choice(&self, to: &str, choice: &Successor, when: Option<&str>) -> String {
        let mode = &self.system.modes[choice.mode].name;
        match &choice.when {
            None => format!("    {to} {mode}\n"),
            Some(row) => condition("    ", &format!("{to} {mode} where "), when, &self.form(row)),
        }
    }

    /// The start, where the system has one.
    pub(super) fn start(&self) -> String {
        let Some(start) = &self.system.start else {
            return "no start: --start FILE.toml, or --mode and --at for each state\n".to_owned();
        };
        let mode = &self.system.modes[start.mode].name;
        let mut text = format!("start in {mode} at t = {}\n", number(&start.time));
        let names = ["cos", "sin", ""].map(str::to_owned);
        for (state, terms) in self.system.states.iter().zip(&start.state) {
            let _ = writeln!(text, "  {state} = {}", form(terms, &names));
        }
        if !self.system.start_modes.is_empty() {
            text.push_str("  its mode is the first whose condition holds there:\n");
        }
        for choice in &self.system.start_modes {
            text.push_str(&self.choice("in", choice, None));
        }
        text.push_str(&zero_line("  ", "zero there", &zeros::at_start(self.system, start)));
        text
    }

    /// A row as a combination of the states, of cos, sin and 1.
    fn form(&self, row: &Row) -> String {
        let mut names = self.system.states.clone();
        if self.system.forcing.is_some() {
            names.extend(["cos", "sin"].map(str::to_owned));
        }
        names.push(String::new());
        form(row, &names)
    }
}

/// An equation as it is written, and with all numbers put in where that differs.
fn both_forms(indent: &str, left: &str, written: Option<&str>, form: &str) -> String {
    match written.filter(|it| !is_alike(it, form)) {
        None => format!("{indent}{left}{form}\n"),
        Some(written) => {
            let place = left.len() - "= ".len();
            format!("{indent}{left}{written}\n{indent}{:place$}= {form}\n", "")
        }
    }
}

/// A condition as it is written, and as a form that is positive where it holds.
fn condition(indent: &str, name: &str, written: Option<&str>, form: &str) -> String {
    let positive = format!("{form} > 0");
    match written.filter(|it| !is_alike(it, &positive)) {
        None => format!("{indent}{name}{positive}\n"),
        Some(written) => {
            format!(
                "{indent}{name}{written}\n{indent}{:width$}{positive}\n",
                "",
                width = name.len()
            )
        }
    }
}

/// Whether two texts are the same but for spaces.
fn is_alike(one: &str, other: &str) -> bool {
    let plain = |it: &str| it.split_whitespace().collect::<String>();
    plain(one) == plain(other)
}

fn zero_line(indent: &str, when: &str, zero: &ZeroNames) -> String {
    let guards = zero.guards.iter().map(|[event, mode]| format!("guard of {event} in {mode}"));
    let all: Vec<String> = zero.states.iter().cloned().chain(guards).collect();
    match all.is_empty() {
        true => String::new(),
        false => format!("{indent}{when} by the model: {}\n", all.join(", ")),
    }
}

/// A combination of names, of which the empty one stands for 1.
fn form(factors: &[Rational], names: &[String]) -> String {
    let mut text = String::new();
    for (factor, name) in factors.iter().zip(names).filter(|(factor, _)| !factor.is_zero()) {
        let is_negative = *factor < Rational::ZERO;
        let size = if is_negative { -factor.clone() } else { factor.clone() };
        let sign = match (text.is_empty(), is_negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let term = match (size.is_one(), name.is_empty()) {
            (true, false) => name.clone(),
            (_, true) => number(&size),
            (false, false) => format!("{} {name}", number(&size)),
        };
        text.push_str(sign);
        text.push_str(&term);
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// A number as a fraction where that is short, or else as the nearest f64.
fn number(exact: &Rational) -> String {
    let fraction = exact.to_string();
    if fraction.len() <= MAX_FRACTION_CHARACTERS { fraction } else { shortest(exact.to_f64()) }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    fn rationals(numbers: &[(i64, i64)]) -> Vec<Rational> {
        numbers.iter().map(|(a, b)| Rational::from(*a) / Rational::from(*b)).collect()
    }

    #[test]
    fn forms_are_printed_as_they_are_written() {
        let names = ["x", "v", "cos", ""].map(str::to_owned);
        let cases: [(&[(i64, i64)], &str); 4] = [
            (&[(1, 1), (-1, 1), (0, 1), (0, 1)], "x - v"),
            (&[(-2, 3), (0, 1), (5, 4), (-7, 1)], "-2/3 x + 5/4 cos - 7"),
            (&[(0, 1), (0, 1), (0, 1), (1, 1)], "1"),
            (&[(0, 1), (0, 1), (0, 1), (0, 1)], "0"),
        ];
        for (numbers, wanted) in cases {
            assert_eq!(form(&rationals(numbers), &names), wanted);
        }
    }

    #[test]
    fn a_long_fraction_is_the_nearest_number() {
        let tenth = Rational::try_from(0.1).expect("finite");
        assert_eq!(number(&tenth), "0.1");
        assert_eq!(number(&(Rational::from(1) / Rational::from(3))), "1/3");
    }

    #[test]
    fn the_same_equation_is_printed_once() {
        assert_eq!(both_forms("  ", "x' = ", Some("v"), "v"), "  x' = v\n");
        assert_eq!(both_forms("  ", "v' = ", Some("-g"), "-1"), "  v' = -g\n     = -1\n");
    }
}
