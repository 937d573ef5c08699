//! The picture of a run of a system.

use super::progress::RunEnd;
use super::rows::{Rows, Sink};
use crate::cli::shared::names;
use crate::cli::shared::picture::PictureFormat;
use crate::picture::{self, MAX_STATES, SystemMotion};
use crate::truth::DoubleDouble;
use anyhow::{Result, bail};
use percuss::affine::{self, Solver, System, Time, What};
use percuss::{Event, Kind, Proved};
use std::io::Write;

/// A picture of more events than this shows nothing.
const MAX_DRAWN_EVENTS: usize = 20_000;

/// The indices of the states that `--states` names, or of the first ones.
pub(super) fn shown(system: &System, states: Option<&str>) -> Result<Vec<usize>> {
    let Some(states) = states else {
        return Ok((0..system.states.len().min(MAX_STATES)).collect());
    };
    let mut shown = Vec::new();
    for name in states.split(',').map(str::trim) {
        let index = system.states.iter().position(|it| it == name);
        let Some(index) = index.filter(|it| !shown.contains(it)) else {
            let near = names::nearest_names(name, system.states.iter().map(String::as_str));
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
    if shown.len() > MAX_STATES {
        bail!("--states {states} is not accepted: at most {MAX_STATES} states are");
    }
    Ok(shown)
}

/// An event in 106 bits, without the bounds of its errors; of an ending it has time and state.
fn in_106_bits(event: &Event<'_, Proved>) -> affine::Event<DoubleDouble> {
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

/// The picture of a run, in all formats that are asked for.
pub(super) struct Drawn<'a> {
    pub(super) outputs: Vec<(PictureFormat, &'a mut dyn Write)>,
    pub(super) backward: bool,
    /// The indices of the states that are shown.
    pub(super) shown: &'a [usize],
    /// The start and all events, in 106 bits.
    pub(super) run: Vec<affine::Event<DoubleDouble>>,
}

impl Sink for Drawn<'_> {
    fn passed(&mut self, event: &Event<'_, Proved>) -> Result<()> {
        if self.run.len() > MAX_DRAWN_EVENTS {
            bail!(
                "a picture of more than {MAX_DRAWN_EVENTS} events is not accepted: --output or \
                 --format of csv or json is, or a shorter run"
            );
        }
        self.run.push(in_106_bits(event));
        Ok(())
    }

    fn finish(&mut self, rows: &Rows<'_>, _: &RunEnd) -> Result<()> {
        let solver = Solver::<DoubleDouble>::prepare(rows.system, self.backward)?;
        let motion = SystemMotion::new(&solver, &self.run, self.shown);
        for (format, out) in &mut self.outputs {
            let bytes = match format {
                PictureFormat::Svg => picture::svg(&motion).into_bytes(),
                PictureFormat::Png => picture::png(&motion)?,
            };
            out.write_all(&bytes)?;
        }
        Ok(())
    }
}
