//! The ending of a run, and what is said of it on stderr.

use super::progress::{Accumulation, Passed, RunEnd};
use super::rows::Rows;
use crate::cli::shared::run_ending::RunEnding;
use percuss::{Ending, Event, Events, Kind, Proved};

impl Rows<'_> {
    /// The event's name, or that of the ending, which leaves a note.
    pub(super) fn name(
        &self,
        event: &Event<'_, Proved>,
        events: &Events<'_, Proved>,
        passed: &Passed,
        end: &mut RunEnd,
    ) -> String {
        let Kind::End(ending) = event.kind() else { return event.name().to_owned() };
        if ending == Ending::Accumulation {
            end.accumulation = accumulation(event);
        }
        let ends = end.accumulation.as_ref();
        let ending = RunEnding {
            ending,
            time: self.time(event),
            accumulation: ends.map(|it| [it.earliest.as_str(), &it.latest]),
            bits: events.bits(),
        };
        let notes = ending.notes(self.system, &passed.last);
        end.undecided = !ending.ending.is_decided();
        end.notes.extend(notes);
        event.name().to_owned()
    }

    /// The name of the ending of a run that has as many events as it may have, which leaves a note.
    pub(super) fn stopped(&self, last: &Event<'_, Proved>, end: &mut RunEnd) -> String {
        let most = self.limits.most.unwrap_or_default();
        let time = self.time(last);
        end.notes.push(format!("the run is stopped at {time}, after {most} events: --max-events"));
        "stopped".to_owned()
    }
}

/// The two times, after the last impact, between which infinitely many impacts accumulate.
fn accumulation(last: &Event<'_, Proved>) -> Option<Accumulation> {
    /// The digits of each end, which is rounded away from the other.
    const END_DIGITS: u8 = 30;
    let [earliest, latest] = last.accumulation()?;
    Some(Accumulation { earliest: earliest.lower(END_DIGITS)?, latest: latest.upper(END_DIGITS)? })
}
