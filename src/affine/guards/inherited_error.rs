//! Bounds of the errors of a guard along a segment that were made before it.

use super::row::ModalRow;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::closed_form::bound::{BlockGrowth, ORDERS};
use crate::affine::closed_form::flow::ModeFlow;
use crate::numeric::number::{Bound, Number};

/// The factor by which bounds are raised against rounding in f64.
pub const OUTWARD_FACTOR: f64 = 1.0 + 1e-9;

/// Bounds of a row's error along a segment, by the errors at the segment's entry.
#[derive(Clone, Copy, Debug, Default)]
pub struct InheritedError<B> {
    /// Bounds of value and derivatives at entry, of the blocks that are polynomials of the time: so
    /// an error of a rate is none of the value before time has passed.
    pub orders: [B; ORDERS],
    /// Bounds of the norms of the other errors at entry, in each of the flow's subspaces.
    pub norms: Vector<B>,
}

impl<B: Bound> InheritedError<B> {
    /// Adds an error by its modal co-ordinates. In polynomial blocks it changes a derivative of the
    /// row by the sum of `term` of the row's factors and the co-ordinates.
    pub fn add<T: Number<Bound = B>>(
        &mut self,
        flow: &ModeFlow<T>,
        row: &ModalRow<T>,
        error: &Vector<B>,
        term: impl Fn(B, B) -> B,
    ) {
        let (norms, mut orders) = (flow.norms_of_bounds(error), [B::ZERO; ORDERS]);
        for part in &row.parts {
            if part.growth != BlockGrowth::Polynomial {
                self.norms[part.subspace] += norms[part.subspace] * OUTWARD_FACTOR;
                continue;
            }
            for it in &row.columns[part.columns.0..part.columns.1] {
                let terms = it.orders.iter().map(|order| term(order.bound(), error[it.at]));
                orders.iter_mut().zip(terms).for_each(|(order, term)| *order += term);
            }
        }
        let all = self.orders.iter_mut().zip(orders);
        all.for_each(|(sum, order)| *sum += order.abs() * OUTWARD_FACTOR);
    }

    /// A bound of the row's error at a time, which is not negative. Between two times it is at most
    /// the larger of theirs, because decays and polynomials of positive terms are convex.
    pub fn bound<T: Number<Bound = B>>(
        &self,
        flow: &ModeFlow<T>,
        row: &ModalRow<T>,
        time: f64,
    ) -> B {
        let norms = flow.decayed(&self.norms, time);
        (self.orders[0] + self.polynomial(1, time)) * OUTWARD_FACTOR + row.bound(0, &norms, time)
    }

    /// A bound of the row's error at a time, which is not negative, where so many of its first
    /// Taylor terms at entry are zeros and are left out: the rest of a block that is no polynomial
    /// is an integral of the derivative that follows those. The bound increases with the time.
    pub fn bound_without_zeros<T: Number<Bound = B>>(
        &self,
        zeros: usize,
        row: &ModalRow<T>,
        time: f64,
    ) -> B {
        let norms = row.bound(zeros, &self.norms, time);
        let others = (1..=zeros).fold(norms, |sum, k| sum * time / k as f64);
        (self.polynomial(zeros, time) + others) * OUTWARD_FACTOR
    }

    /// The Taylor terms of the polynomial blocks at a time, from an order on that is not zero.
    fn polynomial(&self, from: usize, time: f64) -> B {
        let own = |k: usize| if k < from { B::ZERO } else { self.orders[k] };
        (1..ORDERS).rev().fold(B::ZERO, |sum, k| (sum + own(k)) * time / k as f64)
    }
}
