//! The ending of a system's run as stderr tells it, and whether it was decided.

use super::no_progress::{self, LastTurns};
use percuss::Ending;
use percuss::affine::System;

/// The ending of a run, with what is known of it.
pub(in crate::cli) struct RunEnding<'a> {
    pub(in crate::cli) ending: Ending,
    /// The time in which the run ends, as text.
    pub(in crate::cli) time: String,
    /// The times between which infinitely many impacts accumulate, where they are known.
    pub(in crate::cli) accumulation: Option<[&'a str; 2]>,
    /// The bits of the arithmetic.
    pub(in crate::cli) bits: u32,
}

impl RunEnding<'_> {
    /// The lines to say; none of a horizon.
    pub(in crate::cli) fn notes(&self, system: &System, last: &LastTurns) -> Vec<String> {
        let Some(words) = self.words(system, last) else { return Vec::new() };
        let mut notes = vec![format!("the run ends at {}: {words}", self.time)];
        if self.ending == Ending::NoProgress {
            notes.extend(no_progress::remedy(system, last));
        }
        notes
    }

    fn words(&self, system: &System, last: &LastTurns) -> Option<String> {
        Some(match self.ending {
            Ending::Accumulation => match self.accumulation {
                None => "infinitely many impacts accumulate".to_owned(),
                Some([earliest, latest]) => {
                    format!("infinitely many impacts accumulate between {earliest} and {latest}")
                }
            },
            Ending::LeavesDomain => "the boundary of the mode is reached".to_owned(),
            Ending::NoProgress => no_progress::note(system, last),
            Ending::BeyondGuard => "the mode is entered beyond one of its guards".to_owned(),
            Ending::Undecided => format!("what comes next is not decided by {} bits", self.bits),
            _ => return None,
        })
    }
}
