//! The truth of a case: its tables, of which those in the oscillator's own words name phases and
//! have no growth.

use super::decimal;
use super::growth::GrowthMatrices;
use super::heading::check_heading;
use crate::case::{Case, FileError};
use percuss::Ending;
use percuss::TwoWord;
use percuss::affine::{System, Until};
use std::collections::BTreeMap;

/// A state that stays below this part of the largest is called faint.
const MAX_FAINT_SHARE: f64 = 1e-3;

/// A row of a table.
#[derive(Clone, Debug)]
pub struct TruthRow {
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

impl TruthRow {
    /// The row's state, rounded.
    #[must_use]
    pub fn rounded(&self) -> Vec<f64> {
        self.state.iter().map(|it| it.value()).collect()
    }

    /// What an error of a time is judged beside, over the time scale: one, and the time or the
    /// largest state so far, whichever is larger.
    #[must_use]
    pub fn size_of_time(&self, time_scale: f64) -> f64 {
        1.0 + self.size.max(self.elapsed.value().abs() / time_scale)
    }
}

/// The truth of a case.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The start.
    pub start: TruthRow,
    /// The events.
    pub events: Vec<TruthRow>,
    /// The last state of the run.
    pub end: TruthRow,
    /// The ending of the run.
    pub ended: Ending,
    /// The time for which engines run: up to the horizon, or past an accumulation of impacts.
    pub span: f64,
    /// The states at the instants asked for, as far as the run goes.
    pub samples: Vec<TruthRow>,
    /// Whether events of one instant have an order that matters for what follows.
    pub ordered: bool,
}

/// The ending that the last row of a table tells; a proved table has no undecided one.
fn told_ending(word: &str) -> Option<Ending> {
    word.parse().ok().filter(|it| *it != Ending::Undecided)
}

impl Truth {
    /// Reads both tables and holds them against the case they are said to be of.
    pub(super) fn read(
        case: &Case,
        events: (&str, &str),
        samples: (&str, &str),
    ) -> Result<Self, FileError> {
        let form = TableForm::new(case);
        let table = Table::read(case, form, events, true)?;
        let sampled = Table::read(case, form, samples, false)?;
        let refused = |what: &str| FileError::new(events.0, what);
        let (last, rest) = table.rows.split_last().ok_or_else(|| refused("holds no row"))?;
        let (start, between) = rest.split_first().ok_or_else(|| refused("holds no start"))?;
        let ended = told_ending(&last.0).ok_or_else(|| refused("its last row names no ending"))?;
        if ended == Ending::BeyondGuard {
            return Err(refused(
                "the run ends where a mode is entered beyond one of its guards; accepted is a case \
                 whose horizon is before that",
            ));
        }
        let mut mode = start.1.mode;
        let mut rows = Vec::new();
        for (name, row) in between {
            let event = form.event(&case.system, mode, name, row.mode).ok_or_else(|| {
                refused(&format!("{name:?} is no event of {}", case.system.modes[mode].name))
            })?;
            mode = row.mode;
            rows.push(TruthRow { event, ..row.clone() });
        }
        let earliest = table.heading.get("accumulation.earliest");
        let earliest = earliest.and_then(|it| decimal::parse(it)).map(TwoWord::value);
        let phases = form == TableForm::Phases;
        let (mut end, mut whole) = (last.1.clone(), case.span());
        if phases {
            (end.mode, whole) = (mode, end.elapsed.value());
        }
        let mut truth = Self {
            start: start.1.clone(),
            events: rows,
            end,
            ended,
            span: earliest.unwrap_or(whole),
            samples: sampled.rows.into_iter().map(|(_, row)| row).collect(),
            ordered: phases || table.heading.contains_key("order_matters"),
        };
        let growth = GrowthMatrices::new(case);
        match form {
            TableForm::Phases => growth.fill(&mut truth),
            TableForm::Events => growth.round_instants(&mut truth),
        }
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
        let is_faint =
            |n: &usize| (f64::MIN_POSITIVE..MAX_FAINT_SHARE * largest).contains(&extent(*n));
        (0..scales.len()).filter(is_faint).collect()
    }

    /// The times since the start at which the state is known.
    #[must_use]
    pub fn sample_times(&self) -> Vec<f64> {
        self.samples.iter().map(|row| row.elapsed.value()).collect()
    }
}

