//! Grids of starts in two states of a SYSTEM.

use anyhow::{Result, bail};
use percuss::System;
use percuss::affine::Plane;
use percuss::dynamics::attractor::Window;

/// The grid in two states, of which `axes` has the names as `--axes` has them; the first two states
/// where it has none.
pub(in crate::cli) fn plane(
    system: &System,
    axes: Option<&str>,
    [columns, rows]: [u32; 2],
    window: Window,
) -> Result<Plane> {
    Ok(Plane { axes: indices(system, axes)?, window: [window.p, window.y], columns, rows })
}

fn indices(system: &System, axes: Option<&str>) -> Result<[usize; 2]> {
    let states = &system.states;
    let Some(text) = axes else {
        if states.len() < 2 {
            bail!("{} has one state, and no grid of two: {}", system.name, states.join(", "));
        }
        return Ok([0, 1]);
    };
    let names: Vec<&str> = text.split(',').map(str::trim).collect();
    let index = |name: &&str| states.iter().position(|it| it == name);
    match names.iter().map(index).collect::<Option<Vec<_>>>().as_deref() {
        Some([across, up]) if across != up => Ok([*across, *up]),
        _ => bail!("--axes {text} is not accepted: accepted are two of {}", states.join(", ")),
    }
}
