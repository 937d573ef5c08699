//! The growth of errors along the true run, from the truth's rows alone.
//!
//! In every phase (p, y, q, v, cos, sin, 1) obeys a linear system with constant coefficients, so
//! the derivative of a phase's flow is a matrix exponential: no closed form of the solver is used.
//! Through an event the flow's derivative is completed by the field times the gradient of the
//! event's time.
//!
//! G at event n, for one quantity: the largest, over m <= n and at least 1, of the norm of the
//! quantity's derivative with respect to the state just before event m (forcing angle, p, y, q, v;
//! m = 0 is the start). Samples at a fixed tau use the plain derivative.

use crate::score::{SCORED_ERROR, SCORED_FACTOR};
use crate::truth::{Truth, TruthRow};
use nalgebra::{SMatrix, SVector};
use percuss::TwoWord;
use percuss::{Parameters, Phase};

/// p, y, q, v, cos, sin and 1.
const SIZE: usize = 7;
const COS: usize = 4;
const SIN: usize = 5;
const ONE: usize = 6;
/// Forcing angle, p, y, q and v may be wrong.
const DIRECTIONS: usize = 5;

type Linear = SMatrix<f64, SIZE, SIZE>;
type GrowthPoint = SVector<f64, SIZE>;
type Bundle = SMatrix<f64, SIZE, DIRECTIONS>;
type EventTimes = SMatrix<f64, 1, DIRECTIONS>;

/// The growth at every event and sample, at least 1.
#[derive(Clone, Debug)]
pub struct RunGrowth {
    /// The growth at each event: of tau, p, y, q and v.
    pub events: Vec<[f64; 5]>,
    /// The growth at each sample: of p, y, q and v.
    pub samples: Vec<[f64; 4]>,
    /// The growth at the horizon: of p, y, q and v.
    pub end: [f64; 4],
}

/// Perturbations that began just before one of the events: what they have become.
#[derive(Clone, Copy)]
struct Descent {
    state: Bundle,
    times: EventTimes,
}

struct GrowthMotion {
    omega: f64,
    angle: f64,
    parameters: Parameters,
}

impl RunGrowth {
    /// Follows the truth's rows; `angle` is omega tau + phi at the start.
    #[must_use]
    pub fn along(truth: &Truth, parameters: &Parameters, angle: f64) -> Self {
        let motion = GrowthMotion { omega: parameters.omega, angle, parameters: *parameters };
        let mut growth = Self { events: Vec::new(), samples: Vec::new(), end: [1.0; 4] };
        let mut descents =
            vec![Descent { state: motion.directions(&truth.start), times: EventTimes::zeros() }];
        let mut begin = truth.start;
        for next in truth.events.iter().chain([&truth.end]) {
            let Some(phase) = begin.phase else { break };
            let linear = motion.linear(phase);
            let samples = &truth.samples[growth.samples.len()..];
            let inside = |row: &&TruthRow| {
                next.phase.is_none() || row.elapsed.minus(next.elapsed).value() < 0.0
            };
            for sample in samples.iter().take_while(inside) {
                growth.samples.push(motion.plain(&linear, &descents, &begin, sample));
            }
            if next.phase.is_none() {
                growth.end = motion.plain(&linear, &descents, &begin, next);
                break;
            }
            motion.after_event(phase, &linear, &mut descents, &begin, next);
            growth.events.push(largest(&descents, |it| {
                let row = |i: usize| it.state.row(i).norm();
                [it.times.norm(), row(0), row(1), row(2), row(3)]
            }));
            begin = *next;
        }
        growth
    }

    /// The first sample that is no longer scored for an engine with this unit of error.
    #[must_use]
    pub fn scored_samples(&self, unit: f64) -> usize {
        let passes = |growth: &[f64; 4]| {
            let size = growth[..3].iter().fold(1.0_f64, |a, b| a.max(*b));
            SCORED_FACTOR * unit * size > SCORED_ERROR
        };
        self.samples.iter().position(passes).unwrap_or(self.samples.len())
    }
}

impl GrowthMotion {
    fn linear(&self, phase: Phase) -> Linear {
        let Parameters { a, b, xi, omega, .. } = self.parameters;
        let rate = 1.0 / (2.0 * xi);
        let mut m = Linear::zeros();
        (m[(COS, SIN)], m[(SIN, COS)]) = (-omega, omega);
        (m[(1, COS)], m[(1, ONE)]) = (a, b);
        match phase {
            Phase::NoContact => {
                m[(0, 1)] = 1.0;
                m[(2, 2)] = -rate;
            }
            Phase::Contact => {
                (m[(0, 1)], m[(2, 1)]) = (1.0, 1.0);
                (m[(1, 1)], m[(1, 2)]) = (-2.0 * xi, -1.0);
            }
            Phase::Progression => {
                (m[(0, 2)], m[(0, ONE)]) = (-rate, rate);
                (m[(2, 2)], m[(2, ONE)]) = (-rate, rate);
                m[(1, ONE)] = b - 1.0;
                (m[(3, 1)], m[(3, 2)], m[(3, ONE)]) = (1.0, rate, -rate);
            }
        }
        m
    }

    fn guard(&self, phase: Phase) -> SMatrix<f64, 1, SIZE> {
        let mut guard = SMatrix::<f64, 1, SIZE>::zeros();
        match phase {
            Phase::NoContact => (guard[0], guard[2]) = (1.0, -1.0),
            Phase::Contact | Phase::Progression => {
                (guard[1], guard[2]) = (2.0 * self.parameters.xi, 1.0)
            }
        }
        guard
    }

