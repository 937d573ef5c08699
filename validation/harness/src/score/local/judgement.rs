//! What the local judgement says of a run.

use crate::case::ClassBounds;
use crate::number::brief;
use crate::score::Spread;

/// The largest defects of a right method of a class, in units: its bounds.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    /// The unit of error relative to a state's size: the tolerance, or what a step makes of it.
    pub tolerance: f64,
    /// The largest defect of an event's time.
    pub time: f64,
    /// The largest defect of a state just after an event.
    pub state: f64,
    /// The largest defect of a state at an instant of output.
    pub sample: f64,
    /// The largest median delay of these states in a run.
    pub delay: f64,
}

impl Allowance {
    /// What a class of methods is allowed at a unit of error.
    #[must_use]
    pub const fn new(class: &ClassBounds, tolerance: f64) -> Self {
        let ClassBounds { time, state, sample, delay, .. } = *class;
        Self { tolerance, time, state, sample, delay }
    }
}

/// What is wrong with a record, or with what stands between two of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WrongKind {
    /// The exact continuation has an event that no record tells.
    Missed,
    /// The exact continuation has no such event by then.
    Spurious,
    /// The event is followed by another mode.
    WrongMode,
    /// The guard is not zero at the state before the reset.
    Location,
    /// The event's time is beyond what its class of methods is allowed.
    Time,
    /// The state after the event is beyond what its class of methods is allowed.
    State,
    /// A state at an instant of output is beyond what its class of methods is allowed.
    Sample,
    /// The parts of a record contradict each other.
    Inconsistent,
}

impl WrongKind {
    /// The kind's word in every file and message.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Missed => "missed",
            Self::Spurious => "spurious",
            Self::WrongMode => "wrong-mode",
            Self::Location => "location",
            Self::Time => "time",
            Self::State => "state",
            Self::Sample => "sample",
            Self::Inconsistent => "inconsistent",
        }
    }
}

impl WrongKind {
    /// The part of a record that is wrong.
    const fn of_a_record(self) -> &'static str {
        match self {
            Self::WrongMode => "mode",
            Self::Location => "location",
            Self::Time => "time",
            Self::State => "state",
            Self::Inconsistent => "state after the reset",
            Self::Missed | Self::Spurious | Self::Sample => "event",
        }
    }
}

/// The first thing that is wrong in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstWrong {
    /// The number of the record, from 1; of a missed event that of the next record.
    pub n: usize,
    /// What is wrong.
    pub kind: WrongKind,
    /// The time since the start at which it shows.
    pub elapsed: f64,
    /// The event's name, as the engine has it; of a missed event nothing.
    pub event: Option<String>,
    /// The mode after the record's event.
    pub mode: Option<String>,
    /// The record's time; of a missed event the next record's.
    pub time: Option<f64>,
    /// The record's state.
    pub state: Option<Vec<f64>>,
    /// What the exact continuation has instead: its event, the mode after it, and its time.
    pub exact: Option<(String, String, f64)>,
    /// The defect in units, where it has one.
    pub defect: f64,
}

/// The defects of a run, one for each thing that was measured, in units.
#[derive(Clone, Debug, Default)]
pub struct Defects {
    /// |guard| at the states before the resets.
    pub location: Vec<f64>,
    /// Times, positive where the engine is late.
    pub time: Vec<f64>,
    /// States just after events.
    pub state: Vec<f64>,
    /// States at the instants of output.
    pub sample: Vec<f64>,
    /// The times by which states at the instants of output are ahead of the exact continuations of
    /// the records before them, in tolerances of the time scale.
    pub delay: Vec<f64>,
    /// Contradictions between the parts of a record.
    pub inconsistency: Vec<f64>,
}

/// What was found in a run.
#[derive(Clone, Debug, Default)]
pub struct LocalJudgement {
    /// Records that are right.
    pub right: usize,
    /// Events of the exact continuations that no record tells.
    pub missed: usize,
    /// Records of events that the exact continuation does not have.
    pub spurious: usize,
    /// Records with another mode than the exact continuation's.
    pub wrong_mode: usize,
    /// Records and missing events at which either answer is right.
    pub undecidable: usize,
    /// Records whose parts contradict each other.
    pub inconsistent: usize,
    /// Records of the right event, located or computed worse than their class is allowed.
    pub inaccurate: usize,
    /// States at instants of output that are worse than their class is allowed.
    pub samples_wrong: usize,
    /// All defects.
    pub defects: Defects,
    /// The first thing that is wrong.
    pub first_wrong: Option<FirstWrong>,
}

