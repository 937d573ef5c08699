//! A guard shortly after an entry at which it is a structural zero: by its Taylor series, of which
//! the zeros are left out.

use super::row::ModalRow;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::closed_form::bound::{BlockGrowth, ORDERS};
use crate::affine::closed_form::modal_state::ModalState;
use crate::numeric::number::{Bound, Number};

/// A guard's Taylor coefficients at entry, with the sums of the sizes of their terms.
pub(super) struct EntrySeries<T: Number> {
    coefficients: [T; ORDERS],
    sizes: [T::Bound; ORDERS],
}

/// The entry of a segment, from which the Taylor series of its guards are computed.
pub(super) struct SegmentEntry<T: Number> {
    /// The entry's co-ordinates, without the rounding of those that are no polynomials.
    pub modal: ModalState<T>,
    /// The norms of the sizes in each of the flow's subspaces.
    pub norms: Vector<T::Bound>,
    /// The time up to which the series are asked for.
    pub until: f64,
}

/// Whether a guard that begins with so many zeros can be summed from its series.
#[inline]
pub(super) fn has_series(zeros: usize) -> bool {
    0 < zeros && zeros < ORDERS
}

impl<T: Number> EntrySeries<T> {
    /// The series of a guard that begins with so many zeros; zero where it has none.
    pub fn new(row: &ModalRow<T>, zeros: usize, entry: &SegmentEntry<T>) -> Self {
        let (mut coefficients, mut sizes) = ([T::zero(); ORDERS], [T::Bound::ZERO; ORDERS]);
        if !has_series(zeros) {
            return Self { coefficients, sizes };
        }
        for k in zeros..row.last {
            let (value, size) = row.order(k, &entry.modal);
            coefficients[k] = value * T::inverse_factorial(k);
            sizes[k] = size * f64::inverse_factorial(k);
        }
        // Rounding errors of the entry move as the co-ordinates do: large derivatives of a fast
        // block do not matter, because its errors decay.
        let others = row.parts.iter().filter(|it| it.growth != BlockGrowth::Polynomial);
        let moved: T::Bound = others.map(|it| it.bound(zeros, entry.until, &entry.norms)).sum();
        sizes[zeros] += moved * f64::inverse_factorial(zeros);
        Self { coefficients, sizes }
    }

    /// Value and three derivatives at a time, and the size of what the value is summed from.
    #[inline]
    pub fn at(&self, time: T) -> ([T; 4], T::Bound) {
        let Self { coefficients, sizes } = self;
        let [mut value, mut slope, mut bend, mut third] = [T::zero(); 4];
        let (mut size, size_of_time) = (T::Bound::ZERO, time.to_f64().abs());
        let last = sizes[..ORDERS - 1].iter().rposition(|it| *it > 0.0).map_or(0, |it| it + 1);
        for (coefficient, own) in coefficients[..last].iter().zip(sizes).rev() {
            third = third * time + bend;
            bend = bend * time + slope;
            slope = slope * time + value;
            value = value * time + *coefficient;
            size = size * size_of_time + *own;
        }
        ([value, slope, bend + bend, T::exact(6.0) * third], size)
    }
}

/// For each order, the product of the integers above it up to the last order, which f64 holds
/// exactly.
const FACTORS: [f64; ORDERS] = {
    let mut factors = [1.0; ORDERS];
    let mut n = ORDERS - 1;
    while n > 0 {
        factors[n - 1] = factors[n] * n as f64;
        n -= 1;
    }
    factors
};

/// The time up to which a guard's series without its last order is good to the last digit: `lead`
/// is the first derivative that is not zero, `last` a bound of the last.
#[inline]
pub(super) fn series_limit<T: Number>(lead: T::Bound, zeros: usize, last: T::Bound) -> f64 {
    if last == 0.0 {
        return f64::INFINITY;
    }
    let order = ORDERS - 1;
    let power = T::unit() * lead * FACTORS[zeros] / last;
    0.9 * power.approximate_root(order - zeros).to_f64()
}
