//! Numbers side by side whose count is known when a system is read: no memory is asked for, and no
//! library sees more of them than the system has.

use crate::equations::Numbers;
use std::ops::{Deref, DerefMut};

/// The most states of a system.
pub const MAX_STATES: usize = 11;
/// The most guards of a mode; a guard that is watched in both directions is two. The format accepts
/// more: here they are copied with every look at them.
pub const MAX_GUARDS: usize = 24;

/// A list of at most `MOST` numbers, without an allocation.
#[derive(Clone, Copy, PartialEq)]
pub struct Inline<const MOST: usize> {
    count: usize,
    /// The numbers; those past `count` are zero.
    values: [f64; MOST],
}

/// The states of a system.
pub type Values = Inline<MAX_STATES>;

/// The guards of a mode.
pub type Guards = Inline<MAX_GUARDS>;

impl<const MOST: usize> Numbers for Inline<MOST> {
    /// These numbers, of which those past the most are left out.
    fn from_slice(values: &[f64]) -> Self {
        let count = values.len().min(MOST);
        let mut all = Self::all(count, 0.0);
        all.copy_from_slice(&values[..count]);
        all
    }

    fn all(count: usize, value: f64) -> Self {
        let count = count.min(MOST);
        let mut values = [0.0; MOST];
        values[..count].fill(value);
        Self { count, values }
    }
}

impl<const MOST: usize> Default for Inline<MOST> {
    fn default() -> Self {
        Self::all(0, 0.0)
    }
}

impl<const MOST: usize> std::fmt::Debug for Inline<MOST> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.deref().fmt(f)
    }
}

impl<const MOST: usize> Deref for Inline<MOST> {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

impl<const MOST: usize> DerefMut for Inline<MOST> {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[..self.count]
    }
}

impl<const MOST: usize> AsRef<[f64]> for Inline<MOST> {
    fn as_ref(&self) -> &[f64] {
        self
    }
}

impl<const MOST: usize> AsMut<[f64]> for Inline<MOST> {
    fn as_mut(&mut self) -> &mut [f64] {
        self
    }
}
