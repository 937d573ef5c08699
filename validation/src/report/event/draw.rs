//! Pictures of wrong events as files.

use super::super::setting::{setting, who};
use super::{EventPicture, View, ViewTrajectory};
use crate::picture::Colour;
use crate::picture::{Encounter, Stage, TimeStretch, Trail};
use percuss::Phase;

impl EventPicture {
    /// The file it is drawn to, without its ending: the folder, case, engine and setting.
    pub(in super::super) fn file_name(&self) -> String {
        let setting = setting(self.tolerance, self.step).replace(' ', "");
        let parts = [self.case.as_str(), &self.engine, &setting];
        let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        format!("events/{}", parts.join("__"))
    }

    /// The widest view beside the one that tells most.
    pub(in super::super) fn encounter(&self, colour: Colour) -> Encounter {
        let mut places = vec![0, self.telling];
        places.dedup();
        let shown = places.into_iter().filter_map(|i| self.views.get(i));
        Encounter {
            title: format!(
                "{}: {}",
                self.case,
                who(&self.engine, &setting(self.tolerance, self.step))
            ),
            subtitle: self.title.clone(),
            engine: self.engine.clone(),
            colour,
            guard: self.guard.clone(),
            centre: self.centre,
            stretches: shown.map(|view| self.stretch(view)).collect(),
        }
    }

    fn stretch(&self, view: &View) -> TimeStretch {
        TimeStretch {
            from: view.from,
            to: view.to,
            truth: self.trail(&view.truth),
            engine: self.trail(&view.engine),
            steps: view.steps.clone(),
            looks: view.looks.clone(),
        }
    }

    fn trail(&self, trajectory: &ViewTrajectory) -> Trail {
        let mark = |mark: &super::EventMark| (mark.t, self.stage(&mark.phase), mark.matched);
        Trail {
            values: trajectory.values.clone(),
            stage: self.stage(&trajectory.phase),
            events: trajectory.events.iter().map(mark).collect(),
        }
    }

    /// A phase of the oscillator by its word, or a mode by its name.
    fn stage(&self, name: &str) -> Stage {
        let place = self.modes.iter().position(|mode| mode == name);
        let phase = Phase::ALL.into_iter().find(|phase| phase.as_str() == name);
        match (place, phase) {
            (None, Some(phase)) => Stage::phase(phase),
            (place, _) => Stage::mode(name, place.unwrap_or_default()),
        }
    }
}
