//! The closed form of a mode: z(t) = exp(M t) z, block by block.

use super::bound::BlockGrowth;
use super::modal_state::ModalState;
use super::motion::BlockMotion;
use crate::affine::arithmetic::real::BigReal;
use crate::affine::arithmetic::vector::{Entry, Vector, add_product, euclidean, norm, vector};
use crate::affine::modal;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number, ScaledF64};
use std::ops::Range;

/// A mode's closed form.
#[derive(Clone, Debug)]
pub struct ModeFlow<T: Number> {
    pub dimension: usize,
    pub blocks: Vec<FlowBlock<T>>,
    /// The co-ordinates whose norms are kept: those of each block, then parts of blocks.
    pub subspaces: Vec<Subspace>,
    /// The longest time for which bounds are asked: a growing block grows by at most e in it.
    pub longest: f64,
    /// The largest speed of the blocks ([`modal::Block::speed`]).
    pub speed: f64,
    /// The matrix W of all blocks, by columns.
    to_modal: Vec<Vector<T>>,
    /// The matrix W of all blocks, rounded to the digits of bounds, by columns; and the sizes of
    /// its entries.
    to_modal_rounded: Vec<Vector<T::Bound>>,
    to_modal_sizes: Vec<Vector<T::Bound>>,
    /// The first co-ordinate of each block that rotates.
    turning: Vec<usize>,
    /// The matrix X of all blocks, by columns.
    from_modal: Vec<Vector<T>>,
    /// Bounds of the errors of the entries of X and of W, by columns.
    errors: [Vec<Vector<T::Bound>>; 2],
}

/// Modal co-ordinates that move by themselves: all of a block, or its last ones where these do not
/// depend on those before them.
#[derive(Clone, Debug, PartialEq)]
pub struct Subspace {
    /// The block's index.
    pub block: usize,
    /// The indices of the co-ordinates.
    pub range: Range<usize>,
}

/// A block of modal co-ordinates, which move independently of other blocks.
#[derive(Clone, Debug)]
pub struct FlowBlock<T: Number> {
    pub at: usize,
    pub size: usize,
    /// The block's speed ([`modal::Block::speed`]).
    speed: f64,
    pub(super) motion: BlockMotion<T>,
    /// How the block's parts in rows may grow.
    pub growth: BlockGrowth,
}

impl<T: Number> ModeFlow<T> {
    /// A mode's closed form from its blocks.
    pub fn new(blocks: &[modal::Block]) -> Self {
        let dimension = blocks.iter().map(|it| it.matrix.len()).sum();
        let mut flow = Self {
            dimension,
            blocks: Vec::new(),
            subspaces: subspaces(blocks),
            longest: f64::INFINITY,
            speed: 0.0,
            to_modal: Vec::new(),
            to_modal_rounded: Vec::new(),
            to_modal_sizes: Vec::new(),
            turning: Vec::new(),
            from_modal: Vec::new(),
            errors: [Vec::new(), Vec::new()],
        };
        let (mut to_modal, mut errors) = (Vec::new(), Vec::new());
        for block in blocks {
            flow.from_modal.extend(transposed(&block.columns));
            let at = to_modal.len();
            to_modal.extend(block.rows.iter().cloned());
            let [columns, rows] = &block.errors;
            flow.errors[0].extend(by_columns(columns));
            errors.extend(rows.iter().cloned());
            flow.blocks.push(FlowBlock::new(block, at));
        }
        let rate = |block: &FlowBlock<T>| {
            if let BlockGrowth::Growing(rate) = block.growth { rate } else { 0.0 }
        };
        flow.speed = flow.blocks.iter().map(|it| it.speed).fold(0.0, f64::max);
        flow.longest = 1.0 / flow.blocks.iter().map(rate).fold(0.0, f64::max);
        flow.to_modal = transposed(&to_modal);
        flow.errors[1] = by_columns(&errors);
        let rounded = |row: &Vector<T>| row.map(Number::bound);
        flow.to_modal_rounded = flow.to_modal.iter().map(rounded).collect();
        let sizes = |row: &Vector<T::Bound>| row.map(Bound::abs);
        flow.to_modal_sizes = flow.to_modal_rounded.iter().map(sizes).collect();
        let turns = |it: &&FlowBlock<T>| matches!(it.motion, BlockMotion::Pair { .. });
        flow.turning = flow.blocks.iter().filter(turns).map(|it| it.at).collect();
        flow
    }

