//! Answers in files, as an engine that gives them again.

use super::answer::answer;
use super::table::{EVENTS_ENDING, SAMPLES_ENDING};
use percuss_engines::engine::{
    Accuracy, Class, Colours, Declaration, Engine, Failure, Limits, Location, Outcome, Role,
    Stepping, Task,
};
use std::path::PathBuf;

/// Who answered, for the report.
#[derive(Clone, Copy, Debug)]
pub struct Answerer {
    /// The engine's name.
    pub name: &'static str,
    /// The library of the engine.
    pub library: &'static str,
    /// The library's version.
    pub version: &'static str,
    /// The language.
    pub language: &'static str,
    /// The method's class, where it is stated.
    pub class: Option<Class>,
    /// The method's order, where it is stated.
    pub order: Option<u32>,
    /// The way in which the engine's accuracy is chosen, which fixes the unit of its error.
    pub stepping: Stepping,
    /// Whether the derivatives are differences of whole runs.
    pub takes_differences: bool,
}

/// The answers to one case, which were made before, as an engine that runs this case alone.
pub struct FileEngine {
    answerer: Answerer,
    folder: PathBuf,
    case: String,
}

impl FileEngine {
    /// The answers to a case in a folder.
    #[must_use]
    pub fn new(answerer: Answerer, folder: PathBuf, case: String) -> Self {
        Self { answerer, folder, case }
    }
}

impl Engine for FileEngine {
    fn declaration(&self) -> Declaration {
        let Answerer { name, library, version, class, order, stepping, .. } = self.answerer;
        Declaration {
            name,
            library,
            version: version.to_owned(),
            method: "answers in files",
            class,
            order,
            events: Location::Library,
            dense_output: false,
            stepping,
            role: Role::Rows,
            colours: Colours::OTHERS,
        }
    }

    fn language(&self) -> &str {
        self.answerer.language
    }

    fn available(&self) -> Result<(), String> {
        let file = |ending| format!("{}{ending}", self.case);
        let [events, samples] = [EVENTS_ENDING, SAMPLES_ENDING].map(file);
        if [&events, &samples].into_iter().any(|it| self.folder.join(it).exists()) {
            return Ok(());
        }
        Err(format!("not answered: there is no {events}"))
    }

    fn takes_differences(&self) -> bool {
        self.answerer.takes_differences
    }

    fn run(&self, task: &Task, _: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        answer(&self.folder, &self.case, task, limits).map_err(Failure::new)
    }
}
