//! A system that is whole: every row of the right length, every successor there, and what an
//! integrator wants to know beforehand computed once.

use super::derivative_rows::{AugmentedRow, DerivativeRows, ModeMatrix, value};
use super::spectrum::{Rates, spectrum};
use super::{Direction, MAX_GUARDS, MAX_STATES, Mode, Row, System, Until};
use crate::failure::Failure;
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// A system with what a run of it wants to know.
#[derive(Clone, Debug)]
pub struct CheckedSystem {
    system: System,
    backward: bool,
    pub(super) modes: Vec<CheckedMode>,
    pub(super) most_guards: usize,
    /// What the eigenvalues tell, worked out when it is asked for: short runs of one system are
    /// many, and those of the oscillator never ask.
    rates: OnceLock<Rates>,
}

#[derive(Clone, Debug)]
pub(super) struct CheckedMode {
    /// The matrix A, row by row.
    pub(super) a: Vec<f64>,
    pub(super) b: Vec<[f64; 2]>,
    pub(super) c: Vec<f64>,
    /// Whether the states' rates depend on theta.
    pub(super) forced: bool,
    /// Whether the guards do, and their rates.
    pub(super) guards_forced: [bool; 2],
    pub(super) guards: Vec<Guard>,
    pub(super) until: Vec<ModeEnd>,
}

/// A guard of an event; an event that counts crossings in both directions has two.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    pub(super) event: usize,
    pub(super) ends: bool,
    pub(super) chain: DerivativeRows,
}

/// The reset and the successors at the end of a mode.
#[derive(Clone, Debug)]
pub(super) struct ModeEnd {
    /// The matrix R of z+ = R z.
    pub(super) reset: Vec<AugmentedRow>,
    pub(super) next: Vec<Successor>,
}

#[derive(Clone, Debug)]
pub(super) struct Successor {
    pub(super) when: Option<DerivativeRows>,
    pub(super) mode: usize,
    /// The derivatives of `when`, and of the guards of the mode, that the event's guard makes zero.
    pub(super) when_zeros: u16,
    pub(super) zeros: Vec<u16>,
}

impl CheckedSystem {
    /// Checks a system.
    ///
    /// # Errors
    /// What is wrong with it, or more than this program runs.
    pub fn new(system: System) -> Result<Self, Failure> {
        check(&system)?;
        let motions: Vec<ModeMatrix> =
            system.modes.iter().map(|mode| motion(&system, mode)).collect();
        let guards: Vec<Vec<Guard>> =
            system.modes.iter().zip(&motions).map(|(mode, motion)| guards(mode, motion)).collect();
        let passages = |mode: &Mode| -> Vec<ModeEnd> {
            mode.until.iter().map(|until| passage(until, &motions, &guards)).collect()
        };
        let checked = |(mode, guards): (&Mode, &Vec<Guard>)| CheckedMode {
            a: mode.a.concat(),
            b: mode.b.clone(),
            c: mode.c.clone(),
            forced: mode.b.iter().flatten().any(|it| *it != 0.0),
            guards_forced: [0, 1].map(|order| are_forced(guards, order, &system)),
            guards: guards.clone(),
            until: passages(mode),
        };
        let modes: Vec<CheckedMode> = system.modes.iter().zip(&guards).map(checked).collect();
        let most_guards = guards.iter().map(Vec::len).max().unwrap_or_default();
        if most_guards > MAX_GUARDS {
            return Err(Failure::new(format!(
                "a mode has {most_guards} guards, and at most {MAX_GUARDS} are accepted"
            )));
        }
        Ok(Self { system, backward: false, modes, most_guards, rates: OnceLock::new() })
    }

    /// The fastest of the modes' rates; of decay that which every mode has.
    fn rates(&self) -> &Rates {
        self.rates.get_or_init(|| {
            let spectra = self.system.modes.iter().map(|mode| spectrum(&mode.a));
            let all = |one: Rates, other: Rates| Rates {
                fastest: one.fastest.max(other.fastest),
                turning: one.turning.max(other.turning),
                decay: one.decay.min(other.decay),
            };
            spectra.reduce(all).unwrap_or_default()
        })
    }

