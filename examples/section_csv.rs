//! Writes a stroboscopic section of a forced system as CSV: the state once in each forcing period.
//!
//! `cargo run --release --example section_csv > section.csv`

use percuss::{System, gallery};
use std::error::Error;
use std::io::Write;

/// The states after the first `transient` periods, once in each of `periods` more.
pub fn write(transient: usize, periods: usize, out: impl Write) -> Result<(), Box<dyn Error>> {
    let system = System::from_toml(gallery::IMPACT_OSCILLATOR)?;
    let solver = system.solver::<f64>()?;
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record(&system.states)?;
    for sample in solver.run().samples(1)?.skip(transient).take(periods) {
        rows.write_record(sample.state().iter().map(f64::to_string))?;
    }
    Ok(rows.flush()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    write(1000, 2000, std::io::stdout().lock())
}
