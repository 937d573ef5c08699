//! The closed form of a mode: z(t) = exp(M t) z, block by block.

use super::bound::{self, Later, ORDERS};
use super::modal::{self, BigReal};
use super::motion::BlockMotion;
use super::system::{LARGEST_DIMENSION, Row};
use super::vector::{UNDERFLOW, Vector, euclidean, vector};
use crate::number::Number;

/// A mode's closed form.
#[derive(Clone, Debug)]
pub(super) struct Flow<T> {
    pub dimension: usize,
    pub blocks: Vec<FlowBlock<T>>,
    /// How long a bound may be asked for: a growing block grows by at most e.
    pub longest: f64,
    /// How fast a block's co-ordinates move at most, beside their sizes.
    pub speed: f64,
    /// The matrix W of all blocks, by columns.
    to_modal: Vec<Vector<T>>,
    /// The matrix W of all blocks, rounded to f64, by columns.
    to_modal_rounded: Vec<Vector<f64>>,
    /// The matrix X of all blocks, by columns.
    from_modal: Vec<Vector<T>>,
}

/// A block of modal co-ordinates that move by themselves.
#[derive(Clone, Debug)]
pub(super) struct FlowBlock<T> {
    pub at: usize,
    pub size: usize,
    motion: BlockMotion<T>,
    /// What is known of it at all later times.
    pub later: Later,
}

/// A row of z with its derivatives, in modal co-ordinates.
#[derive(Clone, Debug)]
pub(super) struct ModalRow<T> {
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
}

/// A co-ordinate's factors in a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowColumn<T> {
    pub at: usize,
    /// The part of each order: of the value and of its derivatives.
    pub orders: [T; ORDERS],
    /// The size of the part of the value.
    size: f64,
}

/// A block's part in a row.
#[derive(Clone, Debug)]
pub(super) struct RowPart {
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

impl<T: Number> Flow<T> {
    /// A mode's closed form from its blocks.
    pub fn of(blocks: &[modal::Block]) -> Self {
        let dimension = blocks.iter().map(|it| it.matrix.len()).sum();
        let mut flow = Self {
            dimension,
            blocks: Vec::new(),
            longest: f64::INFINITY,
            speed: blocks.iter().map(|it| modal::norm(&it.matrix)).fold(0.0, f64::max),
            to_modal: Vec::new(),
            to_modal_rounded: Vec::new(),
            from_modal: Vec::new(),
        };
        let mut to_modal = Vec::new();
        for block in blocks {
            flow.from_modal.extend(transposed(&block.columns));
            let at = to_modal.len();
            to_modal.extend(block.rows.iter().cloned());
            flow.blocks.push(FlowBlock::of(block, at));
        }
        let rate =
            |block: &FlowBlock<T>| if let Later::Growing(rate) = block.later { rate } else { 0.0 };
        flow.longest = 1.0 / flow.blocks.iter().map(rate).fold(0.0, f64::max);
        flow.to_modal = transposed(&to_modal);
        let rounded = |row: &Vector<T>| row.map(Number::to_f64);
        flow.to_modal_rounded = flow.to_modal.iter().map(rounded).collect();
        flow
    }

    /// A row of z in modal co-ordinates.
    pub fn row(&self, row: &Row, blocks: &[modal::Block]) -> ModalRow<T> {
        let row: Vec<BigReal> = row.iter().map(BigReal::of).collect();
        let parts: Vec<_> = blocks.iter().map(|block| bound::derivatives(&row, block)).collect();
        let order = |k: usize| {
            let entries: Vec<_> = parts.iter().flat_map(|part| part[k].iter().cloned()).collect();
            vector(&entries)
        };
        let orders: Vec<Vector<T>> = (0..ORDERS).map(order).collect();
        let is_there = |order: &Vector<T>| order.iter().any(|it| *it != T::zero());
        let last = orders.iter().rposition(is_there).map_or(0, |it| it + 1);
        let mut modal =
            ModalRow { twin: 0, orders, last, columns: Vec::new(), parts: Vec::new(), blocks: 0 };
        for (n, (block, part)) in blocks.iter().zip(&parts).enumerate() {
            let norms = bound::norms(block, part);
            if norms.iter().any(|it| *it > 0.0) {
                modal.add_part(n, &self.blocks[n], norms);
            }
        }
        modal
    }

    /// The modal co-ordinates of a state.
    #[inline]
    pub fn modal(&self, z: &Vector<T>) -> Vector<T> {
        times(&self.to_modal, z)
    }

