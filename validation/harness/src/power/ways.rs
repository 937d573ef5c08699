//! Ways of running a system's case: faults in them have to be caught where a case is run in that
//! way, and to do no harm where none is.

use crate::engine::Equations;
use crate::integrators::{COOLDOWN_TIME, Way};
use crate::suite::PreparedCase;
use crate::system::{AffineEquations, Direction, System, Until};

/// The longest step of the integrators with a fault, in forcing periods: a step that an event cuts
/// short reaches no further beyond it.
const MAX_STEP_PERIODS: f64 = 0.125;
/// Room for an integrator's errors where a time is compared with a limit.
const ERROR_MARGIN_FACTOR: f64 = 1.1;

/// The longest run that engines with a fault are asked for, in the shortest times in which the
/// system changes: explicit methods cannot step over these.
const MAX_SHORTEST_TIMES: f64 = 1e5;
/// Calls after which an engine that is wrong on purpose is given up.
pub(super) const MAX_CALLS: u64 = 1_000_000;

/// Whether a case is run in a way.
#[must_use]
pub fn is_run(case: &PreparedCase, way: Way) -> bool {
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
            let reach = MAX_STEP_PERIODS * case.period();
            let mut samples = case.truth.samples.iter().map(|it| it.elapsed.value());
            samples.any(|at| times.iter().any(|event| (*event..=event + reach).contains(&at)))
        }
        Way::Simultaneous => times.windows(2).any(|pair| pair[0] == pair[1]),
        Way::CloseEvents => {
            let close = ERROR_MARGIN_FACTOR * COOLDOWN_TIME * system.time_scale;
            times.windows(2).any(|pair| pair[1] - pair[0] <= close)
        }
    }
}

fn starts_on_guard(case: &PreparedCase) -> bool {
    let equations = AffineEquations::new(&case.task.system);
    let entered = equations.enter(None, case.task.mode, 0.0, &case.task.state);
    entered.zeros != 0 || entered.fires.is_some()
}

/// The events of a true run that change the state.
fn resets(case: &PreparedCase) -> impl Iterator<Item = &Until> {
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
pub(super) fn is_affordable(case: &PreparedCase) -> bool {
    case.truth.span <= MAX_SHORTEST_TIMES * case.task.system.shortest_time()
}
