//! Judges an integrator of one's own by proved events: a Runge-Kutta method of fixed steps that
//! looks for events by the sign of the guard at the ends of its steps.
//!
//! A forced mass comes to a stop. The longer the steps, the more contacts the method passes over.
//!
//! `cargo run --release --example judge_steps`

use percuss::{Proved, System, gallery};
use std::error::Error;
use std::io::Write;

/// The events that were found, beside the proved ones.
#[derive(Debug, PartialEq)]
pub struct Verdict {
    /// The number of proved events.
    pub events: usize,
    /// The number of them that the method has, before the first that it has not.
    pub found: usize,
    /// The largest error of their times.
    pub error: f64,
}

/// The right side of the free motion of [`gallery::IMPACT_OSCILLATOR`].
fn rate(time: f64, [x, v]: [f64; 2]) -> [f64; 2] {
    [v, (2.8 * time).cos() - x - 0.1 * v]
}

/// A step of the classical Runge-Kutta method.
fn step(time: f64, state: [f64; 2], h: f64) -> [f64; 2] {
    let moved = |k: [f64; 2], h: f64| [state[0] + h * k[0], state[1] + h * k[1]];
    let k1 = rate(time, state);
    let k2 = rate(time + h / 2.0, moved(k1, h / 2.0));
    let k3 = rate(time + h / 2.0, moved(k2, h / 2.0));
    let k4 = rate(time + h, moved(k3, h));
    let sum = |n: usize| k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n];
    [state[0] + h / 6.0 * sum(0), state[1] + h / 6.0 * sum(1)]
}

/// The times of the impacts up to an end, by steps of one size and bisection inside a step.
fn impacts(h: f64, end: f64) -> Vec<f64> {
    const STOP: f64 = 0.125;
    let (mut time, mut state, mut times) = (0.0, [0.0, 0.0], Vec::new());
    while time < end {
        let next = step(time, state, h);
        if next[0] <= STOP {
            (time, state) = (time + h, next);
            continue;
        }
        let (mut before, mut after) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (before + after);
            if step(time, state, middle)[0] > STOP { after = middle } else { before = middle }
        }
        let [_, speed] = step(time, state, before);
        (time, state) = (time + before, [STOP, -0.75 * speed]);
        times.push(time);
    }
    times
}

/// The verdict on steps of this size.
pub fn judge(h: f64, end: f64) -> Result<Verdict, Box<dyn Error>> {
    let solver = System::from_toml(gallery::IMPACT_OSCILLATOR)?.solver::<Proved>()?;
    let proved: Vec<f64> = solver
        .run()
        .until(end)?
        .filter(|event| event.name() == "impact")
        .map(|event| event.time().midpoint())
        .collect();
    let own = impacts(h, end);
    let errors = proved.iter().zip(&own).map(|(proved, own)| (proved - own).abs());
    let right: Vec<f64> = errors.take_while(|error| *error < 0.05).collect();
    let error = right.iter().copied().fold(0.0, f64::max);
    Ok(Verdict { events: proved.len(), found: right.len(), error })
}

/// A row for each size of steps.
pub fn write(mut out: impl Write) -> Result<(), Box<dyn Error>> {
    writeln!(out, "{:>8} {:>7} {:>6} {:>8}", "step", "events", "found", "error")?;
    for h in [0.5, 0.2, 0.05, 0.01] {
        let Verdict { events, found, error } = judge(h, 20.0)?;
        writeln!(out, "{h:>8} {events:>7} {found:>6} {error:>8.0e}")?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
