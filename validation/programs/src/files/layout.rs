//! The columns of files of events and of samples: those of an answer, or those that `percuss
//! events` prints.

use super::table::Table;
use crate::wire::EndedBy;
use percuss_engines::system::System;

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
        let with_before = Self::answer_with_before(system);
        Self::named(table, [Self::answer(system), with_before, Self::printed(system)])
    }

    /// The layout of a file of samples, which its header names.
    ///
    /// # Errors
    /// Another header, with those that are accepted.
    pub(super) fn of_samples(table: &Table, system: &System) -> Result<Self, String> {
        let layout = |first: &[&str], has_start| {
            let columns = columns(first, system);
            Self { columns, has_start, time: 0, state: first.len(), before: None }
        };
        Self::named(table, [layout(&["time"], false), layout(&["time", "mode"], true)])
    }

    /// The ending that a word in the column of events stands for.
    pub(super) fn ending(&self, event: &str) -> Option<EndedBy> {
        let is_printed_end = self.has_start && event == "end";
        if is_printed_end { Some(EndedBy::Horizon) } else { EndedBy::named(event) }
    }

    fn named<const N: usize>(table: &Table, accepted: [Self; N]) -> Result<Self, String> {
        let header = table.header();
        let texts = accepted.each_ref().map(|it| format!("{:?}", it.columns.join(",")));
        let found = accepted.into_iter().find(|it| it.columns == header);
        found.ok_or_else(|| table.other_header(&texts.join(", ")))
    }

    fn answer(system: &System) -> Self {
        let first = ["time", "event", "mode"].map(str::to_owned).into_iter();
        let columns = first.chain(system.states.iter().cloned()).collect();
        Self { columns, has_start: false, time: 0, state: 3, before: None }
    }

    fn answer_with_before(system: &System) -> Self {
        let mut layout = Self::answer(system);
        layout.before = Some(layout.columns.len());
        layout.columns.extend(system.states.iter().map(|it| format!("before.{it}")));
        layout
    }

    /// What `percuss events` prints.
    fn printed(system: &System) -> Self {
        let columns = columns(&["n", "time", "event", "mode"], system);
        Self { columns, has_start: true, time: 1, state: 4, before: None }
    }
}

/// The first columns of what `percuss events` prints, and the states, which have a prefix where
/// they are called as one of its columns.
fn columns(first: &[&str], system: &System) -> Vec<String> {
    let column = |state: &String| match ["n", "time", "event", "mode"].contains(&state.as_str()) {
        true => format!("state.{state}"),
        false => state.clone(),
    };
    let states = system.states.iter().map(column);
    first.iter().map(|it| (*it).to_owned()).chain(states).collect()
}