    /// The modal co-ordinates of a state, without their sizes.
    #[inline]
    pub fn co_ordinates(&self, z: &Vector<T>) -> Vector<T> {
        times(&self.to_modal, z)
    }

    /// The modal co-ordinates of a state, with their sizes.
    #[inline]
    pub fn modal(&self, z: &Vector<T>) -> ModalState<T> {
        let mut modal = ModalState::default();
        self.set_modal(&mut modal, z);
        modal
    }

    /// Overwrites modal co-ordinates by those of a state.
    #[inline]
    pub fn set_modal(&self, modal: &mut ModalState<T>, z: &Vector<T>) {
        match self.dimension {
            0..=4 => self.set_modal_in::<4>(modal, z),
            5..=8 => self.set_modal_in::<8>(modal, z),
            _ => self.set_modal_in::<LARGEST_DIMENSION>(modal, z),
        }
        for at in &self.turning {
            let norm = modal.sizes[*at] + modal.sizes[at + 1];
            (modal.sizes[*at], modal.sizes[at + 1]) = (norm, norm);
        }
    }

    #[inline(always)]
    fn set_modal_in<const ROWS: usize>(&self, modal: &mut ModalState<T>, z: &Vector<T>) {
        let (mut sums, mut sizes) = ([T::zero(); ROWS], [T::Bound::ZERO; ROWS]);
        for ((column, own), entry) in self.to_modal.iter().zip(&self.to_modal_sizes).zip(z) {
            add_product(&mut sums, column, *entry);
            add_product(&mut sizes, own, entry.bound().abs());
        }
        modal.y[..ROWS].copy_from_slice(&sums);
        modal.sizes[..ROWS].copy_from_slice(&sizes);
    }

    /// Modal co-ordinates whose sizes are their own, because no rounding error is counted so far.
    #[inline]
    pub fn exact(&self, y: &Vector<T>) -> ModalState<T> {
        let mut modal = ModalState { y: *y, sizes: y.map(|it| it.bound().abs()) };
        for at in &self.turning {
            let norm = euclidean(modal.sizes[*at..at + 2].iter().copied());
            modal.sizes[*at..at + 2].fill(norm);
        }
        modal
    }

    /// Modal co-ordinates whose sizes are their own, but for blocks that are polynomials of the
    /// time: their rounding errors so far are counted.
    pub fn polynomial_sizes(&self, modal: &ModalState<T>) -> ModalState<T> {
        let mut own = self.exact(&modal.y);
        for block in self.blocks.iter().filter(|it| it.growth == BlockGrowth::Polynomial) {
            own.sizes[block.range()].copy_from_slice(&modal.sizes[block.range()]);
        }
        own
    }

    /// The state with these modal co-ordinates.
    #[inline]
    pub fn state(&self, y: &Vector<T>) -> Vector<T> {
        times(&self.from_modal, y)
    }

    /// For each entry of a state, the sum of the sizes of its terms, from the sizes of the modal
    /// co-ordinates.
    pub fn sizes(&self, y: &Vector<T::Bound>) -> Vector<T::Bound> {
        let mut sizes = [T::Bound::ZERO; LARGEST_DIMENSION];
        for (column, entry) in self.from_modal.iter().zip(y) {
            let terms = column.iter().map(|it| (it.bound() * *entry).abs());
            sizes.iter_mut().zip(terms).for_each(|(size, term)| *size += term);
        }
        sizes
    }

    /// Bounds of the errors that the error of the matrix X makes in the entries of a state, from
    /// the sizes of its modal co-ordinates.
    pub fn state_errors(&self, y: &Vector<T::Bound>) -> Vector<T::Bound> {
        times(&self.errors[0], y)
    }

