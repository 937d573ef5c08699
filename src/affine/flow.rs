//! The closed form of a mode: z(t) = exp(M t) z, block by block.

use super::bound::Later;
use super::modal::{self, BigReal};
use super::motion::BlockMotion;
use super::system::LARGEST_DIMENSION;
use super::vector::{UNDERFLOW, Vector, add_product, euclidean, vector};
use crate::number::Number;

/// A mode's closed form.
#[derive(Clone, Debug)]
pub(super) struct ModeFlow<T> {
    pub dimension: usize,
    pub blocks: Vec<FlowBlock<T>>,
    /// How long a bound may be asked for: a growing block grows by at most e.
    pub longest: f64,
    /// How fast a block's co-ordinates move at most, relative to their sizes.
    pub speed: f64,
    /// The matrix W of all blocks, by columns.
    to_modal: Vec<Vector<T>>,
    /// The matrix W of all blocks, rounded to f64, by columns.
    to_modal_rounded: Vec<Vector<f64>>,
    /// The matrix X of all blocks, by columns.
    from_modal: Vec<Vector<T>>,
    /// How far the entries of X and of W may be off, by columns.
    off: [Vec<Vector<f64>>; 2],
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

impl<T: Number> ModeFlow<T> {
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
            off: [Vec::new(), Vec::new()],
        };
        let (mut to_modal, mut off) = (Vec::new(), Vec::new());
        for block in blocks {
            flow.from_modal.extend(transposed(&block.columns));
            let at = to_modal.len();
            to_modal.extend(block.rows.iter().cloned());
            let [columns, rows] = &block.off;
            flow.off[0].extend(by_columns(columns));
            off.extend(rows.iter().cloned());
            flow.blocks.push(FlowBlock::of(block, at));
        }
        let rate =
            |block: &FlowBlock<T>| if let Later::Growing(rate) = block.later { rate } else { 0.0 };
        flow.longest = 1.0 / flow.blocks.iter().map(rate).fold(0.0, f64::max);
        flow.to_modal = transposed(&to_modal);
        flow.off[1] = by_columns(&off);
        let rounded = |row: &Vector<T>| row.map(Number::to_f64);
        flow.to_modal_rounded = flow.to_modal.iter().map(rounded).collect();
        flow
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

    /// How far each entry of the state may be off because the matrix X is, where the modal
    /// co-ordinates have sizes.
    pub fn state_off(&self, y: &Vector<f64>) -> Vector<f64> {
        times(&self.off[0], y)
    }

    /// What rounding may do to a state where it is taken to modal co-ordinates: the states that
    /// belong to the error of each of them.
    pub fn entry_roundings(&self, z: &Vector<T>, unit: f64) -> Vec<Vector<f64>> {
        let margin = (self.dimension + 2) as f64 * unit;
        let error = |(n, column): (usize, &Vector<T>)| {
            let terms = self.to_modal.iter().zip(z).map(|(it, z)| (it[n].to_f64(), z.to_f64()));
            let size: f64 = terms.map(|(factor, entry)| (factor * entry).abs()).sum();
            let off = self.off[1].iter().zip(z).map(|(it, z)| it[n] * z.to_f64().abs());
            let error = margin * size + off.sum::<f64>();
            column.map(|entry| error * entry.to_f64())
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

/// A matrix of f64 by columns.
fn by_columns(matrix: &[Vec<f64>]) -> Vec<Vector<f64>> {
    let columns = matrix.first().map_or(0, Vec::len);
    let mut all = vec![[0.0; LARGEST_DIMENSION]; columns];
    for (n, row) in matrix.iter().enumerate() {
        all.iter_mut().zip(row).for_each(|(column, entry)| column[n] = *entry);
    }
    all
}

fn transposed<T: Number>(matrix: &[Vec<BigReal>]) -> Vec<Vector<T>> {
    let columns = matrix.first().map_or(0, Vec::len);
    let column = |n: usize| vector(&matrix.iter().map(|row| row[n].clone()).collect::<Vec<_>>());
    (0..columns).map(column).collect()
}
