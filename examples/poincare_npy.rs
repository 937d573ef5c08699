//! Writes a Poincare section of the chaotic attractor of Fig. 5 as an array for NumPy: one row per
//! forcing period, with the columns p and y.
//!
//! `cargo run --release --example poincare_npy > section.npy`

use npyz::WriterBuilder;
use percuss::dynamics::section::section;
use percuss::{Model, Parameters, Start};
use std::error::Error;
use std::io::Write;

/// The section at omega tau = 0 mod 2 pi (phi not included), after a transient of 100 forcing
/// periods.
pub fn write(out: impl Write, strobes: u64) -> Result<(), Box<dyn Error>> {
    let model = Model::new(Parameters::default())?;
    let rest = model.start(&Start::default())?;
    let options = npyz::WriteOptions::new().default_dtype().shape(&[strobes, 2]);
    let mut array = options.writer(out).begin_nd()?;
    for entry in section(&model, rest, 0.0, 100, strobes) {
        array.extend([entry.state.p, entry.state.y])?;
    }
    Ok(array.finish()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock(), 10_000)
}
