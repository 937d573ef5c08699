//! The space K of structural zeros: the rows r for which r z = 0 is known from the model, not from
//! numbers.

use super::residue::{Residue, Residues, row_times};

/// A space of rows, in its reduced echelon form, which is unique.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct ZeroSpace {
    rows: Vec<Residues>,
}

impl ZeroSpace {
    /// Whether a row belongs to the space.
    pub fn contains(&self, row: &[Residue]) -> bool {
        self.reduced(row).iter().all(|it| it.is_zero())
    }

    /// The entries of z that are zero by themselves, as bits.
    pub fn zero_entries(&self, dimension: usize) -> u64 {
        let unit = |n: usize| -> Residues {
            let entry = |k| if k == n { Residue::ONE } else { Residue::ZERO };
            (0..dimension).map(entry).collect()
        };
        let is_zero = |n: &usize| self.contains(&unit(*n));
        (0..dimension).filter(is_zero).fold(0, |mask, n| mask | 1 << n)
    }

    /// Adds a row to the space.
    pub fn insert(&mut self, row: &[Residue]) {
        let mut row = self.reduced(row);
        let Some(pivot) = pivot(&row) else { return };
        let inverse = row[pivot].inverse();
        row.iter_mut().for_each(|it| *it = it.times(inverse));
        for other in &mut self.rows {
            let factor = other[pivot];
            subtract(other, factor, &row);
        }
        let place = self.rows.iter().position(|other| self::pivot(other) > Some(pivot));
        self.rows.insert(place.unwrap_or(self.rows.len()), row);
    }

    /// The largest subspace that r -> r M maps into itself: what stays zero along a segment.
    pub fn invariant(&self, matrix: &[Residues]) -> Self {
        let mut space = self.clone();
        loop {
            let images = space.rows.iter().map(|row| space.reduced(&row_times(row, matrix)));
            let kept = kernel(images.collect());
            if kept.len() == space.rows.len() {
                return space;
            }
            let mut smaller = Self::default();
            for combination in kept {
                smaller.insert(&combined(&combination, &space.rows));
            }
            space = smaller;
        }
    }

    /// The rows in which some entries of z, given as bits, are not.
    pub fn without(&self, entries: u64) -> Self {
        let given = |row: &Residues| {
            let own = row.iter().enumerate().filter(|(n, _)| entries >> n & 1 == 1);
            own.map(|(_, it)| *it).collect()
        };
        let mut space = Self::default();
        for combination in kernel(self.rows.iter().map(given).collect()) {
            space.insert(&combined(&combination, &self.rows));
        }
        space
    }

    /// The rows r for which r R is in the space: what is zero after a reset.
    pub fn after(&self, reset: &[Residues]) -> Self {
        let images = reset.iter().map(|row| self.reduced(row)).collect();
        let mut space = Self::default();
        for row in kernel(images) {
            space.insert(&row);
        }
        space
    }

    /// The least k for which w M^k is not in the space, if there is one.
    pub fn multiplicity(&self, guard: &[Residue], matrix: &[Residues]) -> Option<usize> {
        let mut row = guard.to_vec();
        // By Cayley and Hamilton no later power is independent of these.
        for k in 0..guard.len() {
            if !self.contains(&row) {
                return Some(k);
            }
            row = row_times(&row, matrix);
        }
        None
    }

    /// The factor in first = factor * second modulo the space, if there is one.
    pub fn ratio(&self, first: &[Residue], second: &[Residue]) -> Option<Residue> {
        let (mut first, second) = (self.reduced(first), self.reduced(second));
        let pivot = pivot(&second)?;
        let factor = first[pivot].times(second[pivot].inverse());
        subtract(&mut first, factor, &second);
        first.iter().all(|it| it.is_zero()).then_some(factor)
    }

    /// A row modulo the space: less the combination of the space's rows that makes its pivot
    /// columns zero.
    fn reduced(&self, row: &[Residue]) -> Residues {
        let mut row = row.to_vec();
        for own in &self.rows {
            if let Some(pivot) = pivot(own) {
                let factor = row[pivot];
                subtract(&mut row, factor, own);
            }
        }
        row
    }
}

/// The left kernel: the combinations of rows that vanish.
pub fn kernel(mut rows: Vec<Residues>) -> Vec<Residues> {
    let count = rows.len();
    let unit = |n| (0..count).map(|m| if m == n { Residue::ONE } else { Residue::ZERO }).collect();
    let mut combinations: Vec<Residues> = (0..count).map(unit).collect();
    let mut done = 0;
    while let Some((at, pivot)) =
        (done..count).find_map(|at| pivot(&rows[at]).map(|pivot| (at, pivot)))
    {
        rows.swap(done, at);
        combinations.swap(done, at);
        let inverse = rows[done][pivot].inverse();
        let (above, below) = rows.split_at_mut(done + 1);
        let (combined_above, combined_below) = combinations.split_at_mut(done + 1);
        for (row, combination) in below.iter_mut().zip(combined_below) {
            let factor = row[pivot].times(inverse);
            subtract(row, factor, &above[done]);
            subtract(combination, factor, &combined_above[done]);
        }
        done += 1;
    }
    combinations.split_off(done)
}

fn combined(factors: &[Residue], rows: &[Residues]) -> Residues {
    let mut sum = vec![Residue::ZERO; rows.first().map_or(0, Vec::len)];
    for (factor, row) in factors.iter().zip(rows) {
        for (sum, entry) in sum.iter_mut().zip(row) {
            *sum = sum.plus(factor.times(*entry));
        }
    }
    sum
}

fn subtract(row: &mut [Residue], factor: Residue, other: &[Residue]) {
    if factor.is_zero() {
        return;
    }
    for (entry, other) in row.iter_mut().zip(other) {
        *entry = entry.minus(factor.times(*other));
    }
}

/// The first entry that is not zero modulo either prime.
fn pivot(row: &[Residue]) -> Option<usize> {
    row.iter().position(|it| !it.is_zero() && !it.is_unlucky())
}
