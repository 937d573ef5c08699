//! Modal co-ordinates, with the sizes to which their rounding errors are proportional.

use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::system::LARGEST_DIMENSION;
use crate::numeric::number::{Bound, Number};

/// Modal co-ordinates, and the sizes of what each is summed from: what rounding may do to it is
/// proportional to that, and terms may cancel.
#[derive(Clone, Copy, Debug)]
pub struct ModalState<T: Number> {
    pub y: Vector<T>,
    pub sizes: Vector<T::Bound>,
}

impl<T: Number> ModalState<T> {
    /// Takes over the co-ordinates of another one of this dimension.
    #[inline(always)]
    pub fn copy(&mut self, other: &Self, dimension: usize) {
        match dimension {
            0..=4 => self.copy_in::<4>(other),
            5..=8 => self.copy_in::<8>(other),
            _ => *self = *other,
        }
    }

    #[inline(always)]
    fn copy_in<const ROWS: usize>(&mut self, other: &Self) {
        self.y[..ROWS].copy_from_slice(&other.y[..ROWS]);
        self.sizes[..ROWS].copy_from_slice(&other.sizes[..ROWS]);
    }
}

impl<T: Number> Default for ModalState<T> {
    #[inline]
    fn default() -> Self {
        Self { y: [T::zero(); LARGEST_DIMENSION], sizes: [T::Bound::ZERO; LARGEST_DIMENSION] }
    }
}
