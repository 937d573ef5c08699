//! A run of the oscillator as one of the system `percussive-oscillator`, with exact coefficients.

use super::systems::named;
use super::{Case, FileError, Horizon, OscillatorCase, ProbedCase, Problem, Regime};
use percuss::affine::{Rational, StartPoint, System, SystemFile};
use percuss::{Entry, Instant, Parameters, Phase};

/// The system's name, which is that of its file.
const NAME: &str = "percussive-oscillator";

/// The rule of starts: within four units in the last place a state is on the surface or on a
/// threshold, and is then put there exactly.
const FOUR_ULPS: f64 = 4.0 * f64::EPSILON;

/// Instants per forcing period at which the state is tabulated.
pub const SAMPLES_PER_PERIOD: u32 = 8;

impl Case {
    /// A case of a run of the oscillator, without a name or a file.
    ///
    /// # Errors
    /// Numbers that the system's file does not accept.
    pub fn of_run(problem: Problem, horizon: Horizon) -> Result<Self, FileError> {
        let period = problem.model.period();
        let span = match horizon {
            Horizon::Periods(periods) => f64::from(periods) * period,
            Horizon::Until(tau) => {
                let omega = problem.model.parameters().omega;
                Instant::at(omega, tau, 0).since(&problem.entry.instant, omega).value()
            }
        };
        let samples = (span / period * f64::from(SAMPLES_PER_PERIOD)).floor() + 1.0;
        let (regime, margin, probed) = (Regime::Other(String::new()), None, ProbedCase::default());
        Ok(Self {
            name: String::new(),
            file: String::new(),
            text: String::new(),
            why: String::new(),
            trouble: Vec::new(),
            system: percussive_oscillator(&problem)?,
            until: problem.start.tau + span,
            backward: false,
            samples: samples as u32,
            oscillator: Some(OscillatorCase { regime, margin, problem, horizon, probed }),
            bounds: Vec::new(),
            shortcomings: Vec::new(),
        })
    }
}

/// The system with a problem's parameters and start. The clock shows tau at the start: whole
/// forcing cycles before it change nothing.
///
/// # Errors
/// Numbers that the system's file does not accept.
pub fn percussive_oscillator(problem: &Problem) -> Result<System, FileError> {
    let text = named(NAME).unwrap_or_default();
    let refused = |error: percuss::affine::SystemError| FileError(error.to_string());
    let mut file =
        SystemFile::read(&format!("systems/{NAME}.system.toml"), text).map_err(refused)?;
    let Parameters { a, b, xi, omega, g, phi } = *problem.model.parameters();
    let parameters =
        [("a", a), ("b", b), ("xi", xi), ("frequency", omega), ("g", g), ("phase", phi)];
    for (name, value) in parameters {
        file.set(name, value, name).map_err(refused)?;
    }
    let start = start(problem).ok_or_else(|| FileError::new(NAME, "the start is not finite"))?;
    let mut system = file.system().map_err(refused)?;
    system.start = Some(start);
    Ok(system)
}

/// The place of a phase among the oscillator's modes, which are in the order of [`Phase::ALL`].
#[must_use]
pub const fn place(phase: Phase) -> usize {
    phase as usize
}

fn start(problem: &Problem) -> Option<StartPoint> {
    let number = |value: f64| Rational::try_from(value).ok();
    let entry = &problem.entry;
    let [p, q] = surface(entry, problem.model.parameters())?;
    let states = [p, number(entry.state.y)?, q, number(entry.v())?];
    let state = states.map(|it| [Rational::ZERO, Rational::ZERO, it]).to_vec();
    Some(StartPoint { mode: place(entry.phase()), time: number(problem.start.tau)?, state })
}

/// The exact p and q of a start: where it lies on the surface, and where its trial force lies on a
/// threshold, rounding has put them beside it.
fn surface(entry: &Entry, parameters: &Parameters) -> Option<[Rational; 2]> {
    let number = |value: f64| Rational::try_from(value).ok();
    let (p, y, q) = (number(entry.state.p)?, number(entry.state.y)?, number(entry.state.q)?);
    let (g, two_xi) = (number(parameters.g)?, number(2.0 * parameters.xi)?);
    let near = |value: &Rational, sizes: &[&Rational]| {
        let largest = sizes.iter().map(|it| it.abs().to_f64()).fold(0.0, f64::max);
        value.abs().to_f64() <= FOUR_ULPS * largest
    };
    if entry.phase() == Phase::NoContact && !near(&(&(&p - &q) - &g), &[&p, &q, &g]) {
        return Some([p, q]);
    }
    let damper = &two_xi * &y;
    let force = &damper + &q;
    let one = Rational::from(1);
    let q = if near(&force, &[&damper, &q]) {
        -damper
    } else if near(&(&force - &one), &[&damper, &q, &one]) {
        one - damper
    } else {
        q
    };
    Some([&q + &g, q])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{OscillatorCase, embedded};
    use percuss::affine::Solver;

    /// The general solver, given the system's file, finds the same events as the oscillator's own
    /// solver.
    #[test]
    fn the_systems_run_is_the_oscillators() {
        let cases = embedded().unwrap_or_default();
        for case in cases.iter().filter(|it| it.oscillator.is_some()) {
            let Ok(OscillatorCase { problem, .. }) = case.of_oscillator() else { continue };
            let system = &case.system;
            let (Ok(solver), Some(start)) = (Solver::<f64>::new(system), &system.start) else {
                unreachable!("{} is solved", case.name)
            };
            let begin = problem.entry.instant;
            let omega = problem.model.parameters().omega;
            let segments = problem.model.trajectory(problem.entry).until(begin.after_periods(3, 1));
            let own: Vec<_> = segments.skip(1).map(|it| *it.entry()).collect();
            let until = problem.start.tau + 3.0 * problem.model.period();
            let Ok(run) = solver.run(start, until) else { unreachable!("{} runs", case.name) };
            let found: Vec<_> =
                run.filter(|it| matches!(it.what, percuss::affine::What::Until(..))).collect();
            assert_eq!(own.len(), found.len(), "{}", case.name);
            for (own, found) in own.iter().zip(&found) {
                let elapsed = found.time.high - problem.start.tau + found.time.low;
                let apart = (own.instant.since(&begin, omega).value() - elapsed).abs();
                assert!(
                    place(own.phase()) == found.mode && apart <= 1e-6,
                    "{}: {apart:e}",
                    case.name
                );
            }
        }
    }
}
