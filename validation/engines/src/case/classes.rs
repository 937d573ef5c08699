//! `classes.toml`: the largest defects of right engines, by class of method.

use super::located::{FileError, FileText};
use crate::accuracy::{Accuracy, Stepping};
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
    sample_median: f64,
    why: String,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Steppings {
    One(SteppingKind),
    Several(Vec<SteppingKind>),
}

/// The way in which an accuracy is chosen, without its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum SteppingKind {
    Adaptive,
    PerStep,
    Fixed,
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
    /// The largest median of these defects in a run.
    pub sample_median: f64,
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
        sample_median: it.sample_median,
        why: it.why,
    };
    Ok(wire.class.into_iter().map(class).collect())
}

impl ClassBounds {
    /// The bounds of an engine's class at an accuracy; those of explicit methods where an engine
    /// declares none, and none for closed forms.
    #[must_use]
    pub fn of(
        classes: &[Self],
        (class, order): (Option<Class>, Option<u32>),
        stepping: Stepping,
        accuracy: Accuracy,
    ) -> Option<&Self> {
        let kind = match stepping {
            Stepping::Exact => return None,
            Stepping::Adaptive => SteppingKind::Adaptive,
            Stepping::PerStep { .. } => SteppingKind::PerStep,
            Stepping::Fixed { .. } => SteppingKind::Fixed,
        };
        let method = class.unwrap_or(Class::Explicit);
        let order = order.unwrap_or_default();
        classes.iter().find(|it| {
            it.method == method
                && (it.stepping.is_empty() || it.stepping.contains(&kind))
                && (it.order[0]..=it.order[1]).contains(&order)
                && accuracy.tolerance().unwrap_or(0.0) < it.below
        })
    }
}
