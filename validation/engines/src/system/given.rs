//! A system in plain numbers, from its exact coefficients.

use super::{Direction, Mode, Row, System, Until, Watch};
use percuss::affine::{self, Rational};

impl From<&affine::System> for System {
    /// Rounds every coefficient once; the forcing's angle is that at the system's start.
    fn from(exact: &affine::System) -> Self {
        let states = exact.states.len();
        let (omega, phi) = match &exact.forcing {
            Some(forcing) => {
                let begin = exact.start.as_ref().map(|start| &start.time);
                let turned = begin.map(|time| &forcing.omega * time).unwrap_or_default();
                (rounded(&forcing.omega), rounded(&(turned + &forcing.phi)))
            }
            None => (0.0, 0.0),
        };
        Self {
            name: exact.name.clone(),
            states: exact.states.clone(),
            drift: exact.drifts(),
            scales: exact.scales.clone(),
            time_scale: exact.time_scale,
            omega,
            phi,
            modes: exact.modes.iter().map(|it| mode(it, states)).collect(),
        }
    }
}

pub(super) fn rounded(number: &Rational) -> f64 {
    number.to_f64()
}

pub(super) fn mode(exact: &affine::Mode, states: usize) -> Mode {
    let rows: Vec<Row> = exact.matrix.iter().take(states).map(|it| row(it, states)).collect();
    Mode {
        name: exact.name.clone(),
        a: rows.iter().map(|row| row[..states].to_vec()).collect(),
        b: rows.iter().map(|row| [row[states], row[states + 1]]).collect(),
        c: rows.iter().map(|row| row[states + 2]).collect(),
        until: exact.until.iter().map(|it| until_in_f64(it, states)).collect(),
        watch: exact.watch.iter().map(|it| watch(it, states)).collect(),
    }
}

/// The coefficients of the states, cos theta, sin theta and 1; a system that is not forced has none
/// of cos theta and sin theta.
fn row(exact: &[Rational], states: usize) -> Row {
    let mut row: Row = exact.iter().map(rounded).collect();
    if row.len() == states + 1 {
        row.splice(states..states, [0.0, 0.0]);
    }
    row
}

fn until_in_f64(exact: &affine::Until, states: usize) -> Until {
    let condition = |when: &Option<Vec<Rational>>| when.as_ref().map(|it| row(it, states));
    Until {
        name: exact.name.clone(),
        guard: row(&exact.guard, states),
        reset: Some(exact.reset.iter().take(states).map(|it| row(it, states)).collect()),
        next: exact.next.iter().map(|it| (condition(&it.when), it.mode)).collect(),
    }
}

fn watch(exact: &affine::Watch, states: usize) -> Watch {
    let direction = match exact.direction {
        affine::Direction::Rising => Direction::Rising,
        affine::Direction::Falling => Direction::Falling,
        affine::Direction::Both => Direction::Both,
    };
    Watch { name: exact.name.clone(), guard: row(&exact.guard, states), direction }
}
