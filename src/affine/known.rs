//! What runs have learned of a system's graph of structural zeros, kept for the runs that follow.

use super::structure::Structure;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex};

/// How many graphs are kept: one for each thread that runs the system.
const MOST: usize = 64;

/// Graphs that no run uses now.
#[derive(Clone, Debug)]
pub(super) struct Known {
    /// The graph that nothing has been learned of.
    blank: Structure,
    learned: Arc<Mutex<Vec<Structure>>>,
}

/// A graph that a run uses, and gives back.
#[derive(Debug)]
pub(super) struct Loan<'a> {
    own: Structure,
    known: &'a Known,
}

impl Known {
    pub fn of(blank: Structure) -> Self {
        Self { blank, learned: Arc::default() }
    }

    /// A graph for a run.
    pub fn lend(&self) -> Loan<'_> {
        let learned = self.learned.lock().ok().and_then(|mut all| all.pop());
        Loan { own: learned.unwrap_or_else(|| self.blank.clone()), known: self }
    }
}

impl Drop for Loan<'_> {
    fn drop(&mut self) {
        if let Ok(mut all) = self.known.learned.lock()
            && all.len() < MOST
        {
            all.push(std::mem::take(&mut self.own));
        }
    }
}

impl Deref for Loan<'_> {
    type Target = Structure;
    #[inline]
    fn deref(&self) -> &Structure {
        &self.own
    }
}

impl DerefMut for Loan<'_> {
    #[inline]
    fn deref_mut(&mut self) -> &mut Structure {
        &mut self.own
    }
}
