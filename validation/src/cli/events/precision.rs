//! The arithmetics of a run: 106 bits, and twice as many where these do not decide or have too few
//! digits.

use super::Arguments;
use super::left_open::LeftOpen;
use super::progress::RunEnd;
use super::rows::{Limits, Outcome, Rows};
use crate::cli::shared::long_work::Bar;
use crate::truth::DoubleDouble;
use anyhow::Result;
use percuss::affine::{Arithmetic, Solver, System};
use percuss::affine::{Bits212, Bits424, Bits848, Bits1696, Bits3392};

/// The fewest and the most bits of an arithmetic.
pub(super) const BITS: std::ops::RangeInclusive<u64> = 106..=3392;

/// A run in as many bits as it needs.
pub(super) struct Precision<'a> {
    pub(super) system: &'a System,
    pub(super) is_backward: bool,
    pub(super) digits: usize,
    pub(super) limits: Limits,
    pub(super) bar: Option<&'a Bar>,
    /// The most bits that are used.
    pub(super) most: u32,
    /// The solver in 106 bits, with which each run begins, and which a picture needs too.
    pub(super) solver: Solver<DoubleDouble>,
}

/// Work that is done in one arithmetic after the other, as long as more bits are needed.
pub(super) trait InBits {
    /// Does the work that is not done yet.
    fn run<T: Arithmetic>(&mut self, rows: &Rows<'_, T>) -> Result<Outcome>;
}

impl<'a> Precision<'a> {
    /// The run that the arguments ask for.
    pub(super) fn of(
        arguments: &Arguments,
        system: &'a System,
        limits: Limits,
        bar: Option<&'a Bar>,
    ) -> Result<Self> {
        let digits = if arguments.digits.as_deref() == Some("25") { 25 } else { 17 };
        let most = arguments.max_bits.unwrap_or(*BITS.end() as u32);
        let is_backward = arguments.backward;
        let solver = DoubleDouble::solver(system, is_backward)?;
        Ok(Self { system, is_backward, digits, limits, bar, most, solver })
    }

    /// Does some work, in more bits where fewer do not suffice.
    pub(super) fn each(&self, work: &mut impl InBits) -> Result<RunEnd> {
        let mut left = LeftOpen::default();
        let steps = [
            Self::in_106_bits,
            Self::within::<Bits212>,
            Self::within::<Bits424>,
            Self::within::<Bits848>,
            Self::within::<Bits1696>,
            Self::within::<Bits3392>,
        ];
        for step in steps {
            match step(self, &left, work)? {
                Outcome::Ended(end) => return Ok(end),
                Outcome::MoreBits(more) => left = more,
            }
        }
        Ok(RunEnd::default())
    }

    fn in_106_bits(&self, left: &LeftOpen, work: &mut impl InBits) -> Result<Outcome> {
        self.by(&self.solver, left, work)
    }

    fn within<T: Arithmetic>(&self, left: &LeftOpen, work: &mut impl InBits) -> Result<Outcome> {
        self.by(&T::solver(self.system, self.is_backward)?, left, work)
    }

    fn by<T: Arithmetic>(
        &self,
        solver: &Solver<T>,
        left: &LeftOpen,
        work: &mut impl InBits,
    ) -> Result<Outcome> {
        let may_go_on = 2 * T::BITS <= self.most;
        let Self { system, is_backward, digits, limits, bar, .. } = *self;
        work.run(&Rows { system, solver, is_backward, digits, limits, bar, left, may_go_on })
    }
}
