//! The rows of `events`.

use super::super::format::OutputFlags;
use super::Format;
use super::digits::{has_digits, proved};
use crate::truth::DoubleDouble;
use anyhow::{Result, bail};
use percuss::affine::{Ending, Event, Run, Solver, System, What};
use percuss::number::Number;
use serde::Serialize;
use std::collections::BTreeMap;

/// What is asked for.
pub(super) struct Rows<'a> {
    pub(super) system: &'a System,
    pub(super) solver: &'a Solver<DoubleDouble>,
    pub(super) digits: usize,
    pub(super) most: Option<usize>,
    /// Whether the run is kept, to be drawn.
    pub(super) is_picture: bool,
}

/// A picture of more events than this shows nothing.
const MOST_DRAWN: usize = 20_000;

/// What is printed.
#[derive(Default)]
pub(super) struct EventListing {
    rows: Vec<EventRow>,
    accumulation: Option<Accumulation>,
    pub(super) notes: Vec<String>,
    pub(super) decided: bool,
    /// The start and all events, where they are to be drawn.
    pub(super) run: Vec<Event<DoubleDouble>>,
}

/// Numbers are texts, because a reader's f64 would not hold their digits.
#[derive(Serialize)]
struct EventRow {
    n: usize,
    time: String,
    event: String,
    mode: String,
    #[serde(serialize_with = "in_order")]
    state: Vec<(String, String)>,
}

#[derive(Serialize)]
struct Accumulation {
    earliest: String,
    latest: String,
}

#[derive(Serialize)]
struct List<'a> {
    schema: u32,
    percuss: &'static str,
    system: &'a str,
    parameters: BTreeMap<String, f64>,
    accumulation: Option<&'a Accumulation>,
    rows: &'a [EventRow],
}

impl Rows<'_> {
    /// Runs the system from its start.
    pub(super) fn listed(&self, until: f64) -> Result<EventListing> {
        let start = self.system.start.as_ref();
        let run = start.and_then(|it| self.solver.run_enclosed(it, DoubleDouble::exact(until)));
        let Some(run) = run else { bail!("{}: its start is not decided", self.system.name) };
        let mut listed = EventListing { decided: true, ..EventListing::default() };
        self.push(&mut listed, &run.start(), String::new());
        self.collect(run, &mut listed)?;
        Ok(listed)
    }

    fn collect(&self, run: Run<'_, DoubleDouble>, listed: &mut EventListing) -> Result<()> {
        for event in run {
            if self.most.is_some_and(|most| listed.rows.len() > most) {
                return Ok(());
            }
            if self.is_picture && listed.rows.len() > MOST_DRAWN {
                bail!(
                    "a picture of more than {MOST_DRAWN} events is not accepted: --output or --format of csv or json is, or a shorter run"
                );
            }
            let name = self.name(&event, listed);
            self.push(listed, &event, name);
            if listed.rows.last().is_some_and(|row| !has_digits(&row.time)) {
                listed.rows.pop();
                listed.run.pop();
                listed.notes.push(format!(
                    "after {} events no digit of the time is left: the run ends there",
                    listed.rows.len() - 1
                ));
                return Ok(());
            }
        }
        Ok(())
    }

    fn push(&self, listed: &mut EventListing, event: &Event<DoubleDouble>, name: String) {
        let Some(errors) = &event.errors else { return };
        let cells = event.state.iter().zip(&errors.state);
        let cells = cells.map(|(value, error)| proved(*value, *error, self.digits));
        if self.is_picture {
            listed.run.push(event.clone());
        }
        listed.rows.push(EventRow {
            n: listed.rows.len(),
            time: proved(event.time.value(), errors.time, self.digits),
            event: name,
            mode: self.system.modes[event.mode].name.clone(),
            state: self.system.states.iter().cloned().zip(cells).collect(),
        });
    }

    /// The event's name, or that of the ending, which leaves a note.
    fn name(&self, event: &Event<DoubleDouble>, listed: &mut EventListing) -> String {
        let ending = match &event.what {
            What::Until(mode, index) => return self.system.modes[*mode].until[*index].name.clone(),
            What::Watch(mode, index) => return self.system.modes[*mode].watch[*index].name.clone(),
            What::Start => return String::new(),
            What::End(ending) => ending,
        };
        let time = event.time.value();
        let (name, note, decided) = match ending {
            Ending::Horizon => return "end".to_owned(),
            Ending::Accumulation(from, to) => {
                let error = event.errors.as_ref().map_or(0.0, |it| it.time);
                let middle = time + (*from + *to) * DoubleDouble::exact(0.5);
                let width = 0.5 * (*to - *from).to_f64() + error + 1e-29 * time.to_f64().abs();
                let [earliest, latest] = [-width, width].map(|it| {
                    let end = middle + DoubleDouble::exact(it);
                    proved(end, 1e-30 * end.to_f64().abs(), 30)
                });
                let note =
                    format!("infinitely many impacts accumulate between {earliest} and {latest}");
                listed.accumulation = Some(Accumulation { earliest, latest });
                ("accumulation", note, true)
            }
            Ending::LeavesDomain => {
                ("leaves-domain", "the boundary of the mode is reached".to_owned(), true)
            }
            Ending::NoProgress => {
                ("no-progress", "64 events fall on one instant".to_owned(), false)
            }
            Ending::BeyondGuard => {
                ("beyond-guard", "the mode is entered beyond one of its guards".to_owned(), false)
            }
            Ending::Undecided => {
                ("undecided", "what comes next is not decided by 106 bits".to_owned(), false)
            }
        };
        listed.notes.push(format!("the run ends at {}: {note}", time.to_f64()));
        listed.decided = decided;
        name.to_owned()
    }

    /// Writes the rows.
    pub(super) fn write(
        &self,
        listed: &EventListing,
        output: &OutputFlags<Format>,
        format: Format,
    ) -> Result<()> {
        match format {
            Format::Json => output.destination().json(&List {
                schema: 1,
                percuss: env!("CARGO_PKG_VERSION"),
                system: &self.system.name,
                parameters: self.system.parameters.clone(),
                accumulation: listed.accumulation.as_ref(),
                rows: &listed.rows,
            }),
            _ => output.destination().write(|out| {
                let mut writer = csv::Writer::from_writer(Vec::new());
                let states = self.system.states.iter().map(String::as_str);
                writer.write_record(["n", "time", "event", "mode"].into_iter().chain(states))?;
                for row in &listed.rows {
                    let n = row.n.to_string();
                    let first = [n.as_str(), &row.time, &row.event, &row.mode];
                    let cells = row.state.iter().map(|(_, cell)| cell.as_str());
                    writer.write_record(first.into_iter().chain(cells))?;
                }
                Ok(out.write_all(&writer.into_inner()?)?)
            }),
        }
    }
}

fn in_order<S: serde::Serializer>(
    state: &[(String, String)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(state.iter().map(|(name, cell)| (name, cell)))
}
