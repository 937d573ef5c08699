//! Evaluates a run anywhere between its events: the closed form of a phase is its dense output.
//!
//! `cargo run --release --example dense_output > motion.csv`

use percuss::{Model, Parameters, Start};
use std::error::Error;
use std::io::Write;

/// Twenty forcing periods, at eight instants of each phase and its beginning.
pub fn write(out: impl Write) -> Result<(), Box<dyn Error>> {
    const POINTS: u32 = 8;
    let model = Model::new(Parameters::default())?;
    let rest = model.start(&Start::default())?;
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record(["tau", "p", "y", "q", "v"])?;
    for segment in model.trajectory(rest).for_periods(20) {
        let begin = model.time(&segment.entry().instant);
        for k in 0..POINTS {
            let elapsed = segment.duration() * f64::from(k) / f64::from(POINTS);
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
