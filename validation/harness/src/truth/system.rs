//! The truth of a case of a piecewise-affine system: its tables, or its run made again.

use super::{decimal, system_growth};
use crate::case::{FileError, SystemCase};
use crate::engine::Ended;
use percuss::TwoWord;
use percuss::affine::System;
use std::collections::BTreeMap;

/// A state that stays below this part of the largest is called faint.
const FAINT: f64 = 1e-3;

/// A row of a table.
#[derive(Clone, Debug)]
pub struct SystemTruthRow {
    /// The number of the event in the mode that it ends, or in which it is counted.
    pub event: usize,
    /// The mode that begins at an event, or holds at a sample.
    pub mode: usize,
    /// Time since the start.
    pub elapsed: TwoWord,
    /// The state after the event.
    pub state: Vec<TwoWord>,
    /// The growth of errors in the event time; 1 for samples.
    pub growth_time: f64,
    /// The growth of errors in each state.
    pub growth: Vec<f64>,
    /// The largest state of the run so far, over its scale: what rounds in one state grows into the
    /// others.
    pub size: f64,
}

impl SystemTruthRow {
    /// What an error of a time is judged beside, over the time scale: one, and the time or the
    /// largest state so far, whichever is larger.
    #[must_use]
    pub fn size_of_time(&self, time_scale: f64) -> f64 {
        1.0 + self.size.max(self.elapsed.value().abs() / time_scale)
    }
}

/// The truth of a case of a system.
#[derive(Clone, Debug)]
pub struct SystemTruth {
    /// The start.
    pub start: SystemTruthRow,
    /// The events.
    pub events: Vec<SystemTruthRow>,
    /// The last state of the run.
    pub end: SystemTruthRow,
    /// The ending of the run.
    pub ended: Ended,
    /// The time for which engines run: up to the horizon, or past an accumulation of impacts.
    pub span: f64,
    /// The states at the instants asked for, as far as the run goes.
    pub samples: Vec<SystemTruthRow>,
    /// Whether events of one instant have an order that matters for what follows.
    pub ordered: bool,
}

/// The last row's word for how a run ends.
fn ending(word: &str) -> Option<Ended> {
    Some(match word {
        "end" => Ended::Horizon,
        "accumulation" => Ended::Accumulation,
        "leaves-domain" => Ended::LeavesDomain,
        "no-progress" => Ended::NoProgress,
        "beyond-guard" => Ended::BeyondGuard,
        _ => return None,
    })
}

impl SystemTruth {
    /// Reads both tables and holds them against the case they are said to be of.
    pub(super) fn read(
        case: &SystemCase,
        events: (&str, &str),
        samples: (&str, &str),
    ) -> Result<Self, FileError> {
        let table = SystemTable::read(case, events, true)?;
        let sampled = SystemTable::read(case, samples, false)?;
        let refused = |what: &str| FileError::of(events.0, what);
        let (last, rest) = table.rows.split_last().ok_or_else(|| refused("holds no row"))?;
        let (start, events_between) =
            rest.split_first().ok_or_else(|| refused("holds no start"))?;
        let ended = ending(&last.0).ok_or_else(|| refused("its last row names no ending"))?;
        if ended == Ended::BeyondGuard {
            return Err(refused(
                "the run ends where a mode is entered beyond one of its guards; accepted is a case \
                 whose horizon is before that",
            ));
        }
        let mut mode = start.1.mode;
        let mut rows = Vec::new();
        for (name, row) in events_between {
            let event = number(&case.system, mode, name).ok_or_else(|| {
                refused(&format!("{name:?} is no event of {}", case.system.modes[mode].name))
            })?;
            mode = row.mode;
            rows.push(SystemTruthRow { event, ..row.clone() });
        }
        let earliest = table.heading.get("accumulation.earliest");
        let earliest = earliest.and_then(|it| decimal::parse(it)).map(TwoWord::value);
        let mut truth = Self {
            start: start.1.clone(),
            events: rows,
            end: last.1.clone(),
            ended,
            span: earliest.unwrap_or_else(|| case.span()),
            samples: sampled.rows.into_iter().map(|(_, row)| row).collect(),
            ordered: table.heading.contains_key("order_matters"),
        };
        system_growth::round_instants(&mut truth, case);
        Ok(truth.with_sizes(&case.system.scales))
    }

    /// The truth with the largest state so far in each row.
    #[must_use]
    pub(super) fn with_sizes(mut self, scales: &[f64]) -> Self {
        let rows = [&mut self.start, &mut self.end];
        let mut rows: Vec<_> =
            rows.into_iter().chain(&mut self.events).chain(&mut self.samples).collect();
        rows.sort_by(|a, b| a.elapsed.value().total_cmp(&b.elapsed.value()));
        let mut largest = 0.0_f64;
        for row in rows {
            let sizes =
                row.state.iter().zip(scales).map(|(state, scale)| state.value().abs() / scale);
            largest = sizes.fold(largest, f64::max);
            row.size = largest;
        }
        self
    }

