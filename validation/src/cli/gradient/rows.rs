//! The rows of `gradient`, one for each event and each name.

use crate::cli::shared::no_progress::LastTurns;
use crate::cli::shared::run_ending::RunEnding;
use crate::cli::shared::states::in_order;
use anyhow::Result;
use percuss::{Event, Events, Gradient, Kind, NoGradient, Proved, System};
use serde::Serialize;

/// The system, the names and the digits of the derivatives.
pub(super) struct Rows<'a> {
    pub(super) system: &'a System,
    pub(super) names: &'a [String],
    pub(super) digits: usize,
    /// The number of events that are wanted.
    pub(super) limit: Option<usize>,
}

/// The ending of a run, and what is said of it on stderr.
#[derive(Default)]
pub(super) struct RunEnd {
    /// The name of the ending, of a run that ended before it had its events.
    pub(super) ending: Option<String>,
    pub(super) notes: Vec<String>,
    /// Whether a derivative is missing, or the run ended without a decision.
    pub(super) is_open: bool,
}

/// The derivatives of a row of `events` by a name. Numbers are texts, because a reader's f64 would
/// not hold their digits.
#[derive(Serialize)]
pub(super) struct GradientRow<'a> {
    pub(super) n: usize,
    pub(super) event: &'a str,
    pub(super) mode: &'a str,
    pub(super) wrt: &'a str,
    /// The side of the value of `wrt` for which the derivatives hold, where the two sides differ:
    /// `-` for smaller values, `+` for larger ones. It is empty where they do not differ.
    pub(super) side: &'static str,
    pub(super) dtime: Option<String>,
    #[serde(serialize_with = "in_order")]
    pub(super) dstate: Vec<(&'a str, Option<String>)>,
}

/// Takes a row.
pub(super) type Taker<'a> = &'a mut dyn FnMut(GradientRow<'_>) -> Result<()>;

impl Rows<'_> {
    /// Goes through a run from its start, which is row 0.
    pub(super) fn each(&self, mut events: Events<'_, Proved>, take: Taker<'_>) -> Result<RunEnd> {
        let (mut end, mut last) = (RunEnd::default(), LastTurns::default());
        let mut missing = Vec::new();
        self.take(0, &events.start(), "", take)?;
        for n in 1.. {
            if self.limit.is_some_and(|limit| n > limit) {
                break;
            }
            let Some(event) = events.next() else { break };
            last.add(event.kind(), event.mode_index());
            self.note_missing(n, &event, &mut missing, &mut end);
            self.take(n, &event, event.name(), take)?;
            if let Kind::End(ending) = event.kind() {
                let time = event.time().to_digits(self.digits);
                let (accumulation, bits) = (None, events.bits());
                let said = RunEnding { ending, time, accumulation, bits };
                end.notes.extend(said.notes(self.system, &last));
                end.is_open |= !ending.is_decided();
                end.ending = Some(ending.as_str().to_owned());
            }
        }
        end.notes.extend(events.cause().map(|it| it.to_string()));
        Ok(end)
    }

    /// Says from which row on there is no derivative by a name, or on a side of its value.
    fn note_missing(
        &self,
        n: usize,
        event: &Event<'_, Proved>,
        missing: &mut Vec<(usize, &'static str)>,
        end: &mut RunEnd,
    ) {
        for (k, name) in self.names.iter().enumerate() {
            for (side, of_side, gradient) in by_side(event, name) {
                let Some(Err(reason)) = gradient else { continue };
                if missing.contains(&(k, side)) {
                    continue;
                }
                missing.push((k, side));
                end.notes
                    .push(format!("from row {n} on, no derivative by {name}{of_side}: {reason}"));
                end.is_open = true;
            }
        }
    }

    /// The rows of an event: one for each name, or two where its derivatives have two sides.
    fn take(&self, n: usize, event: &Event<'_, Proved>, of: &str, take: Taker<'_>) -> Result<()> {
        for name in self.names {
            for (side, _, gradient) in by_side(event, name) {
                let gradient = gradient.and_then(Result::ok);
                let cell = |it: &Proved| it.to_digits(self.digits);
                let states = self.system.states.iter().map(String::as_str);
                let cells = match gradient {
                    Some(it) => it.state().iter().map(|it| Some(cell(it))).collect(),
                    None => vec![None; self.system.states.len()],
                };
                take(GradientRow {
                    n,
                    event: of,
                    mode: event.mode(),
                    wrt: name,
                    side,
                    dtime: gradient.map(|it| cell(it.time())),
                    dstate: states.zip(cells).collect(),
                })?;
            }
        }
        Ok(())
    }
}

/// The derivatives of an event on a side of a name's value, or the reason why there are none.
type Found<'e> = Option<Result<&'e Gradient<Proved>, NoGradient>>;

/// The derivatives of an event by a name, each with its side and the words for that.
fn by_side<'e>(
    event: &'e Event<'_, Proved>,
    name: &str,
) -> Vec<(&'static str, &'static str, Found<'e>)> {
    match event.one_sided(name) {
        Some([below, above]) => {
            vec![("-", " below its value", Some(below)), ("+", " above its value", Some(above))]
        }
        None => vec![("", "", event.gradient(name))],
    }
}
