//! The picture of a run of a system.

use super::super::note;
use super::Format;
use crate::cli::shared::format::OutputFlags;
use crate::cli::shared::names;
use crate::picture::{self, MOST_STATES, SystemMotion};
use crate::truth::DoubleDouble;
use anyhow::{Result, bail};
use percuss::affine::{self, Solver, System, Time, What};
use percuss::{Event, Kind, Proved};

/// The indices of the states that `--states` names, or of the first ones.
pub(super) fn shown(system: &System, states: Option<&str>) -> Result<Vec<usize>> {
    let Some(states) = states else {
        return Ok((0..system.states.len().min(MOST_STATES)).collect());
    };
    let mut shown = Vec::new();
    for name in states.split(',').map(str::trim) {
        let index = system.states.iter().position(|it| it == name);
        let Some(index) = index.filter(|it| !shown.contains(it)) else {
            let near = names::nearest(name, system.states.iter().map(String::as_str));
            let near = if near.is_empty() {
                String::new()
            } else {
                format!(" ({name:?}: {})", near.join(", "))
            };
            bail!(
                "--states {states} is not accepted: each once, some of {}{near}",
                system.states.join(", ")
            );
        };
        shown.push(index);
    }
    if shown.len() > MOST_STATES {
        bail!("--states {states} is not accepted: at most {MOST_STATES} states are");
    }
    Ok(shown)
}

/// An event in 106 bits, without the bounds of its errors; of an ending it has time and state.
pub(super) fn in_106_bits(event: &Event<'_, Proved>) -> affine::Event<DoubleDouble> {
    let number = |it: &Proved| DoubleDouble::from(it.to_two_words());
    let what = match event.kind() {
        Kind::Until(mode, index) => What::Until(mode, index),
        Kind::Watch(mode, index) => What::Watch(mode, index),
        Kind::Limit(mode, index) => What::Limit(mode, index),
        Kind::End(_) => What::End(affine::Ending::Horizon),
        _ => What::Start,
    };
    let time = Time { high: number(event.time()), low: DoubleDouble::default() };
    let state = event.state().iter().map(number).collect();
    affine::Event { what, time, state, mode: event.mode_index(), errors: None }
}

/// Draws a run, given by its start and its events.
pub(super) fn write(
    system: &System,
    backward: bool,
    run: &[affine::Event<DoubleDouble>],
    shown: &[usize],
    output: &OutputFlags<Format>,
    format: Format,
) -> Result<()> {
    let solver = Solver::<DoubleDouble>::prepare(system, backward)?;
    let motion = SystemMotion::of(&solver, run, shown);
    let all = system.states.len();
    if shown.len() == MOST_STATES && all > MOST_STATES {
        note(&format!("{MOST_STATES} of {all} states are shown: --states chooses"));
    }
    output.destination().write(|out| {
        let bytes = match format {
            Format::Svg => picture::svg(&motion).into_bytes(),
            _ => picture::png(&motion)?,
        };
        Ok(out.write_all(&bytes)?)
    })
}
