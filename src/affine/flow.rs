//! The closed form of a mode: z(t) = exp(M t) z, block by block.

use super::bound::{self, Later};
use super::modal::{self, Real};
use super::motion::{BlockMotion, vector};
use super::system::{LARGEST_DIMENSION, Row};
use crate::number::Number;

/// The entries of z, or of the modal co-ordinates; those beyond the dimension are zero.
pub(super) type Vector<T> = [T; LARGEST_DIMENSION];

/// How many derivatives of a row are held, its value included.
pub(super) const ORDERS: usize = 17;

/// A mode's closed form.
#[derive(Clone, Debug)]
pub(super) struct Flow<T> {
    pub dimension: usize,
    pub blocks: Vec<Block<T>>,
    /// W of all blocks.
    to_modal: Vec<Vector<T>>,
    /// W of all blocks, rounded to f64.
    to_modal_rounded: Vec<Vector<f64>>,
    /// X of all blocks.
    from_modal: Vec<Vector<T>>,
}

/// A block of modal co-ordinates that move by themselves.
#[derive(Clone, Debug)]
pub(super) struct Block<T> {
    pub at: usize,
    pub size: usize,
    motion: BlockMotion<T>,
    /// A bound of the rate at which a vector of it grows, not negative.
    growth: f64,
    /// What is known of it at all later times.
    pub later: Later,
}

/// A row of z with its derivatives, in modal co-ordinates.
#[derive(Clone, Debug)]
pub(super) struct ModalRow<T> {
    /// The row's derivatives.
    pub orders: Vec<Vector<T>>,
    /// The sizes of the entries of the row itself.
    sizes: [f64; LARGEST_DIMENSION],
    /// The norms of the derivatives' parts that belong to each block, and of what they become
    /// where the block's co-ordinates only turn and decay.
    pub norms: Vec<[f64; ORDERS]>,
    /// The blocks that it is made of, as bits.
    pub blocks: u16,
}

/// The distance from 1 to the next smaller number of an arithmetic.
pub(super) fn unit<T: Number>() -> f64 {
    const HALF: f64 = 0.5 * f64::EPSILON;
    // Double-double arithmetic is good to a few units of 2^-106.
    if T::TERMS <= <f64 as Number>::TERMS { HALF } else { HALF * HALF * 4.0 }
}

/// The sum of products of the first entries.
#[inline]
pub(super) fn dot<T: Number>(a: &Vector<T>, b: &Vector<T>, dimension: usize) -> T {
    let mut sum = a[0] * b[0];
    for (a, b) in a[..dimension].iter().zip(&b[..dimension]).skip(1) {
        sum = sum + *a * *b;
    }
    sum
}

impl<T: Number> Flow<T> {
    /// A mode's closed form from its blocks.
    pub fn of(blocks: &[modal::Block]) -> Self {
        let dimension = blocks.iter().map(|it| it.matrix.len()).sum();
        let mut flow = Self {
            dimension,
            blocks: Vec::new(),
            to_modal: Vec::new(),
            to_modal_rounded: Vec::new(),
            from_modal: Vec::new(),
        };
        for row in 0..dimension {
            let entries = blocks.iter().flat_map(|it| it.columns[row].iter().cloned());
            flow.from_modal.push(vector(&entries.collect::<Vec<_>>()));
        }
        for block in blocks {
            let at = flow.to_modal.len();
            flow.to_modal.extend(block.rows.iter().map(|row| vector(row)));
            flow.blocks.push(Block::of(block, at));
        }
        let rounded = |row: &Vector<T>| row.map(Number::to_f64);
        flow.to_modal_rounded = flow.to_modal.iter().map(rounded).collect();
        flow
    }

    /// A row of z in modal co-ordinates.
    pub fn row(&self, row: &Row, blocks: &[modal::Block]) -> ModalRow<T> {
        let row: Vec<Real> = row.iter().map(Real::of).collect();
        let parts: Vec<_> = blocks.iter().map(|block| bound::derivatives(&row, block)).collect();
        let order = |k: usize| {
            let entries: Vec<_> = parts.iter().flat_map(|part| part[k].iter().cloned()).collect();
            vector(&entries)
        };
        let orders: Vec<Vector<T>> = (0..ORDERS).map(order).collect();
        let norms: Vec<_> =
            blocks.iter().zip(&parts).map(|(block, part)| bound::norms(block, part)).collect();
        let sizes = orders[0].map(|it| it.to_f64().abs());
        let seen = norms.iter().enumerate().filter(|(_, it)| it.iter().any(|it| *it > 0.0));
        let blocks = seen.fold(0, |mask, (n, _)| mask | 1 << n);
        ModalRow { orders, sizes, norms, blocks }
    }

