//! Arrays of numbers, as a verb gives them at one point of a sweep.

use serde::{Deserialize, Serialize};

/// A named array of some shape, last index fastest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Array {
    /// The name, which is the entry's in the archive.
    pub name: String,
    /// The length along each dimension; empty for a single number.
    pub shape: Vec<usize>,
    /// The numbers.
    pub values: ArrayValues,
}

/// The numbers of an array.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ArrayValues {
    /// Numbers; a NaN where there is none.
    F8(Vec<f64>),
    /// Integers; -1 where there is none.
    I4(Vec<i32>),
    /// The bytes of a text; a space where there is none.
    U1(Vec<u8>),
}

impl Array {
    /// An array of numbers.
    #[must_use]
    pub fn f8(name: &str, shape: &[usize], values: Vec<f64>) -> Self {
        Self { name: name.to_owned(), shape: shape.to_vec(), values: ArrayValues::F8(values) }
    }

    /// An array of integers.
    #[must_use]
    pub fn i4(name: &str, shape: &[usize], values: Vec<i32>) -> Self {
        Self { name: name.to_owned(), shape: shape.to_vec(), values: ArrayValues::I4(values) }
    }

    /// A text.
    #[must_use]
    pub fn text(name: &str, bytes: Vec<u8>) -> Self {
        Self { name: name.to_owned(), shape: vec![bytes.len()], values: ArrayValues::U1(bytes) }
    }
}

/// The place of every value of a small array within a larger one: none of those that are padding.
///
/// Both shapes have as many dimensions, and the small one is nowhere longer.
pub(super) fn places(small: &[usize], large: &[usize]) -> impl Iterator<Item = Option<usize>> {
    let count = large.iter().product();
    let (small, large) = (small.to_vec(), large.to_vec());
    (0..count).map(move |flat| {
        let (mut rest, mut place, mut stride) = (flat, 0, 1);
        for (have, length) in small.iter().zip(&large).rev() {
            let index = rest % length;
            if index >= *have {
                return None;
            }
            (rest, place, stride) = (rest / length, place + index * stride, stride * have);
        }
        Some(place)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padding_goes_to_the_end_of_each_dimension() {
        let found: Vec<_> = places(&[2, 2], &[3, 3]).collect();
        let expected = [Some(0), Some(1), None, Some(2), Some(3), None, None, None, None].to_vec();
        assert_eq!(found, expected);
        assert_eq!(places(&[], &[]).collect::<Vec<_>>(), [Some(0)]);
        assert_eq!(places(&[0, 3], &[1, 3]).collect::<Vec<_>>(), [None; 3]);
    }
}
