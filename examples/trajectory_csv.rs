//! Writes the events of a run from rest as rows of CSV.
//!
//! A row is a phase's beginning, the start first: the phase that begins, the time, p and q from the
//! slider's bottom, y the velocity of the mass, and v the drift; all non-dimensional.
//!
//! `cargo run --release --example trajectory_csv > run.csv`

use percuss::{Exit, Model, Parameters, Start};
use std::error::Error;
use std::io::Write;

/// The run from rest that leads to Table 1 of the paper: its last nine rows, from tau = 1142.285
/// on, are the table.
pub fn write(out: impl Write) -> Result<(), Box<dyn Error>> {
    let model = Model::new(Parameters { omega: 0.1, ..Parameters::default() })?;
    let rest = model.start(&Start::default())?;
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record(["phase", "tau", "p", "y", "q", "v"])?;
    for segment in model.trajectory(rest).until_time(1268.0)? {
        let (entry, state) = (segment.entry(), segment.entry().state);
        let numbers = [model.time(&entry.instant), state.p, state.y, state.q, entry.drift.value()];
        let row = std::iter::once(segment.phase().to_string());
        rows.write_record(row.chain(numbers.map(|number| number.to_string())))?;
        if let Exit::Endless(why) = segment.exit() {
            eprintln!("the last phase {why}");
        }
    }
    Ok(rows.flush()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
