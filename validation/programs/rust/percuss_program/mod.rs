//! Programs that percuss runs as engines, for Rust: the protocol, and a system's equations.
//!
//! A program calls [`serve`] with what it can do and with a function that makes a run. The protocol
//! is described in docs/PROTOCOL.md. What follows an event is told by the signs of conditions
//! alone: engines in Rust that experts set up are part of percuss.

#![allow(dead_code, reason = "each program uses a part of it")]

pub mod derivatives;
pub mod saltation;

use derivatives::{Passed, Rates};
use serde::Deserialize;
use serde_json::{Value, json};
use std::cell::Cell;
use std::error::Error;
use std::io::{BufRead, Write};
use std::rc::Rc;
use std::time::{Duration, Instant};

/// So many events in one instant end a run.
const MAX_SIMULTANEOUS_EVENTS: usize = 64;
const INSTANT_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// A row over (z, cos theta, sin theta, 1).
pub type Row = Vec<f64>;

#[derive(Deserialize)]
struct Request {
    id: u64,
    ask: String,
    run: Option<Run>,
}

/// A run that percuss asks for.
#[derive(Deserialize)]
pub struct Run {
    pub setup: String,
    pub system: SystemWire,
    backward: bool,
    pub mode: usize,
    pub state: Vec<f64>,
    pub span: f64,
    pub samples: Vec<f64>,
    pub tolerance: Tolerance,
    pub limits: Limits,
    /// The names by which derivatives are asked for.
    #[serde(default)]
    pub gradients: Vec<Rates>,
}

/// The tolerances.
#[derive(Deserialize)]
pub struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

/// The limits beyond which a run gives up.
#[derive(Deserialize)]
pub struct Limits {
    pub calls: u64,
    pub events: usize,
    pub wall_s: f64,
}

/// A system, whose modes a course has taken.
#[derive(Deserialize)]
pub struct SystemWire {
    pub name: String,
    pub states: Vec<String>,
    pub scales: Vec<f64>,
    pub time_scale: f64,
    pub omega: f64,
    pub phi: f64,
    modes: Vec<ModeWire>,
}

/// A mode's coefficients and events.
#[derive(Deserialize)]
pub struct ModeWire {
    pub name: String,
    #[serde(rename = "A")]
    pub a: Vec<Row>,
    #[serde(rename = "B")]
    pub b: Vec<[f64; 2]>,
    pub c: Vec<f64>,
    pub events: Vec<Event>,
}

/// An event of a mode.
#[derive(Deserialize)]
pub struct Event {
    pub name: String,
    guard: Row,
    pub direction: String,
    pub reset: Option<Vec<Row>>,
    pub successors: Vec<Successor>,
}

/// A mode that may follow an event.
#[derive(Deserialize)]
pub struct Successor {
    pub when: Option<Row>,
    pub mode: usize,
}

impl Event {
    /// 1 where the guard rises, -1 where it falls, 0 for both.
    pub fn sign(&self) -> f64 {
        match self.direction.as_str() {
            "rising" => 1.0,
            "falling" => -1.0,
            _ => 0.0,
        }
    }

    /// The row of its guard.
    pub fn guard(&self) -> &[f64] {
        &self.guard
    }

    /// Whether it ends its mode.
    pub fn ends(&self) -> bool {
        !self.successors.is_empty()
    }
}

/// A mode: z' = A z + c + B (cos theta, sin theta).
pub struct Mode {
    /// The place of the mode in its system.
    pub place: usize,
    pub wire: ModeWire,
    omega: f64,
    phi: f64,
    calls: Rc<Cell<u64>>,
}

impl Mode {
    fn wide(&self, t: f64, z: &[f64]) -> Row {
        let theta = self.omega * t + self.phi;
        z.iter().copied().chain([theta.cos(), theta.sin(), 1.0]).collect()
    }

    /// Counts a call of the right-hand side.
    pub fn count_call(&self) {
        self.calls.set(self.calls.get() + 1);
    }

    /// The forcing's frequency and phase.
    pub fn forcing(&self) -> (f64, f64) {
        (self.omega, self.phi)
    }

    /// The right-hand side.
    pub fn rates(&self, t: f64, z: &[f64]) -> Vec<f64> {
        self.count_call();
        let (sin, cos) = (self.omega * t + self.phi).sin_cos();
        let ModeWire { a, b, c, .. } = &self.wire;
        let rate =
            |((row, b), c): ((&Row, &[f64; 2]), &f64)| dot(row, z) + b[0] * cos + b[1] * sin + c;
        a.iter().zip(b).zip(c).map(rate).collect()
    }

    /// The Jacobian times a vector.
    pub fn jacobian(&self, v: &[f64]) -> Vec<f64> {
        self.wire.a.iter().map(|row| dot(row, v)).collect()
    }

    /// A state's rate as a row.
    pub fn row(&self, state: usize) -> Row {
        let ModeWire { a, b, c, .. } = &self.wire;
        [a[state].as_slice(), &b[state], &[c[state]]].concat()
    }

