//! Zeros that hold to first order in a name: rows r with r z = 0 and d(r z) = 0.
//!
//! The entries of z and of its derivative s are one vector (s, z), whose rows (a, b) have the value
//! a s + b z. It moves by the matrix of z with that matrix's derivative beside it, and so on for
//! resets, so that the space of zeros is followed as [`ZeroSpace`] says. The derivative at an event
//! is that at its moving time, which differs from the one at a fixed time by a multiple of a M z
//! for a row (a, b): that is zero because only such rows are kept for which (0, a) is a zero, too.

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

/// The zeros of a run that hold to first order, at the present segment.
#[derive(Clone)]
pub struct FirstOrder {
    modes: Vec<ModeRows>,
    at_entry: ZeroSpace,
    lasting: ZeroSpace,
}

/// A row with its derivative, as a row over (s, z); none if a coefficient has no residue.
pub fn with_derivative(row: &Row, rate: &Row) -> Option<Residues> {
    let mut both = residues(row)?;
    both.extend(residues(rate)?);
    Some(both)
}

/// A row of z alone, as a row over (s, z).
pub fn of_value(row: &Row) -> Option<Residues> {
    let mut both = vec![Residue::ZERO; row.len()];
    both.extend(residues(row)?);
    Some(both)
}

fn doubled(rows: &[Row], rates: &[Row]) -> Option<Vec<Residues>> {
    let upper = rows.iter().zip(rates).map(|(row, rate)| with_derivative(row, rate));
    upper.chain(rows.iter().map(of_value)).collect()
}

impl FirstOrder {
    /// The zeros at a start, where z and s are these combinations of linearly independent numbers.
    pub fn at_start(
        modes: &[Mode],
        rates: &[Mode],
        mode: usize,
        [s, z]: [&[Vec<Rational>]; 2],
    ) -> Option<Self> {
        let modes: Option<Vec<ModeRows>> = modes.iter().zip(rates).map(of_mode).collect();
        let modes = modes?;
        let rows: Option<Vec<Residues>> = s.iter().chain(z).map(|it| residues(it)).collect();
        let mut known = ZeroSpace::default();
        kernel(rows?).iter().for_each(|row| known.insert(row));
        let size = z.len();
        // From (a, b) to (0, a).
        let shift: Vec<Residues> = (0..2 * size)
            .map(|n| (0..2 * size).map(|k| unit(n < size && k == n + size)).collect())
            .collect();
        let at_entry = known.invariant(&shift);
        let lasting = at_entry.invariant(&modes[mode].matrix);
        Some(Self { modes, at_entry, lasting })
    }

    /// The least order of a row's derivatives that is not zero to first order; none if all are.
    pub fn multiplicity(&self, row: &Residues, mode: usize) -> Option<usize> {
        self.at_entry.multiplicity(row, &self.modes[mode].matrix)
    }

    /// Whether a row that is not zero to first order is zero at the entry all the same.
    pub fn is_zero_at_entry(&self, row: &Row) -> bool {
        of_value(row).is_some_and(|it| self.at_entry.contains(&it))
    }

    /// Whether a row over (s, z) is zero along the whole segment.
    pub fn lasts(&self, row: &Residues) -> bool {
        self.lasting.contains(row)
    }

    /// The zeros at an instant of the segment, or at its entry, where a guard fires.
    pub fn with_guard(&self, guard: [&Row; 2], at_entry: bool) -> Option<ZeroSpace> {
        let mut space = if at_entry { self.at_entry.clone() } else { self.lasting.clone() };
        space.insert(&of_value(guard[0])?);
        space.insert(&with_derivative(guard[0], guard[1])?);
        Some(space)
    }

    /// Enters a mode after the reset of an event of another.
    pub fn enter(&mut self, before: &ZeroSpace, [mode, until]: [usize; 2], next: usize) {
        self.at_entry = before.after(&self.modes[mode].resets[until]);
        self.lasting = self.at_entry.invariant(&self.modes[next].matrix);
    }
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