/// The words of a table.
#[derive(Clone, Copy, PartialEq, Eq)]
enum TableForm {
    /// Those of the oscillator: the phase that begins, and no growth.
    Phases,
    /// Those of systems: an event, the mode that begins, and how errors have grown.
    Events,
}

impl TableForm {
    fn new(case: &Case) -> Self {
        if case.oscillator.is_some() { Self::Phases } else { Self::Events }
    }

    fn columns(self, states: &[String], of_events: bool) -> Vec<String> {
        let first: &[&str] = match self {
            Self::Phases => &["index", "phase", "elapsed", "tau"],
            Self::Events if of_events => &["index", "event", "mode", "elapsed", "time"],
            Self::Events => &["index", "mode", "elapsed", "time"],
        };
        let mut columns: Vec<String> = first.iter().map(|it| (*it).to_owned()).collect();
        columns.extend(states.iter().cloned());
        if self == Self::Events {
            columns.extend(of_events.then(|| "growth_time".to_owned()));
            columns.extend(states.iter().map(|state| format!("growth_{state}")));
        }
        columns
    }

    /// The number of an event in a mode, by its name or by the phase that it leads to: those that
    /// end the mode come first.
    fn event(self, system: &System, mode: usize, name: &str, next: usize) -> Option<usize> {
        let mode = &system.modes[mode];
        let leads = |until: &Until| until.next.iter().any(|it| it.mode == next);
        if self == Self::Phases {
            return mode.until.iter().position(leads);
        }
        let until = mode.until.iter().map(|it| &it.name);
        until.chain(mode.watch.iter().map(|it| &it.name)).position(|it| it == name)
    }
}

struct Table {
    heading: BTreeMap<String, String>,
    /// Each with the name of its event.
    rows: Vec<(String, TruthRow)>,
}

impl Table {
    fn read(
        case: &Case,
        form: TableForm,
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
        let columns = form.columns(&case.system.states, of_events);
        let found = reader.headers().map_err(|error| FileError::new(file, error))?;
        if found.iter().ne(columns.iter().map(String::as_str)) {
            let what = format!("accepted are the columns {}", columns.join(","));
            return Err(FileError::new(file, what));
        }
        let mut rows: Vec<(String, TruthRow)> = Vec::new();
        for (index, record) in reader.records().enumerate() {
            let record = record.map_err(|error| FileError::new(file, error))?;
            let row = read_row(case, index, &columns, &record).ok_or_else(|| {
                FileError::new(file, format!("row {index} is not accepted: {record:?}"))
            })?;
            let is_earlier =
                |before: &(String, TruthRow)| row.1.elapsed.minus(before.1.elapsed).value() < 0.0;
            if rows.last().is_some_and(is_earlier) {
                let what = format!("row {index} is earlier than the one before it");
                return Err(FileError::new(file, what));
            }
            rows.push(row);
        }
        Ok(Self { heading, rows })
    }
}

/// A row with the name of its event, or of its phase.
fn read_row(
    case: &Case,
    index: usize,
    columns: &[String],
    record: &csv::StringRecord,
) -> Option<(String, TruthRow)> {
    if record.get(0)?.parse() != Ok(index) {
        return None;
    }
    let place = |name: &str| columns.iter().position(|it| it == name);
    let word = |name: &str| record.get(place(name)?);
    let number = |name: &str| decimal::parse(word(name)?);
    let growth = |name: &str| match place(name) {
        Some(column) => {
            let growth = record.get(column)?.parse::<f64>().ok()?;
            (growth >= 1.0 && growth.is_finite()).then_some(growth)
        }
        None => Some(1.0),
    };
    let states = || case.system.states.iter();
    let name = word("event").or_else(|| word("phase")).unwrap_or_default();
    let mode = word("mode").unwrap_or(name);
    // The last row of a table of phases names none.
    let last = told_ending(mode).filter(|_| place("phase").is_some()).map(|_| 0);
    let row = TruthRow {
        event: 0,
        mode: last.or_else(|| case.system.mode(mode))?,
        elapsed: number("elapsed")?,
        state: states().map(|it| number(it)).collect::<Option<_>>()?,
        growth_time: growth("growth_time")?,
        growth: states().map(|it| growth(&format!("growth_{it}"))).collect::<Option<_>>()?,
        size: 0.0,
    };
    Some((name.to_owned(), row))
}