    /// The rate of a guard.
    pub fn guard_rate(&self, event: usize, t: f64, z: &[f64]) -> f64 {
        let (sin, cos) = (self.omega * t + self.phi).sin_cos();
        let turned = [-self.omega * sin, self.omega * cos, 0.0];
        dot(&self.wire.events[event].guard, &[self.rates(t, z).as_slice(), &turned].concat())
    }

    /// The state after an event.
    pub fn reset(&self, event: usize, t: f64, z: &[f64]) -> Vec<f64> {
        let wide = self.wide(t, z);
        let rows = |rows: &Vec<Row>| rows.iter().map(|row| dot(row, &wide)).collect();
        self.wire.events[event].reset.as_ref().map_or_else(|| z.to_vec(), rows)
    }

    /// The derivative of a guard by the state, times a vector.
    pub fn guard_slope(&self, event: usize, v: &[f64]) -> f64 {
        dot(&self.wire.events[event].guard, v)
    }

    /// The derivative of the state after an event by that before it, times a vector.
    pub fn reset_slope(&self, event: usize, v: &[f64]) -> Vec<f64> {
        let rows = |rows: &Vec<Row>| rows.iter().map(|row| dot(row, v)).collect();
        self.wire.events[event].reset.as_ref().map_or_else(|| v.to_vec(), rows)
    }

    /// The value of a guard.
    pub fn guard(&self, event: usize, t: f64, z: &[f64]) -> f64 {
        dot(&self.wire.events[event].guard, &self.wide(t, z))
    }

    /// The events, those that end the mode first.
    pub fn events(&self) -> &[Event] {
        &self.wire.events
    }
}

fn dot(row: &[f64], w: &[f64]) -> f64 {
    row.iter().zip(w).map(|(a, b)| a * b).sum()
}

/// A run as it is made.
pub struct Course {
    pub run: Run,
    modes: Vec<Rc<Mode>>,
    calls: Rc<Cell<u64>>,
    until: Instant,
    pub t: f64,
    mode: usize,
    pub z: Vec<f64>,
    events: Vec<Value>,
    sampled: Vec<Vec<f64>>,
    ended: Option<&'static str>,
    crowd: usize,
    pub steps: u64,
    /// The derivatives by each name that has them.
    pub derivatives: Vec<Value>,
}

/// A run that went beyond its limits.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct GaveUp(&'static str);

impl Course {
    fn new(mut run: Run) -> Self {
        let calls = Rc::new(Cell::new(0));
        let SystemWire { omega, phi, ref mut modes, .. } = run.system;
        let mode =
            |(place, wire)| Rc::new(Mode { place, wire, omega, phi, calls: Rc::clone(&calls) });
        let modes = std::mem::take(modes).into_iter().enumerate().map(mode).collect();
        let until = Instant::now() + Duration::from_secs_f64(run.limits.wall_s);
        let (mode, z) = (run.mode, run.state.clone());
        let mut course = Self {
            run,
            modes,
            calls,
            until,
            t: 0.0,
            mode,
            z: z.clone(),
            events: Vec::new(),
            sampled: Vec::new(),
            ended: None,
            crowd: 0,
            steps: 0,
            derivatives: Vec::new(),
        };
        while course.due(0.0).is_some() {
            course.sample(z.clone());
        }
        course
    }

    /// The mode of now.
    pub fn mode(&self) -> Rc<Mode> {
        Rc::clone(&self.modes[self.mode])
    }

    /// All modes, and the place of that of now among them.
    pub fn modes(&self) -> (Vec<Rc<Mode>>, usize) {
        (self.modes.clone(), self.mode)
    }

    /// Whether the run has not come to its end.
    pub fn goes_on(&self) -> bool {
        self.ended.is_none() && self.run.span - self.t > 2.0 * INSTANT_TOLERANCE * self.run.span
    }

    /// Counts a step, and ends a run that goes beyond its limits.
    pub fn step(&mut self) -> Result<(), Box<dyn Error>> {
        self.steps += 1;
        self.within_limits()
    }

    /// Ends a run that goes beyond its limits.
    pub fn within_limits(&self) -> Result<(), Box<dyn Error>> {
        if self.calls.get() > self.run.limits.calls {
            return Err(Box::new(GaveUp("too many calls")));
        }
        if Instant::now() > self.until {
            return Err(Box::new(GaveUp("the time is over")));
        }
        Ok(())
    }

    /// The next sample's time, if it is not after this.
    pub fn due(&self, until: f64) -> Option<f64> {
        self.run.samples.get(self.sampled.len()).copied().filter(|time| *time <= until)
    }

    /// The times of all samples that are still wanted.
    pub fn pending(&self) -> &[f64] {
        &self.run.samples[self.sampled.len()..]
    }

    /// Takes a sample.
    pub fn sample(&mut self, z: Vec<f64>) {
        self.sampled.push(z);
    }

