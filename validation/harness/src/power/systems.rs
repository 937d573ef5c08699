//! Faults in ways of running a system's case: they have to be caught where a case is run in that
//! way, and to do no harm where none is.

use super::{AS_EXACT, Finding, Standard, judged};
use crate::case::Bound;
use crate::engine::{Equations, Limits};
use crate::integrators::{
    COOLDOWN, Way, WrongEngine, WrongWay, faulty_on_systems, wrong_on_systems,
};
use crate::score::Checked;
use crate::suite::{CaseRun, PreparedSystem};
use crate::system::{Affine, Direction, System, Until};
use rayon::prelude::*;

/// The longest step of the integrators with a fault, in forcing periods: a step that an event cuts
/// short reaches no further beyond it.
const LONGEST_STEP: f64 = 0.125;
/// Room for an integrator's errors where a time is compared with a limit.
const ROOM: f64 = 1.1;

/// The longest run that engines with a fault are asked for, in the shortest times in which the
/// system changes: explicit methods cannot step over these.
const MOST_TIMES: f64 = 1e5;
/// Calls after which an engine that is wrong on purpose is given up.
const MOST_CALLS: u64 = 1_000_000;

/// Every engine that is wrong in a way of running a case, with what it is held to.
#[must_use]
pub fn all_on_systems() -> Vec<(WrongWay, Standard)> {
    let integrators = Standard::of_faulty().into_iter();
    let integrators =
        integrators.flat_map(|held| faulty_on_systems().iter().map(move |it| (*it, held)));
    wrong_on_systems().iter().map(|it| (*it, AS_EXACT)).chain(integrators).collect()
}

/// Whether a case is run in a way.
#[must_use]
pub fn is_run(case: &PreparedSystem, way: Way) -> bool {
    let times: Vec<f64> = case.truth.events.iter().map(|it| it.elapsed.value()).collect();
    let system = case.task.system.system();
    match way {
        Way::Backward => case.case.backward,
        Way::Direction => {
            let mut watched = system.modes.iter().flat_map(|mode| &mode.watch);
            watched.any(|it| it.direction != Direction::Both)
        }
        Way::StartOnGuard => starts_on_guard(case),
        Way::OutputAtEvents => resets(case).next().is_some(),
        Way::OutputBetweenEvents => {
            let reach = LONGEST_STEP * case.period();
            let mut samples = case.truth.samples.iter().map(|it| it.elapsed.value());
            samples.any(|at| times.iter().any(|event| (*event..=event + reach).contains(&at)))
        }
        Way::Simultaneous => times.windows(2).any(|pair| pair[0] == pair[1]),
        Way::CloseEvents => {
            let close = ROOM * COOLDOWN * system.time_scale;
            times.windows(2).any(|pair| pair[1] - pair[0] <= close)
        }
    }
}

fn starts_on_guard(case: &PreparedSystem) -> bool {
    let equations = Affine::of(&case.task.system);
    let entered = equations.enter(None, case.task.mode, 0.0, &case.task.state);
    entered.zeros != 0 || entered.fires.is_some()
}

/// The events of a true run that change the state.
fn resets(case: &PreparedSystem) -> impl Iterator<Item = &Until> {
    let System { modes, states, .. } = case.task.system.system();
    let mut mode = case.truth.start.mode;
    case.truth.events.iter().filter_map(move |row| {
        let until = modes[mode].until.get(row.event);
        mode = row.mode;
        until.filter(|it| changes(it, states.len()))
    })
}

fn changes(until: &Until, states: usize) -> bool {
    let stays = |(i, row): (usize, &Vec<f64>)| {
        row.iter().enumerate().all(|(j, entry)| *entry == f64::from(u8::from(i == j && i < states)))
    };
    until.reset.as_ref().is_some_and(|rows| !rows.iter().enumerate().all(stays))
}

/// Whether an explicit integrator gets through a case at a cost that a fault is worth.
fn is_affordable(case: &PreparedSystem) -> bool {
    case.truth.span <= MOST_TIMES * case.task.system.shortest_time()
}

/// Runs an engine that is wrong in one way on all cases, but for the stiffest: on those that are
/// run in that way it has to fail a bound, and on the others none.
#[must_use]
pub fn examine_on_systems(
    it: &WrongWay,
    cases: &[PreparedSystem],
    standard: Standard,
    bounds: &[Bound],
) -> Finding {
    let cases = cases.iter().filter(|case| is_affordable(case));
    let (with, without): (Vec<_>, Vec<_>) = cases.partition(|case| is_run(case, it.way));
    let run = |cases: &[&PreparedSystem]| -> Vec<(String, Option<Vec<Checked>>)> {
        let one = |case: &&PreparedSystem| {
            (case.name().to_owned(), held(&it.wrong, case, standard, bounds))
        };
        cases.par_iter().map(one).collect()
    };
    let elsewhere = Finding::of(&it.wrong, standard, run(&without));
    let failed = elsewhere.failed_on.clone();
    let mut finding = Finding::of(&it.wrong, standard, run(&with));
    finding.way = Some(it.way);
    finding.elsewhere = (without.len(), failed);
    finding
}

fn held(
    wrong: &WrongEngine,
    case: &PreparedSystem,
    standard: Standard,
    defaults: &[Bound],
) -> Option<Vec<Checked>> {
    let Standard { accuracy, unit, .. } = standard;
    let limits = Limits { calls: MOST_CALLS, ..Limits::default() };
    let measured = case.measured(wrong.engine, (accuracy, unit), &limits).ok()?;
    Some(judged(case, &measured.measures, standard, defaults))
}
