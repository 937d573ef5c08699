//! `attractors SYSTEM` and `basins SYSTEM`: where the starts of a grid in two states lead.

pub(in crate::cli) mod json;
mod table;

use super::draw::colours;
use super::{AttractorFormat, GridFlags};
use crate::arrays::Npz;
use crate::cli::shared::long_work;
use crate::cli::shared::output;
use crate::cli::shared::section::SectionFlags;
use crate::cli::shared::system_choice::ChosenSystem;
use crate::picture::{BasinMap, ShownAttractor};
use anyhow::Result;
use percuss::System;
use percuss::affine::{ReturnAttractor, ReturnBasins, Solver};
use percuss::dynamics::attractor::{Label, SearchLimits};
use std::io::Write;

/// A surveyed grid of a system's starts.
pub(in crate::cli) struct Survey {
    pub(in crate::cli) system: System,
    limits: SearchLimits,
    pub(in crate::cli) basins: ReturnBasins,
    /// The section as it was written.
    section: String,
}

impl Survey {
    pub(super) fn new(
        chosen: &ChosenSystem,
        grid: &GridFlags,
        section: &SectionFlags,
        threads: Option<u16>,
    ) -> Result<Self> {
        let system = chosen.system()?;
        let plane = grid.plane(&system)?;
        chosen.note_replaced_by_grid(&system, plane.axes);
        let bar = long_work::bar(plane.count() as u64, "starts");
        let seen = |count| bar.inc(count);
        let survey =
            long_work::pool(threads)?.install(|| Self::watched(system, grid, section, &seen));
        bar.finish_and_clear();
        survey
    }

    /// The survey of a system that has a start; `seen` is told of how many starts more the label is
    /// known.
    pub(in crate::cli) fn watched(
        system: System,
        grid: &GridFlags,
        section: &SectionFlags,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Result<Self> {
        let (plane, limits) = (grid.plane(&system)?, grid.limits());
        let solver = Solver::<f64>::new(&system)?;
        let basins = section.map(&solver)?.basins(system.start()?, &plane, limits, seen)?;
        Ok(Self { limits, basins, section: section.text().to_owned(), system })
    }

    pub(super) fn show(&self, shown: AttractorFormat, out: &mut dyn Write) -> Result<()> {
        match shown {
            AttractorFormat::Json => output::json(out, &json::Json::new(self)),
            AttractorFormat::Table => Ok(out.write_all(table::text(self).as_bytes())?),
        }
    }

    /// The names of the two states, across and up.
    fn axes(&self) -> [&str; 2] {
        self.basins.plane.axes.map(|it| self.system.states[it].as_str())
    }

    /// `labels` int32 [NY, NX], the centres f8 under the states' names, `ids` int32, `meta` the
    /// JSON as bytes.
    pub(super) fn npz(&self) -> Result<Vec<u8>> {
        let ReturnBasins { plane, attractors, labels, .. } = &self.basins;
        let (columns, rows) = (plane.columns as usize, plane.rows as usize);
        let ids: Vec<i32> = (0..attractors.len()).map(|k| Label::Attractor(k).number()).collect();
        let meta = serde_json::to_vec(&json::Json::new(self))?;
        let mut archive = Npz::new(Vec::new());
        archive.add("labels", &[rows, columns], labels.iter().map(|label| label.number()))?;
        for (axis, name) in self.axes().into_iter().enumerate() {
            let centres = plane.centres(axis);
            archive.add(&array_name(name), &[centres.len()], centres)?;
        }
        archive.add("ids", &[ids.len()], ids)?;
        archive.add("meta", &[meta.len()], meta)?;
        archive.finish()
    }

    /// The labels as a picture.
    pub(super) fn map(&self) -> BasinMap {
        let ReturnBasins { plane, attractors, labels, .. } = &self.basins;
        let colours = colours(attractors.iter().map(|it| it.kind));
        let shown = attractors.iter().enumerate().zip(colours);
        BasinMap {
            title: self.system.name.clone(),
            note: format!(
                "{} x {} starts at the centres of cells, other states as those of the start;\n\
                 returns to {}; at first {} returns a start",
                plane.columns, plane.rows, self.section, self.limits.transient
            ),
            axes: self.axes().map(str::to_owned),
            window: plane.window,
            columns: plane.columns as usize,
            cells: labels.clone(),
            attractors: shown.map(|((id, it), colour)| self.shown(id, it, colour)).collect(),
        }
    }

    fn shown(&self, id: usize, attractor: &ReturnAttractor, colour: usize) -> ShownAttractor {
        let what = match attractor.period() {
            Some(period) => format!("{id}: period {period}"),
            None => format!("{id}: {}", attractor.kind.as_str()),
        };
        let share = 100.0 * self.basins.fraction(Label::Attractor(id));
        let [across, up] = self.basins.plane.axes;
        ShownAttractor {
            name: format!("{what}\n{share:.2} % of starts"),
            colour,
            points: attractor.points.iter().map(|it| [it.state[across], it.state[up]]).collect(),
            is_orbit: attractor.orbit.is_some(),
        }
    }
}

/// The name of a state's array, which is none of the others'.
pub(in crate::cli) fn array_name(state: &str) -> String {
    match state {
        "labels" | "ids" | "meta" => format!("state.{state}"),
        _ => state.to_owned(),
    }
}
