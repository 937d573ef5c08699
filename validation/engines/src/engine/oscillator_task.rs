//! A run of the oscillator as the harness asks for it: by parameters, a start and forcing periods.

use crate::case::{Horizon, OscillatorCase, Problem};
use percuss::insides::angle;
use percuss::{Instant, Parameters, Phase, TwoWord};

/// Instants at which the state is compared: `k / per_period` forcing periods after the start.
#[derive(Clone, Copy, Debug)]
pub struct SampleGrid {
    /// The number of instants per forcing period.
    pub per_period: u32,
    /// The number of instants, the start included.
    pub count: usize,
}

/// A run of the oscillator to be made, in the oscillator's own words.
#[derive(Clone, Debug)]
pub struct OscillatorTask {
    /// The model's parameters.
    pub parameters: Parameters,
    /// The checked model and start.
    pub problem: Problem,
    /// The phase the start is in.
    pub phase: Phase,
    /// p, y, q and v at the start.
    pub state: [f64; 4],
    /// omega tau + phi at the start, reduced to a few turns: integrators run in the time elapsed
    /// since the start, so that a late start costs them no digits.
    pub forcing_angle: f64,
    /// The instant at which the run ends.
    pub horizon: Instant,
    /// Time from start to horizon.
    pub span: f64,
    /// The instants at which the state is compared.
    pub grid: SampleGrid,
    /// Events in the engine's life before this run: a fault may drop every hundredth event.
    pub events_before: u64,
}

impl OscillatorTask {
    /// The run that a case asks for.
    #[must_use]
    pub fn new(case: &OscillatorCase, grid: SampleGrid) -> Self {
        let (problem, parameters) = (case.problem, *case.parameters());
        let horizon = match case.horizon {
            Horizon::Periods(periods) => problem.entry.instant.after_periods(u64::from(periods), 1),
            Horizon::Until(tau) => Instant::at(parameters.omega, tau, 0),
        };
        Self::until(parameters, problem, horizon, grid)
    }

    /// A run from a start to a horizon.
    #[must_use]
    pub fn until(
        parameters: Parameters,
        problem: Problem,
        horizon: Instant,
        grid: SampleGrid,
    ) -> Self {
        let entry = problem.entry;
        let (_, phi) = angle::reduce(TwoWord::new(parameters.phi));
        Self {
            parameters,
            problem,
            phase: entry.phase(),
            state: [entry.state.p, entry.state.y, entry.state.q, entry.v()],
            forcing_angle: entry.instant.angle_two_word().plus(phi).value(),
            horizon,
            span: horizon.since(&entry.instant, parameters.omega).value(),
            grid,
            events_before: 0,
        }
    }

    /// The grid's instants, as times since the start.
    #[must_use]
    pub fn sample_times(&self) -> Vec<f64> {
        let start = self.problem.entry.instant;
        let instant = |k: usize| start.after_periods(k as u64, u64::from(self.grid.per_period));
        let since = |k: usize| instant(k).since(&start, self.parameters.omega).value();
        (0..self.grid.count).map(since).map(|time| time.min(self.span)).collect()
    }
}
