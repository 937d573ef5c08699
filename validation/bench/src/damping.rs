//! The cost of a run against xi: the slider relaxes in a time 2 xi, which an explicit method has to
//! follow step by step, an implicit one at the price of linear systems, and a closed form not at
//! all.

use super::contest::{SettingResult, contest_at};
use super::contestant::Contestant;
use super::timed_case::TimedCase;
use crate::engine::{Accuracy, Failure, Role, Stepping};
use percuss::Parameters;

const DAMPING_RATIOS: [f64; 9] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4];
/// The forcing frequency of the cases with falling damping ratios.
const OMEGA: f64 = 1.2;
const PERIODS: u32 = 20;
/// A tolerance at which most engines are right to the end, and stability limits their steps.
const TOLERANCE: f64 = 1e-9;

/// All contestants at one damping ratio.
#[derive(Clone, Debug)]
pub struct DampingPoint {
    /// The damping ratio.
    pub xi: f64,
    /// The results of all engines at this damping ratio.
    pub results: Vec<SettingResult>,
}

/// Times a few engines of every library, and the exact solver, at falling damping ratios xi.
///
/// # Errors
/// [`Failure`] for a run that 106 bits do not decide.
pub fn over_xi(
    contestants: &[&dyn Contestant],
    rounds: usize,
    done: &dyn Fn(),
) -> Result<Vec<DampingPoint>, Failure> {
    let asked = asked(contestants);
    let point = |xi: f64| {
        let parameters = Parameters { xi, omega: OMEGA, ..Parameters::default() };
        let case = TimedCase::from_rest(parameters, PERIODS)?;
        Ok(DampingPoint { xi, results: contest_at(&case, &asked, rounds, done) })
    };
    DAMPING_RATIOS.into_iter().map(point).collect()
}

/// The number of progress steps of [`over_xi`].
#[must_use]
pub fn size(contestants: &[&dyn Contestant], rounds: usize) -> u64 {
    (DAMPING_RATIOS.len() * asked(contestants).len() * (rounds + 1)) as u64
}

fn asked<'a>(contestants: &[&'a dyn Contestant]) -> Vec<(&'a dyn Contestant, Accuracy)> {
    let setting = |it: &&'a dyn Contestant| match it.declaration().stepping {
        Stepping::Exact => Some((*it, Accuracy::Exact)),
        _ => (it.declaration().role >= Role::Damping)
            .then_some((*it, Accuracy::Tolerance(TOLERANCE))),
    };
    contestants.iter().filter_map(setting).collect()
}