    fn point(&self, row: &TruthRow) -> GrowthPoint {
        let [p, y, q, v] = row.rounded();
        let (sin, cos) = (self.omega * row.elapsed.value() + self.angle).sin_cos();
        GrowthPoint::from([p, y, q, v, cos, sin, 1.0])
    }

    /// Unit errors of the forcing angle and of each co-ordinate.
    fn directions(&self, row: &TruthRow) -> Bundle {
        let point = self.point(row);
        let mut bundle = Bundle::zeros();
        (bundle[(COS, 0)], bundle[(SIN, 0)]) = (-point[SIN], point[COS]);
        for i in 0..4 {
            bundle[(i, i + 1)] = 1.0;
        }
        bundle
    }

    fn after_event(
        &self,
        phase: Phase,
        linear: &Linear,
        descents: &mut Vec<Descent>,
        begin: &TruthRow,
        next: &TruthRow,
    ) {
        let flow = flow(linear, next.elapsed.minus(begin.elapsed));
        let field = linear * self.point(next);
        let guard = self.guard(phase);
        let rate = (guard * field)[0];
        for descent in &mut *descents {
            descent.state = flow * descent.state;
        }
        descents.push(Descent { state: self.directions(next), times: EventTimes::zeros() });
        for descent in descents {
            let delay = -(guard * descent.state) / rate;
            descent.state += field * delay;
            descent.times += delay;
        }
    }

    /// The growth at a fixed tau inside a phase.
    fn plain(
        &self,
        linear: &Linear,
        descents: &[Descent],
        begin: &TruthRow,
        at: &TruthRow,
    ) -> [f64; 4] {
        let flow = flow(linear, at.elapsed.minus(begin.elapsed));
        let field = linear * self.point(at);
        largest(descents, |descent| {
            let state = flow * descent.state - field * descent.times;
            [0, 1, 2, 3].map(|i| state.row(i).norm())
        })
    }
}

fn flow(linear: &Linear, time: TwoWord) -> Linear {
    (linear * time.value()).exp()
}

fn largest<const N: usize>(descents: &[Descent], norms: impl Fn(&Descent) -> [f64; N]) -> [f64; N] {
    descents.iter().map(norms).fold([1.0; N], |mut largest, norms| {
        for (size, norm) in largest.iter_mut().zip(norms) {
            *size = size.max(norm);
        }
        largest
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Case, Given, embedded};
    use crate::truth::Library;
    use percuss::{Exit, Start};

    /// tau, p, y, q and v of the exact solver's first events from a start.
    fn events(case: &Case, start: Start) -> Vec<[f64; 5]> {
        let given = Given { parameters: case.parameters, start, ..Given::default() };
        let Ok(problem) = given.check() else { return Vec::new() };
        let begin = problem.entry.instant;
        let rows =
            problem.model.trajectory(problem.entry).map_while(|segment| match segment.exit() {
                Exit::Switch(next) => {
                    let elapsed = next.instant.since(&begin, case.parameters.omega).value();
                    Some([elapsed, next.state.p, next.state.y, next.state.q, next.v()])
                }
                _ => None,
            });
        rows.take(EVENTS).collect()
    }

    const EVENTS: usize = 5;
    /// Central differences of values known to about 1e-15 with this step are good to 1e-8.
    const STEP: f64 = 1e-6;
    const DIFFERENCE: f64 = 1e-4;

    /// The derivatives of an event with respect to the start's p and y are what finite differences
    /// of the exact solver say. (The start lies in flight: both may vary freely.)
    #[test]
    fn derivatives_through_events_agree_with_differences() {
        let cases = embedded().unwrap_or_default();
        let library = Library::embedded().ok();
        for name in ["stiff-xi-0-3", "over-damped-xi-1-5", "impact-into-progression"] {
            let case = cases.iter().find(|case| case.name == name);
            let truth = case.and_then(|case| library.as_ref()?.truth(case).ok());
            let (Some(case), Some(truth)) = (case, truth) else {
                unreachable!("{name} is embedded")
            };
            let parameters = case.parameters;
            let angle = parameters.omega * case.start.tau + parameters.phi;
            let motion = GrowthMotion { omega: parameters.omega, angle, parameters };
            let mut descents = vec![Descent {
                state: motion.directions(&truth.start),
                times: EventTimes::zeros(),
            }];
            let mut begin = truth.start;
            let p = |step: f64| events(case, Start { p: case.start.p + step, ..case.start });
            let y = |step: f64| events(case, Start { y: case.start.y + step, ..case.start });
            let (by_p, by_y) = ([p(STEP), p(-STEP)], [y(STEP), y(-STEP)]);
            for n in 0..EVENTS {
                let phase = begin.phase.unwrap_or(Phase::Contact);
                motion.after_event(
                    phase,
                    &motion.linear(phase),
                    &mut descents,
                    &begin,
                    &truth.events[n],
                );
                begin = truth.events[n];
                for (direction, [plus, minus]) in [(1, &by_p), (2, &by_y)] {
                    let descent = &descents[0];
                    let ours = [
                        descent.times[direction],
                        descent.state[(0, direction)],
                        descent.state[(1, direction)],
                    ];
                    for (i, ours) in ours.into_iter().enumerate() {
                        let difference = (plus[n][i] - minus[n][i]) / (2.0 * STEP);
                        approx::assert_relative_eq!(
                            ours,
                            difference,
                            epsilon = DIFFERENCE,
                            max_relative = DIFFERENCE
                        );
                    }
                }
            }
        }
    }
}
