//! The time at which a run with proved digits ends.

use super::parse::Typed;
use anyhow::{Result, bail};
use percuss::System;
use percuss::affine::MAX_HORIZON;

/// The time of `--until`, or without it the longest time for a number of events, of a run that
/// begins at a time.
pub(in crate::cli) fn horizon(
    until: Option<&Typed<f64>>,
    system: &System,
    start: f64,
    backward: bool,
) -> Result<f64> {
    let direction = if backward { -1.0 } else { 1.0 };
    match until {
        Some(until) if direction * (until.value - start) >= 0.0 && until.value.is_finite() => {
            Ok(until.value)
        }
        Some(until) => {
            let side = if backward { "before" } else { "after" };
            bail!(
                "--until {until} is not accepted: a finite time at or {side} the start at {start} is"
            )
        }
        None => Ok(start + direction * MAX_HORIZON * system.time_scale),
    }
}
