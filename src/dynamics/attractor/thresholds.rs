//! The thresholds of the theory of attractors, which the oscillator's strobes and the returns of
//! any system share: a strobe is a return too.

/// The number of starts along each side of the grid from which attractors are first looked for,
/// whatever grid is asked for: so they do not depend on it.
pub(crate) const LATTICE_SIDE: u32 = 16;
/// Starts looked at in one go: what is kept of each until then is ten times its label.
pub(crate) const BLOCK_STARTS: usize = 1 << 14;
/// The largest number of starts that are settled between two looks at what has been found.
pub(crate) const MAX_BATCH_STARTS: usize = 64;
/// The number of times that a transient is doubled before a start is given up.
pub(crate) const EXTENSIONS: u32 = 3;

/// The longest period that is looked for at once: a longer one only where a motion has nearly no
/// other place to go, so that ordinary starts do not pay for it.
pub(crate) const MAX_FIRST_PERIOD: u32 = 128;
/// Returns that repeat this closely (relative to their size) are handed to Newton's method.
pub(crate) const REPEAT_TOLERANCE: f64 = 1e-3;
/// Returns that repeat this closely, and multipliers this near to the unit circle, differ by no
/// more than the roundings of an orbit's longest period: an orbit there is neutral.
pub(crate) const ROUNDING_TOLERANCE: f64 = 1e-12;
/// The least number of pairs of returns that must repeat.
pub(crate) const MIN_PAIRS: usize = 8;
/// Turns within which a motion must enter a trap of the orbit that it seems to follow: one that
/// loses 1 % of its distance a turn loses 1e-8 of it in so many.
pub(crate) const MAX_TURNS_INTO_TRAP: u64 = 2000;
/// Returns of the first look at the exponents.
pub(crate) const FIRST_LOOK_RETURNS: u64 = 512;
/// Returns of the look at the exponents that decides.
pub(crate) const DECISION_RETURNS: u64 = 1 << 14;
/// The number of times that a motion of no kind is looked at again, [`DECISION_RETURNS`] later each
/// time.
pub(crate) const LATE_LOOKS: u32 = 8;
/// Returns after which chaos that is known to end has to have ended.
pub(crate) const MAX_ENDING_RETURNS: u64 = 8 * REFERENCE_RETURNS;
/// The largest size of an exponent, or of a contraction, that is taken for zero.
pub(crate) const NEUTRAL_TOLERANCE: f64 = 1e-3;
/// The number of known attractors from which on only orbits are added: nearly without damping every
/// start has its own invariant curve.
pub(crate) const MAX_ATTRACTORS: usize = 64;
/// The largest number of starts described among those that were not recognised.
pub(crate) const MAX_EXAMPLES: usize = 3;
/// Returns over which the exponent of a described start is taken.
pub(crate) const EXAMPLE_RETURNS: u64 = 1 << 12;

/// Cells along the largest extent. An attractor of dimension 1.3 then fills about
/// [`CELLS_PER_EXTENT`]^1.3 = 1400 of them, each visited many times by a run of
/// [`REFERENCE_RETURNS`] returns.
pub(crate) const CELLS_PER_EXTENT: f64 = 256.0;
/// Returns of the run that fills the cells.
pub(crate) const REFERENCE_RETURNS: u64 = 1 << 17;
/// The number of returns in a row that lie in the cells of an attractor when a motion is on it.
pub(crate) const RECURRENCES: u32 = 48;
/// The least share of one run that lies in the cells of another when the two are on one attractor.
pub(crate) const MIN_COMMON_SHARE: f64 = 0.5;

/// The number of successive turns around a trap's orbit, each of which brings a motion closer to
/// it, after which the motion is taken for one that leads to the orbit.
pub(crate) const CLOSER_TURNS: u32 = 3;
/// Radii of traps that are tried, largest first: how far one may reach in any direction. In a
/// larger one the net would be too coarse for a tongue of another basin.
pub(crate) const MAX_RADIUS: f64 = 0.25;
/// The largest number of times that the radius of a trap is halved.
pub(crate) const RADIUS_HALVINGS: i32 = 28;
/// Points of a trap's net on each of its shells, in three dimensions.
pub(crate) const DIRECTIONS: u32 = 48;
/// Turns within which a point of a trap's net that comes back on another way than the orbit's has
/// to arrive at it.
pub(crate) const ARRIVAL_TURNS: u64 = 256;
/// The square of the distance, as a share of the trap's radius, at which it has arrived: another
/// orbit in the trap is further away.
pub(crate) const ARRIVAL_TOLERANCE: f64 = 1e-6;
/// The shells, as shares of the radius: a corner of the map inside must not stay unseen.
pub(crate) const SHELLS: [f64; 4] = [1.0, 0.6, 0.3, 0.1];
/// The number of points of an orbit, roughly, that get a trap at most.
pub(crate) const MAX_TRAPS: usize = 12;
/// The largest square of the distance, as a share of the trap's radius, of a motion that is at rest
/// on an orbit.
pub(crate) const REST_TOLERANCE: f64 = 1e-12;
/// Turns over which is measured how far rounding moves a motion on the orbit. Of an orbit of
/// hundreds of periods that can be 1e-11, which in a trap of 1e-9 next to a graze is more than that
/// share.
pub(crate) const REST_TURNS: u64 = 8;
/// Multiples of that distance that a motion may be away and still at rest.
pub(crate) const REST_FACTOR: f64 = 4.0;
/// The number of times that the sum of a trap's metric is doubled in length: multipliers up to 1 -
/// 1e-8 are summed up.
pub(crate) const METRIC_DOUBLINGS: usize = 32;
