//! A row of z, as guards and conditions are, in modal co-ordinates: its derivatives, with their
//! sizes and bounds.

use crate::affine::arithmetic::real::BigReal;
use crate::affine::arithmetic::vector::{UNDERFLOW, Vector, add_product, vector};
use crate::affine::closed_form::bound::{self, Later, ORDERS};
use crate::affine::closed_form::flow::FlowBlock;
use crate::affine::closed_form::modal_state::ModalState;
use crate::affine::modal;
use crate::affine::model::system::Row;
use crate::numeric::number::Number;

/// A row of z with its derivatives, in modal co-ordinates.
#[derive(Clone, Debug)]
pub struct ModalRow<T> {
    /// The number of the first guard of its mode that is the same row.
    pub twin: usize,
    /// The row's derivatives.
    pub orders: Vec<Vector<T>>,
    /// How many of them there are up to the last that is not zero.
    pub last: usize,
    /// The co-ordinates that it is made of, in their order.
    pub columns: Vec<RowColumn<T>>,
    /// The blocks that it is made of, in their order.
    pub parts: Vec<RowPart>,
    /// The blocks of `parts`, a bit each.
    pub blocks: u16,
    /// The rate of the first of `parts`, the fastest, if that is one decay.
    pub decay: Option<f64>,
}

/// A co-ordinate's factors in a row.
#[derive(Clone, Copy, Debug)]
pub struct RowColumn<T> {
    pub at: usize,
    /// The part of each order: of the value and of its derivatives.
    pub orders: [T; ORDERS],
    /// The size of the part of the value.
    size: f64,
    /// How far that part may be off.
    off: f64,
}

/// A block's part in a row.
#[derive(Clone, Debug)]
pub struct RowPart {
    /// The block's index.
    pub block: usize,
    /// The first column of the block and the one after its last, among those of the row.
    pub columns: (usize, usize),
    /// What is known of the block at all later times.
    pub later: Later,
    /// The norms of the derivatives' parts, and of what they become where the block's co-ordinates
    /// only turn and decay.
    pub norms: [f64; ORDERS],
}

impl<T: Number> ModalRow<T> {
    /// A row of z in the modal co-ordinates of a closed form's blocks, of which `blocks` are the
    /// exact forms.
    pub fn of(row: &Row, flow: &[FlowBlock<T>], blocks: &[modal::Block]) -> Self {
        let row: Vec<BigReal> = row.iter().map(BigReal::of).collect();
        let parts: Vec<_> = blocks.iter().map(|block| bound::derivatives(&row, block)).collect();
        let order = |k: usize| {
            let entries: Vec<_> = parts.iter().flat_map(|part| part[k].iter().cloned()).collect();
            vector(&entries)
        };
        let orders: Vec<Vector<T>> = (0..ORDERS).map(order).collect();
        let is_there = |order: &Vector<T>| order.iter().any(|it| *it != T::zero());
        let last = orders.iter().rposition(is_there).map_or(0, |it| it + 1);
        let (columns, parts_of_row) = (Vec::new(), Vec::new());
        let mut modal =
            Self { twin: 0, orders, last, columns, parts: parts_of_row, blocks: 0, decay: None };
        for (n, (block, part)) in blocks.iter().zip(&parts).enumerate() {
            let norms = bound::norms(block, part);
            if norms.iter().any(|it| *it > 0.0) {
                modal.add_part(n, &flow[n], norms, |j| off(&row, block, j));
            }
        }
        modal.decay = modal.parts.first().and_then(RowPart::decay);
        modal
    }

