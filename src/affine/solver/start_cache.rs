//! A cache of the starts of runs, with their nodes, times and states: exact arithmetic computes
//! these, and would take longer than the events of a short run.

use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::zeros::graph::ZeroGraph;
use crate::affine::zeros::residue::residues;
use crate::affine::zeros::space::{ZeroSpace, kernel};

/// The largest number of starts in the cache.
const MAX_STARTS: usize = 8;

/// A cache of the starts of the last runs.
#[derive(Clone, Debug)]
pub(super) struct StartCache<T> {
    entries: Vec<CachedStart<T>>,
    /// The index of the start that the next new one replaces, once there are [`MAX_STARTS`].
    oldest: usize,
}

/// A start of an earlier run, with everything that follows from it.
#[derive(Clone, Debug)]
struct CachedStart<T> {
    point: StartPoint,
    zeros: ZeroSpace,
    run_start: RunStart<T>,
}

/// The node, time and state at which a run begins.
#[derive(Clone, Copy, Debug)]
pub struct RunStart<T> {
    /// The node of the graph of structural zeros.
    pub node: usize,
    pub time: Time<T>,
    pub state: Vector<T>,
}

impl<T> Default for StartCache<T> {
    fn default() -> Self {
        Self { entries: Vec::new(), oldest: 0 }
    }
}

impl<T: Copy> StartCache<T> {
    /// The node, time and state of a start; `time_and_state` is called if the start is new. None if
    /// the start's structural zeros cannot be decided.
    pub fn start_of_run(
        &mut self,
        system: &System,
        graph: &mut ZeroGraph,
        point: &StartPoint,
        time_and_state: impl FnOnce() -> (Time<T>, Vector<T>),
    ) -> Option<RunStart<T>> {
        if let Some(known) = self.entries.iter_mut().find(|it| it.point == *point) {
            // A graph that has grown too large has lost its nodes.
            known.run_start.node =
                graph.at_start(point.mode, &known.zeros, Some(known.run_start.node));
            return Some(known.run_start);
        }
        let zeros = zeros_at_start(system, point, &[])?;
        let node = graph.at_start(point.mode, &zeros, None);
        let (time, state) = time_and_state();
        let run_start = RunStart { node, time, state };
        self.keep(CachedStart { point: point.clone(), zeros, run_start });
        Some(run_start)
    }

    fn keep(&mut self, start: CachedStart<T>) {
        if self.entries.len() < MAX_STARTS {
            self.entries.push(start);
        } else {
            self.entries[self.oldest] = start;
            self.oldest = (self.oldest + 1) % MAX_STARTS;
        }
    }
}

/// The left kernel of the start's coefficients over cos theta, sin theta and 1, of which some
/// states are free: they may be anywhere, and those that hang on them follow.
pub fn zeros_at_start(system: &System, start: &StartPoint, free: &[usize]) -> Option<ZeroSpace> {
    let zero_angle = system.is_at_zero_angle(start);
    let mut rows: Vec<[Rational; 3]> = start.state.clone();
    if system.forcing.is_some() {
        rows.push([Rational::ONE, Rational::ZERO, Rational::ZERO]);
        rows.push([Rational::ZERO, Rational::ONE, Rational::ZERO]);
    }
    rows.push([Rational::ZERO, Rational::ZERO, Rational::ONE]);
    let changes: Vec<_> = free.iter().map(|it| system.start_changes(start, *it, free)).collect();
    let row = |(n, [cos, sin, one]): (usize, &[Rational; 3])| {
        // At theta = 0 the cosine is 1 and the sine 0.
        let mut row = if zero_angle {
            vec![Rational::ZERO, Rational::ZERO, cos + one]
        } else {
            vec![cos.clone(), sin.clone(), one.clone()]
        };
        row.extend(changes.iter().map(|it| it.get(n).cloned().unwrap_or_default()));
        residues(&row)
    };
    let mut zeros = ZeroSpace::default();
    for row in kernel(rows.iter().enumerate().map(row).collect::<Option<_>>()?) {
        zeros.insert(&row);
    }
    Some(zeros)
}
