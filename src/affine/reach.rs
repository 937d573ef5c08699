//! How far a guard is looked at in one piece, and what of it is only enclosed there.
//!
//! A piece is as long as the eighth derivative allows (`hull.rs`). Of blocks that move much faster
//! than the rest only that they turn and decay is used where their sizes are small beside the
//! guard: a part exp(-r s) c is below its chord if c > 0, and below its right end if c < 0; any
//! other part is below its norm. What is left is slow, and pieces of it are long. Where that leaves
//! only a constant, the piece has no end.

use super::bound::Later;
use super::flow::{Vector, dot};
use super::hull::{self, Judged, Lengths};
use super::point::{Point, Segment, root};
use super::search::{Track, outward};
use crate::crossing::certificate::MIDDLE;
use crate::number::Number;

/// The share of a guard's size that the remainder of a piece may have.
const REMAINDER: f64 = 1e-2;

/// The share of a guard's size that has to be left when its fastest blocks are enclosed.
const LEFT: f64 = 0.25;

/// The share of its largest part that a guard near zero is taken to have.
const SMALLEST: f64 = 1e-3;

/// Room for the rounding of a part.
const OUTWARD: f64 = 1.0 + 1e-12;

/// How far a guard is looked at.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reach {
    /// How many of the blocks are only enclosed.
    cut: usize,
    /// How far that goes.
    pub length: f64,
    /// How far a piece with all blocks goes.
    whole: f64,
}

impl<T: Number> Segment<'_, T> {
    /// How far a guard is looked at from a point.
    pub fn reach(&self, n: usize, track: &Track, left: &Point<T>, longest: f64) -> Reach {
        let (row, blocks) = (&self.rows[n], &self.flow.blocks);
        let orders = outward(&left.orders[n], track).map(Number::to_f64);
        let eighth = |block: usize| {
            blocks[block].later.bound(&row.norms[block], 8, longest) * left.norms[block]
        };
        let mut rest: f64 = (0..blocks.len()).map(eighth).sum();
        let size = row.size(&left.y, self.flow.dimension);
        let whole = length(&orders, rest, track.zeros, size).min(longest);
        let mut reach = Reach { cut: 0, length: whole, whole };
        if track.zeros > 0 || whole >= longest {
            return reach;
        }
        let mut value = orders[0];
        for block in 0..blocks.len() {
            if row.blocks >> block & 1 == 0 {
                continue;
            }
            let part = self.part(n, track, &left.y, block);
            value += match blocks[block].later {
                Later::Fading => part.max(0.0) - part,
                Later::Steady => row.norms[block][0] * left.norms[block] - part,
                Later::Polynomial | Later::Growing(_) => break,
            };
            if value > LEFT * orders[0] {
                break;
            }
            rest = (block + 1..blocks.len()).map(eighth).sum();
            let further = remaining(-value, rest).min(longest);
            if further > 1.5 * reach.length {
                reach = Reach { cut: block + 1, length: further, whole };
            }
        }
        reach
    }

    /// Judges a guard on a piece.
    pub fn judge(
        &self,
        n: usize,
        track: &Track,
        reach: &Reach,
        [left, right]: [&Point<T>; 2],
        lengths: &Lengths<T>,
    ) -> Judged {
        let slack = left.slack[n].max(right.slack[n]);
        let length = lengths.length.to_f64();
        if reach.cut == 0 || length <= reach.whole {
            let ends = [outward(&left.orders[n], track), outward(&right.orders[n], track)];
            let eighth = self.eighth(n, track, left, 0, length);
            return hull::judge(&ends, lengths, eighth, [0.0; 2], slack, track.zeros);
        }
        let raise = self.raise(n, track, [left, right], reach.cut);
        let ends = [left, right].map(|point| self.slow_orders(n, track, &point.y, reach.cut));
        let eighth = self.eighth(n, track, left, reach.cut, length);
        hull::judge(&ends, lengths, eighth, raise, slack, track.zeros)
    }

    /// An upper bound of the eighth derivative of all blocks from `cut` on, not negative.
    fn eighth(&self, n: usize, track: &Track, left: &Point<T>, cut: usize, length: f64) -> f64 {
        let row = &self.rows[n];
        let mut sum = 0.0;
        for (k, block) in self.flow.blocks.iter().enumerate().skip(cut) {
            // An even derivative of a decay has its sign.
            let falls = block.later == Later::Fading && self.part(n, track, &left.y, k) <= 0.0;
            if !falls {
                sum += block.later.bound(&row.norms[k], 8, length) * left.norms[k];
            }
        }
        sum * OUTWARD
    }

    /// What the first blocks add to a guard on a piece at most, at its ends; between them it is
    /// below the straight line.
    fn raise(
        &self,
        n: usize,
        track: &Track,
        [left, right]: [&Point<T>; 2],
        cut: usize,
    ) -> [f64; 2] {
        let row = &self.rows[n];
        let mut raise = [0.0; 2];
        for (k, block) in self.flow.blocks.iter().enumerate().take(cut) {
            let ends = [left, right].map(|it| self.part(n, track, &it.y, k));
            let own = match block.later {
                Later::Fading if ends[0] > 0.0 => ends.map(|it| it * OUTWARD),
                Later::Fading => [ends[1] / OUTWARD; 2],
                _ => [row.norms[k][0] * left.norms[k] * OUTWARD; 2],
            };
            raise = [raise[0] + own[0], raise[1] + own[1]];
        }
        raise
    }

    /// What a block adds to the value of a guard.
    fn part(&self, n: usize, track: &Track, y: &Vector<T>, block: usize) -> f64 {
        let block = &self.flow.blocks[block];
        let row = &self.rows[n].orders[0];
        let part = (block.at..block.at + block.size).map(|k| row[k].to_f64() * y[k].to_f64());
        track.outward * part.sum::<f64>()
    }

    /// Value and three derivatives without the first blocks.
    fn slow_orders(&self, n: usize, track: &Track, y: &Vector<T>, cut: usize) -> [T; 4] {
        let (rows, dimension) = (&self.rows[n].orders, self.flow.dimension);
        let from = self.flow.blocks.get(cut).map_or(dimension, |block| block.at);
        let mut slow = *y;
        slow[..from].iter_mut().for_each(|it| *it = T::zero());
        let orders = [0, 1, 2, 3].map(|k| dot(&rows[k], &slow, dimension));
        outward(&orders, track)
    }
}

/// A length on which the remainder stays small beside what a guard becomes by one of its first
/// derivatives that are not zero.
fn length(orders: &[f64; 4], eighth: f64, zeros: usize, size: f64) -> f64 {
    let room = REMAINDER * MIDDLE / eighth;
    if room == f64::INFINITY {
        return room;
    }
    let [value, slope, bend, _] = orders.map(f64::abs);
    let by_value = if zeros > 0 { SMALLEST * size } else { value.max(SMALLEST * size) };
    let by_slope = if zeros > 1 { 0.0 } else { root(0.5 * room * slope, 7) };
    root(room * by_value, 8).max(by_slope).max(root(0.125 * room * bend, 6))
}

fn remaining(size: f64, eighth: f64) -> f64 {
    root(REMAINDER * MIDDLE * size / eighth, 8)
}