    /// Adds the part of a block, whose co-ordinates' factors may be off by so much.
    fn add_part(
        &mut self,
        n: usize,
        block: &FlowBlock<T>,
        norms: [f64; ORDERS],
        off: impl Fn(usize) -> f64,
    ) {
        let first = self.columns.len();
        for at in block.at..block.at + block.size {
            let orders: [T; ORDERS] = std::array::from_fn(|k| self.orders[k][at]);
            let used = orders.iter().any(|it| *it != T::zero());
            if used {
                let (size, off) = (orders[0].to_f64().abs(), off(at - block.at));
                self.columns.push(RowColumn { at, orders, size, off });
            }
        }
        let columns = (first, self.columns.len());
        self.parts.push(RowPart { block: n, columns, later: block.later, norms });
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

    /// The sums of the sizes of what the first orders are summed from.
    #[inline]
    pub fn order_sizes<const N: usize>(&self, sizes: &Vector<f64>) -> [f64; N] {
        let mut sums = [0.0; N];
        for column in &self.columns {
            let factors: [f64; N] = std::array::from_fn(|k| column.orders[k].to_f64().abs());
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

    /// Value and three derivatives, and the sum of the sizes of what the value is summed from.
    #[inline]
    pub fn sized_orders(&self, ModalState { y, sizes }: &ModalState<T>) -> ([T; 4], f64) {
        let (mut sums, mut size) = ([T::zero(); 4], 0.0);
        for column in &self.columns {
            let entry = y[column.at];
            add_product(&mut sums, &column.orders, entry);
            size += column.size * sizes[column.at];
        }
        (sums, size)
    }

    /// The first orders, and the sums of the sizes of what they are summed from, in f64, from a
    /// column on.
    #[inline(always)]
    pub fn orders_and_sizes<const N: usize>(
        &self,
        modal: &ModalState<T>,
        from: usize,
    ) -> [[f64; N]; 2] {
        let [mut orders, mut sizes] = [[0.0; N]; 2];
        for column in &self.columns[from..] {
            let (entry, size) = (modal.y[column.at].to_f64(), modal.sizes[column.at]);
            for k in 0..N {
                let factor = column.orders[k].to_f64();
                orders[k] += factor * entry;
                sizes[k] += factor.abs() * size;
            }
        }
        [orders, sizes]
    }

    /// A bound of the derivative of an order over `length`, from the norms of the blocks'
    /// co-ordinates.
    #[inline]
    pub fn bound(&self, order: usize, sizes: &Vector<f64>, length: f64) -> f64 {
        let mut sum = 0.0;
        for part in &self.parts {
            sum += part.bound(order, length, sizes);
        }
        sum * (1.0 + 1e-12)
    }

    /// The sum of the sizes of what the row's value is summed from.
    #[inline]
    pub fn size<U: Number>(&self, y: &Vector<U>) -> f64 {
        self.columns.iter().map(|it| it.size * y[it.at].to_f64().abs()).sum()
    }

    /// How far the row's value may be off because its factors are, where the co-ordinates have
    /// sizes.
    pub fn off(&self, y: &Vector<f64>) -> f64 {
        self.columns.iter().map(|it| it.off * y[it.at]).sum()
    }

    /// A derivative, and the sum of the sizes of what it is summed from.
    #[inline]
    pub fn order(&self, order: usize, ModalState { y, sizes }: &ModalState<T>) -> (T, f64) {
        let row = &self.orders[order];
        let (mut sum, mut size) = (T::zero(), 0.0);
        for RowColumn { at, .. } in &self.columns {
            sum = sum + row[*at] * y[*at];
            size += row[*at].to_f64().abs() * sizes[*at];
        }
        (sum, size)
    }
}

impl RowPart {
    /// The rate of a decay: the quotient of two norms, unless they have lost digits to underflow or
    /// have overflown.
    fn decay(&self) -> Option<f64> {
        const RANGE: std::ops::Range<f64> = 1e-250..1e250;
        let is_told = self.norms[..2].iter().all(|norm| RANGE.contains(norm));
        let is_decay = self.later == Later::Fading && is_told;
        is_decay.then(|| self.norms[1] / self.norms[0])
    }

    /// A bound of the part in a derivative over `length`, from the norms of the blocks'
    /// co-ordinates.
    #[inline]
    pub fn bound(&self, order: usize, length: f64, sizes: &Vector<f64>) -> f64 {
        let size = sizes[self.block];
        let norm = if size == 0.0 { 0.0 } else { self.later.bound(&self.norms, order, length) };
        // Nothing comes of zeros, even where a factor of theirs overflows; what is not zero does
        // not vanish, because a derivative without a bound would be taken for a polynomial's.
        if norm == 0.0 { 0.0 } else { (norm * size).max(UNDERFLOW) }
    }
}

/// How far a row's factor of a block's co-ordinate may be off.
fn off(row: &[BigReal], block: &modal::Block, j: usize) -> f64 {
    row.iter().zip(&block.off[0]).map(|(it, off)| it.to_f64().abs() * off[j]).sum()
}
