//! A mode's guards along a segment: their values and derivatives, and what rounding does to them.
//!
//! [`row`] is a guard in modal co-ordinates, with all its derivatives and their bounds. [`point`]
//! evaluates the guards of a segment at an instant: from the co-ordinates there, or soon after an
//! entry at which a guard is a structural zero, from its Taylor series at the entry
//! ([`entry_series`]). [`inherited_error`] bounds what errors made before the segment do to a
//! guard. [`track`] is what a search knows of a guard, and counts what the search costs. Read `row`
//! first, then `point`.

mod entry_series;
pub mod inherited_error;
pub mod point;
pub mod row;
pub mod track;
