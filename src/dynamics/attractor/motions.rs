//! The motions between the returns to a section, as the search for attractors follows them.

use super::AttractorKind;
use super::coordinates::Coordinates;
use super::known::{KnownAttractor, Label};
use super::recognition::Recognizer;
use crate::dynamics::linear::ReIm;
use crate::dynamics::parallel;

/// The return map of a section, with its motions.
pub(crate) trait Motions: Sized + Sync {
    /// The co-ordinates of the section.
    type Coordinates: Coordinates;
    /// A start as it is asked for.
    type Start: Sync;
    /// The place at which a motion goes on.
    type Place: Clone + Send + Sync;
    /// A periodic orbit.
    type Orbit;

    /// Whether the first return of a motion is its start, which is the return of number 0.
    const FIRST_RETURN_IS_START: bool;

    /// The co-ordinates of the section.
    fn coordinates(&self) -> &Self::Coordinates;

    /// The place of a start, or the label of what is none.
    fn begin(&self, start: &Self::Start) -> Result<Self::Place, Label>;

    /// The spot of a place.
    fn spot_of(&self, place: &Self::Place) -> SpotOf<Self>;

    /// The piece of the section on which a place lies.
    fn piece_of(&self, place: &Self::Place) -> PieceOf<Self>;

    /// A place with a change of its co-ordinates, and the spot there; none out of range.
    fn moved(&self, place: &Self::Place, step: &[f64]) -> Option<(Self::Place, SpotOf<Self>)>;

    /// Follows a motion for `count` returns, or until it is known where it leads; gives the place
    /// of the last return.
    fn follow(
        &self,
        from: &Self::Place,
        count: u64,
        see: &mut Observer<'_, Self>,
    ) -> Result<Self::Place, StopOf<Self>>;

    /// The place of a motion after this number of returns.
    fn after(&self, from: &Self::Place, returns: u64) -> Result<Self::Place, StopOf<Self>>;

    /// The metric of a trap about a place of a stable orbit, and the axes along which the returns
    /// to it lie; none where the multipliers are not inside the unit circle.
    fn turn(&self, place: &Self::Place, period: u64) -> Option<Turn>;

    /// Directions that are spread evenly over the unit sphere of this dimension.
    fn directions(dimension: usize) -> Vec<Vec<f64>>;

    /// The means of a motion over this number of returns; none where it does not return so often.
    fn means(&self, from: &Self::Place, returns: u64) -> Option<RunMeans>;

    /// The largest exponent of a motion over this number of returns, those that are zero for any
    /// motion included; NaN where it does not return so often.
    fn exponent(&self, from: &Self::Place, returns: u64) -> f64;

    /// The orbit, with its places, that Newton's method reaches from a motion at a place.
    fn orbit(&self, from: &Self::Place, period: u32) -> Option<(Self::Orbit, Vec<Self::Place>)>;

    /// The multipliers of an orbit.
    fn multipliers(orbit: &Self::Orbit) -> &[ReIm];

    /// The attractor that is a stable orbit of these places.
    fn periodic(&self, orbit: Self::Orbit, places: &[Self::Place]) -> AttractorOf<Self>;

    /// The attractor of a run that is on no orbit.
    fn of_run(kind: AttractorKind, run: &[PointOf<Self>], means: &RunMeans) -> AttractorOf<Self>;

    /// Follows a motion until it is recognised, for at most so many returns; where it is then if it
    /// is not.
    fn recognise(
        &self,
        known: &[KnownAttractor<Self::Coordinates>],
        from: &Self::Place,
        returns: u64,
    ) -> Result<Self::Place, StopOf<Self>> {
        let mut recognizer = Recognizer::new(self.coordinates(), known);
        let see = |n, _: &_, spot: &_| recognizer.see(n, spot).map(Label::Attractor);
        self.follow(from, returns, &mut { see })
    }

    /// [`Self::recognise`] of many motions. `seen` is told how many more have got a label.
    fn recognised_all(
        &self,
        known: &[KnownAttractor<Self::Coordinates>],
        from: &[&Self::Place],
        returns: u64,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Vec<Result<Self::Place, StopOf<Self>>> {
        parallel::map(from, |it| {
            seen(0);
            let outcome = self.recognise(known, it, returns);
            let label = outcome.as_ref().err().and_then(|it| it.label(self.coordinates(), known));
            seen(u64::from(label.is_some()));
            outcome
        })
    }
}

/// The spots of a section.
pub(crate) type SpotOf<M> = <<M as Motions>::Coordinates as Coordinates>::Spot;
/// The points of a section.
pub(crate) type PointOf<M> = <<M as Motions>::Coordinates as Coordinates>::Point;
/// The pieces of a section.
pub(crate) type PieceOf<M> = <<M as Motions>::Coordinates as Coordinates>::Piece;
/// The attractors of a section.
pub(crate) type AttractorOf<M> = <<M as Motions>::Coordinates as Coordinates>::Attractor;
/// The ends of motions between the returns to a section.
pub(crate) type StopOf<M> = Stop<PointOf<M>>;

/// The observer of a motion: it is shown each return with its number, and says where the motion
/// leads if that is known.
pub(crate) type Observer<'o, M> = dyn FnMut(u64, &PointOf<M>, &SpotOf<M>) -> Option<Label> + 'o;

/// The end of a motion that leads to no further return.
pub(crate) enum Stop<P> {
    /// It is known where the motion leads, or not to be known.
    Label(Label),
    /// The motion rests, or does not return for so long, at this point.
    #[cfg_attr(
        not(feature = "affine"),
        expect(dead_code, reason = "the oscillator's strobes never end")
    )]
    Rest(P),
}

impl<P> Stop<P> {
    /// The label of a motion that ends so; none where it rests at a new place.
    pub fn label<C>(&self, coordinates: &C, known: &[KnownAttractor<C>]) -> Option<Label>
    where
        C: Coordinates<Point = P>,
    {
        let point = match self {
            Self::Label(label) => return Some(*label),
            Self::Rest(point) => point,
        };
        let place = known.iter().position(|it| it.rests_at(coordinates, point));
        place.map(Label::Attractor)
    }
}

/// One turn of a stable orbit from one of its places.
pub(crate) struct Turn {
    /// The metric in which linear theory contracts, by rows.
    pub metric: Vec<Vec<f64>>,
    /// The axes, of length 1 and at right angles, along which the returns to the place lie.
    pub axes: Vec<Vec<f64>>,
}

/// Means over a run.
pub(crate) struct RunMeans {
    /// The largest exponent, with its error, without those that are zero for any motion.
    pub largest_exponent: [f64; 2],
    /// The exponent by which areas shrink where it is measured, zero elsewhere.
    pub contraction: f64,
    /// The means of the drifts with their standard errors.
    pub drift: Vec<f64>,
    pub drift_error: Vec<f64>,
}

impl RunMeans {
    /// The means of a run of which none is known.
    pub const UNKNOWN: Self = Self {
        largest_exponent: [f64::NAN; 2],
        contraction: 0.0,
        drift: Vec::new(),
        drift_error: Vec::new(),
    };
}
