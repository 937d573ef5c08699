//! Finds periodic orbits of one, two and five forcing periods at omega = 1.6, xi = 0.1 and says
//! which are stable: that of period five, one of the three attractors of Fig. 7e.
//!
//! `cargo run --release --example orbit_multipliers`

use percuss::dynamics::orbit::scan;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Model, Parameters, Start};
use std::error::Error;
use std::io::Write;

/// One line per orbit, with its first strobe, its multipliers and its drift.
pub fn write(mut out: impl Write) -> Result<(), Box<dyn Error>> {
    let model = Model::new(Parameters { omega: 1.6, xi: 0.1, ..Parameters::default() })?;
    let map = StrobeMap::new(model, model.start(&Start::default())?.instant);
    for period in [1, 2, 5] {
        let found = scan(&map, period, &mut |_| {});
        for orbit in found.iter().filter(|orbit| orbit.period() == period) {
            let [p, y, _] = orbit.points[0];
            let moduli = orbit.multipliers.map(|[re, im]| re.hypot(im));
            let kind = if orbit.is_stable() { "stable" } else { "unstable" };
            writeln!(out, "period {}, {kind}: p = {p:.6}, y = {y:.6}", orbit.period())?;
            writeln!(out, "    moduli of the multipliers {moduli:.6?}")?;
            writeln!(out, "    drift per forcing period {:.6}", orbit.drift_per_period)?;
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
