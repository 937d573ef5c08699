//! Runs one system from many starts, on all threads: how long a room heats before its thermostat
//! switches for the first time, beside the temperature from which it starts.
//!
//! `cargo run --release --example ensemble > first_switch.csv`

use percuss::{System, SystemError, gallery};
use std::error::Error;
use std::io::Write;
use std::thread;

/// The time of the first switch from each temperature.
pub fn first_switches(temperatures: &[f64]) -> Result<Vec<f64>, SystemError> {
    let system = System::from_toml(gallery::THERMOSTAT)?;
    let solver = system.solver::<f64>()?;
    let first_switch = |temperature: f64| {
        let start = system.start_at("on", 0.0, &[temperature, temperature])?;
        let first = solver.run_from(&start).events(1)?.next();
        Ok(first.map_or(f64::NAN, |event| *event.time()))
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let part = temperatures.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let parts: Vec<_> = temperatures
            .chunks(part)
            .map(|part| {
                scope.spawn(|| {
                    part.iter().map(|it| first_switch(*it)).collect::<Result<Vec<_>, _>>()
                })
            })
            .collect();
        let mut times = Vec::new();
        for part in parts {
            times.extend(part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?);
        }
        Ok(times)
    })
}

/// A row for each of a thousand temperatures.
pub fn write(out: impl Write) -> Result<(), Box<dyn Error>> {
    let temperatures: Vec<f64> = (0..1000).map(|n| f64::from(n) * 0.02).collect();
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record(["temperature", "first_switch"])?;
    for (temperature, time) in temperatures.iter().zip(first_switches(&temperatures)?) {
        rows.write_record([temperature.to_string(), time.to_string()])?;
    }
    Ok(rows.flush()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