/// The word for the horizon that a run does not reach, where an event's name stands.
pub(super) const END: &str = "end";

impl FirstWrong {
    /// What is wrong, in a sentence for reasons.
    #[must_use]
    pub fn sentence(&self) -> String {
        let at = |time: Option<f64>| time.map_or(String::new(), |it| format!(" at {it}"));
        let exact = self.exact.as_ref().map(|(event, mode, time)| {
            format!("{event} at {time}, after which the mode is {mode}")
        });
        let own = match (&self.event, &self.mode) {
            (Some(event), Some(mode)) => {
                format!("{event}{}, after which the mode is {mode}", at(self.time))
            }
            _ => format!("the sample{}", at(self.time)),
        };
        let units = if self.defect.is_nan() {
            String::new()
        } else {
            format!(" by {} units", brief(self.defect.abs()))
        };
        let n = self.n;
        match self.kind {
            WrongKind::Missed if self.is_cut_short() => {
                "the run ends before its horizon without a reason".to_owned()
            }
            WrongKind::Missed => {
                let exact = exact.unwrap_or_default();
                format!("the first wrong event is missed before record {n}: {exact}")
            }
            WrongKind::Sample if self.event.is_some() => {
                format!("the first wrong record, {n}, is off the flow before it{units}: {own}")
            }
            WrongKind::Sample => format!("the first wrong sample is{} off{units}", at(self.time)),
            WrongKind::Spurious => {
                let next = exact.map_or("there is no event by then".to_owned(), |exact| {
                    format!("the next event is {exact}")
                });
                format!("the first wrong record, {n}, is spurious: {own}; {next}")
            }
            kind => {
                let exact = exact
                    .map_or(String::new(), |exact| format!("; the exact continuation has {exact}"));
                let part = kind.of_a_record();
                format!("the first wrong record, {n}, has its {part} wrong{units}: {own}{exact}")
            }
        }
    }

    /// Whether the run's end itself is what is missed.
    fn is_cut_short(&self) -> bool {
        self.exact.as_ref().is_some_and(|it| it.0 == END)
    }
}

impl LocalJudgement {
    /// The records that were judged, and the events that were missed.
    #[must_use]
    pub const fn judged(&self) -> usize {
        self.right
            + self.missed
            + self.spurious
            + self.wrong_mode
            + self.undecidable
            + self.inconsistent
            + self.inaccurate
    }

    /// Whether anything is wrong, or the states at instants of output say that the times of events
    /// are off on the whole.
    #[must_use]
    pub fn is_wrong(&self, allowance: &Allowance) -> bool {
        let delay = Defects::spread(&self.defects.delay).median;
        self.first_wrong.is_some() || delay > allowance.delay
    }

    /// Keeps what is wrong, if nothing was before: what is found comes in the order of the run.
    pub(super) fn wrong(&mut self, wrong: FirstWrong) {
        self.first_wrong.get_or_insert(wrong);
    }

    /// Counts a wrong sample, which comes first if it is earlier than what was found.
    pub(super) fn wrong_sample(&mut self, wrong: FirstWrong) {
        self.samples_wrong += 1;
        let earlier = |first: &FirstWrong| first.elapsed > wrong.elapsed;
        if self.first_wrong.as_ref().is_none_or(earlier) {
            self.first_wrong = Some(wrong);
        }
    }
}

/// Whether a defect is beyond its limit; one that is no number is.
pub(super) fn exceeds(defect: f64, limit: f64) -> bool {
    defect.is_nan() || defect > limit
}

impl Defects {
    /// Adds the defects that another judgement of the same run has measured.
    pub(super) fn append(&mut self, mut other: Self) {
        let Self { location, time, state, sample, delay, inconsistency } = self;
        location.append(&mut other.location);
        time.append(&mut other.time);
        state.append(&mut other.state);
        sample.append(&mut other.sample);
        delay.append(&mut other.delay);
        inconsistency.append(&mut other.inconsistency);
    }

    /// The quantiles of defects, of which the sign does not count.
    #[must_use]
    pub fn spread(defects: &[f64]) -> Spread {
        Spread::new(defects.iter().map(|it| it.abs()).collect())
    }
}
