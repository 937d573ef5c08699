//! The closed form of a mode: z(t) = exp(M t) z, block by block.

use super::modal::{self, Kind, Real};
use super::system::{LARGEST_DIMENSION, Row};
use crate::number::Number;

/// The entries of z, or of the modal co-ordinates; those beyond the dimension are zero.
pub(super) type Vector<T> = [T; LARGEST_DIMENSION];

/// How many derivatives of a row are held, its value included.
pub(super) const ORDERS: usize = 17;

/// A number in two words of an arithmetic.
#[derive(Clone, Copy, Debug)]
struct Words<T> {
    high: T,
    low: T,
}

/// A mode's closed form.
#[derive(Clone, Debug)]
pub(super) struct Flow<T> {
    pub dimension: usize,
    blocks: Vec<Block<T>>,
    /// W of all blocks.
    to_modal: Vec<Vector<T>>,
    /// W of all blocks, rounded to f64.
    to_modal_rounded: Vec<Vector<f64>>,
    /// X of all blocks.
    from_modal: Vec<Vector<T>>,
}

#[derive(Clone, Debug)]
struct Block<T> {
    at: usize,
    size: usize,
    motion: BlockMotion<T>,
    /// A bound of the rate at which a vector of it grows, not negative.
    growth: f64,
}

#[derive(Clone, Debug)]
enum BlockMotion<T> {
    Still,
    Real { rate: Words<T> },
    Pair { rate: Option<Words<T>>, frequency: Words<T> },
    Nilpotent { rate: Option<Words<T>>, matrix: Vec<Vector<T>> },
    Cluster(Box<Powers<T>>),
}

/// exp(B t) by tables: t = step (d_0 + 16 d_1 + ...) + rest.
#[derive(Clone, Debug)]
struct Powers<T> {
    step: f64,
    /// exp(B step 16^j d) for d from 1 to 15.
    tables: Vec<Vec<Vec<Vector<T>>>>,
    matrix: Vec<Vector<T>>,
}

/// A row of z with its derivatives, in modal co-ordinates.
#[derive(Clone, Debug)]
pub(super) struct ModalRow<T> {
    /// The row's derivatives.
    pub orders: Vec<Vector<T>>,
    /// The sizes of the entries of the row itself.
    sizes: [f64; LARGEST_DIMENSION],
    /// The norms of the derivatives' parts that belong to each block.
    norms: Vec<[f64; ORDERS]>,
}

/// The distance from 1 to the next smaller number of an arithmetic.
pub(super) fn unit<T: Number>() -> f64 {
    const HALF: f64 = 0.5 * f64::EPSILON;
    // Double-double arithmetic is good to a few units of 2^-106.
    if T::TERMS <= <f64 as Number>::TERMS { HALF } else { HALF * HALF * 4.0 }
}

/// A wide number, rounded to an arithmetic of one or two words.
pub(super) fn rounded<T: Number>(value: &Real) -> T {
    let (high, low) = value.words();
    T::exact(high) + T::exact(low)
}

fn words<T: Number>(value: &Real) -> Words<T> {
    let high: T = rounded(value);
    // What is left beyond an arithmetic of two words is not resolved by it either.
    let rest = if unit::<T>() > 1e-20 { value.words().1 } else { 0.0 };
    Words { high, low: T::exact(rest) }
}

fn nonzero<T: Number>(value: &Real) -> Option<Words<T>> {
    (!value.is_zero()).then(|| words(value))
}

fn vector<T: Number>(row: &[Real]) -> Vector<T> {
    let mut vector = [T::zero(); LARGEST_DIMENSION];
    for (entry, value) in vector.iter_mut().zip(row) {
        *entry = rounded(value);
    }
    vector
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
        let parts: Vec<_> =
            blocks.iter().map(|block| modal::derivatives(&row, block, ORDERS)).collect();
        let order = |k: usize| {
            let entries: Vec<_> = parts.iter().flat_map(|part| part[k].iter().cloned()).collect();
            vector(&entries)
        };
        let orders: Vec<Vector<T>> = (0..ORDERS).map(order).collect();
        let norm = |part: &Vec<Vec<Real>>, k: usize| {
            let squares = part[k].iter().map(|it| it.to_f64() * it.to_f64());
            squares.sum::<f64>().sqrt() * (1.0 + 1e-12)
        };
        let norms = parts.iter().map(|part| std::array::from_fn(|k| norm(part, k))).collect();
        let sizes = orders[0].map(|it| it.to_f64().abs());
        ModalRow { orders, sizes, norms }
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
        for block in &self.blocks {
            let range = block.at..block.at + block.size;
            block.motion.advance(&mut later[range], time);
        }
        later
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
        let mut sum = 0.0;
        for (block, norms) in self.blocks.iter().zip(&row.norms) {
            if norms[order] == 0.0 {
                continue;
            }
            let own = &y[block.at..block.at + block.size];
            let size = match own {
                [one] => one.to_f64().abs(),
                many => many.iter().map(|it| it.to_f64() * it.to_f64()).sum::<f64>().sqrt(),
            };
            let growth = if block.growth == 0.0 { 1.0 } else { libm::exp(block.growth * length) };
            sum += norms[order] * size * growth;
        }
        sum * (1.0 + 1e-12)
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
        let size = block.matrix.len();
        let motion = match &block.kind {
            Kind::Real(rate) if rate.is_zero() => BlockMotion::Still,
            Kind::Real(rate) => BlockMotion::Real { rate: words(rate) },
            Kind::Pair(rate, frequency) => {
                BlockMotion::Pair { rate: nonzero(rate), frequency: words(frequency) }
            }
            Kind::Nilpotent(rate) => {
                let nilpotent = block.matrix.iter().enumerate().map(|(n, row)| {
                    let mut row = row.clone();
                    row[n] = &row[n] - rate;
                    vector(&row)
                });
                BlockMotion::Nilpotent { rate: nonzero(rate), matrix: nilpotent.collect() }
            }
            Kind::Cluster => BlockMotion::Cluster(Box::new(Powers::of(&block.matrix))),
        };
        Self { at, size, motion, growth: growth(block) }
    }
}

