//! The request of a run: its start, its end and its samples.

use crate::affine::model::system::StartPoint;
use crate::affine::model::tangent::Tangent;
use std::sync::Arc;

/// The start and the end of a run, and the samples between.
#[derive(Clone, Debug)]
pub struct Request {
    pub(super) start: StartPoint,
    pub(super) horizon: Horizon,
    /// The number of samples in a forcing period, or in the system's scale of time.
    pub(super) samples: Option<u32>,
    /// The significant digits that are wanted of proved numbers.
    pub(super) digits: usize,
    /// The derivatives of the coefficients by each name by which the run is differentiated.
    pub(super) tangents: Vec<Arc<Tangent>>,
    /// The most bits of an arithmetic.
    pub(super) most_bits: u32,
}

/// The end of a run.
#[derive(Clone, Copy, Debug)]
pub(super) enum Horizon {
    /// A time.
    At(f64),
    /// So many forcing periods, or units of the system's scale of time, after the start.
    Units(f64),
    /// Later than any event that is wanted.
    Far,
}
