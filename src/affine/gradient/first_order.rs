//! Zeros that hold to first order in a name, and for other values of it: rows r with r z = 0 and
//! d(r z) = 0.
//!
//! The entries of z and of its derivative s are one vector (s, z), whose rows (a, b) have the value
//! a s + b z. It moves by the matrix of z with that matrix's derivative beside it, and so on for
//! resets, so that the space of zeros is followed as [`ZeroSpace`] says. The derivative at an event
//! is that at its moving time, which differs from the one at a fixed time by a multiple of a M z
//! for a row (a, b): that is zero because only such rows are kept for which (0, a) is a zero, too.
//!
//! A zero may hold to first order and still be one of this value alone, as (1 - e)^2 at e = 1, and
//! then the run has other events for every other value. So zeros are followed for another value of
//! the name as well: what is zero there by the model too is so for all values but a few.

use super::derivative::NoGradient;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{Mode, Row};
use crate::affine::zeros::residue::{Residue, Residues, residues};
use crate::affine::zeros::space::{ZeroSpace, kernel};

/// The rows of a mode over (s, z).
#[derive(Clone)]
struct ModeRows {
    matrix: Vec<Residues>,
    resets: Vec<Vec<Residues>>,
}

/// The zeros at the present segment of a run.
#[derive(Clone)]
struct Followed {
    modes: Vec<ModeRows>,
    at_entry: ZeroSpace,
    lasting: ZeroSpace,
}

/// The zeros of a run that hold to first order, at the present segment.
#[derive(Clone)]
pub struct FirstOrder {
    first: Followed,
    /// Those of the same events for another value of the name, if it has one.
    nearby: Option<Followed>,
}

/// The zeros at an instant.
pub struct InstantZeros {
    first: ZeroSpace,
    nearby: Option<ZeroSpace>,
}

/// A guard or a condition, with its derivative, and as it is for another value of the name.
#[derive(Clone, Copy)]
pub struct VariedRow<'a> {
    pub row: &'a Row,
    pub rate: &'a Row,
    pub nearby: Option<&'a Row>,
}

impl VariedRow<'_> {
    fn first(&self) -> Option<Residues> {
        with_derivative(self.row, self.rate)
    }

    fn nearby_residues(&self) -> Option<Residues> {
        residues(self.nearby?)
    }

    /// Whether it is zero to first order.
    ///
    /// # Errors
    /// A zero of this value of the name alone.
    fn is_zero_in(
        &self,
        first: &ZeroSpace,
        nearby: Option<&ZeroSpace>,
    ) -> Result<bool, NoGradient> {
        if !first.contains(&self.first().ok_or(NoGradient::Unknown)?) {
            return Ok(false);
        }
        let holds =
            nearby.zip(self.nearby_residues()).is_some_and(|(space, row)| space.contains(&row));
        if holds { Ok(true) } else { Err(NoGradient::HigherOrder) }
    }
}

/// The values of z and of s at a start, as combinations of linearly independent numbers.
pub struct StartZeros<'a> {
    pub s: &'a [Vec<Rational>],
    pub z: &'a [Vec<Rational>],
    /// The values of z for another value of the name, if it has one.
    pub nearby: Option<&'a [Vec<Rational>]>,
}

/// A row with its derivative, as a row over (s, z); none if a coefficient has no residue.
fn with_derivative(row: &Row, rate: &Row) -> Option<Residues> {
    let mut both = residues(row)?;
    both.extend(residues(rate)?);
    Some(both)
}

/// A row of z alone, as a row over (s, z).
fn of_value(row: &Row) -> Option<Residues> {
    let mut both = vec![Residue::ZERO; row.len()];
    both.extend(residues(row)?);
    Some(both)
}

fn doubled(rows: &[Row], rates: &[Row]) -> Option<Vec<Residues>> {
    let upper = rows.iter().zip(rates).map(|(row, rate)| with_derivative(row, rate));
    upper.chain(rows.iter().map(of_value)).collect()
}

impl Followed {
    fn begun(modes: Vec<ModeRows>, at_entry: ZeroSpace, mode: usize) -> Self {
        let lasting = at_entry.invariant(&modes[mode].matrix);
        Self { modes, at_entry, lasting }
    }

    /// The zeros at an instant of the segment, or at its entry, where these rows are zero too.
    fn with(&self, at_entry: bool, rows: &[Residues]) -> ZeroSpace {
        let mut space = if at_entry { self.at_entry.clone() } else { self.lasting.clone() };
        rows.iter().for_each(|row| space.insert(row));
        space
    }

    fn enter(&mut self, before: &ZeroSpace, [mode, until]: [usize; 2], next: usize) {
        self.at_entry = before.after(&self.modes[mode].resets[until]);
        self.lasting = self.at_entry.invariant(&self.modes[next].matrix);
    }

    fn multiplicity(&self, row: &Residues, mode: usize) -> Option<usize> {
        self.at_entry.multiplicity(row, &self.modes[mode].matrix)
    }
}

