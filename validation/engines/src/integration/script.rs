//! A run repeated without the harness's own part, so that a bench can measure what that part takes.
//!
//! The run is told where its events lie. [`GuardSearch`] then evaluates no guard and asks for no
//! state inside a step, and the meter neither counts nor checks. The library takes the same steps
//! from the same states, so that the answer is the same to the last bit; whoever times the repeated
//! run can hold it to that.
//!
//! [`GuardSearch`]: super::location::GuardSearch

use std::cell::{Cell, RefCell};
use std::rc::Rc;

thread_local! {
    static SCRIPT: RefCell<Option<Script>> = const { RefCell::new(None) };
    /// What the run on this thread locates, where that is noted.
    static NOTED_LINES: RefCell<Option<Vec<ScriptLine>>> = const { RefCell::new(None) };
}

/// A guard that has risen to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GuardRise {
    pub(crate) t: f64,
    pub(crate) guard: usize,
}

/// A crossing that a search has found. An event at the entry of a mode is none: nobody searches for
/// it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScriptLine {
    pub(crate) rise: GuardRise,
    /// Whether the mode ends there.
    pub(crate) ends: bool,
}

/// The crossings of a run that was made before.
#[derive(Clone, Debug, Default)]
pub struct Script(Rc<AnswerLines>);

#[derive(Debug, Default)]
struct AnswerLines {
    crossings: Vec<ScriptLine>,
    /// Whether a run has asked for the crossings.
    read: Cell<bool>,
}

impl Script {
    /// Makes a run, and notes the crossings that its search finds.
    pub fn of_run<T>(run: impl FnOnce() -> T) -> (T, Self) {
        NOTED_LINES.set(Some(Vec::new()));
        let done = run();
        let crossings = NOTED_LINES.take().unwrap_or_default();
        (done, Self(Rc::new(AnswerLines { crossings, read: Cell::new(false) })))
    }

    /// Makes a run that is told these crossings.
    pub fn follow<T>(&self, run: impl FnOnce() -> T) -> T {
        SCRIPT.set(Some(self.clone()));
        let done = run();
        SCRIPT.set(None);
        done
    }

    /// Whether a run was told: an engine that has no meter has nothing that could be left out.
    #[must_use]
    pub fn was_read(&self) -> bool {
        self.0.read.get()
    }
}

/// Notes a crossing of the run on this thread, where that is wanted.
pub(crate) fn note(rise: GuardRise, ends: bool) {
    NOTED_LINES.with_borrow_mut(|noted| {
        if let Some(lines) = noted {
            lines.push(ScriptLine { rise, ends });
        }
    });
}

/// The crossings that a run is told, one after another.
pub(crate) struct ToldCrossings {
    script: Script,
    next: Cell<usize>,
}

impl ToldCrossings {
    /// The crossings that the run which begins on this thread is given; none as a rule.
    pub(crate) fn of_this_thread() -> Option<Self> {
        let script = SCRIPT.with_borrow(Clone::clone)?;
        script.0.read.set(true);
        Some(Self { script, next: Cell::new(0) })
    }

    /// The next crossing up to `end`.
    pub(crate) fn up_to(&self, end: f64) -> Option<ScriptLine> {
        let next = self.next.get();
        let found = self.script.0.crossings.get(next).copied().filter(|it| it.rise.t <= end)?;
        self.next.set(next + 1);
        Some(found)
    }
}