    /// The state with these modal co-ordinates.
    #[inline]
    pub fn state(&self, y: &Vector<T>) -> Vector<T> {
        times(&self.from_modal, y)
    }

    /// The sizes of what each entry of the state is summed from, where the modal co-ordinates have
    /// sizes.
    pub fn sizes(&self, y: &Vector<f64>) -> [f64; LARGEST_DIMENSION] {
        let mut sizes = [0.0; LARGEST_DIMENSION];
        for (column, entry) in self.from_modal.iter().zip(y) {
            let terms = column.iter().map(|it| (it.to_f64() * entry).abs());
            sizes.iter_mut().zip(terms).for_each(|(size, term)| *size += term);
        }
        sizes
    }

    /// What rounding may do to a state where it is taken to modal co-ordinates: the states that
    /// belong to the error of each of them.
    pub fn entry_roundings(&self, z: &Vector<T>, unit: f64) -> Vec<Vector<f64>> {
        let margin = (self.dimension + 2) as f64 * unit;
        let error = |(n, column): (usize, &Vector<T>)| {
            let terms = self.to_modal.iter().zip(z).map(|(it, z)| (it[n].to_f64(), z.to_f64()));
            let size: f64 = terms.map(|(factor, entry)| (factor * entry).abs()).sum();
            column.map(|entry| margin * size * entry.to_f64())
        };
        self.from_modal.iter().enumerate().map(error).collect()
    }

    /// The modal co-ordinates a time later.
    #[inline]
    pub fn at(&self, y: &Vector<T>, time: T) -> Vector<T> {
        let mut later = *y;
        self.advance(&mut later, time, u16::MAX);
        later
    }

    /// Advances the co-ordinates of these blocks.
    #[inline]
    pub fn advance(&self, y: &mut Vector<T>, time: T, blocks: u16) {
        for (n, block) in self.blocks.iter().enumerate() {
            if blocks >> n & 1 == 1 {
                block.motion.advance(&mut y[block.at..block.at + block.size], time);
            }
        }
    }

    /// The sizes of what the modal co-ordinates a time later are summed from.
    pub fn sizes_later(&self, y: &Vector<T>, time: T) -> Vector<f64> {
        let mut sizes = y.map(Number::to_f64);
        for block in &self.blocks {
            block.motion.sizes(&mut sizes[block.at..block.at + block.size], time.to_f64());
        }
        sizes
    }

    /// The norms of each block's co-ordinates.
    #[inline]
    pub fn norms<U: Number>(&self, y: &Vector<U>) -> Vector<f64> {
        let mut norms = [0.0; LARGEST_DIMENSION];
        for (n, block) in self.blocks.iter().enumerate() {
            let size = block.size;
            norms[n] = if size == 1 {
                y[block.at].to_f64().abs()
            } else {
                euclidean(y[block.at..block.at + size].iter().map(|it| it.to_f64()))
            };
        }
        norms
    }

    /// What underflow may do to each block's modal co-ordinates at most: to zeros nothing.
    pub fn underflow(&self, y: &Vector<T>) -> Vector<f64> {
        let lost = |norm: f64| if norm > 0.0 { 4.0 * UNDERFLOW * (1.0 + norm) } else { 0.0 };
        self.norms(y).map(lost)
    }

    /// The modal co-ordinates of an error, in f64.
    pub fn modal_rounded(&self, z: &Vector<f64>) -> Vector<f64> {
        times(&self.to_modal_rounded, z)
    }

    /// The columns of exp(M t), in f64.
    pub fn transition(&self, time: T) -> Vec<Vector<f64>> {
        let column = |n: usize| {
            let mut unit = [T::zero(); LARGEST_DIMENSION];
            unit[n] = T::one();
            self.state(&self.at(&self.modal(&unit), time)).map(Number::to_f64)
        };
        (0..self.dimension).map(column).collect()
    }

    /// A bound of a row's derivative of an order over `length` after a state.
    #[inline]
    pub fn bound<U: Number>(
        &self,
        row: &ModalRow<T>,
        order: usize,
        y: &Vector<U>,
        length: f64,
    ) -> f64 {
        self.bound_by(row, order, &self.norms(y), length)
    }

