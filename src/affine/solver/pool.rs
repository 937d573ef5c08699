//! A pool of what runs have computed of a system, for the runs that follow: the graph of its
//! structural zeros, and their starts.

use super::start_cache::{RunStart, StartCache};
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::zeros::graph::ZeroGraph;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex};

/// The largest number of graphs in the pool: one for each thread that runs the system.
const MAX_GRAPHS: usize = 64;

/// A pool of the graphs and starts that no run uses at present.
#[derive(Clone, Debug)]
pub struct CachePool<T> {
    /// A graph without nodes, for runs that find the pool empty.
    blank: ZeroGraph,
    returned: Arc<Mutex<Vec<PooledCaches<T>>>>,
}

/// The graph and the starts that a run takes from the pool and returns.
#[derive(Clone, Debug)]
struct PooledCaches<T> {
    graph: ZeroGraph,
    starts: StartCache<T>,
}

/// A graph and starts on loan to a run, which returns them to the pool when it is dropped.
#[derive(Debug)]
pub struct Loan<'a, T> {
    own: PooledCaches<T>,
    pool: &'a CachePool<T>,
}

impl<T> CachePool<T> {
    pub fn new(blank: ZeroGraph) -> Self {
        Self { blank, returned: Arc::default() }
    }

    /// Lends a graph and starts to a run.
    pub fn lend(&self) -> Loan<'_, T> {
        let learned = self.returned.lock().ok().and_then(|mut all| all.pop());
        let blank = || PooledCaches { graph: self.blank.clone(), starts: StartCache::default() };
        Loan { own: learned.unwrap_or_else(blank), pool: self }
    }
}

impl<T: Copy> Loan<'_, T> {
    /// The node, time and state of a start, by [`StartCache::start_of_run`].
    pub fn start_of_run(
        &mut self,
        system: &System,
        point: &StartPoint,
        time_and_state: impl FnOnce() -> (Time<T>, Vector<T>),
    ) -> Option<RunStart<T>> {
        let PooledCaches { graph, starts } = &mut self.own;
        starts.start_of_run(system, graph, point, time_and_state)
    }
}

impl<T> Drop for Loan<'_, T> {
    fn drop(&mut self) {
        if let Ok(mut all) = self.pool.returned.lock()
            && all.len() < MAX_GRAPHS
        {
            let graph = std::mem::take(&mut self.own.graph);
            let starts = std::mem::take(&mut self.own.starts);
            all.push(PooledCaches { graph, starts });
        }
    }
}

impl<T> Deref for Loan<'_, T> {
    type Target = ZeroGraph;
    #[inline]
    fn deref(&self) -> &ZeroGraph {
        &self.own.graph
    }
}

impl<T> DerefMut for Loan<'_, T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut ZeroGraph {
        &mut self.own.graph
    }
}
