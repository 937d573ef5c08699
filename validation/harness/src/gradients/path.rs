//! The events of the exact run, along which derivatives are taken.

use super::linear::{Linear, flow_with_rate};
use crate::engine::Failure;
use nalgebra::{DMatrix, DVector};
use percuss::affine::System;
use percuss::{Ending, Event, Kind};

/// What ends a stretch of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    /// The mode's `until` of this index.
    Until(usize),
    /// The guard of this index, of which those that are watched are the last.
    Watch(usize),
    /// The time at which the run ends.
    End,
}

/// A stretch of a run in one mode, and the event that ends it.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub mode: usize,
    pub next: usize,
    pub stop: Stop,
    pub elapsed: f64,
    /// Whether the event fires at the instant at which the mode is entered.
    pub at_entry: bool,
    /// z at the beginning, just before the event, and just after it.
    pub begin: DVector<f64>,
    pub before: DVector<f64>,
    pub after: DVector<f64>,
}

/// The exact run of a system, rounded.
pub(super) fn path(system: &System, linear: &Linear, until: f64) -> Result<Vec<Stretch>, Failure> {
    let solver = system.solver::<f64>().map_err(Failure::new)?;
    let mut events = solver.run().until(until).map_err(Failure::new)?;
    let start = events.start();
    let (mut mode, mut time, mut begin) = (start.mode_index(), *start.time(), linear.start.clone());
    let mut all = Vec::new();
    for event in &mut events {
        let stop = match event.kind() {
            Kind::Until(_, until) => Stop::Until(until),
            Kind::Watch(of, watch) => Stop::Watch(system.modes[of].until.len() + watch),
            Kind::End(Ending::Horizon) => Stop::End,
            _ => return Err(Failure::new(format!("the run ends with {}", event.name()))),
        };
        let elapsed = event.time() - time;
        let matrix = &linear.modes[mode].matrix;
        let before = (matrix * elapsed).exp() * &begin;
        let after = after(system, &before, &event);
        let before = if let Stop::Until(_) = stop { before } else { after.clone() };
        let at_entry = elapsed == 0.0 && matches!(stop, Stop::Until(_)) && !all.is_empty();
        let next = event.mode_index();
        all.push(Stretch {
            mode,
            next,
            stop,
            elapsed,
            at_entry,
            begin,
            before,
            after: after.clone(),
        });
        (mode, time, begin) = (next, *event.time(), after);
    }
    Ok(all)
}

/// z after an event: its own states, and the forcing as it has turned.
fn after(system: &System, before: &DVector<f64>, event: &Event<'_, f64>) -> DVector<f64> {
    let mut after = before.clone();
    after.rows_mut(0, system.states.len()).copy_from_slice(event.state());
    after
}

/// The matrix e^(M t) of a segment's motion, and its derivative by a parameter or a start state.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    pub exponential: DMatrix<f64>,
    pub derivative: DMatrix<f64>,
}

/// The flows of a path by a name.
pub(super) fn flows(path: &[Stretch], linear: &Linear, rates: &Linear) -> Vec<Flow> {
    let flow = |it: &Stretch| {
        let [matrix, rate] = [linear, rates].map(|all| &all.modes[it.mode].matrix);
        let (exponential, derivative) = flow_with_rate(matrix, rate, it.elapsed);
        Flow { exponential, derivative }
    };
    path.iter().map(flow).collect()
}
