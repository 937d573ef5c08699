//! A case's task as files: JSON, and plain CSV.

use super::equations::equations;
use super::rows::{rows, sample_times, start};
use crate::wire::{ModeAsk, RatesAsk, TimesAsk};
use percuss_engines::engine::Task;
use percuss_engines::number::shortest;
use percuss_engines::system::System;
use serde::Serialize;
use std::collections::BTreeMap;

/// The task of a case: the system, the start, the horizon, and the times at which the state is
/// wanted.
///
/// Its serialization is `CASE.json`, whose modes are those of the protocol's requests.
#[derive(Serialize)]
pub struct CaseFile<'a> {
    schema: u32,
    percuss: &'static str,
    case: &'a str,
    system: &'a str,
    parameters: BTreeMap<&'a str, f64>,
    start: StartFile<'a>,
    horizon: f64,
    backward: bool,
    sample_times: Vec<f64>,
    states: &'a [String],
    drift: Vec<&'a str>,
    scales: &'a [f64],
    time_scale: f64,
    times: TimesAsk,
    modes: Vec<ModeAsk<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gradients: Option<GradientsFile<'a>>,
    #[serde(skip)]
    task: &'a Task,
}

/// The derivatives that are asked for: of the time of each event and of the state after it, and of
/// the state at the end, by each of these names.
#[derive(Serialize)]
struct GradientsFile<'a> {
    events: &'static str,
    end: bool,
    by: Vec<RatesAsk<'a>>,
}

#[derive(Serialize)]
struct StartFile<'a> {
    mode: usize,
    state: &'a [f64],
}

impl<'a> CaseFile<'a> {
    /// What a case asks whose run is `task`. Its parameters are those of the model, which the
    /// equations hold already; omega and phi are those of theta, with time counted from the start.
    #[must_use]
    pub fn new(
        case: &'a str,
        task: &'a Task,
        parameters: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Self {
        let system: &'a System = task.system.system();
        let forcing = [("omega", system.omega), ("phi", system.phi)];
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION"),
            case,
            system: &system.name,
            parameters: parameters.into_iter().chain(forcing).collect(),
            start: StartFile { mode: task.mode, state: &task.state },
            horizon: task.span,
            backward: task.system.is_backward(),
            sample_times: sample_times(task),
            states: &system.states,
            drift: system.drift.iter().map(|it| system.states[*it].as_str()).collect(),
            scales: &system.scales,
            time_scale: system.time_scale,
            times: TimesAsk::new(&task.system),
            modes: system.modes.iter().map(ModeAsk::new).collect(),
            gradients: task.gradients.as_ref().map(|rates| GradientsFile {
                events: "all",
                end: true,
                by: rates.iter().map(RatesAsk::new).collect(),
            }),
            task,
        }
    }

    /// The case's name.
    #[must_use]
    pub fn case(&self) -> &str {
        self.case
    }

    /// The other files of the case: the endings of their names after the case's, and their texts.
    #[must_use]
    pub fn plain_files(&self) -> [(&'static str, String); 4] {
        let times = self.sample_times.iter().map(|time| shortest(*time) + "\n");
        [
            ("rows.csv", rows(self.task.system.system())),
            ("start.csv", start(self.task)),
            ("sample-times.csv", "time\n".to_owned() + &times.collect::<String>()),
            ("txt", equations(self.case, self.task)),
        ]
    }
}
