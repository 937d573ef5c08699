//! Tolerances and counts that the solver and the lanes have in common.
//!
//! The limits of work are in [`crate::crossing::limit`]; a bound that one certificate uses alone
//! stands in its module.
//!
//! Where lanes are stricter their constant stands beside the solver's, with its reason: what no
//! lane proves is left to the scalar solver, so that a stricter constant costs time and no event.

/// Rounding room of a guard, in its largest term: three roundings in the guard, one in the
/// coefficients of its certificate.
pub const SLACK: f64 = 4.0 * f64::EPSILON;

/// A sum within this of its largest term counts as zero, four units in the last place: so a trial
/// force, or a gap, that near to a threshold is taken to be on it.
pub const FOUR_ULPS: f64 = 4.0 * f64::EPSILON;

/// A trial force in lanes this near to a threshold is left to the scalar solver: it is rounded in
/// another order, and the decision is not to depend on that.
pub const LANE_TIE_TOLERANCE: f64 = 16.0 * FOUR_ULPS;

/// The rounding of a contact that is computed in at most [`CONTACT_PIECES`] steps from its start,
/// two products each, in eps times the sum of the sizes of its terms.
pub const STEP_ROUNDINGS: f64 = 16.0;

/// The largest length of the last step, in lengths of the others.
pub const MAX_LAST_STEP_RATIO: f64 = 1.3;

/// Pieces in which a contact is certified before its search divides it.
pub const CONTACT_PIECES: usize = 8;

/// Shorter pieces that lanes take where the usual ones do not prove a contact; the solver divides
/// there instead.
pub const LANE_FINE_PIECES: usize = 16;

/// Stretches of negative force in which a flight is certified by tangents.
pub const TANGENT_STRETCHES: usize = 8;

/// The forcing angle up to which one interpolant is tried for a whole flight or progression.
pub const MAX_WHOLE_PHASE_RADIANS: f64 = 4.0;

/// Steps in which the end of a contact is guessed. Lanes guess other ends in as many; the solver
/// goes on there.
pub const GUESS_STEPS: usize = 24;

/// Evaluations in which a guess has to lead to a root.
pub const GUESS_EVALUATIONS: usize = 5;

/// The longest step from an evaluation to a root, against the time of the root: over a longer one
/// the rounding of the evaluation would show.
pub const MAX_ROOT_STEP: f64 = 0.25;

/// The largest share of an excess that may be left where its cubic is zero: the series puts it
/// right.
pub const RESIDUAL_TOLERANCE: f64 = 1e-6;

/// The part of an exponential below which one step of a guess forgets it.
pub const NEGLIGIBLE_DECAY: f64 = 0.05;

/// Margin on the largest force in lanes, in its amplitudes. Lanes take the largest force up to the
/// time in question, which only the rounding of its cosine can exceed; the solver bounds it by its
/// amplitudes ([`crate::flow::steps::FORCE_FACTOR`]).
pub const LANE_FORCE_MARGIN: f64 = 1e-12;
