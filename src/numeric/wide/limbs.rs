//! Arithmetic of words of 64 bits, the lowest first.

use std::cmp::Ordering;

/// The order of two numbers of as many words.
pub fn compare(a: &[u64], b: &[u64]) -> Ordering {
    a.iter().rev().cmp(b.iter().rev())
}

/// Adds a number of no more words; whether a carry is left.
pub fn add_into(sum: &mut [u64], other: &[u64]) -> bool {
    let mut carry = false;
    for (n, word) in sum.iter_mut().enumerate() {
        let Some(add) = other.get(n) else {
            if !carry {
                return false;
            }
            (*word, carry) = word.overflowing_add(1);
            continue;
        };
        let (first, over) = word.overflowing_add(*add);
        let (second, again) = first.overflowing_add(u64::from(carry));
        (*word, carry) = (second, over || again);
    }
    carry
}

/// Subtracts a number that is not larger.
pub fn subtract_from(difference: &mut [u64], other: &[u64]) {
    let mut borrow = false;
    for (word, less) in difference.iter_mut().zip(other) {
        let (first, under) = word.overflowing_sub(*less);
        let (second, again) = first.overflowing_sub(u64::from(borrow));
        (*word, borrow) = (second, under || again);
    }
}

/// Shifts to the left by less bits than there are zeros at the top.
pub fn shifted_left(words: &mut [u64], bits: usize) {
    let (whole, rest) = (bits / 64, bits % 64);
    for n in (0..words.len()).rev() {
        let word = |at: Option<usize>| at.map_or(0, |at| words[at]);
        let (high, low) = (word(n.checked_sub(whole)), word(n.checked_sub(whole + 1)));
        words[n] = if rest == 0 { high } else { high << rest | low >> (64 - rest) };
    }
}

/// Shifts to the right; what falls out is lost.
pub fn shifted_right(words: &mut [u64], bits: usize) {
    let (whole, rest) = (bits / 64, bits % 64);
    for n in 0..words.len() {
        let word = |at: usize| words.get(at).copied().unwrap_or(0);
        let (low, high) = (word(n + whole), word(n + whole + 1));
        words[n] = if rest == 0 { low } else { low >> rest | high << (64 - rest) };
    }
}

/// The highest words of the product of two numbers of as many words, two more than each has; of
/// what is below them the highest word alone is counted.
pub fn high_product(a: &[u64], b: &[u64], product: &mut [u64]) {
    // Columns of the whole product from this one on are summed.
    let lowest = (2 * a.len() - product.len()).saturating_sub(1);
    let mut carried = 0_u128;
    for sum in lowest..2 * a.len() {
        let (mut low, mut high) = (carried, 0);
        let from = (sum + 1).saturating_sub(b.len());
        for k in from..a.len().min(sum + 1) {
            let term = u128::from(a[k]) * u128::from(b[sum - k]);
            low += u128::from(term as u64);
            high += term >> 64;
        }
        if let Some(place) = (sum + product.len()).checked_sub(2 * a.len()) {
            product[place] = low as u64;
        }
        carried = high + (low >> 64);
    }
}

/// Multiplies a fraction by a word, and forgets what is beyond its top.
pub fn times_word(words: &mut [u64], factor: u64) {
    let mut carried = 0_u128;
    for word in words {
        carried += u128::from(*word) * u128::from(factor);
        *word = carried as u64;
        carried >>= 64;
    }
}

/// Divides by a word that is not zero, and forgets what is left.
pub fn quotient_by_word(words: &mut [u64], divisor: u64) {
    let mut rest = 0_u128;
    for word in words.iter_mut().rev() {
        let whole = rest << 64 | u128::from(*word);
        *word = (whole / u128::from(divisor)) as u64;
        rest = whole % u128::from(divisor);
    }
}
