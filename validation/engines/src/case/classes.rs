//! `classes.toml`: the largest defects of right engines, by class of method.

use super::bound::{Bound, NamePattern, Quantity, Statistic};
use super::located::{FileError, FileText};
use crate::accuracy::{Accuracy, Stepping, SteppingKind};
use crate::class::Class;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClassesFile {
    class: Vec<ClassTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClassTable {
    method: Class,
    stepping: Option<Steppings>,
    order: Option<[u32; 2]>,
    below: Option<f64>,
    time: f64,
    state: f64,
    sample: f64,
    delay: f64,
    constant: f64,
    why: String,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Steppings {
    One(SteppingKind),
    Several(Vec<SteppingKind>),
}

/// The largest defects of the right engines of a class, in units of the local judgement.
#[derive(Clone, Debug)]
pub struct ClassBounds {
    method: Class,
    /// Any where there is none.
    stepping: Vec<SteppingKind>,
    order: [u32; 2],
    /// Tolerances below this, or any.
    below: f64,
    /// The largest defect of an event's time.
    pub time: f64,
    /// The largest defect of the state just after an event.
    pub state: f64,
    /// The largest defect of a state at an instant of output.
    pub sample: f64,
    /// The largest median time in a run by which these states are ahead or behind, in tolerances of
    /// the time scale.
    pub delay: f64,
    /// The largest error beside the truth of the start, over unit x (1 + size) x growth.
    pub constant: f64,
    /// The set-ups on which they were measured, and the margin.
    pub why: String,
}

/// Reads the classes.
pub(super) fn read_classes(file: &str, text: &str) -> Result<Vec<ClassBounds>, FileError> {
    let wire: ClassesFile = FileText { file, text }.parse()?;
    let class = |it: ClassTable| ClassBounds {
        method: it.method,
        stepping: match it.stepping {
            None => Vec::new(),
            Some(Steppings::One(one)) => vec![one],
            Some(Steppings::Several(several)) => several,
        },
        order: it.order.unwrap_or([0, u32::MAX]),
        below: it.below.unwrap_or(f64::INFINITY),
        time: it.time,
        state: it.state,
        sample: it.sample,
        delay: it.delay,
        constant: it.constant,
        why: it.why,
    };
    Ok(wire.class.into_iter().map(class).collect())
}

impl ClassBounds {
    /// The bounds of an engine's class at an accuracy; those of explicit methods where an engine
    /// declares none, and none for closed forms.
    #[must_use]
    pub fn new(
        classes: &[Self],
        (class, order): (Option<Class>, Option<u32>),
        stepping: Stepping,
        accuracy: Accuracy,
    ) -> Option<&Self> {
        let kind = stepping.kind()?;
        let method = class.unwrap_or(Class::Explicit);
        let order = order.unwrap_or_default();
        classes.iter().find(|it| {
            it.method == method
                && (it.stepping.is_empty() || it.stepping.contains(&kind))
                && (it.order[0]..=it.order[1]).contains(&order)
                && accuracy.tolerance().unwrap_or(0.0) < it.below
        })
    }

    /// The bounds as those of any quantity are held.
    #[must_use]
    pub fn bounds(&self) -> Vec<Bound> {
        let bound = |quantity, limit, why: &str| Bound {
            engine: NamePattern::Any,
            at: Vec::new(),
            quantity,
            statistic: Statistic::Max,
            limit,
            times_tolerance: false,
            why: why.to_owned(),
        };
        let counted =
            |quantity, why| Bound { statistic: Statistic::Value, ..bound(quantity, 0.0, why) };
        let located = "the guard is zero at an event to one tolerance of its size";
        let of_a_record = "the state after a reset is the reset of the state before it";
        let of_a_run = "states between events lag as far as the times of events are off: three times the largest median of a right set-up of the class in one run";
        let since_the_start = "three times the largest of a right set-up of the class";
        vec![
            counted(
                Quantity::EventsWrongMode,
                "the mode after an event is the one that the guard decides",
            ),
            bound(Quantity::Location, 1.0, located),
            bound(Quantity::Inconsistency, 1.0, of_a_record),
            bound(Quantity::TimeDefect, self.time, &self.why),
            bound(Quantity::StateDefect, self.state, &self.why),
            bound(Quantity::SampleDefect, self.sample, &self.why),
            Bound {
                statistic: Statistic::Median,
                ..bound(Quantity::SampleDelay, self.delay, of_a_run)
            },
            bound(Quantity::EventConstant, self.constant, since_the_start),
            bound(Quantity::StateConstant, self.constant, since_the_start),
        ]
    }
}