    /// Bounds of the rounding errors of a state's modal co-ordinates, each as the state that
    /// belongs to it.
    pub fn entry_roundings(&self, z: &Vector<T>) -> Vec<Vector<T::Bound>> {
        let margin = T::unit() * (self.dimension + 2) as f64;
        let error = |(n, column): (usize, &Vector<T>)| {
            let terms = self.to_modal.iter().zip(z).map(|(it, z)| (it[n].bound(), z.bound()));
            let size: T::Bound = terms.map(|(factor, entry)| (factor * entry).abs()).sum();
            let errors = self.errors[1].iter().zip(z).map(|(it, z)| it[n] * z.bound().abs());
            let error = margin * size + errors.sum::<T::Bound>();
            column.map(|entry| error * entry.bound())
        };
        self.from_modal.iter().enumerate().map(error).collect()
    }

    /// The modal co-ordinates a time later.
    #[inline]
    pub fn at(&self, modal: &ModalState<T>, time: T) -> ModalState<T> {
        let mut later = *modal;
        self.advance(&mut later, time, u16::MAX);
        later
    }

    /// Advances the co-ordinates of these blocks.
    #[inline]
    pub fn advance(&self, ModalState { y, sizes }: &mut ModalState<T>, time: T, blocks: u16) {
        for (n, block) in self.blocks.iter().enumerate() {
            if blocks >> n & 1 == 1 {
                block.motion.advance(block.range(), y, sizes, time);
            }
        }
    }

    /// The state a short time after these modal co-ordinates, by one of their derivatives or two
    /// where the third is less than rounding.
    ///
    /// Blocks that move so fast that they are others by then stay as they are: the time is below
    /// the rounding of the time at which they are known.
    #[inline]
    pub fn state_shortly_after(&self, mut modal: ModalState<T>, time: T) -> Vector<T> {
        for (n, block) in self.blocks.iter().enumerate() {
            // The powers of a short turn may be less than any f64.
            let turn = time.bound().abs() * block.speed;
            let derivatives = match [turn * turn, turn * turn * turn] {
                [square, _] if T::unit() * 0.25 >= square => 1,
                [_, cube] if T::unit() * 0.25 >= cube => 2,
                _ if turn <= 1.0 => {
                    self.advance(&mut modal, time, 1 << n);
                    continue;
                }
                _ => continue,
            };
            block.motion.taylor_step(&mut modal.y[block.range()], derivatives, time);
        }
        self.state(&modal.y)
    }

    /// The norms of the co-ordinates of each of `subspaces`.
    #[inline]
    pub fn norms(&self, y: &Vector<T>) -> Vector<T::Bound> {
        let mut norms = [T::Bound::ZERO; LARGEST_DIMENSION];
        self.set_norms(&mut norms, y);
        norms
    }

    /// Overwrites the norms of the co-ordinates of each of `subspaces`; entries beyond them stay.
    #[inline]
    pub fn set_norms(&self, norms: &mut Vector<T::Bound>, y: &Vector<T>) {
        for (place, subspace) in norms.iter_mut().zip(&self.subspaces) {
            *place = norm(&y[subspace.range.clone()]);
        }
    }

    /// The norms of sizes or errors in each of `subspaces`.
    pub fn norms_of_bounds(&self, sizes: &Vector<T::Bound>) -> Vector<T::Bound> {
        let mut norms = [T::Bound::ZERO; LARGEST_DIMENSION];
        for (place, subspace) in norms.iter_mut().zip(&self.subspaces) {
            *place = euclidean(sizes[subspace.range.clone()].iter().copied());
        }
        norms
    }

    /// Norms of errors in each of `subspaces`, a time later at most, but for what
    /// [`ModalRow::bound`](crate::affine::guards::row::ModalRow::bound) adds.
    pub fn decayed(&self, norms: &Vector<T::Bound>, time: f64) -> Vector<T::Bound> {
        let mut later = *norms;
        for (norm, subspace) in later.iter_mut().zip(&self.subspaces) {
            *norm *= self.blocks[subspace.block].motion.decay(time);
        }
        later
    }

    /// Bounds of the errors that underflow makes in each of `subspaces`: none in zeros.
    pub fn underflow(&self, y: &Vector<T>) -> Vector<T::Bound> {
        let lost = |norm: T::Bound| match norm > 0.0 {
            true => T::Bound::UNDERFLOW * 4.0 * (T::Bound::from_f64(1.0) + norm),
            false => T::Bound::ZERO,
        };
        self.norms(y).map(lost)
    }

    /// The modal co-ordinates of an error.
    pub fn modal_rounded(&self, z: &Vector<T::Bound>) -> Vector<T::Bound> {
        times(&self.to_modal_rounded, z)
    }

