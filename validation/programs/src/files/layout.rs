//! The columns of files of events and of samples: those of an answer, or those that `percuss
//! events` prints.

use super::table::Table;
use percuss_engines::engine::Ending;
use percuss_engines::system::System;
use std::borrow::Cow;

/// The columns that `percuss events` prints before those of the states.
pub const EVENT_COLUMNS: [&str; 4] = ["n", "time", "event", "mode"];

/// The columns that `percuss events --samples` prints before those of the states.
pub const SAMPLE_COLUMNS: [&str; 2] = ["time", "mode"];

/// The column of a state in what `percuss events` prints: its name, unless that is another
/// column's.
#[must_use]
pub fn printed_column(state: &str) -> Cow<'_, str> {
    if EVENT_COLUMNS.contains(&state) { format!("state.{state}").into() } else { state.into() }
}

/// The places of the parts of an event or a sample in a line.
pub(super) struct Layout {
    /// All columns, in their order.
    pub(super) columns: Vec<String>,
    /// Whether the first line is the start, which is no event; times are then those of the clock.
    pub(super) has_start: bool,
    /// The column of the time; those of an event and its mode follow.
    pub(super) time: usize,
    /// The first column of the state.
    pub(super) state: usize,
    /// The first column of the state before the reset, where the file has it.
    pub(super) before: Option<usize>,
}

impl Layout {
    /// The layout of a file of events, which its header names.
    ///
    /// # Errors
    /// Another header, with those that are accepted.
    pub(super) fn of_events(table: &Table, system: &System) -> Result<Self, String> {
        let answer = || Self::answer(&["time", "event", "mode"], system);
        let with_before = answer().with_before(system);
        Self::named(table, [answer(), with_before, Self::printed(&EVENT_COLUMNS, system)])
    }

    /// The layout of a file of samples, which its header names.
    ///
    /// # Errors
    /// Another header, with those that are accepted.
    pub(super) fn of_samples(table: &Table, system: &System) -> Result<Self, String> {
        Self::named(
            table,
            [Self::answer(&["time"], system), Self::printed(&SAMPLE_COLUMNS, system)],
        )
    }

    /// The ending that a word in the column of events stands for.
    pub(super) fn ending(&self, event: &str) -> Option<Ending> {
        let is_printed_end = self.has_start && event == "end";
        let named = event.parse().ok().filter(|it| *it != Ending::Horizon);
        if is_printed_end { Some(Ending::Horizon) } else { named }
    }

    fn named<const N: usize>(table: &Table, accepted: [Self; N]) -> Result<Self, String> {
        let header = table.header();
        let texts = accepted.each_ref().map(|it| format!("{:?}", it.columns.join(",")));
        let found = accepted.into_iter().find(|it| it.columns == header);
        found.ok_or_else(|| table.other_header(&texts.join(", ")))
    }

    /// The columns of an answer: these, and the states by their names.
    fn answer(first: &[&str], system: &System) -> Self {
        let all = first.iter().copied().chain(system.states.iter().map(String::as_str));
        let columns = all.map(str::to_owned).collect();
        Self { columns, has_start: false, time: 0, state: first.len(), before: None }
    }

    fn with_before(mut self, system: &System) -> Self {
        self.before = Some(self.columns.len());
        self.columns.extend(system.states.iter().map(|it| format!("before.{it}")));
        self
    }

    /// The columns that `percuss events` prints: these, and the states.
    fn printed(first: &[&str], system: &System) -> Self {
        let states = system.states.iter().map(|it| printed_column(it));
        let all = first.iter().map(|it| Cow::from(*it)).chain(states);
        let columns: Vec<_> = all.map(Cow::into_owned).collect();
        let time = columns.iter().position(|it| it == "time").unwrap_or_default();
        Self { columns, has_start: true, time, state: first.len(), before: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percuss_engines::engine::percussive;

    /// A state that is called as a column keeps its name in answers, in both files.
    #[test]
    fn a_state_may_be_called_as_a_column() {
        let mut system = percussive(&percuss::Parameters::default(), 0.0);
        system.states[0] = "n".to_owned();
        let answer = Layout::answer(&["time"], &system);
        assert_eq!(answer.columns, ["time", "n", "y", "q", "v"]);
        let with_before = answer.with_before(&system);
        assert_eq!((with_before.state, with_before.before), (1, Some(5)));
        let printed = Layout::printed(&SAMPLE_COLUMNS, &system);
        assert_eq!(printed.columns, ["time", "mode", "state.n", "y", "q", "v"]);
        let printed = Layout::printed(&EVENT_COLUMNS, &system);
        assert_eq!((printed.time, printed.state), (1, 4));
    }
}