    /// The system with its time reversed.
    ///
    /// # Errors
    /// As [`CheckedSystem::new`].
    pub fn backward(&self) -> Result<Self, Failure> {
        Ok(Self { backward: true, ..Self::new(self.system.backward())? })
    }

    /// The system before the checks.
    #[must_use]
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Whether it is run back in time: it then has no resets, and the end of a mode is the end of
    /// the run.
    #[must_use]
    pub fn is_backward(&self) -> bool {
        self.backward
    }

    /// The forcing period, or what stands for it where the system is not forced.
    #[must_use]
    pub fn period(&self) -> f64 {
        TAU * self.system.time_scale
    }

    /// What decides which mode follows an event: for each condition that is looked at the first
    /// derivative that the event's guard does not make zero, as a row with its value in the state
    /// after the event, and the value's rate.
    #[must_use]
    pub fn decisions(
        &self,
        (mode, until): (usize, usize),
        elapsed: f64,
        after: &[f64],
    ) -> Vec<(Row, [f64; 2])> {
        let (sin, cos) = (self.system.omega * elapsed + self.system.phi).sin_cos();
        let passage = self.modes.get(mode).and_then(|mode| mode.until.get(until));
        let mut found = Vec::new();
        for successor in passage.map_or(&[][..], |passage| &passage.next) {
            let Some(when) = &successor.when else { break };
            let order = (0..when.rows.len()).find(|k| successor.when_zeros & 1 << k == 0);
            let Some(order) = order else { continue };
            let at = |k: usize| when.rows.get(k).map_or(0.0, |row| value(row, after, [cos, sin]).0);
            let row = when.rows[order][..after.len() + 3].to_vec();
            found.push((row, [at(order), at(order + 1)]));
            if at(order) > 0.0 {
                break;
            }
        }
        found
    }

    /// The shortest turn of a free oscillation; infinite where nothing oscillates.
    #[must_use]
    pub fn turn(&self) -> f64 {
        TAU / self.rates().turning
    }

    /// The smallest, over all modes, of the rate at which a mode's fastest part decays.
    #[must_use]
    pub fn decay(&self) -> f64 {
        self.rates().decay
    }

    /// The shortest of the times in which the system changes: its time scale, and those of its
    /// matrices.
    #[must_use]
    pub fn shortest_time(&self) -> f64 {
        self.system.time_scale.min(1.0 / self.rates().fastest)
    }
}

fn augmented_row(row: &Row) -> AugmentedRow {
    std::array::from_fn(|i| row.get(i).copied().unwrap_or_default())
}

fn motion(system: &System, mode: &Mode) -> ModeMatrix {
    let size = system.states.len();
    let mut rows: Vec<AugmentedRow> = (0..size).map(|i| augmented_row(&mode.rate(i))).collect();
    let [mut cos, mut sin] = [AugmentedRow::default(); 2];
    cos[size + 1] = -system.omega;
    sin[size] = system.omega;
    rows.extend([cos, sin, AugmentedRow::default()]);
    ModeMatrix { size, rows }
}

fn guards(mode: &Mode, motion: &ModeMatrix) -> Vec<Guard> {
    let chain = |row: &AugmentedRow| DerivativeRows::new(*row, motion);
    let until = mode.until.iter().enumerate();
    let until = until.map(|(event, it)| Guard {
        event,
        ends: true,
        chain: chain(&augmented_row(&it.guard)),
    });
    let watch = mode.watch.iter().enumerate().flat_map(|(k, it)| {
        let signs: &[f64] = match it.direction {
            Direction::Rising => &[1.0],
            Direction::Falling => &[-1.0],
            Direction::Both => &[1.0, -1.0],
        };
        let row = augmented_row(&it.guard);
        let event = mode.until.len() + k;
        let guard = move |sign: &f64| Guard {
            event,
            ends: false,
            chain: chain(&row.map(|entry| sign * entry)),
        };
        signs.iter().map(guard)
    });
    until.chain(watch).collect()
}

