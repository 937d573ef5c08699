//! Writes the motion of a system between its events as CSV, from a file or of the built-in ball.
//!
//! A row is a sample or an event: the mode, the time, and the states.
//!
//! `cargo run --release --example motion_csv [FILE.system.toml] > motion.csv`

use percuss::{System, gallery};
use std::error::Error;
use std::io::Write;

/// The motion up to a time, with so many samples in each unit of time or forcing period.
pub fn write(
    system: &System,
    until: f64,
    samples: u32,
    out: impl Write,
) -> Result<(), Box<dyn Error>> {
    let solver = system.solver::<f64>()?;
    let mut rows = csv::Writer::from_writer(out);
    let states = system.states.iter().map(String::as_str);
    rows.write_record(["what", "mode", "time"].into_iter().chain(states))?;
    for event in solver.run().until_with_samples(until, samples)? {
        let mut row = vec![event.name().to_owned(), event.mode().to_owned()];
        row.extend(std::iter::once(event.time()).chain(event.state()).map(f64::to_string));
        rows.write_record(&row)?;
    }
    Ok(rows.flush()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let system = match std::env::args().nth(1) {
        Some(path) => System::from_file(path)?,
        None => System::from_toml(gallery::BOUNCING_BALL)?,
    };
    write(&system, 10.0 * system.time_scale, 20, std::io::stdout().lock())
}
