//! The motion of a mode through one time, which several states share: its exponentials, sines and
//! cosines are worked out once.

use super::flow::ModeFlow;
use super::modal_state::ModalState;
use super::motion::{BlockMotion, circular, exponential};
use crate::affine::arithmetic::vector::Vector;
use crate::numeric::number::Number;
use smallvec::SmallVec;

/// The number of blocks up to which no heap memory is needed.
const INLINE_BLOCKS: usize = 4;

/// exp(M t) of a mode at one time.
pub struct Propagator<'a, T: Number> {
    flow: &'a ModeFlow<T>,
    time: T,
    blocks: SmallVec<[BlockFactor<T>; INLINE_BLOCKS]>,
}

/// exp(B t) of a block, as far as states share it.
enum BlockFactor<T> {
    /// The factor of one co-ordinate.
    Real(T),
    /// Sine and cosine of the angle by which a pair turns, and the factor of its decay.
    Pair([T; 2], Option<T>),
    /// A motion that each state goes through by itself.
    Other,
}

impl<T: Number> ModeFlow<T> {
    /// The motion through a time, for states that share it.
    pub fn propagator(&self, time: T) -> Propagator<'_, T> {
        let factor = |motion: &BlockMotion<T>| match motion {
            BlockMotion::Real { rate } => BlockFactor::Real(exponential(*rate, time)),
            BlockMotion::Pair { rate, frequency } => {
                let (sin, cos) = circular(*frequency, time);
                BlockFactor::Pair([sin, cos], rate.map(|it| exponential(it, time)))
            }
            _ => BlockFactor::Other,
        };
        let blocks = self.blocks.iter().map(|it| factor(&it.motion)).collect();
        Propagator { flow: self, time, blocks }
    }
}

impl<T: Number> Propagator<'_, T> {
    /// The state a time later.
    pub fn after(&self, state: &Vector<T>) -> Vector<T> {
        let mut y = self.flow.co_ordinates(state);
        for (block, factor) in self.flow.blocks.iter().zip(&self.blocks) {
            let at = block.at;
            match factor {
                BlockFactor::Real(factor) => y[at] = y[at] * *factor,
                BlockFactor::Pair([sin, cos], factor) => {
                    let (first, second) = (y[at], y[at + 1]);
                    y[at] = *cos * first + *sin * second;
                    y[at + 1] = *cos * second - *sin * first;
                    if let Some(factor) = factor {
                        (y[at], y[at + 1]) = (y[at] * *factor, y[at + 1] * *factor);
                    }
                }
                BlockFactor::Other => {
                    let mut modal = ModalState { y, ..ModalState::default() };
                    let ModalState { y: moved, sizes } = &mut modal;
                    block.motion.advance(block.range(), moved, sizes, self.time);
                    y = modal.y;
                }
            }
        }
        self.flow.state(&y)
    }
}
