//! The co-ordinates in which distances between points of a section are taken.

use std::fmt::Debug;
use std::hash::Hash;

/// The co-ordinates of a section's points, and the attractors that are kept by such points.
pub(crate) trait Coordinates: Clone + Debug + Send + Sync {
    /// A point as an attractor keeps it.
    type Point: Clone + Debug + Send + Sync;
    /// A point by its co-ordinates, each over its scale.
    type Spot: Clone + Debug + Send + Sync;
    /// A piece of the section, whose points have no distance to those of other pieces.
    type Piece: Clone + Debug + Send + Sync;
    /// The change from one spot to another; entries beyond the co-ordinates are zero.
    type Step: AsRef<[f64]>;
    /// A small cell of the section, by whole numbers.
    type Cell: Clone + Debug + Eq + Hash + Ord + Send + Sync;
    /// An attractor.
    type Attractor: Clone + Debug + Send + Sync;

    /// The spot of a point.
    fn spot(&self, point: &Self::Point) -> Self::Spot;

    /// The co-ordinates of a spot, of each as many.
    fn at<'s>(&self, spot: &'s Self::Spot) -> &'s [f64];

    /// Whether a co-ordinate tells points apart: a drift does not.
    fn counts(&self, coordinate: usize) -> bool;

    /// The change from one spot to another.
    fn step(&self, from: &Self::Spot, to: &Self::Spot) -> Self::Step;

    /// Whether a spot lies on a piece.
    fn lies_on(&self, piece: &Self::Piece, spot: &Self::Spot) -> bool;

    /// Whether two spots lie on one piece, as far as they alone tell.
    fn are_on_one_piece(&self, one: &Self::Spot, other: &Self::Spot) -> bool;

    /// The cell of this width in which a spot lies.
    fn cell(&self, spot: &Self::Spot, width: f64) -> Self::Cell;

    /// Bits of the way on which a motion has come to a spot: none where ways are not told apart.
    fn way(&self, _spot: &Self::Spot) -> Option<u64> {
        None
    }

    /// The period of an attractor in returns; none of one that is no orbit.
    fn period(attractor: &Self::Attractor) -> Option<u64>;

    /// The points that are kept of an attractor.
    fn points(attractor: &Self::Attractor) -> &[Self::Point];

    /// Whether two spots differ by no more than a share of the first, or of 1, in any co-ordinate.
    fn are_near(&self, from: &Self::Spot, to: &Self::Spot, share: f64) -> bool {
        let step = self.step(from, to);
        let small = |(by, at): (&f64, &f64)| by.abs() <= share * (1.0 + at.abs());
        self.are_on_one_piece(from, to) && step.as_ref().iter().zip(self.at(from)).all(small)
    }

    /// The spots of an attractor's points.
    fn spots<'a>(
        &'a self,
        attractor: &'a Self::Attractor,
    ) -> impl Iterator<Item = Self::Spot> + 'a {
        Self::points(attractor).iter().map(|it| self.spot(it))
    }
}