/// A bound of a block's logarithmic norm, not negative: by the rows of its symmetric part.
fn growth(block: &modal::Block) -> f64 {
    if let Kind::Real(rate) | Kind::Pair(rate, _) = &block.kind {
        return rate.to_f64().max(0.0);
    }
    let entry = |i: usize, j: usize| block.matrix[i][j].to_f64();
    let size = block.matrix.len();
    let row = |i: usize| {
        let others = (0..size).filter(|j| *j != i);
        entry(i, i) + others.map(|j| 0.5 * (entry(i, j) + entry(j, i)).abs()).sum::<f64>()
    };
    (0..size).map(row).fold(0.0, f64::max) * (1.0 + 1e-12)
}

impl<T: Number> BlockMotion<T> {
    fn advance(&self, y: &mut [T], time: T) {
        match self {
            Self::Still => {}
            Self::Real { rate } => y[0] = y[0] * exponential(*rate, time),
            Self::Pair { rate, frequency } => {
                let (sin, cos) = circular(*frequency, time);
                let (first, second) = (y[0], y[1]);
                y[0] = cos * first + sin * second;
                y[1] = cos * second - sin * first;
                decay(*rate, time, y);
            }
            Self::Nilpotent { rate, matrix } => {
                let start: Vector<T> = copied(y);
                for k in (1..y.len()).rev() {
                    let factor = time / T::exact(k as f64);
                    step(matrix, factor, &start, y);
                }
                decay(*rate, time, y);
            }
            Self::Cluster(powers) => powers.advance(y, time),
        }
    }
}

/// `y = start + factor * matrix * y`.
fn step<T: Number>(matrix: &[Vector<T>], factor: T, start: &Vector<T>, y: &mut [T]) {
    let last: Vector<T> = copied(y);
    let size = y.len();
    for (n, entry) in y.iter_mut().enumerate() {
        *entry = start[n] + factor * dot(&matrix[n], &last, size);
    }
}

fn copied<T: Number>(y: &[T]) -> Vector<T> {
    let mut copy = [T::zero(); LARGEST_DIMENSION];
    copy[..y.len()].copy_from_slice(y);
    copy
}

fn decay<T: Number>(rate: Option<Words<T>>, time: T, y: &mut [T]) {
    let Some(rate) = rate else { return };
    let factor = exponential(rate, time);
    y.iter_mut().for_each(|entry| *entry = *entry * factor);
}

/// A product with a rate, and what rounding took from it.
fn product<T: Number>(rate: Words<T>, time: T) -> (T, T) {
    let high = rate.high * time;
    (high, rate.high.product_error(time) + rate.low * time)
}

fn exponential<T: Number>(rate: Words<T>, time: T) -> T {
    let (high, low) = product(rate, time);
    let value = high.exp();
    value + value * low
}

fn circular<T: Number>(frequency: Words<T>, time: T) -> (T, T) {
    let (high, low) = product(frequency, time);
    let (sin, cos) = high.sin_cos();
    (sin + low * cos, cos - low * sin)
}

impl<T: Number> Powers<T> {
    /// Tables up to 16^12 steps, beyond any horizon.
    const LEVELS: usize = 12;

    fn of(matrix: &[Vec<Real>]) -> Self {
        let size = modal::norm(matrix);
        let exponent = if size > 0.0 { -libm::ceil(libm::log2(size)) - 1.0 } else { 0.0 };
        let step = libm::exp2(exponent);
        let mut tables = Vec::new();
        let mut first = modal::exponential(matrix, exponent as isize);
        for _ in 0..Self::LEVELS {
            let multiples = modal::multiples(&first, 16);
            let (last, table) = match multiples.split_last() {
                Some(split) => split,
                None => break,
            };
            let rounded = |it: &Vec<Vec<Real>>| it.iter().map(|row| vector(row)).collect();
            tables.push(table.iter().map(rounded).collect());
            first = last.clone();
        }
        Self { step, tables, matrix: matrix.iter().map(|row| vector(row)).collect() }
    }

    fn advance(&self, y: &mut [T], time: T) {
        let size = y.len();
        let steps = libm::floor(time.to_f64() / self.step).max(0.0);
        let rest = time - T::exact(steps * self.step);
        let mut digits = steps as u64;
        for table in &self.tables {
            let digit = (digits & 15) as usize;
            digits >>= 4;
            if digit > 0 {
                let last: Vector<T> = copied(y);
                for (entry, row) in y.iter_mut().zip(&table[digit - 1]) {
                    *entry = dot(row, &last, size);
                }
            }
            if digits == 0 {
                break;
            }
        }
        let start: Vector<T> = copied(y);
        // With |B rest| below 1/2 the terms beyond fall under the last digit.
        for k in (1..2 * T::TERMS).rev() {
            step(&self.matrix, rest / T::exact(k as f64), &start, y);
        }
    }
}
