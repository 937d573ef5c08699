//! Pictures of wrong events as files.

use super::super::setting::{setting, who};
use super::{EventPicture, View, ViewCourse};
use crate::picture::Colour;
use crate::picture::{Encounter, TimeStretch, Trail};

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
            guard: self.guard.to_owned(),
            centre: self.centre,
            stretches: shown.map(stretch).collect(),
        }
    }
}

fn stretch(view: &View) -> TimeStretch {
    TimeStretch {
        from: view.from,
        to: view.to,
        truth: trail(&view.truth),
        engine: trail(&view.engine),
        steps: view.steps.clone(),
        looks: view.looks.clone(),
    }
}

fn trail(course: &ViewCourse) -> Trail {
    let mark = |mark: &super::EventMark| (mark.t, mark.phase, mark.matched);
    Trail {
        values: course.values.clone(),
        phase: course.phase,
        events: course.events.iter().map(mark).collect(),
    }
}
