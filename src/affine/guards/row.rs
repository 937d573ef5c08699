//! A row of z, as guards and conditions are, in modal co-ordinates: its derivatives, with their
//! sizes and bounds.

use crate::affine::arithmetic::real::{BigReal, bits_for};
use crate::affine::arithmetic::vector::{Vector, add_product, vector};
use crate::affine::closed_form::bound::{self, BlockGrowth, ORDERS};
use crate::affine::closed_form::flow::{FlowBlock, ModeFlow, Subspace};
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::modal;
use crate::affine::model::system::Row;
use crate::numeric::number::{Bound, Number, ScaledF64};

/// A row of z with its derivatives, in modal co-ordinates.
#[derive(Clone, Debug)]
pub struct ModalRow<T: Number> {
    /// The number of the first guard of its mode that is the same row.
    pub twin: usize,
    /// The row's derivatives.
    pub orders: Vec<Vector<T>>,
    /// The number of derivatives up to the last that is not zero.
    pub last: usize,
    /// The co-ordinates that have a part in the row, in their order.
    pub columns: Vec<RowColumn<T>>,
    /// The blocks that have a part in the row, in their order.
    pub parts: Vec<RowPart<T::Bound>>,
    /// The blocks of `parts`, a bit each.
    pub blocks: u16,
    /// The rate of the first of `parts`, the fastest, if it is a single decaying exponential.
    pub decay_rate: Option<f64>,
}

/// A co-ordinate's factors in a row.
#[derive(Clone, Copy, Debug)]
pub struct RowColumn<T: Number> {
    pub at: usize,
    /// The factors in the value and in its derivatives.
    pub orders: [T; ORDERS],
    /// The size of the factor in the value.
    size: T::Bound,
    /// A bound of the error of the factor in the value.
    error: T::Bound,
}

/// A block's part in a row.
#[derive(Clone, Debug)]
pub struct RowPart<B> {
    /// The index of the smallest of the flow's subspaces in which the part lies.
    pub subspace: usize,
    /// The first column of the block and the one after its last, among those of the row.
    pub columns: (usize, usize),
    /// How the block's part may grow.
    pub growth: BlockGrowth,
    /// The norms of the block's rows in the derivatives, for all times at which its co-ordinates
    /// only rotate and decay.
    pub norms: [B; ORDERS],
}

impl<T: Number> ModalRow<T> {
    /// A row of z in the modal co-ordinates of a closed form, of whose blocks `blocks` are the
    /// exact forms.
    pub fn new(row: &Row, flow: &ModeFlow<T>, blocks: &[modal::Block]) -> Self {
        let row: Vec<BigReal> = row.iter().map(|it| BigReal::new(it, bits_for::<T>())).collect();
        let parts: Vec<_> = blocks.iter().map(|block| bound::derivatives(&row, block)).collect();
        let order = |k: usize| {
            let entries: Vec<_> = parts.iter().flat_map(|part| part[k].iter().cloned()).collect();
            vector(&entries)
        };
        let orders: Vec<Vector<T>> = (0..ORDERS).map(order).collect();
        let is_there = |order: &Vector<T>| order.iter().any(|it| *it != T::zero());
        let last = orders.iter().rposition(is_there).map_or(0, |it| it + 1);
        let (columns, parts_of_row) = (Vec::new(), Vec::new());
        let mut modal = Self {
            twin: 0,
            orders,
            last,
            columns,
            parts: parts_of_row,
            blocks: 0,
            decay_rate: None,
        };
        for (n, (block, part)) in blocks.iter().zip(&parts).enumerate() {
            let norms = bound::norms::<T::Bound>(block, part);
            if norms.iter().any(|it| *it > 0.0) {
                let subspace = smallest_subspace(flow, n, part);
                modal.add_part((n, subspace), &flow.blocks[n], norms, |j| {
                    factor_error(&row, block, j)
                });
            }
        }
        modal.decay_rate = modal.parts.first().and_then(RowPart::decay_rate);
        modal
    }

