//! Derivatives of a run by names: of the coefficients, as a request has them, and through the
//! events of a run by the chain rule.

use super::{Mode, Row, Run, dot};
use serde::Deserialize;
use serde_json::{Value, json};
use std::error::Error;
use std::rc::Rc;

/// The derivatives of a system's coefficients by a name, each in the coefficient's place.
#[derive(Clone, Deserialize)]
pub struct Rates {
    pub wrt: String,
    pub value: f64,
    pub omega: f64,
    pub phi: f64,
    pub state: Vec<f64>,
    modes: Vec<ModeRates>,
}

#[derive(Clone, Deserialize)]
struct ModeRates {
    #[serde(rename = "A")]
    a: Vec<Row>,
    #[serde(rename = "B")]
    b: Vec<[f64; 2]>,
    c: Vec<f64>,
    events: Vec<EventRates>,
}

#[derive(Clone, Deserialize)]
struct EventRates {
    guard: Row,
    reset: Option<Vec<Row>>,
}

impl Rates {
    /// The derivative of (z, cos theta, sin theta, 1) at a time that moves.
    fn wide(&self, mode: &Mode, t: f64, dt: f64, dz: &[f64]) -> Row {
        let (sin, cos) = (mode.omega * t + mode.phi).sin_cos();
        let angle = self.omega * t + mode.omega * dt + self.phi;
        dz.iter().copied().chain([-sin * angle, cos * angle, 0.0]).collect()
    }

    /// The derivative of the right-hand side at a fixed time and state.
    pub fn field(&self, mode: &Mode, t: f64, z: &[f64]) -> Vec<f64> {
        let wide = mode.wide(t, z);
        let turned = self.wide(mode, t, 0.0, &vec![0.0; z.len()]);
        let rate = |n: usize| dot(&self.row(mode, n), &wide) + dot(&mode.row(n), &turned);
        (0..z.len()).map(rate).collect()
    }

    /// The derivative of a state's rate as a row.
    pub fn row(&self, mode: &Mode, state: usize) -> Row {
        let ModeRates { a, b, c, .. } = &self.modes[mode.place];
        [a[state].as_slice(), &b[state], &[c[state]]].concat()
    }

    /// The derivative of the row of a guard.
    pub fn guard_row(&self, mode: &Mode, event: usize) -> Row {
        self.modes[mode.place].events[event].guard.clone()
    }

    /// The derivative of a row of a reset, for an event that has one.
    pub fn reset_row(&self, mode: &Mode, event: usize, state: usize) -> Row {
        let EventRates { guard, reset } = &self.modes[mode.place].events[event];
        reset.as_ref().map_or_else(|| vec![0.0; guard.len()], |rows| rows[state].clone())
    }

    /// The derivative of a guard at a fixed time, where the state has its own.
    pub fn guard(&self, mode: &Mode, event: usize, t: f64, z: &[f64], dz: &[f64]) -> f64 {
        let own = &self.modes[mode.place].events[event].guard;
        let wide = self.wide(mode, t, 0.0, dz);
        dot(own, &mode.wide(t, z)) + dot(mode.events()[event].guard(), &wide)
    }

    /// The derivative of the state after an event, whose time and state before it have their own.
    pub fn reset(
        &self,
        mode: &Mode,
        event: usize,
        (t, z): (f64, &[f64]),
        (dt, dz): (f64, &[f64]),
    ) -> Vec<f64> {
        let Some(rows) = &mode.events()[event].reset else { return dz.to_vec() };
        let (own, wide) = (&self.modes[mode.place].events[event].reset, self.wide(mode, t, dt, dz));
        let mut after: Vec<f64> = rows.iter().map(|row| dot(row, &wide)).collect();
        for (after, own) in after.iter_mut().zip(own.iter().flatten()) {
            *after += dot(own, &mode.wide(t, z));
        }
        after
    }
}

