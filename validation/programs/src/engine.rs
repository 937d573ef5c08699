//! A set-up of a program, as an engine among others.

use crate::answer::checked;
use crate::pool::Pool;
use crate::wire::{Capabilities, EventsBy, RunAsk, SetUp};
use percuss_engines::engine::{
    Accuracy, Colours, Declaration, Engine, Failure, Limits, Location, Outcome, Role, Stepping,
    SteppingKind, Task,
};
use std::sync::Arc;

/// Why a program has no engines.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotStarted {
    /// It is not installed here, which is no mistake of its own.
    #[error("{program}: unavailable: {why}")]
    Unavailable {
        /// The program's name.
        program: String,
        /// The reason why the program cannot run.
        why: String,
    },
    /// The program did something wrong.
    #[error("{program}: {why}")]
    Failed {
        /// The program's name.
        program: String,
        /// The reason of the failure.
        why: String,
    },
}

impl NotStarted {
    /// An engine by the program's name, so that its rows say why there are none.
    #[must_use]
    pub fn stand_in(self) -> ProgramEngine {
        ProgramEngine::stand_in(self)
    }
}

/// A set-up of a program.
pub struct ProgramEngine {
    declaration: Declaration,
    language: String,
    runs: Runs,
}

/// The source of the runs of an engine.
enum Runs {
    Set { pool: Arc<Pool>, set_up: SetUp },
    None(NotStarted),
}

/// Engines' names live as long as this process: there are few, and each is made once.
fn for_ever(text: String) -> &'static str {
    Box::leak(text.into_boxed_str())
}

impl ProgramEngine {
    pub(crate) fn new(pool: &Arc<Pool>, said: &Capabilities, set_up: &SetUp) -> Self {
        let declaration = Declaration {
            name: for_ever(format!("{}-{}", pool.program().name, set_up.name)),
            library: for_ever(said.library.clone()),
            version: said.version.clone(),
            method: for_ever(set_up.method.clone()),
            class: set_up.class,
            order: set_up.order,
            events: match set_up.events {
                EventsBy::Library => Location::Library,
                EventsBy::Program => Location::Harness,
            },
            dense_output: set_up.dense_output,
            // An order that is needed was seen when the program was started.
            stepping: set_up.stepping.of_order(set_up.order).unwrap_or(Stepping::Adaptive),
            role: Role::Rows,
            colours: Colours::OTHERS,
        };
        let runs = Runs::Set { pool: Arc::clone(pool), set_up: set_up.clone() };
        Self { declaration, language: said.language.clone(), runs }
    }

    pub(crate) fn stand_in(why: NotStarted) -> Self {
        let (NotStarted::Unavailable { program, .. } | NotStarted::Failed { program, .. }) = &why;
        let name = for_ever(program.clone());
        let declaration = Declaration {
            name,
            library: name,
            version: "unknown".to_owned(),
            method: "unknown",
            class: None,
            order: None,
            events: Location::Library,
            dense_output: false,
            stepping: Stepping::Adaptive,
            role: Role::Rows,
            colours: Colours::OTHERS,
        };
        Self { declaration, language: "unknown".to_owned(), runs: Runs::None(why) }
    }
}

impl Engine for ProgramEngine {
    fn declaration(&self) -> Declaration {
        self.declaration.clone()
    }

    fn language(&self) -> &str {
        &self.language
    }

    fn available(&self) -> Result<(), String> {
        match &self.runs {
            Runs::None(NotStarted::Unavailable { why, .. }) => Err(why.clone()),
            Runs::None(NotStarted::Failed { .. }) | Runs::Set { .. } => Ok(()),
        }
    }

    fn differentiates(&self) -> bool {
        matches!(&self.runs, Runs::Set { set_up, .. } if set_up.gradients)
    }

    fn takes_differences(&self) -> bool {
        matches!(&self.runs, Runs::Set { set_up, .. } if set_up.differences)
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let (pool, set_up) = match &self.runs {
            Runs::Set { pool, set_up } => (pool, set_up),
            Runs::None(NotStarted::Failed { why, .. } | NotStarted::Unavailable { why, .. }) => {
                return Err(Failure::new(why));
            }
        };
        can_run(set_up, task, accuracy)?;
        let limits = Limits { wall: limits.wall.min(pool.program().timeout), ..*limits };
        let ask = RunAsk::new(&set_up.name, task, accuracy, &limits);
        let (reply, took) = pool.run(&ask, limits.wall)?;
        checked(&reply, task, (ask.samples(), took), &limits).map_err(Failure::new)
    }
}

/// Refuses what a set-up cannot run, before it is asked.
fn can_run(set_up: &SetUp, task: &Task, accuracy: Accuracy) -> Result<(), Failure> {
    let wanted = match (set_up.stepping, accuracy) {
        (SteppingKind::Fixed, Accuracy::Step(step)) => (step, "step"),
        (SteppingKind::Fixed, _) => (f64::NAN, "step"),
        (_, Accuracy::Tolerance(tolerance)) => (tolerance, "tolerance"),
        _ => (f64::NAN, "tolerance"),
    };
    if !(wanted.0.is_finite() && wanted.0 > 0.0) {
        return Err(Failure::new(format!("needs a positive {}", wanted.1)));
    }
    if task.system.is_backward() && !set_up.backward {
        return Err(Failure::new("does not run back in time"));
    }
    let watches = task.system.system().modes.iter().any(|mode| !mode.watch.is_empty());
    if watches && !set_up.watch {
        return Err(Failure::new("does not report events that end no mode"));
    }
    Ok(())
}
