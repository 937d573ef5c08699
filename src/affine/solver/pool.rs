//! What runs have learned of a system, kept for the runs that follow: its graph of structural
//! zeros, and the starts that they had.

use super::start_cache::{RunStart, Starts};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::zeros::graph::Structure;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex};

/// How many graphs are kept: one for each thread that runs the system.
const MOST: usize = 64;

/// What runs have learned and no run uses at present.
#[derive(Clone, Debug)]
pub struct Known<T> {
    /// The graph that nothing has been learned of.
    blank: Structure,
    learned: Arc<Mutex<Vec<Learned<T>>>>,
}

/// What the runs of one thread have learned.
#[derive(Clone, Debug)]
struct Learned<T> {
    structure: Structure,
    starts: Starts<T>,
}

/// The graph that a run uses, and gives back.
#[derive(Debug)]
pub struct Loan<'a, T> {
    own: Learned<T>,
    known: &'a Known<T>,
}

impl<T> Known<T> {
    pub fn of(blank: Structure) -> Self {
        Self { blank, learned: Arc::default() }
    }

    /// A graph for a run.
    pub fn lend(&self) -> Loan<'_, T> {
        let learned = self.learned.lock().ok().and_then(|mut all| all.pop());
        let blank = || Learned { structure: self.blank.clone(), starts: Starts::default() };
        Loan { own: learned.unwrap_or_else(blank), known: self }
    }
}

impl<T: Copy> Loan<'_, T> {
    /// What a run begins with, as [`Starts::begun`] has it.
    pub fn begun(
        &mut self,
        system: &System,
        point: &StartPoint,
        worked_out: impl FnOnce() -> (Time<T>, Vector<T>),
    ) -> Option<RunStart<T>> {
        let Learned { structure, starts } = &mut self.own;
        starts.begun(system, structure, point, worked_out)
    }
}

impl<T> Drop for Loan<'_, T> {
    fn drop(&mut self) {
        if let Ok(mut all) = self.known.learned.lock()
            && all.len() < MOST
        {
            let structure = std::mem::take(&mut self.own.structure);
            let starts = std::mem::take(&mut self.own.starts);
            all.push(Learned { structure, starts });
        }
    }
}

impl<T> Deref for Loan<'_, T> {
    type Target = Structure;
    #[inline]
    fn deref(&self) -> &Structure {
        &self.own.structure
    }
}

impl<T> DerefMut for Loan<'_, T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut Structure {
        &mut self.own.structure
    }
}