fn are_forced(guards: &[Guard], order: usize, system: &System) -> bool {
    let size = system.states.len();
    let mut rows = guards.iter().map(|guard| &guard.chain.rows[order]);
    rows.any(|row| row[size] != 0.0 || row[size + 1] != 0.0)
}

fn passage(until: &Until, motions: &[ModeMatrix], guards: &[Vec<Guard>]) -> ModeEnd {
    let size = motions.first().map_or(0, |motion| motion.size);
    let unit = |i: usize| -> AugmentedRow { std::array::from_fn(|j| f64::from(u8::from(i == j))) };
    let mut reset: Vec<AugmentedRow> = (0..size + 3).map(unit).collect();
    if let Some(rows) = &until.reset {
        reset.iter_mut().zip(rows).for_each(|(line, row)| *line = augmented_row(row));
    }
    let guard = augmented_row(&until.guard);
    let successor = |(when, mode): &(Option<Row>, usize)| {
        let when =
            when.as_ref().map(|row| DerivativeRows::new(augmented_row(row), &motions[*mode]));
        let zeros_of = |chain: &DerivativeRows| chain.zeros_after(&guard, &reset, size);
        Successor {
            when_zeros: when.as_ref().map_or(0, zeros_of),
            zeros: guards[*mode].iter().map(|it| zeros_of(&it.chain)).collect(),
            when,
            mode: *mode,
        }
    };
    let next = until.next.iter().map(successor).collect();
    ModeEnd { reset, next }
}

fn check(system: &System) -> Result<(), Failure> {
    let size = system.states.len();
    let wrong = |what: String| Err(Failure::new(format!("system {}: {what}", system.name)));
    if !(1..=MAX_STATES).contains(&size) {
        return wrong(format!("{size} states, accepted are 1 to {MAX_STATES}"));
    }
    if system.scales.len() != size || !system.scales.iter().all(|it| it.is_finite() && *it > 0.0) {
        return wrong("each state needs a positive scale".to_owned());
    }
    let time = system.time_scale;
    if !(time.is_finite() && time > 0.0 && system.omega.is_finite() && system.phi.is_finite()) {
        return wrong("it needs a positive time scale and a finite forcing".to_owned());
    }
    if system.modes.is_empty() {
        return wrong("it needs a mode".to_owned());
    }
    for mode in &system.modes {
        check_mode(mode, size, system.modes.len())
            .or_else(|what| wrong(format!("mode {}: {what}", mode.name)))?;
    }
    Ok(())
}

fn check_mode(mode: &Mode, size: usize, modes: usize) -> Result<(), String> {
    let is_finite = |row: &[f64]| row.iter().all(|it| it.is_finite());
    let is_row = |row: &Row| row.len() == size + 3 && is_finite(row);
    let rates = mode.a.iter().all(|row| row.len() == size && is_finite(row))
        && mode.b.iter().all(|row| is_finite(row))
        && is_finite(&mode.c);
    if [mode.a.len(), mode.b.len(), mode.c.len()] != [size; 3] || !rates {
        return Err(format!("its equations are not those of {size} states"));
    }
    for until in &mode.until {
        let whens = until.next.iter().filter_map(|(when, _)| when.as_ref());
        let resets = until.reset.iter().flatten();
        if !std::iter::once(&until.guard).chain(whens).chain(resets).all(is_row)
            || until.reset.as_ref().is_some_and(|rows| rows.len() != size)
        {
            return Err(format!("event {}: a row of another length than {}", until.name, size + 3));
        }
        let last = until.next.last().is_some_and(|(when, _)| when.is_none());
        if !last || until.next.iter().any(|(_, next)| *next >= modes) {
            return Err(format!("event {}: no mode follows", until.name));
        }
    }
    match mode.watch.iter().find(|watch| !is_row(&watch.guard)) {
        Some(watch) => Err(format!("event {}: a row of another length", watch.name)),
        None => Ok(()),
    }
}

#[cfg(test)]
#[path = "checked_tests.rs"]
mod tests;