    /// The modal co-ordinates of a state.
    pub fn modal(&self, z: &Vector<T>) -> Vector<T> {
        self.times(&self.to_modal, z)
    }

    /// The state with these modal co-ordinates.
    pub fn state(&self, y: &Vector<T>) -> Vector<T> {
        self.times(&self.from_modal, y)
    }

    fn times(&self, rows: &[Vector<T>], vector: &Vector<T>) -> Vector<T> {
        let mut product = [T::zero(); LARGEST_DIMENSION];
        for (entry, row) in product.iter_mut().zip(rows) {
            *entry = dot(row, vector, self.dimension);
        }
        product
    }

    /// The sizes of what each entry of the state is summed from.
    pub fn sizes(&self, y: &Vector<T>) -> [f64; LARGEST_DIMENSION] {
        let mut sizes = [0.0; LARGEST_DIMENSION];
        for (size, row) in sizes.iter_mut().zip(&self.from_modal) {
            *size = row.iter().zip(y).map(|(a, b)| (a.to_f64() * b.to_f64()).abs()).sum();
        }
        sizes
    }

    /// The modal co-ordinates a time later.
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

    /// The norms of each block's co-ordinates.
    #[inline]
    pub fn norms<U: Number>(&self, y: &Vector<U>) -> Vector<f64> {
        let mut norms = [0.0; LARGEST_DIMENSION];
        for (norm, block) in norms.iter_mut().zip(&self.blocks) {
            *norm = match &y[block.at..block.at + block.size] {
                [one] => one.to_f64().abs(),
                many => many.iter().map(|it| it.to_f64() * it.to_f64()).sum::<f64>().sqrt(),
            };
        }
        norms
    }

    /// The modal co-ordinates of an error, in f64.
    pub fn modal_rounded(&self, z: &Vector<f64>) -> Vector<f64> {
        let mut product = [0.0; LARGEST_DIMENSION];
        for (entry, row) in product.iter_mut().zip(&self.to_modal_rounded) {
            *entry = dot(row, z, self.dimension);
        }
        product
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
    pub fn bound<U: Number>(
        &self,
        row: &ModalRow<T>,
        order: usize,
        y: &Vector<U>,
        length: f64,
    ) -> f64 {
        self.bound_by(row, order, &self.norms(y), length)
    }

    /// The same, from the norms of the blocks' co-ordinates.
    #[inline]
    pub fn bound_by(
        &self,
        row: &ModalRow<T>,
        order: usize,
        sizes: &Vector<f64>,
        length: f64,
    ) -> f64 {
        let parts = self.blocks.iter().zip(&row.norms).zip(sizes);
        let parts =
            parts.map(|((block, norms), size)| block.later.bound(norms, order, length) * size);
        parts.sum::<f64>() * (1.0 + 1e-12)
    }

    /// How long a bound may be asked for: a growing block grows by at most e.
    pub fn longest(&self) -> f64 {
        let rate =
            |block: &Block<T>| if let Later::Growing(rate) = block.later { rate } else { 0.0 };
        1.0 / self.blocks.iter().map(rate).fold(0.0, f64::max)
    }

    /// The largest growth rate of a block.
    pub fn fastest_growth(&self) -> f64 {
        self.blocks.iter().fold(0.0, |most: f64, block| most.max(block.growth))
    }
}

impl<T: Number> ModalRow<T> {
    /// The sum of the sizes of what the row's value is summed from.
    pub fn size(&self, y: &Vector<T>, dimension: usize) -> f64 {
        let terms = self.sizes[..dimension].iter().zip(y);
        terms.map(|(size, entry)| size * entry.to_f64().abs()).sum()
    }

    /// The sizes of what a derivative is summed from.
    pub fn size_of(&self, order: usize, y: &Vector<T>, dimension: usize) -> f64 {
        let terms = self.orders[order][..dimension].iter().zip(y);
        terms.map(|(factor, entry)| (factor.to_f64() * entry.to_f64()).abs()).sum()
    }
}

impl<T: Number> Block<T> {
    fn of(block: &modal::Block, at: usize) -> Self {
        let motion = BlockMotion::of(block);
        let (growth, later) = (bound::growth(block), Later::of(block));
        Self { at, size: block.matrix.len(), motion, growth, later }
    }
}