    /// The numbers of the states that move, but stay below a thousandth of the size beside which
    /// their errors are judged: a wrong value of them is hardly seen.
    #[must_use]
    pub fn faint_states(&self, scales: &[f64]) -> Vec<usize> {
        let rows = || self.events.iter().chain(&self.samples).chain([&self.start, &self.end]);
        let largest = rows().fold(1.0, |most: f64, row| most.max(row.size));
        let extent = |n: usize| {
            rows().fold(0.0, |most: f64, row| most.max(row.state[n].value().abs() / scales[n]))
        };
        let is_faint = |n: &usize| (f64::MIN_POSITIVE..FAINT * largest).contains(&extent(*n));
        (0..scales.len()).filter(is_faint).collect()
    }

    /// The times since the start at which the state is known.
    #[must_use]
    pub fn sample_times(&self) -> Vec<f64> {
        self.samples.iter().map(|row| row.elapsed.value()).collect()
    }
}

/// The number of an event in a mode: those that end it come first.
fn number(system: &System, mode: usize, name: &str) -> Option<usize> {
    let mode = &system.modes[mode];
    let until = mode.until.iter().map(|it| &it.name);
    until.chain(mode.watch.iter().map(|it| &it.name)).position(|it| it == name)
}

struct SystemTable {
    heading: BTreeMap<String, String>,
    /// Each with the name of its event.
    rows: Vec<(String, SystemTruthRow)>,
}

impl SystemTable {
    fn read(
        case: &SystemCase,
        (file, text): (&str, &str),
        of_events: bool,
    ) -> Result<Self, FileError> {
        let lines = text.lines().take_while(|line| line.starts_with('#'));
        let entry = |line: &str| {
            let (key, value) = line[1..].split_once('=')?;
            Some((key.trim().to_owned(), value.trim().to_owned()))
        };
        let heading: BTreeMap<_, _> = lines.filter_map(entry).collect();
        check_heading(case, file, &heading)?;
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
        let expected = columns(&case.system.states, of_events);
        let found = reader.headers().map_err(|error| FileError::of(file, error))?;
        if found.iter().ne(expected.iter().map(String::as_str)) {
            let what = format!("accepted are the columns {}", expected.join(","));
            return Err(FileError::of(file, what));
        }
        let mut rows = Vec::new();
        for (index, record) in reader.records().enumerate() {
            let record = record.map_err(|error| FileError::of(file, error))?;
            let row = read_row(case, index, &record, of_events).ok_or_else(|| {
                FileError::of(file, format!("row {index} is not accepted: {record:?}"))
            })?;
            rows.push(row);
        }
        Ok(Self { heading, rows })
    }
}

fn columns(states: &[String], of_events: bool) -> Vec<String> {
    let first: &[&str] = if of_events {
        &["index", "event", "mode", "elapsed", "time"]
    } else {
        &["index", "mode", "elapsed", "time"]
    };
    let growth = if of_events { Some("growth_time".to_owned()) } else { None };
    let first = first.iter().map(|it| (*it).to_owned());
    let grown = states.iter().map(|state| format!("growth_{state}"));
    first.chain(states.iter().cloned()).chain(growth).chain(grown).collect()
}

fn read_row(
    case: &SystemCase,
    index: usize,
    record: &csv::StringRecord,
    of_events: bool,
) -> Option<(String, SystemTruthRow)> {
    if record.get(0)?.parse() != Ok(index) {
        return None;
    }
    let at = usize::from(of_events);
    let states = case.system.states.len();
    let state = 4 + at..4 + at + states;
    let number = |column: usize| decimal::parse(record.get(column)?);
    let growth = |column: usize| {
        let growth = record.get(column)?.parse::<f64>().ok()?;
        (growth >= 1.0 && growth.is_finite()).then_some(growth)
    };
    let row = SystemTruthRow {
        event: 0,
        mode: case.system.mode(record.get(1 + at)?)?,
        elapsed: number(2 + at)?,
        state: state.clone().map(number).collect::<Option<_>>()?,
        growth_time: if of_events { growth(state.end)? } else { 1.0 },
        growth: (state.end + at..state.end + at + states).map(growth).collect::<Option<_>>()?,
        size: 0.0,
    };
    Some((if of_events { record.get(1)?.to_owned() } else { String::new() }, row))
}

/// The table must have been made from the very values of the case.
fn check_heading(
    case: &SystemCase,
    file: &str,
    heading: &BTreeMap<String, String>,
) -> Result<(), FileError> {
    let parameters = case.system.parameters.iter();
    let numbers = parameters.map(|(name, value)| (format!("parameters.{name}"), *value)).chain([
        ("horizon.until".to_owned(), case.until),
        ("horizon.samples".to_owned(), f64::from(case.samples)),
    ]);
    for (name, value) in numbers {
        let stated = heading.get(&name);
        if stated.and_then(|it| it.parse::<f64>().ok()) != Some(value) {
            let stated = stated.map_or("missing", String::as_str);
            let what = format!("was made for {name} = {stated}, the case has {value:?}");
            return Err(FileError::of(file, what));
        }
    }
    let words = [
        ("case", case.name.as_str()),
        ("system", case.system.name.as_str()),
        ("horizon.backward", if case.backward { "true" } else { "false" }),
    ];
    for (name, value) in words {
        let stated = heading.get(name).map_or("missing", String::as_str);
        if stated != value {
            let what = format!("was made for {name} = {stated}, the case has {value}");
            return Err(FileError::of(file, what));
        }
    }
    Ok(())
}