    /// The bound as [`Self::bound`] has it, from the norms of the blocks' co-ordinates.
    #[inline]
    pub fn bound_by(
        &self,
        row: &ModalRow<T>,
        order: usize,
        sizes: &Vector<f64>,
        length: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for part in &row.parts {
            sum += part.bound(order, length, sizes);
        }
        sum * (1.0 + 1e-12)
    }
}

impl RowPart {
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

impl<T: Number> ModalRow<T> {
    fn add_part(&mut self, n: usize, block: &FlowBlock<T>, norms: [f64; ORDERS]) {
        let first = self.columns.len();
        for at in block.at..block.at + block.size {
            let orders: [T; ORDERS] = std::array::from_fn(|k| self.orders[k][at]);
            let used = orders.iter().any(|it| *it != T::zero());
            if used {
                self.columns.push(RowColumn { at, orders, size: orders[0].to_f64().abs() });
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

    /// So many orders from one on.
    #[inline]
    pub fn orders_from<const N: usize>(&self, first: usize, y: &Vector<T>) -> [T; N] {
        let mut sums = [T::zero(); N];
        for column in &self.columns {
            let entry = y[column.at];
            add_product(&mut sums, &column.orders[first..first + N], entry);
        }
        sums
    }

    /// Value and three derivatives, and the sum of the sizes of what the value is summed from.
    #[inline]
    pub fn sized_orders(&self, y: &Vector<T>) -> ([T; 4], f64) {
        let (mut sums, mut size) = ([T::zero(); 4], 0.0);
        for column in &self.columns {
            let entry = y[column.at];
            add_product(&mut sums, &column.orders, entry);
            size += column.size * entry.to_f64().abs();
        }
        (sums, size)
    }

    /// The first orders, and the sums of the sizes of what they are summed from, in f64.
    #[inline]
    pub fn orders_and_sizes<const N: usize>(&self, y: &Vector<T>) -> [[f64; N]; 2] {
        let [mut orders, mut sizes] = [[0.0; N]; 2];
        for column in &self.columns {
            let entry = y[column.at].to_f64();
            for k in 0..N {
                let term = column.orders[k].to_f64() * entry;
                orders[k] += term;
                sizes[k] += term.abs();
            }
        }
        [orders, sizes]
    }

    /// The sum of the sizes of what the row's value is summed from.
    #[inline]
    pub fn size<U: Number>(&self, y: &Vector<U>) -> f64 {
        self.columns.iter().map(|it| it.size * y[it.at].to_f64().abs()).sum()
    }

    /// A derivative, and the sum of the sizes of what it is summed from.
    #[inline]
    pub fn order(&self, order: usize, y: &Vector<T>) -> (T, f64) {
        let row = &self.orders[order];
        let (mut sum, mut size) = (T::zero(), 0.0);
        for RowColumn { at, .. } in &self.columns {
            let term = row[*at] * y[*at];
            sum = sum + term;
            size += term.to_f64().abs();
        }
        (sum, size)
    }
}

impl<T: Number> FlowBlock<T> {
    fn of(block: &modal::Block, at: usize) -> Self {
        let motion = BlockMotion::of(block);
        Self { at, size: block.matrix.len(), motion, later: Later::of(block) }
    }
}

/// The product of a matrix, given by its columns, with a vector; entries beyond its rows are zero.
#[inline]
fn times<T: Number>(columns: &[Vector<T>], vector: &Vector<T>) -> Vector<T> {
    match columns.len() {
        0..=4 => times_in::<T, 4>(columns, vector),
        5..=8 => times_in::<T, 8>(columns, vector),
        _ => times_in::<T, LARGEST_DIMENSION>(columns, vector),
    }
}

/// The first `ROWS` entries of the product of a matrix, by columns, and a vector.
#[inline]
fn times_in<T: Number, const ROWS: usize>(columns: &[Vector<T>], vector: &Vector<T>) -> Vector<T> {
    let mut sums = [T::zero(); ROWS];
    for (n, column) in columns.iter().enumerate() {
        let factor = vector[n];
        add_product(&mut sums, column, factor);
    }
    let mut product = [T::zero(); LARGEST_DIMENSION];
    product[..ROWS].copy_from_slice(&sums);
    product
}

/// Adds a multiple of a vector. Indices are what every unit of a crate inlines; iterators that are
/// joined are called.
#[allow(clippy::needless_range_loop, reason = "an iterator costs a call")]
#[inline(always)]
fn add_product<T: Number, const N: usize>(sums: &mut [T; N], vector: &[T], factor: T) {
    let vector = &vector[..N];
    for k in 0..N {
        sums[k] = sums[k] + vector[k] * factor;
    }
}

fn transposed<T: Number>(matrix: &[Vec<BigReal>]) -> Vec<Vector<T>> {
    let columns = matrix.first().map_or(0, Vec::len);
    let column = |n: usize| vector(&matrix.iter().map(|row| row[n].clone()).collect::<Vec<_>>());
    (0..columns).map(column).collect()
}
