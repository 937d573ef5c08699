//! The exit codes of the program, as docs/COMMAND_LINE.md promises them.

/// Done, and within bounds.
pub(in crate::cli) const DONE: u8 = 0;
/// Ran, and a bound failed or an engine erred.
pub(in crate::cli) const OUT_OF_BOUNDS: u8 = 1;
/// Bad usage, bad input, input or output that failed, or nothing selected.
pub(in crate::cli) const REFUSED: u8 = 2;
