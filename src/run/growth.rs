//! How much a run amplifies an error made at, or before, any of its switches.
//!
//! An accuracy bound at switch n reads |error| <= k eps (1 + |value|) G_n n. Here G_n is the
//! largest, over m <= n and at least 1, of the Euclidean norm of D(m, n): the gradient of the
//! compared quantity at switch n with respect to the state just before switch m (m = 0 is the
//! start). The start alone would not do: on a stable orbit its influence dies out while every step
//! still rounds.

use crate::run::trajectory::Segment;
use crate::run::variation::{IDENTITY, Matrix, P, Q, SwitchDerivative, V, Y, product, times};

/// How much a unit error made earlier in the run has grown, in tau, p, y, q and v, at one event or
/// sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Growth {
    /// The growth of errors of the event's time; 1 for a sample.
    pub tau: f64,
    /// The growth of errors of p, y and q.
    pub state: [f64; 3],
    /// The growth of errors of the drift.
    pub v: f64,
}

impl Growth {
    const NONE: Self = Self { tau: 1.0, state: [1.0; 3], v: 1.0 };

    fn raise(&mut self, derivative: &Matrix) {
        for (growth, row) in self.state.iter_mut().zip([P, Y, Q]) {
            *growth = growth.max(norm(&derivative[row]));
        }
        self.v = self.v.max(norm(&derivative[V]));
    }
}

/// Collects the growth along a run. Its memory and the cost of a switch grow with the number of
/// switches: it is for scoring, not for running.
#[derive(Clone, Debug)]
pub struct GrowthRecorder {
    /// Derivatives of the state at the start of the current phase by the states at which errors
    /// entered.
    sources: Vec<Matrix>,
}

impl Default for GrowthRecorder {
    fn default() -> Self {
        Self::new()
    }
}

impl GrowthRecorder {
    /// A recorder for a run that has not begun.
    #[must_use]
    pub fn new() -> Self {
        Self { sources: vec![IDENTITY] }
    }

    /// Passes a phase; gives the growth at the switch that ends it, none if no switch does.
    pub fn pass(&mut self, segment: &Segment) -> Option<Growth> {
        let SwitchDerivative { time, state } = segment.switch_derivative()?;
        let flow = segment.variation(segment.duration());
        let saltation = segment.saltation();
        let mut growth = Growth::NONE;
        for source in &mut self.sources {
            *source = product(&flow, source);
        }
        self.sources.push(IDENTITY);
        for source in &mut self.sources {
            growth.tau = growth.tau.max(norm(&times(&time, source)));
            growth.raise(&product(&state, source));
            *source = product(&saltation, source);
        }
        Some(growth)
    }

    /// The growth of a sample at fixed time, `elapsed` into the phase that the run is in.
    #[must_use]
    pub fn at(&self, segment: &Segment, elapsed: f64) -> Growth {
        let flow = segment.variation(elapsed);
        let mut growth = Growth::NONE;
        for source in &self.sources {
            growth.raise(&product(&flow, source));
        }
        growth
    }
}

fn norm(gradient: &[f64; 5]) -> f64 {
    gradient.iter().map(|slope| slope * slope).sum::<f64>().sqrt()
}