    /// The sums of the terms' sizes in [`modal_rounded`](Self::modal_rounded), for entries of at
    /// most these sizes.
    pub fn modal_sizes(&self, z: &Vector<T::Bound>) -> Vector<T::Bound> {
        let sizes = |column: &Vector<T::Bound>| column.map(Bound::abs);
        times(&self.to_modal_rounded.iter().map(sizes).collect::<Vec<_>>(), z)
    }

    /// The columns of exp(M t), rounded to the digits of bounds.
    pub fn transition(&self, time: T) -> Vec<Vector<T::Bound>> {
        let column = |n: usize| {
            let mut unit = [T::zero(); LARGEST_DIMENSION];
            unit[n] = T::one();
            self.state(&self.at(&self.modal(&unit), time).y).map(Number::bound)
        };
        (0..self.dimension).map(column).collect()
    }
}

impl<T: Number> FlowBlock<T> {
    /// The indices of the block's co-ordinates.
    #[inline]
    pub fn range(&self) -> Range<usize> {
        self.at..self.at + self.size
    }

    fn new(block: &modal::Block, at: usize) -> Self {
        let motion = BlockMotion::new(block, at);
        let (size, growth) = (block.matrix.len(), BlockGrowth::new(block));
        Self { at, size, speed: block.speed(), motion, growth }
    }
}

/// The subspaces of blocks: each block, then the last co-ordinates of blocks that are triangular
/// there, but for polynomials, whose high derivatives are zero. Their number is at most that of all
/// co-ordinates.
fn subspaces(blocks: &[modal::Block]) -> Vec<Subspace> {
    let mut end = 0;
    let mut whole = Vec::new();
    for (block, it) in blocks.iter().enumerate() {
        let range = end..end + it.matrix.len();
        end = range.end;
        whole.push(Subspace { block, range });
    }
    let parts = |Subspace { block, range }: &Subspace| {
        let (block, Range { start, end }) = (*block, range.clone());
        let own = &blocks[block];
        let is_kept = BlockGrowth::new(own) != BlockGrowth::Polynomial;
        let first = (1..range.len()).filter(|first| is_kept && own.moves_alone_from(*first));
        first.map(move |first| Subspace { block, range: start + first..end }).collect::<Vec<_>>()
    };
    let parts: Vec<_> = whole.iter().flat_map(parts).collect();
    whole.extend(parts);
    whole
}

/// The product of a matrix, given by its columns, with a vector; entries beyond its rows are zero.
#[inline]
fn times<E: Entry>(columns: &[Vector<E>], vector: &Vector<E>) -> Vector<E> {
    match columns.len() {
        0..=4 => times_in::<E, 4>(columns, vector),
        5..=8 => times_in::<E, 8>(columns, vector),
        _ => times_in::<E, LARGEST_DIMENSION>(columns, vector),
    }
}

/// The first `ROWS` entries of the product of a matrix, by columns, and a vector.
#[inline]
fn times_in<E: Entry, const ROWS: usize>(columns: &[Vector<E>], vector: &Vector<E>) -> Vector<E> {
    let mut sums = [E::default(); ROWS];
    for (n, column) in columns.iter().enumerate() {
        let factor = vector[n];
        add_product(&mut sums, column, factor);
    }
    let mut product = [E::default(); LARGEST_DIMENSION];
    product[..ROWS].copy_from_slice(&sums);
    product
}

/// A matrix of bounds by columns.
fn by_columns<B: Bound>(matrix: &[Vec<ScaledF64>]) -> Vec<Vector<B>> {
    let columns = matrix.first().map_or(0, Vec::len);
    let mut all = vec![[B::ZERO; LARGEST_DIMENSION]; columns];
    for (n, row) in matrix.iter().enumerate() {
        all.iter_mut().zip(row).for_each(|(column, entry)| column[n] = entry.rounded());
    }
    all
}

fn transposed<T: Number>(matrix: &[Vec<BigReal>]) -> Vec<Vector<T>> {
    let columns = matrix.first().map_or(0, Vec::len);
    let column = |n: usize| vector(&matrix.iter().map(|row| row[n].clone()).collect::<Vec<_>>());
    (0..columns).map(column).collect()
}