    /// Adds the part of a block, which lies in a subspace; `off` bounds the errors of the factors
    /// of its co-ordinates.
    fn add_part(
        &mut self,
        (n, subspace): (usize, usize),
        block: &FlowBlock<T>,
        norms: [T::Bound; ORDERS],
        error: impl Fn(usize) -> T::Bound,
    ) {
        let first = self.columns.len();
        for at in block.at..block.at + block.size {
            let orders: [T; ORDERS] = std::array::from_fn(|k| self.orders[k][at]);
            let used = orders.iter().any(|it| *it != T::zero());
            if used {
                let (size, error) = (orders[0].bound().abs(), error(at - block.at));
                self.columns.push(RowColumn { at, orders, size, error });
            }
        }
        let columns = (first, self.columns.len());
        self.parts.push(RowPart { subspace, columns, growth: block.growth, norms });
        self.blocks |= 1 << n;
    }

    /// The first column of a part, or the end of them.
    #[inline]
    pub fn first_column(&self, part: usize) -> usize {
        self.parts.get(part).map_or(self.columns.len(), |it| it.columns.0)
    }

    /// The value and three derivatives, from a column on.
    #[inline]
    pub fn first_orders(&self, y: &Vector<T>, from: usize) -> [T; 4] {
        let mut sums = [T::zero(); 4];
        for column in &self.columns[from..] {
            let entry = y[column.at];
            add_product(&mut sums, &column.orders, entry);
        }
        sums
    }

    /// For each of the first orders, the sum of the sizes of its terms.
    #[inline]
    pub fn order_sizes<const N: usize>(&self, sizes: &Vector<T::Bound>) -> [T::Bound; N] {
        let mut sums = [T::Bound::ZERO; N];
        for column in &self.columns {
            let factors: [T::Bound; N] = std::array::from_fn(|k| column.orders[k].bound().abs());
            add_product(&mut sums, &factors, sizes[column.at]);
        }
        sums
    }

    /// N orders, beginning with `first`.
    #[inline]
    pub fn orders_from<const N: usize>(&self, first: usize, y: &Vector<T>) -> [T; N] {
        let mut sums = [T::zero(); N];
        for column in &self.columns {
            let entry = y[column.at];
            add_product(&mut sums, &column.orders[first..first + N], entry);
        }
        sums
    }

    /// The first orders in f64, from a column on.
    #[inline(always)]
    pub fn rounded_orders<const N: usize>(&self, y: &Vector<T>, from: usize) -> [f64; N] {
        let mut sums = [0.0; N];
        for column in &self.columns[from..] {
            let factors: [f64; N] = std::array::from_fn(|k| column.orders[k].to_f64());
            add_product(&mut sums, &factors, y[column.at].to_f64());
        }
        sums
    }

    /// Value and three derivatives, and the sum of the sizes of the value's terms.
    #[inline]
    pub fn sized_orders(&self, ModalState { y, sizes }: &ModalState<T>) -> ([T; 4], T::Bound) {
        let (mut sums, mut size) = ([T::zero(); 4], T::Bound::ZERO);
        for column in &self.columns {
            let entry = y[column.at];
            add_product(&mut sums, &column.orders, entry);
            size += column.size * sizes[column.at];
        }
        (sums, size)
    }

    /// The first orders and the sums of their terms' sizes, in f64, from a column on.
    #[inline(always)]
    pub fn orders_and_sizes<const N: usize>(
        &self,
        modal: &ModalState<T>,
        from: usize,
    ) -> [[f64; N]; 2] {
        let [mut orders, mut sizes] = [[0.0; N]; 2];
        for column in &self.columns[from..] {
            let (entry, size) = (modal.y[column.at].to_f64(), modal.sizes[column.at].to_f64());
            for k in 0..N {
                let factor = column.orders[k].to_f64();
                orders[k] += factor * entry;
                sizes[k] += factor.abs() * size;
            }
        }
        [orders, sizes]
    }