    /// Reports an event at a time with the state there, and goes through it if it ends the mode.
    pub fn event(&mut self, t: f64, event: usize, z: Vec<f64>) -> Result<(), Box<dyn Error>> {
        if self.events.len() >= self.run.limits.events {
            return Err(Box::new(GaveUp("too many events")));
        }
        let mode = self.mode();
        let successors = &mode.events()[event].successors;
        self.crowd = if t - self.t <= INSTANT_TOLERANCE * t { self.crowd + 1 } else { 1 };
        self.t = t;
        if self.crowd > 100 * MAX_SIMULTANEOUS_EVENTS {
            return Err(format!("events at {t} are found again and again").into());
        }
        if successors.is_empty() {
            self.add(t, event, &z, &z);
            self.z = z;
            return Ok(());
        }
        if self.run.backward {
            self.z = z;
            self.ended = Some("leaves-domain");
            return Ok(());
        }
        let after = mode.reset(event, t, &z);
        let wide_after = mode.wide(t, &after);
        let holds =
            |it: &&Successor| it.when.as_ref().is_none_or(|row| dot(row, &wide_after) > 0.0);
        self.mode = successors.iter().find(holds).ok_or("no mode follows")?.mode;
        self.add(t, event, &z, &after);
        self.z = after;
        if self.crowd >= MAX_SIMULTANEOUS_EVENTS {
            self.ended = Some("no-progress");
        }
        Ok(())
    }

    /// Adds an event to the answer, with the states before and after its reset.
    fn add(&mut self, t: f64, event: usize, before: &[f64], after: &[f64]) {
        let mode = self.mode;
        self.events.push(
            json!({"time": t, "event": event, "mode": mode, "before": before, "state": after}),
        );
    }

    /// Takes over an event of a run that was made elsewhere.
    pub fn report(&mut self, passed: &Passed) {
        self.mode = passed.follows.place;
        self.add(passed.t, passed.event, &passed.before, &passed.after);
    }

    /// Takes over the end of a run that was made elsewhere, and all its samples.
    pub fn end(
        &mut self,
        samples: Vec<Vec<f64>>,
        ended: Option<&'static str>,
        t: f64,
        z: Vec<f64>,
    ) {
        (self.sampled, self.ended, self.t, self.z) = (samples, ended, t, z);
    }

    /// Takes over what a run has cost that was made elsewhere.
    pub fn count(&mut self, calls: u64, steps: u64) {
        self.calls.set(calls);
        self.steps = steps;
    }

    fn answer(mut self, took: Duration) -> Value {
        let ended = self.ended.unwrap_or("horizon");
        if self.ended.is_none() {
            self.t = self.run.span;
            self.sampled.resize(self.run.samples.len(), self.z.clone());
        }
        let mut answer = json!({"run": {
            "events": self.events, "samples": self.sampled, "end": self.z, "ended": ended,
            "ended_at": self.t, "work": {"rhs": self.calls.get(), "steps": self.steps},
            "own_ns": u64::try_from(took.as_nanos()).unwrap_or(u64::MAX),
        }});
        if !self.run.gradients.is_empty() {
            answer["run"]["gradients"] = Value::Array(self.derivatives);
        }
        answer
    }
}

/// Makes a run of a set-up.
pub type Make = fn(&mut Course) -> Result<(), Box<dyn Error>>;

fn made(run: Run, make: Make) -> Value {
    let mut course = Course::new(run);
    let began = Instant::now();
    match make(&mut course) {
        Ok(()) => course.answer(began.elapsed()),
        Err(why) if why.is::<GaveUp>() => json!({"gave_up": why.to_string()}),
        Err(why) => json!({"failure": why.to_string()}),
    }
}

/// What a program declares of a set-up.
#[derive(Clone, Copy)]
pub struct Setup {
    pub name: &'static str,
    pub method: &'static str,
    pub class: &'static str,
    pub order: Option<u32>,
    /// Whether it runs back in time.
    pub backward: bool,
    /// Whether it answers derivatives.
    pub gradients: bool,
}

/// Answers requests until there are no more.
pub fn serve(
    library: &str,
    version: &str,
    setups: &[Setup],
    make: Make,
) -> Result<(), Box<dyn Error>> {
    let setup = |it: &Setup| {
        json!({"name": it.name, "method": it.method, "class": it.class, "order": it.order,
            "events": "library", "dense_output": true, "stepping": "adaptive",
            "backward": it.backward, "gradients": it.gradients})
    };
    let setups: Vec<_> = setups.iter().map(setup).collect();
    let mut output = std::io::stdout();
    for line in std::io::stdin().lock().lines() {
        let request: Request = serde_json::from_str(&line?)?;
        let mut answer = match (request.ask.as_str(), request.run) {
            ("capabilities", _) => json!({"capabilities": {
                "library": library, "version": version, "language": "Rust", "setups": setups,
            }}),
            ("run", Some(run)) => made(run, make),
            _ => json!({"ready": true}),
        };
        answer["percuss_protocol"] = json!(1);
        answer["id"] = json!(request.id);
        writeln!(output, "{answer}")?;
        output.flush()?;
    }
    Ok(())
}
