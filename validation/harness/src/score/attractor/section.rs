//! What a run visits: its stroboscopic section, phase sequences, drift and exponent; and how far
//! its periods are from the exact map's.

use crate::case::{Given, Problem};
use crate::engine::{Event, Failure, OscillatorTask, Outcome, SampleGrid};
use percuss::dynamics::linear::apply;
use percuss::dynamics::strobe::{Passage, StrobeMap};
use percuss::{Parameters, Phase, Start};
use std::collections::BTreeMap;

/// The section of a run after its transient.
#[derive(Clone, Debug, Default)]
pub struct RunSection {
    /// p, y and q at successive strobes.
    pub points: Vec<[f64; 3]>,
    /// The frequency of each sequence of phases that begin within a forcing period.
    pub phase_sequences: BTreeMap<String, f64>,
    /// Mean drift per forcing period.
    pub drift: f64,
    /// Mean growth of a small error per forcing period, in the exact map's derivative along these
    /// points.
    pub lyapunov: f64,
    /// How far each strobe is from the exact map's image of the strobe before it: the largest of
    /// the differences in p, y and q, each divided by 1 + |value|. Infinite where that has no
    /// image.
    pub map_errors: Vec<f64>,
    /// The series whose distributions are compared, each in rising order.
    pub(super) sorted: [Vec<f64>; SERIES],
}

/// The task of a long run: a state at every strobe, nothing in between.
#[must_use]
pub fn run_of(parameters: Parameters, start: Start, periods: u32) -> Option<OscillatorTask> {
    let problem = Given { parameters, start, ..Given::default() }.check().ok()?;
    let Problem { entry, .. } = problem;
    let horizon = entry.instant.after_periods(u64::from(periods), 1);
    let grid = SampleGrid { per_period: 1, count: periods as usize + 1 };
    Some(OscillatorTask::until(parameters, problem, horizon, grid))
}

impl RunSection {
    /// The section of a run of [`run_of`], without its first `transient` periods.
    ///
    /// # Errors
    /// A run that lacks samples or holds a number that is not finite.
    pub fn new(task: &OscillatorTask, outcome: &Outcome, transient: u32) -> Result<Self, Failure> {
        Self::judged(task, outcome, transient, &task.problem)
    }

    /// The section as [`RunSection::new`] makes it, with the exact map of another problem: the one
    /// that the run should have solved.
    pub(super) fn judged(
        task: &OscillatorTask,
        outcome: &Outcome,
        transient: u32,
        truth: &Problem,
    ) -> Result<Self, Failure> {
        let states = outcome.samples.get(transient as usize..).unwrap_or_default();
        let finite = states.iter().flat_map(|it| it.iter()).all(|value| value.is_finite());
        if states.len() + transient as usize != task.grid.count || states.len() < 3 || !finite {
            return Err(Failure::new("its section is not complete"));
        }
        let points: Vec<_> = states.iter().map(|it| [it[0], it[1], it[2]]).collect();
        let periods = (points.len() - 1) as f64;
        let drift = (states[states.len() - 1][3] - states[0][3]) / periods;
        let period = task.problem.model.period();
        let phase_sequences = phase_sequences(&outcome.events, period, transient, points.len() - 1);
        let (lyapunov, map_errors) = exponent_and_map_errors(truth, &points);
        let sorted = series(&points).map(|mut values| {
            values.sort_by(f64::total_cmp);
            values
        });
        Ok(Self { points, phase_sequences, drift, lyapunov, map_errors, sorted })
    }
}

/// Number of series that both one-dimensional distances are taken of.
pub(super) const SERIES: usize = 7;

/// p, y and q at the strobes, and sums and differences of successive p and y.
fn series(points: &[[f64; 3]]) -> [Vec<f64>; SERIES] {
    let of = |i: usize| points.iter().map(|point| point[i]).collect();
    let pairs = |i: usize, sign: f64| {
        points.windows(2).map(|pair| pair[1][i] + sign * pair[0][i]).collect()
    };
    [of(0), of(1), of(2), pairs(0, 1.0), pairs(0, -1.0), pairs(1, 1.0), pairs(1, -1.0)]
}

/// Shares of the sequences of phases that begin within one period.
fn phase_sequences(
    events: &[Event],
    period: f64,
    transient: u32,
    periods: usize,
) -> BTreeMap<String, f64> {
    let mut spelled = vec![String::new(); periods];
    for event in events {
        let number = event.elapsed / period - f64::from(transient);
        if let Some(sequence) = (number >= 0.0).then(|| spelled.get_mut(number as usize)).flatten()
        {
            sequence.push(match Phase::ALL[event.mode] {
                Phase::NoContact => 'n',
                Phase::Contact => 'c',
                Phase::Progression => 'p',
            });
        }
    }
    let mut frequencies = BTreeMap::new();
    for sequence in spelled {
        *frequencies.entry(sequence).or_insert(0.0) += 1.0 / periods as f64;
    }
    frequencies
}