    /// A bound of the derivative of an order over `length`, from the norms of the flow's subspaces.
    #[inline]
    pub fn bound(&self, order: usize, sizes: &Vector<T::Bound>, length: f64) -> T::Bound {
        let mut sum = T::Bound::ZERO;
        for part in &self.parts {
            sum += part.bound(order, length, sizes);
        }
        sum * (1.0 + 1e-12)
    }

    /// The sum of the sizes of the terms of the row's value.
    #[inline]
    pub fn size(&self, y: &Vector<T>) -> T::Bound {
        self.columns.iter().map(|it| it.size * y[it.at].bound().abs()).sum()
    }

    /// A bound of the error of the row's value by the errors of its factors, from the sizes of the
    /// co-ordinates.
    pub fn value_error(&self, y: &Vector<T::Bound>) -> T::Bound {
        self.columns.iter().map(|it| it.error * y[it.at]).sum()
    }

    /// A derivative, and the sum of the sizes of its terms.
    #[inline]
    pub fn order(&self, order: usize, ModalState { y, sizes }: &ModalState<T>) -> (T, T::Bound) {
        let row = &self.orders[order];
        let (mut sum, mut size) = (T::zero(), T::Bound::ZERO);
        for RowColumn { at, .. } in &self.columns {
            sum = sum + row[*at] * y[*at];
            size += row[*at].bound().abs() * sizes[*at];
        }
        (sum, size)
    }
}

impl<B: Bound> RowPart<B> {
    /// The rate of a decay: the quotient of two norms, unless they have lost digits to underflow or
    /// have overflown.
    fn decay_rate(&self) -> Option<f64> {
        /// The norms that have all of their digits: they neither underflow nor overflow.
        const NORM_RANGE: std::ops::Range<f64> = 1e-250..1e250;
        let is_in_range = self.norms[..2].iter().all(|norm| NORM_RANGE.contains(&norm.to_f64()));
        let is_decay = self.growth == BlockGrowth::Decaying && is_in_range;
        is_decay.then(|| (self.norms[1] / self.norms[0]).to_f64())
    }

    /// A bound of the part in a derivative over `length`, from the norms of the flow's subspaces.
    #[inline]
    pub fn bound(&self, order: usize, length: f64, sizes: &Vector<B>) -> B {
        let size = sizes[self.subspace];
        let norm =
            if size == 0.0 { B::ZERO } else { self.growth.bound(&self.norms, order, length) };
        // Zeros contribute nothing, even where their factors overflow. A bound that is not zero is
        // kept from underflow, because derivatives bounded by zero are taken for a polynomial's.
        if norm == 0.0 { B::ZERO } else { (norm * size).max(B::UNDERFLOW) }
    }
}

/// The index of the smallest subspace in which a row's part of a block lies in all derivatives. Of
/// an entry that is large beside what the row can ever see of it, the bounds then know nothing.
fn smallest_subspace<T: Number>(flow: &ModeFlow<T>, n: usize, part: &[Vec<BigReal>]) -> usize {
    let start = flow.blocks[n].at;
    let is_zero_before =
        |end: usize| part.iter().all(|it| it[..end - start].iter().all(BigReal::is_zero));
    // Subspaces of other blocks may begin before this one.
    let holds = |it: &Subspace| it.block == n && is_zero_before(it.range.start);
    flow.subspaces.iter().rposition(holds).unwrap_or(n)
}

/// A bound of the error of a row's factor of a block's co-ordinate.
fn factor_error<B: Bound>(row: &[BigReal], block: &modal::Block, j: usize) -> B {
    let term =
        |(it, errors): (&BigReal, &Vec<ScaledF64>)| it.bound::<ScaledF64>().abs() * errors[j];
    let sum: ScaledF64 = row.iter().zip(&block.errors[0]).map(term).sum();
    sum.rounded()
}
