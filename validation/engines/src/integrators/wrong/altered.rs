//! The exact solver on a model that is slightly different, or with a drift that is.

use crate::accuracy::Accuracy;
use crate::case::Problem;
use crate::engine::{Declaration, Engine, Limits, OscillatorTask, Outcome, Role, Task, answer};
use crate::failure::Failure;
use crate::integrators::exact::Exact;
use percuss::{Exit, Model, Parameters, Phase, Segment, Start};

/// The difference from the exact solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Alteration {
    /// omega + 0.002
    Frequency,
    /// 1.01 xi
    Damping,
    /// Eq. (20) as printed.
    Drift,
    /// The start's time in one word.
    Clock,
}

pub(super) struct Altered {
    pub(super) name: &'static str,
    pub(super) change: Alteration,
}

impl Engine for Altered {
    fn declaration(&self) -> Declaration {
        let method = "wrong on purpose";
        Declaration { name: self.name, method, role: Role::Rows, ..Exact.declaration() }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        if self.change == Alteration::Drift {
            return drifting(task, limits);
        }
        let task = task.of_the_oscillator()?;
        let (parameters, start) = self.altered(task);
        let refused = |error| Failure::new(format!("the altered problem: {error}"));
        let model = Model::new(parameters).map_err(refused)?;
        let entry = model.start(&start).map_err(refused)?;
        let mut other = task.clone();
        other.parameters = parameters;
        other.problem = Problem { model, start, entry };
        // The same number of forcing periods: the sample stays the one that is compared.
        let (whole, part) = periods(task);
        other.horizon = entry.instant.after_periods(whole, 1).after_periods(part, PARTS_PER_PERIOD);
        Exact.run(&Task::of_oscillator(&other)?, accuracy, limits)
    }
}

impl Altered {
    fn altered(&self, task: &OscillatorTask) -> (Parameters, Start) {
        let (parameters, start) = (task.parameters, exact_start(task));
        match self.change {
            Alteration::Frequency => {
                (Parameters { omega: parameters.omega + 0.002, ..parameters }, start)
            }
            Alteration::Damping => (Parameters { xi: 1.01 * parameters.xi, ..parameters }, start),
            Alteration::Drift => (parameters, start),
            Alteration::Clock => {
                let tau = task.problem.entry.instant.tau(parameters.omega);
                (parameters, Start { tau, cycle: 0, ..start })
            }
        }
    }
}

/// The start with the state that the task begins with: on the surface the phase is stated, because
/// a changed damping changes the trial force.
fn exact_start(task: &OscillatorTask) -> Start {
    let [p, y, q, v] = task.state;
    let phase = (task.phase != Phase::NoContact).then_some(task.phase);
    Start { p, y, q: Some(q), v, phase, ..task.problem.start }
}

const PARTS_PER_PERIOD: u64 = 1 << 32;

fn periods(task: &OscillatorTask) -> (u64, u64) {
    let periods = task.span / task.problem.model.period();
    (periods.floor() as u64, (periods.fract() * PARTS_PER_PERIOD as f64).round() as u64)
}

/// The right motion with the drift of Eq. (20) as printed: at the start of each progression v jumps
/// by 2 (q0 - 1), of which 2 (q0 - 1) exp(-d/(2 xi)) is left after d.
fn drifting(asked: &Task, limits: &Limits) -> Result<Outcome, Failure> {
    let task = asked.of_the_oscillator()?;
    let mut outcome = answer(&Exact, asked, Accuracy::Exact, limits)?;
    let start = task.problem.entry.instant;
    let omega = task.parameters.omega;
    let times = task.sample_times();
    let (mut offset, mut event, mut sample) = (0.0, 0, 0);
    let mut begin = 0.0;
    for segment in task.problem.model.trajectory(task.problem.entry).until(task.horizon) {
        let end = match segment.exit() {
            Exit::Switch(next) => next.instant.since(&start, omega).value(),
            _ => task.span,
        };
        while sample < outcome.samples.len() && times[sample] < end {
            outcome.samples[sample][3] += offset + left_over(task, &segment, times[sample] - begin);
            sample += 1;
        }
        offset += left_over(task, &segment, end - begin);
        begin = end;
        if let Some(found) = outcome.events.get_mut(event) {
            found.state[3] += offset;
            event += 1;
        }
    }
    for late in &mut outcome.samples[sample..] {
        late[3] += offset;
    }
    outcome.end[3] += offset;
    Ok(outcome)
}

fn left_over(task: &OscillatorTask, segment: &Segment, elapsed: f64) -> f64 {
    if segment.phase() != Phase::Progression {
        return 0.0;
    }
    2.0 * (segment.entry().state.q - 1.0) * (-elapsed / (2.0 * task.parameters.xi)).exp()
}
