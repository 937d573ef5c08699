//! The keys of `report.json` that say what became of an engine's records, each judged from the one
//! before it.

use crate::score::local::{Defects, FirstWrong, LocalJudgement, WrongKind};
use crate::score::{Measures, Spread};
use serde::Serialize;

/// The judgement of a row's records; of an exact engine, which is judged by the tables alone, the
/// events that are those of the table, missed and spurious.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[allow(
    missing_docs,
    reason = "the keys are those of the command line's contract, explained in the schema"
)]
pub struct JudgedRecords {
    pub events_judged: Option<usize>,
    pub events_right: Option<usize>,
    pub events_missed: Option<usize>,
    pub events_spurious: Option<usize>,
    pub events_wrong_mode: Option<usize>,
    pub events_undecidable: Option<usize>,
    pub first_wrong: Option<FirstWrongRecord>,
    pub defect: DefectQuantiles,
    pub inconsistency_max: Option<f64>,
}

/// The first thing that is wrong in a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct FirstWrongRecord {
    pub n: usize,
    pub kind: WrongKind,
    pub event: Option<String>,
    pub mode: Option<String>,
    pub time: Option<f64>,
    pub state: Option<Vec<f64>>,
    pub exact_event: Option<String>,
    pub exact_mode: Option<String>,
    pub exact_time: Option<f64>,
    pub defect: Option<f64>,
    /// What is wrong, in a sentence for people.
    #[serde(skip)]
    pub sentence: String,
}

/// Quantiles of the defects, in units of the local judgement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct DefectQuantiles {
    pub location: Quantiles,
    pub time: TimeQuantiles,
    pub state: Quantiles,
    pub sample: Quantiles,
}

/// The quantiles of one kind of defect; nothing where nothing was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct Quantiles {
    pub median: Option<f64>,
    pub q99: Option<f64>,
    pub max: Option<f64>,
}

/// The quantiles of the defects of times: the signed median is positive where events are late.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct TimeQuantiles {
    #[serde(flatten)]
    pub size: Quantiles,
    pub signed_median: Option<f64>,
}

impl JudgedRecords {
    pub(super) fn new(measures: &Measures) -> Self {
        measures.local.as_ref().map_or_else(|| Self::by_table(measures), Self::by_continuations)
    }

    fn by_table(measures: &Measures) -> Self {
        let (missed, spurious) = (measures.mismatch.missed.len(), measures.mismatch.spurious.len());
        Self {
            events_judged: Some(measures.matched + missed + spurious),
            events_right: Some(measures.matched),
            events_missed: Some(missed),
            events_spurious: Some(spurious),
            events_wrong_mode: Some(0),
            events_undecidable: Some(0),
            ..Self::default()
        }
    }

    fn by_continuations(local: &LocalJudgement) -> Self {
        let defects = &local.defects;
        Self {
            events_judged: Some(local.judged()),
            events_right: Some(local.right),
            events_missed: Some(local.missed),
            events_spurious: Some(local.spurious),
            events_wrong_mode: Some(local.wrong_mode),
            events_undecidable: Some(local.undecidable),
            first_wrong: local.first_wrong.as_ref().map(FirstWrongRecord::new),
            defect: DefectQuantiles {
                location: Quantiles::new(&defects.location),
                time: TimeQuantiles {
                    size: Quantiles::new(&defects.time),
                    signed_median: finite(Spread::new(defects.time.clone()).median),
                },
                state: Quantiles::new(&defects.state),
                sample: Quantiles::new(&defects.sample),
            },
            inconsistency_max: Quantiles::new(&defects.inconsistency).max,
        }
    }
}

impl FirstWrongRecord {
    fn new(first: &FirstWrong) -> Self {
        let exact = first.exact.clone();
        Self {
            n: first.n,
            kind: first.kind,
            event: first.event.clone(),
            mode: first.mode.clone(),
            time: first.time,
            state: first.state.clone(),
            exact_event: exact.as_ref().map(|(event, ..)| event.clone()),
            exact_mode: exact.as_ref().map(|(_, mode, _)| mode.clone()),
            exact_time: exact.map(|(.., time)| time),
            defect: finite(first.defect),
            sentence: first.sentence(),
        }
    }
}

impl Quantiles {
    fn new(defects: &[f64]) -> Self {
        let Spread { median, q99, max } = Defects::spread(defects);
        Self { median: finite(median), q99: finite(q99), max: finite(max) }
    }
}

/// The figure as JSON has it: nothing where it is not finite.
pub(super) fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|it| it.is_finite())
}
