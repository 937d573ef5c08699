//! Heun's method with fixed steps, scored on its switches as the engines of the suite are.
//!
//! `cargo run --release -p percuss-validation --example engine`

use percuss::Phase;
use percuss_validation::case::{defaults, embedded};
use percuss_validation::engine::{
    Accuracy, Declaration, Engine, Equations, Event, Failure, Limits, Location, Oscillator,
    Outcome, Stepping, Task, Work, exact, shortest_time,
};
use percuss_validation::report::{Evidence, Report, screen};
use percuss_validation::suite::{Suite, prepare, run};
use percuss_validation::truth::Library;

/// Heun's method: a step of Euler, then one by the trapezoidal rule.
struct Heun;

impl Engine for Heun {
    fn declaration(&self) -> Declaration {
        Declaration {
            name: "heun",
            library: "an example",
            version: "1.0.0".to_owned(),
            method: "Heun, fixed steps",
            events: Location::Harness,
            dense_output: false,
            stepping: Stepping::Fixed { order: 2 },
        }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let step = accuracy.step().ok_or_else(|| Failure::new("needs a step"))?;
        let step = step * shortest_time(&task.parameters);
        let mut walk = Walk {
            equations: Oscillator::of(&task.parameters, task.forcing_angle),
            work: Work::default(),
        };
        let times = task.sample_times();
        let mut outcome = Outcome { samples: vec![task.state], ..Outcome::default() };
        let (mut t, mut phase, mut state) = (0.0, task.phase, task.state);
        while t < task.span {
            if walk.work.rhs_evaluations > limits.calls {
                return Err(Failure::new("gave up"));
            }
            let whole = step.min(task.span - t);
            let found = walk.guard_that_rises(phase, t, &state, whole);
            let length = found.map_or(whole, |guard| walk.locate(phase, t, &state, whole, guard));
            while let Some(time) = times.get(outcome.samples.len()).filter(|it| **it <= t + length)
            {
                outcome.samples.push(walk.step(phase, t, &state, time - t));
            }
            state = walk.step(phase, t, &state, length);
            t = if length < task.span - t { t + length } else { task.span };
            walk.work.steps += 1;
            if let Some(guard) = found {
                (phase, state) = walk.equations.switch(phase, guard, &state);
                outcome.events.push(Event { phase, elapsed: t, state });
            }
        }
        (outcome.end, outcome.work) = (state, walk.work);
        Ok(outcome)
    }
}

/// The equations, and what was counted.
struct Walk {
    equations: Oscillator,
    work: Work,
}

impl Walk {
    fn step(&mut self, phase: Phase, t: f64, state: &[f64; 4], length: f64) -> [f64; 4] {
        let (mut here, mut there) = ([0.0; 4], [0.0; 4]);
        self.equations.derivatives(phase, t, state, &mut here);
        let euler: [f64; 4] = std::array::from_fn(|k| state[k] + length * here[k]);
        self.equations.derivatives(phase, t + length, &euler, &mut there);
        self.work.rhs_evaluations += 2;
        std::array::from_fn(|k| state[k] + 0.5 * length * (here[k] + there[k]))
    }

    /// A guard that is positive after a step, and not on its way back: separation begins with a double
    /// zero of the gap, which rounding turns into a crossing in either direction.
    fn guard_that_rises(
        &mut self,
        phase: Phase,
        t: f64,
        state: &[f64; 4],
        length: f64,
    ) -> Option<usize> {
        let after = self.step(phase, t, state, length);
        let guards = self.equations.guards(phase, &after);
        let rates = self.equations.rates(phase, t + length, &after);
        (0..guards.len()).find(|k| guards[*k] > 0.0 && rates[*k] > 0.0)
    }

    /// The length of the step that ends where the guard is zero, by bisection.
    fn locate(&mut self, phase: Phase, t: f64, state: &[f64; 4], whole: f64, guard: usize) -> f64 {
        let (mut inside, mut outside) = (0.0, whole);
        for _ in 0..52 {
            let middle = 0.5 * (inside + outside);
            if self.guard_that_rises(phase, t, state, middle) == Some(guard) {
                outside = middle;
            } else {
                inside = middle;
            }
        }
        outside
    }
}

/// The method beside the exact solver on two cases, held to the bounds of every engine.
pub fn scored() -> anyhow::Result<String> {
    const CASES: [&str; 2] = ["impact-into-progression", "stiff-xi-0-3"];
    let chosen =
        embedded()?.into_iter().filter(|case| CASES.contains(&case.name.as_str())).collect();
    let cases = prepare(chosen, &Library::embedded()?, Suite::Quick)?;
    let engines: [&'static dyn Engine; 2] = [exact(), &Heun];
    let rows = run(&cases, &engines, Suite::Quick, &defaults()?, &|| ());
    let declarations: Vec<_> = engines.iter().map(|engine| engine.declaration()).collect();
    let report = Report::new(Suite::Quick, &declarations, &rows);
    let evidence = Evidence::gather(&cases, &rows, &[], true);
    Ok(screen(&report, &evidence, true))
}

fn main() -> anyhow::Result<()> {
    print!("{}", scored()?);
    Ok(())
}
