//! Evaluates a run anywhere between its events: the closed form of a phase is its dense output.
//!
//! A row is an instant: its time, p and q from the slider's bottom, y the velocity of the mass, and
//! v the drift; all non-dimensional.
//!
//! `cargo run --release --example dense_output > motion.csv`

use percuss::{Model, Parameters, Start};
use std::error::Error;
use std::io::Write;

/// Twenty forcing periods, at eight instants of each phase, the first of which is its beginning.
pub fn write(out: impl Write) -> Result<(), Box<dyn Error>> {
    const POINTS: u32 = 8;
    let model = Model::new(Parameters::default())?;
    let rest = model.start(&Start::default())?;
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record(["tau", "p", "y", "q", "v"])?;
    let end = rest.instant.after_periods(20, 1);
    for segment in model.trajectory(rest).until(end) {
        // A phase that never ends has an infinite duration, whatever the horizon.
        let length = segment.duration().min(segment.elapsed_at(&end));
        let begin = model.time(&segment.entry().instant);
        for k in 0..POINTS {
            let elapsed = length * f64::from(k) / f64::from(POINTS);
            let sample = segment.at(elapsed);
            let numbers =
                [begin + elapsed, sample.state.p, sample.state.y, sample.state.q, sample.v];
            rows.write_record(numbers.map(|number| number.to_string()))?;
        }
    }
    Ok(rows.flush()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
