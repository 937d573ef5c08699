//! The ending of a run, and what is said of it on stderr.

use super::no_progress;
use super::progress::{Accumulation, Passed, RunEnd};
use super::rows::Rows;
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
        let note = match ending {
            Ending::Accumulation => {
                let (note, found) = accumulation(event);
                end.accumulation = found;
                note
            }
            Ending::LeavesDomain => "the boundary of the mode is reached".to_owned(),
            Ending::NoProgress => no_progress::note(self.system, &passed.recent),
            Ending::BeyondGuard => "the mode is entered beyond one of its guards".to_owned(),
            Ending::Undecided => {
                format!("what comes next is not decided by {} bits", events.bits())
            }
            _ => return event.name().to_owned(),
        };
        end.notes.push(format!("the run ends at {}: {note}", self.time(event)));
        if ending == Ending::NoProgress {
            end.notes.extend(no_progress::remedy(self.system, &passed.recent));
        }
        end.undecided = !ending.is_decided();
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

/// The instant at which impacts accumulate, between two times after the last of them.
fn accumulation(last: &Event<'_, Proved>) -> (String, Option<Accumulation>) {
    /// The digits of each end, which is rounded away from the other.
    const DIGITS: u8 = 30;
    let ends = last.accumulation().and_then(|[earliest, latest]| {
        Some(Accumulation { earliest: earliest.lower(DIGITS)?, latest: latest.upper(DIGITS)? })
    });
    let note = ends.as_ref().map_or_else(
        || "infinitely many impacts accumulate".to_owned(),
        |Accumulation { earliest, latest }| {
            format!("infinitely many impacts accumulate between {earliest} and {latest}")
        },
    );
    (note, ends)
}
