//! `lyapunov SYSTEM` at the points of a sweep.

use super::{SweptSystem, count_in_file, number_of};
use crate::cli::lyapunov::Arguments;
use crate::cli::shared::long_work;
use crate::cli::sweep::exponents::stationary;
use crate::returns;
use crate::sweep::{Array, SweepPoint, SweepVerb, records};
use anyhow::Result;
use percuss::affine::{Exponents, LeftOut, NoReturn, Solver};

/// Exponents at each point; a point is one tile.
pub(in crate::cli::sweep) struct SystemExponentWork {
    swept: SweptSystem,
    arguments: Arguments,
    returns: u64,
}

impl SystemExponentWork {
    pub(in crate::cli::sweep) fn new(swept: SweptSystem, arguments: Arguments) -> Result<Self> {
        let returns = arguments.returns_of_system()?;
        long_work::check_horizon(arguments.transient, returns)?;
        swept.check(&arguments.section)?;
        Ok(Self { swept, arguments, returns })
    }

    /// The arrays of the verb's JSON, with infinite exponents as they are, and NaN where the motion
    /// does not return as often.
    fn arrays(&self, found: Result<Exponents, (NoReturn, u64)>) -> Vec<Array> {
        let (states, drifts) = (self.swept.first.states.len(), self.swept.first.drifts().len());
        let left_out = found.as_ref().err().map(|(why, _)| LeftOut::NoReturn(*why));
        let found = found.ok();
        let found = found.as_ref();
        let list = |name: &str, count: usize, of: &dyn Fn(&Exponents) -> Vec<f64>| {
            let values = found.map_or_else(|| vec![f64::NAN; count], of);
            Array::f8(name, &[values.len()], values)
        };
        let mean = found.map_or(f64::NAN, |it| it.mean_return_time);
        let settled = found.map_or(-1, |it| stationary(it.stationarity));
        let undecidable = found.map_or(0, |it| count_in_file(it.undecidable));
        vec![
            list("exponents_per_return", states, &|it| it.per_return.clone()),
            list("exponents_per_time", states, &Exponents::per_time),
            list("standard_error", states, &|it| it.standard_error.clone()),
            Array::f8("mean_return_time", &[], vec![mean]),
            list("drift_per_return", drifts, &|it| it.drift_per_return.clone()),
            list("drift_standard_error", drifts, &|it| it.drift_standard_error.clone()),
            Array::i4("stationary", &[], vec![settled]),
            Array::i4("left_out", &[], vec![number_of(left_out)]),
            Array::i4("undecidable", &[], vec![undecidable]),
        ]
    }
}

impl SweepVerb for SystemExponentWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        self.swept.system(point).map(drop)
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let system = self.swept.system(point)?;
        let solver = Solver::<f64>::new(&system)?;
        let map = self.arguments.section.map(&solver)?;
        let found = returns::exponents(&map, self.arguments.transient, self.returns, &mut |_| ())?;
        records::bytes(&self.arrays(found))
    }

    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        vec![("states", self.swept.first.states.clone()), ("drifts", self.swept.drifts())]
    }
}
