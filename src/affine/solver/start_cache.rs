//! The starts of runs, with what follows from a start alone: it is exact arithmetic, which would
//! take longer than the events of a short run.

use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::zeros::graph::Structure;
use crate::affine::zeros::residue::residues;
use crate::affine::zeros::space::{Zeros, kernel};
use dashu_ratio::RBig;

/// How many starts are kept: those of the last runs.
const MOST: usize = 8;

/// The starts of the last runs.
#[derive(Clone, Debug)]
pub(super) struct Starts<T> {
    known: Vec<KnownStart<T>>,
    /// The one that the next new start replaces, once there are [`MOST`].
    oldest: usize,
}

/// A start that a run had.
#[derive(Clone, Debug)]
struct KnownStart<T> {
    point: StartPoint,
    zeros: Zeros,
    begun: RunStart<T>,
}

/// What a run begins with.
#[derive(Clone, Copy, Debug)]
pub struct RunStart<T> {
    /// The node of the graph of structural zeros.
    pub node: usize,
    pub time: Time<T>,
    pub state: Vector<T>,
}

impl<T> Default for Starts<T> {
    fn default() -> Self {
        Self { known: Vec::new(), oldest: 0 }
    }
}

impl<T: Copy> Starts<T> {
    /// What a run from a start begins with; time and state are worked out where the start is new.
    /// None if its structural zeros cannot be told.
    pub fn begun(
        &mut self,
        system: &System,
        structure: &mut Structure,
        point: &StartPoint,
        worked_out: impl FnOnce() -> (Time<T>, Vector<T>),
    ) -> Option<RunStart<T>> {
        if let Some(known) = self.known.iter_mut().find(|it| it.point == *point) {
            // A graph that has grown too large has lost its nodes.
            known.begun.node = structure.at_start(point.mode, &known.zeros, Some(known.begun.node));
            return Some(known.begun);
        }
        let zeros = zeros_at_start(system, point)?;
        let node = structure.at_start(point.mode, &zeros, None);
        let (time, state) = worked_out();
        let begun = RunStart { node, time, state };
        self.keep(KnownStart { point: point.clone(), zeros, begun });
        Some(begun)
    }

    fn keep(&mut self, start: KnownStart<T>) {
        if self.known.len() < MOST {
            self.known.push(start);
        } else {
            self.known[self.oldest] = start;
            self.oldest = (self.oldest + 1) % MOST;
        }
    }
}

/// The left kernel of the start's coefficients over cos theta, sin theta and 1.
fn zeros_at_start(system: &System, start: &StartPoint) -> Option<Zeros> {
    let zero_angle = match &system.forcing {
        Some(forcing) => (&forcing.omega * &start.time + &forcing.phi).is_zero(),
        None => true,
    };
    let mut rows: Vec<[RBig; 3]> = start.state.clone();
    if system.forcing.is_some() {
        rows.push([RBig::ONE, RBig::ZERO, RBig::ZERO]);
        rows.push([RBig::ZERO, RBig::ONE, RBig::ZERO]);
    }
    rows.push([RBig::ZERO, RBig::ZERO, RBig::ONE]);
    let row = |[cos, sin, one]: &[RBig; 3]| {
        // At theta = 0 the cosine is 1 and the sine 0.
        let row = if zero_angle {
            vec![RBig::ZERO, RBig::ZERO, cos + one]
        } else {
            vec![cos.clone(), sin.clone(), one.clone()]
        };
        residues(&row)
    };
    let mut zeros = Zeros::default();
    for row in kernel(rows.iter().map(row).collect::<Option<_>>()?) {
        zeros.insert(&row);
    }
    Some(zeros)
}
