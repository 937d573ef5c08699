//! The state of a guard in a search, and the cost of a search.

use crate::numeric::number::Number;

/// The state of a guard at the left end of the time that is searched.
#[derive(Clone, Copy, Debug)]
pub struct Track {
    /// 1 where a crossing rises, -1 where it falls: the guard times this is negative inside.
    pub outward: f64,
    /// The number of the guard's derivatives, the value included, that are zero at the left end.
    pub zeros: usize,
    /// Whether the guard can cross at all.
    pub live: bool,
}

/// The cost of a search, or of a run's searches so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SearchWork {
    /// Evaluations of the closed form.
    pub evaluations: u64,
    /// Pieces of segments on which the guards' signs were to be proved.
    pub pieces: u64,
    /// The number of ties, touches, entries and conditions that rounding leaves undecided.
    pub undecidable: u64,
    /// The first guard that rounding left open by itself, as its number among those of its mode:
    /// the events that end it come first, then the watched ones.
    pub doubtful: Option<usize>,
    /// Whether a search was given up because it took too much work.
    pub exhausted: bool,
}

impl SearchWork {
    /// Counts a guard that rounding leaves open.
    #[inline]
    pub(in crate::affine) fn doubt(&mut self, guard: usize) {
        self.undecidable += 1;
        self.doubtful = self.doubtful.or(Some(guard));
    }
}

/// Value and derivatives of a guard, with the sign that makes it positive outside its mode.
#[inline]
pub fn outward<T: Number>(orders: &[T; 4], track: &Track) -> [T; 4] {
    if track.outward < 0.0 { orders.map(|it| -it) } else { *orders }
}

/// The guards that can cross, with their numbers.
#[inline]
pub fn live_tracks(tracks: &[Track]) -> impl Iterator<Item = (usize, &Track)> {
    tracks.iter().enumerate().filter(|(_, track)| track.live)
}
