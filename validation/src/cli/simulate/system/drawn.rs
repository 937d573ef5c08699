//! The picture of a run of a system: one quantity over another, or over time.

use super::plan::PlannedRun;
use super::sink::{Row, RunEnd, Sink};
use crate::cli::shared::picture::{PictureFlags, PictureFormat, Shown, place};
use crate::picture::{self, Figure, KeyEntry, Layer, Plot, Stroke, mode_colour};
use anyhow::{Result, bail};
use percuss::affine::{self, Time, What};
use percuss::system::Observable;
use std::io::Write;

/// A picture of more events than this shows nothing.
const MAX_DRAWN_EVENTS: usize = 20_000;

/// The width of the curve.
const CURVE_WIDTH: f64 = 1.6;

pub(super) struct Drawn<'a> {
    pub(super) out: &'a mut dyn Write,
    pub(super) flags: &'a PictureFlags,
    pub(super) format: PictureFormat,
    pub(super) shown: &'a Shown,
    pub(super) observables: &'a [Observable],
    /// The start, the events, and the end.
    pub(super) stops: Vec<affine::Event<f64>>,
}

impl Sink for Drawn<'_> {
    fn begin(&mut self, _: &PlannedRun<'_>) -> Result<()> {
        Ok(())
    }

    fn stop(&mut self, stop: &Row<'_>) -> Result<()> {
        if self.stops.len() > MAX_DRAWN_EVENTS {
            bail!(
                "a picture of more than {MAX_DRAWN_EVENTS} events and samples is not accepted: \
                 --output of csv, json, npy or npz is, or a shorter run"
            );
        }
        self.stops.push(affine::Event {
            what: What::Start,
            time: Time { high: stop.time, low: 0.0 },
            state: stop.state.to_vec(),
            mode: stop.mode,
            errors: None,
        });
        Ok(())
    }

    fn row(&mut self, _: &PlannedRun<'_>, _: &Row<'_>) -> Result<()> {
        Ok(())
    }

    fn finish(&mut self, plan: &PlannedRun<'_>, _: &RunEnd) -> Result<()> {
        let pieces = picture::sampled(plan.solver.for_sections(), &self.stops);
        let place = |at: &Vec<f64>| place(self.observables, at[0], at[0], &at[1..]);
        let line = |it: &picture::SampledSegment| Layer::Line {
            points: it.points.iter().map(place).collect(),
            colour: mode_colour(it.mode),
            width: CURVE_WIDTH,
            stroke: Stroke::Solid,
        };
        let mut layers: Vec<Layer> = pieces.iter().map(line).collect();
        let mut modes: Vec<usize> = pieces.iter().map(|it| it.mode).collect();
        modes.sort_unstable();
        modes.dedup();
        let entry = |mode: &usize| KeyEntry {
            name: plan.system().modes[*mode].name.clone(),
            colour: mode_colour(*mode),
            stroke: Some(Stroke::Solid),
        };
        layers.push(Layer::Key(modes.iter().map(entry).collect()));
        let ends = [self.stops.first(), self.stops.last()];
        let [from, to] = ends.map(|it| it.map_or(0.0, |it| it.time.value()));
        let axes = self.shown.axes("time");
        let figure = Figure {
            title: plan.system().name.clone(),
            caption: format!("time {from} to {to}"),
            columns: 1,
            panel: (1200, 800),
            plots: vec![Plot { title: String::new(), axes, window: None, layers }],
        };
        self.flags.write(figure, self.format, self.out)
    }
}