/// The sum over names of a change of each times its derivative.
pub fn sum(changes: &[f64], size: usize, by: impl Fn(usize) -> Vec<f64>) -> Vec<f64> {
    let mut total = vec![0.0; size];
    for (n, change) in changes.iter().enumerate().filter(|(_, change)| **change != 0.0) {
        total.iter_mut().zip(by(n)).for_each(|(total, rate)| *total += change * rate);
    }
    total
}

/// An event of a run, with the mode and the state before it and after it.
pub struct Passed {
    pub t: f64,
    pub mode: Rc<Mode>,
    pub event: usize,
    pub before: Vec<f64>,
    pub follows: Rc<Mode>,
    pub after: Vec<f64>,
}

/// A stretch of a run without events, from a time and state on.
pub struct Stretch<'a> {
    pub mode: &'a Rc<Mode>,
    pub begin: f64,
    pub state: &'a [f64],
    pub end: f64,
}

/// Derivatives along a run by the chain rule, with the jump at each event by hand: its time moves
/// by the change of the guard over the guard's rate, and the state along its rates. `along` takes a
/// stretch and the derivatives of the state where it begins, a list for each name, and gives those
/// where it ends, both at fixed times.
pub fn chained(
    run: &Run,
    first: &Rc<Mode>,
    trail: &[Passed],
    along: impl Fn(&Stretch<'_>, Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, Box<dyn Error>>,
) -> Result<Vec<Value>, Box<dyn Error>> {
    let by = &run.gradients;
    let (mut mode, mut t, mut z) = (Rc::clone(first), 0.0, run.state.clone());
    let mut times = vec![0.0; by.len()];
    let mut states: Vec<_> = by.iter().map(|it| it.state.clone()).collect();
    let mut events: Vec<Vec<Value>> = by.iter().map(|_| Vec::new()).collect();
    for passed in trail {
        // An event where its mode is entered comes when the entry does.
        if passed.t > t {
            let fixed = at_fixed_time(&mode, t, &z, &times, states);
            let stretch = Stretch { mode: &mode, begin: t, state: &z, end: passed.t };
            states = along(&stretch, fixed)?;
            let rates = passed.mode.rates(passed.t, &passed.before);
            let speed = passed.mode.guard_rate(passed.event, passed.t, &passed.before);
            for ((rate, time), state) in by.iter().zip(&mut times).zip(&mut states) {
                let Passed { t, event, before, .. } = passed;
                *time = -rate.guard(&passed.mode, *event, *t, before, state) / speed;
                state.iter_mut().zip(&rates).for_each(|(state, rate)| *state += *time * rate);
            }
        }
        for (n, rates) in by.iter().enumerate() {
            let moved = (times[n], states[n].as_slice());
            let place = (passed.t, passed.before.as_slice());
            states[n] = rates.reset(&passed.mode, passed.event, place, moved);
            events[n].push(json!({"time": times[n], "state": states[n]}));
        }
        (mode, t, z) = (Rc::clone(&passed.follows), passed.t, passed.after.clone());
    }
    let fixed = at_fixed_time(&mode, t, &z, &times, states);
    let ends = along(&Stretch { mode: &mode, begin: t, state: &z, end: run.span }, fixed)?;
    let each = by.iter().zip(events).zip(ends);
    let finite = each.filter(|(_, end)| end.iter().all(|it| it.is_finite()));
    let answer = |((rates, events), end): ((&Rates, Vec<Value>), Vec<f64>)| {
        let name = &rates.wrt;
        json!({"wrt": name, "events": events, "end": end})
    };
    Ok(finite.map(answer).collect())
}

/// The derivatives at the fixed time at which a stretch begins, from those at a time that moves.
fn at_fixed_time(
    mode: &Mode,
    t: f64,
    z: &[f64],
    times: &[f64],
    mut states: Vec<Vec<f64>>,
) -> Vec<Vec<f64>> {
    let rates = mode.rates(t, z);
    for (state, time) in states.iter_mut().zip(times) {
        state.iter_mut().zip(&rates).for_each(|(state, rate)| *state -= time * rate);
    }
    states
}
