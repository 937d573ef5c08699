//! How far errors of the tolerance's size bring a derivative from its value.
//!
//! A method that keeps to a tolerance makes errors e of the state z and d of its derivative s, of
//! the tolerance's size times 1 + |z| and 1 + |s|. Between events they go on as e' = M e and
//! d' = M d + dM e. At an event the time is off by -(w e)/(w M z); the derivative of the time, a
//! quotient, and that of the reset state are off by their own derivatives, taken at the time that
//! is off. So errors of a derivative grow by the derivative of all that makes it: by second
//! derivatives of the flow through the events too. The unit of a cell is the sum over errors that
//! begin at both ends of every stretch, and 1: what is exactly known may be off by the tolerance.

use super::mechanism::RIGHT_RULE;
use super::path::{Stop, Stretch};
use super::walk::{Along, EventTerms};
use nalgebra::DVector;

/// An error that began somewhere: of z and its derivative at a fixed time, and of the last event's
/// time and its derivative.
struct Deviation {
    state: DVector<f64>,
    slope: DVector<f64>,
    time: f64,
    time_rate: f64,
}

/// The sums over all errors, of one unit of tolerance each, for every cell of every row.
pub(super) fn units(along: &Along<'_>, time_scale: f64) -> Vec<Vec<f64>> {
    let mut slope = along.rates.start.clone();
    let mut time = 0.0;
    let mut all: Vec<Deviation> = Vec::new();
    let mut rows = vec![vec![1.0 + slope.amax(); 1 + along.states]];
    for (stretch, flow) in along.path.iter().zip(along.flows) {
        let steps = 1.0 + stretch.elapsed / time_scale;
        begin(&mut all, along.states, (&stretch.begin, &slope), steps);
        for it in &mut all {
            it.slope = &flow.exponential * &it.slope + &flow.derivative * &it.state;
            it.state = &flow.exponential * &it.state;
        }
        let there = &flow.exponential * &slope + &flow.derivative * &stretch.begin;
        begin(&mut all, along.states, (&stretch.before, &there), steps);
        if stretch.stop == Stop::End {
            let sums = (0..along.states)
                .map(|k| 1.0 + all.iter().map(|it| it.slope[k].abs()).sum::<f64>());
            rows.push(std::iter::once(1.0).chain(sums).collect());
            break;
        }
        let event = EventTerms::new(along, stretch);
        if !stretch.at_entry {
            time = event.time(&there, RIGHT_RULE);
        }
        let moved = event.moved(&there, time, RIGHT_RULE);
        slope = &moved - &event.after * time;
        let at = At { event, stretch, there: &there, slope: &slope, time };
        let mut sums = vec![1.0; 1 + along.states];
        for it in &mut all {
            let row = at.pass(it);
            sums[0] += it.time_rate.abs();
            sums[1..].iter_mut().zip(row.iter()).for_each(|(sum, it)| *sum += it.abs());
        }
        rows.push(sums);
    }
    rows
}

/// Adds an error of each state and of each derivative.
fn begin(
    all: &mut Vec<Deviation>,
    states: usize,
    (z, slope): (&DVector<f64>, &DVector<f64>),
    steps: f64,
) {
    let largest = |it: &DVector<f64>| steps * (1.0 + it.rows(0, states).amax());
    let zero = DVector::zeros(z.len());
    for k in 0..states {
        for of_state in [true, false] {
            let (mut state, mut rate) = (zero.clone(), zero.clone());
            if of_state {
                state[k] = largest(z);
            } else {
                rate[k] = largest(slope);
            }
            all.push(Deviation { state, slope: rate, time: 0.0, time_rate: 0.0 });
        }
    }
}

/// An event that errors pass.
struct At<'a> {
    event: EventTerms<'a>,
    stretch: &'a Stretch,
    /// The derivative just before the event and just after it, each at a fixed time, and that of
    /// the event's time.
    there: &'a DVector<f64>,
    slope: &'a DVector<f64>,
    time: f64,
}

impl At<'_> {
    /// Takes an error through the event, and gives the error of the row's states.
    fn pass(&self, it: &mut Deviation) -> DVector<f64> {
        let EventTerms { along, before, after, .. } = &self.event;
        let (Stop::Until(guard) | Stop::Watch(guard)) = self.stretch.stop else {
            return it.slope.clone();
        };
        let [own, rate] = [along.linear, along.rates].map(|all| &all.modes[self.stretch.mode]);
        let [next, next_rate] =
            [along.linear, along.rates].map(|all| &all.modes[self.stretch.next].matrix);
        let dot = |row: &nalgebra::RowDVector<f64>, z: &DVector<f64>| row.dot(&z.transpose());
        let guards = [&own.guards[guard], &rate.guards[guard]];
        let speed = dot(guards[0], before);
        if !self.stretch.at_entry {
            it.time = -dot(guards[0], &it.state) / speed;
        }
        let state = &it.state + before * it.time;
        let field = &own.matrix * self.there + &rate.matrix * &self.stretch.before;
        let slope = &it.slope + field * it.time;
        let state_rate = &own.matrix * &state;
        if !self.stretch.at_entry {
            let shift = dot(guards[0], &slope) + dot(guards[1], &state);
            it.time_rate = -(shift + self.time * dot(guards[0], &state_rate)) / speed;
        }
        let moved = slope + state_rate * self.time + before * it.time_rate;
        let (row, state) = match self.stretch.stop {
            Stop::Until(until) => {
                let [reset, reset_rate] = [&own.resets[until], &rate.resets[until]];
                (reset * moved + reset_rate * &state, reset * state)
            }
            _ => (moved, state),
        };
        let later = &row - (next * &state) * self.time - after * it.time_rate;
        let field = next * self.slope + next_rate * &self.stretch.after;
        it.slope = later - field * it.time;
        it.state = state - after * it.time;
        row
    }
}
