//! One case's tables: its events and its sample.

use super::decimal;
use crate::case::{Case, FileError, Horizon};
use percuss::Phase;
use percuss::TwoWord;

/// The phase of an event table's last row.
const END: &str = "end";

/// A row of a table.
#[derive(Clone, Copy, Debug)]
pub struct TruthRow {
    /// The phase that begins at an event, or holds at a sample; `None` at the horizon.
    pub phase: Option<Phase>,
    /// Time since the start.
    pub elapsed: TwoWord,
    /// p, y, q and v.
    pub state: [TwoWord; 4],
}

/// The truth of a case.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The start.
    pub start: TruthRow,
    /// The state at which each phase after the first begins.
    pub events: Vec<TruthRow>,
    /// The horizon.
    pub end: TruthRow,
    /// Eight instants per forcing period, the start among them.
    pub samples: Vec<TruthRow>,
}

impl TruthRow {
    /// The row's state, rounded.
    #[must_use]
    pub fn rounded(&self) -> [f64; 4] {
        self.state.map(TwoWord::value)
    }
}

impl Truth {
    /// Samples per forcing period.
    pub const SAMPLES_PER_PERIOD: u32 = 8;

    /// Reads both tables and holds them against the case they are said to be of.
    pub(super) fn read(
        case: &Case,
        events: (&str, &str),
        samples: (&str, &str),
    ) -> Result<Self, FileError> {
        let mut rows = read_rows(case, events.0, events.1)?;
        let samples = read_rows(case, samples.0, samples.1)?;
        match (rows.len() >= 2).then(|| rows.pop()).flatten() {
            Some(end) if end.phase.is_none() && rows.iter().all(|row| row.phase.is_some()) => {
                let start = rows.remove(0);
                Ok(Self { start, events: rows, end, samples })
            }
            _ => Err(FileError::of(
                events.0,
                "accepted is a table of phases whose last row alone is \"end\"",
            )),
        }
    }

    /// The run's length.
    #[must_use]
    pub fn span(&self) -> f64 {
        self.end.elapsed.value()
    }
}

fn read_rows(case: &Case, file: &str, text: &str) -> Result<Vec<TruthRow>, FileError> {
    check_heading(case, file, text)?;
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let heading = reader.headers().map_err(|error| FileError::of(file, error))?;
    if heading.iter().ne(["index", "phase", "elapsed", "tau", "p", "y", "q", "v"]) {
        return Err(FileError::of(
            file,
            "accepted are the columns index,phase,elapsed,tau,p,y,q,v",
        ));
    }
    let mut rows: Vec<TruthRow> = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| FileError::of(file, error))?;
        let row = read_row(index, &record);
        let row = row.ok_or_else(|| {
            FileError::of(file, format!("row {index} is not accepted: {record:?}"))
        })?;
        let backwards =
            rows.last().is_some_and(|before| row.elapsed.minus(before.elapsed).value() < 0.0);
        if backwards {
            return Err(FileError::of(
                file,
                format!("row {index} is earlier than the one before it"),
            ));
        }
        rows.push(row);
    }
    Ok(rows)
}

fn read_row(index: usize, record: &csv::StringRecord) -> Option<TruthRow> {
    if record.get(0)?.parse() != Ok(index) {
        return None;
    }
    let phase = match record.get(1)? {
        END => None,
        token => Some(token.parse().ok()?),
    };
    let number = |column: usize| decimal::parse(record.get(column)?);
    let state = [number(4)?, number(5)?, number(6)?, number(7)?];
    Some(TruthRow { phase, elapsed: number(2)?, state })
}

/// The table must have been made from the very f64 values of the case.
fn check_heading(case: &Case, file: &str, text: &str) -> Result<(), FileError> {
    let given = |name: &str| {
        let mut lines = text.lines().take_while(|line| line.starts_with('#'));
        lines.find_map(|line| line.strip_prefix(&format!("# {name} = ")))
    };
    let start = case.start;
    let model = case.parameters;
    let numbers = [
        ("a", model.a),
        ("b", model.b),
        ("xi", model.xi),
        ("omega", model.omega),
        ("g", model.g),
        ("phi", model.phi),
        ("start.tau", start.tau),
        ("start.p", start.p),
        ("start.y", start.y),
        ("start.v", start.v),
        ("start.cycle", start.cycle as f64),
        match case.horizon {
            Horizon::Periods(periods) => ("horizon.periods", f64::from(periods)),
            Horizon::Until(tau) => ("horizon.until", tau),
        },
    ];
    for (name, value) in numbers.into_iter().chain(start.q.map(|q| ("start.q", q))) {
        let stated = given(name).and_then(|text| text.parse::<f64>().ok());
        if stated != Some(value) {
            let stated = given(name).unwrap_or("missing");
            return Err(FileError::of(
                file,
                format!("was made for {name} = {stated}, the case has {value:?}"),
            ));
        }
    }
    Ok(())
}