/// The largest exponent per period, by the exact strobe map's derivative point by point along the
/// section, and how far each point is from the map's image of the one before.
fn exponent_and_map_errors(truth: &Problem, points: &[[f64; 3]]) -> (f64, Vec<f64>) {
    let mut direction = [0.6, 0.48, 0.64];
    let (mut sum, mut counted) = (0.0, 0_u32);
    let mut errors = Vec::with_capacity(points.len());
    let map = StrobeMap::new(truth.model, truth.entry.instant);
    let g = truth.model.parameters().g;
    for (k, &[p, y, q]) in points.iter().enumerate() {
        let passage = map.entry([p.min(q + g), y, q]).map(|entry| map.passage(&entry, 1));
        if let Some(next) = points.get(k + 1) {
            let image = passage.as_ref().map(Passage::point);
            errors.push(image.map_or(f64::INFINITY, |image| relative_distance(next, &image)));
        }
        let Ok(passage) = passage else { continue };
        let image = apply(&passage.jacobian(), &direction);
        let size = image.iter().map(|x| x * x).sum::<f64>().sqrt();
        if size > 0.0 && size.is_finite() {
            sum += size.ln();
            counted += 1;
            direction = image.map(|x| x / size);
        }
    }
    (sum / f64::from(counted), errors)
}

/// The largest difference of two points' co-ordinates, each divided by 1 + |value|.
fn relative_distance(found: &[f64; 3], image: &[f64; 3]) -> f64 {
    let differences = found.iter().zip(image).map(|(a, b)| (a - b).abs() / (1.0 + b.abs()));
    differences.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::place;
    use crate::system::Values;
    use std::f64::consts::PI;

    /// An event belongs to the period in which it lies; one at the section's first strobe begins
    /// the first sequence, and one before it belongs to none.
    #[test]
    fn sequences_are_spelled_by_the_events_of_each_period() {
        let event = |elapsed: f64, phase| Event {
            event: 0,
            mode: place(phase),
            elapsed,
            state: Values::default(),
            before: None,
        };
        let events = [
            event(3.9, Phase::Progression),
            event(4.0, Phase::Contact),
            event(5.9, Phase::NoContact),
            event(6.0, Phase::Contact),
            event(7.0, Phase::Progression),
            event(10.5, Phase::NoContact),
            event(12.0, Phase::Contact),
        ];
        let frequencies = phase_sequences(&events, 2.0, 2, 4);
        let expected = [("", 0.25), ("cn", 0.25), ("cp", 0.25), ("n", 0.25)];
        let expected = expected.map(|(sequence, share)| (sequence.to_owned(), share));
        assert_eq!(frequencies, BTreeMap::from(expected));
    }

    #[test]
    fn differences_count_against_one_and_the_size_of_the_image() {
        assert_eq!(relative_distance(&[0.5, 0.0, 0.0], &[0.0, 0.0, 0.0]), 0.5);
        assert_eq!(relative_distance(&[0.0, -4.0, 0.0], &[0.0, -3.0, 0.0]), 0.25);
        assert_eq!(relative_distance(&[1.0, 1.0, 9.0], &[1.0, 1.0, 4.0]), 1.0);
    }

    /// Over a thousand decay times of the contact all that an impact has left of an error dies out
    /// below the smallest number: of a period that ends so nothing can be said. Of an error in a
    /// contact the part dp - dq stays.
    #[test]
    fn a_period_in_which_an_error_dies_out_does_not_count() {
        let parameters =
            Parameters { xi: 0.5, omega: PI / 1e3, a: 0.05, b: 0.5, ..Parameters::default() };
        let Ok(problem) = (Given { parameters, ..Given::default() }).check() else {
            unreachable!("the parameters are in range")
        };
        let (falling, resting) = ([-0.1, 0.0, 0.0], [0.5 + parameters.g, 0.0, 0.5]);
        let (lyapunov, errors) = exponent_and_map_errors(&problem, &[falling, resting]);
        // From the direction that the first period has not turned: 0.6 - 0.64.
        assert!((lyapunov - 0.04_f64.ln()).abs() <= 1e-14, "{lyapunov}");
        assert_eq!(errors.len(), 1);
        assert!(exponent_and_map_errors(&problem, &[falling]).0.is_nan());
    }
}