impl FirstOrder {
    /// The zeros at a start in a mode.
    pub fn at_start(
        [modes, rates]: [&[Mode]; 2],
        nearby: Option<&[Mode]>,
        mode: usize,
        start: &StartZeros<'_>,
    ) -> Option<Self> {
        let size = start.z.len();
        // From (a, b) to (0, a).
        let shift: Vec<Residues> = (0..2 * size)
            .map(|n| (0..2 * size).map(|k| unit(n < size && k == n + size)).collect())
            .collect();
        let known = zeros_of(start.s.iter().chain(start.z))?.invariant(&shift);
        let both: Option<Vec<ModeRows>> = modes.iter().zip(rates).map(of_mode).collect();
        let beside = || {
            let modes: Option<Vec<ModeRows>> = nearby?.iter().map(of_mode_alone).collect();
            Some(Followed::begun(modes?, zeros_of(start.nearby?.iter())?, mode))
        };
        Some(Self { first: Followed::begun(both?, known, mode), nearby: beside() })
    }

    /// The least order of a row's derivatives that is not zero to first order; none if all are.
    ///
    /// # Errors
    /// A zero of this value of the name alone.
    pub fn multiplicity(
        &self,
        row: &VariedRow<'_>,
        mode: usize,
    ) -> Result<Option<usize>, NoGradient> {
        let first = row.first().ok_or(NoGradient::Unknown)?;
        let order = self.first.multiplicity(&first, mode);
        if order == Some(0) {
            return Ok(order);
        }
        let beside = self.nearby.as_ref().zip(row.nearby_residues());
        let holds = beside.is_some_and(|(zeros, row)| {
            let beside = zeros.multiplicity(&row, mode);
            beside.is_none_or(|beside| order.is_some_and(|order| beside >= order))
        });
        if holds { Ok(order) } else { Err(NoGradient::HigherOrder) }
    }

    /// Whether a row that is not zero to first order is zero at the entry all the same.
    pub fn is_zero_at_entry(&self, row: &Row) -> bool {
        of_value(row).is_some_and(|it| self.first.at_entry.contains(&it))
    }

    /// Whether a row is zero along the whole segment.
    ///
    /// # Errors
    /// A zero of this value of the name alone.
    pub fn lasts(&self, row: &VariedRow<'_>) -> Result<bool, NoGradient> {
        row.is_zero_in(&self.first.lasting, self.nearby.as_ref().map(|it| &it.lasting))
    }

    /// The zeros at an instant of the segment, or at its entry, where a guard fires.
    pub fn with_guard(&self, guard: &VariedRow<'_>, at_entry: bool) -> Option<InstantZeros> {
        let first = self.first.with(at_entry, &[of_value(guard.row)?, guard.first()?]);
        let nearby = self.nearby.as_ref().zip(guard.nearby_residues());
        Some(InstantZeros { first, nearby: nearby.map(|(it, row)| it.with(at_entry, &[row])) })
    }

    /// Enters a mode after the reset of an event of another.
    pub fn enter(&mut self, before: &InstantZeros, event: [usize; 2], next: usize) {
        self.first.enter(&before.first, event, next);
        match (&mut self.nearby, &before.nearby) {
            (Some(own), Some(before)) => own.enter(before, event, next),
            (own, _) => *own = None,
        }
    }
}

impl InstantZeros {
    /// Whether a row is zero at the instant to first order.
    ///
    /// # Errors
    /// A zero of this value of the name alone.
    pub fn contain(&self, row: &VariedRow<'_>) -> Result<bool, NoGradient> {
        row.is_zero_in(&self.first, self.nearby.as_ref())
    }
}

/// The rows that vanish on these combinations of linearly independent numbers.
fn zeros_of<'a>(values: impl Iterator<Item = &'a Vec<Rational>>) -> Option<ZeroSpace> {
    let rows: Option<Vec<Residues>> = values.map(|it| residues(it)).collect();
    let mut known = ZeroSpace::default();
    kernel(rows?).iter().for_each(|row| known.insert(row));
    Some(known)
}

fn unit(is_one: bool) -> Residue {
    if is_one { Residue::ONE } else { Residue::ZERO }
}

fn of_mode((mode, rates): (&Mode, &Mode)) -> Option<ModeRows> {
    let resets = mode.until.iter().zip(&rates.until).map(|(a, b)| doubled(&a.reset, &b.reset));
    Some(ModeRows {
        matrix: doubled(&mode.matrix, &rates.matrix)?,
        resets: resets.collect::<Option<_>>()?,
    })
}

fn of_mode_alone(mode: &Mode) -> Option<ModeRows> {
    let rows = |rows: &[Row]| rows.iter().map(|it| residues(it)).collect::<Option<Vec<_>>>();
    let resets = mode.until.iter().map(|it| rows(&it.reset));
    Some(ModeRows { matrix: rows(&mode.matrix)?, resets: resets.collect::<Option<_>>()? })
}
