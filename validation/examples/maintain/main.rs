//! Makes the project's own pages, tables and limits anew: `cargo maintain`.

pub(crate) mod attractor_power;
pub(crate) mod blocks;
pub(crate) mod calibrate;
pub(crate) mod drift_map;
pub(crate) mod nulls;
pub(crate) mod power_curve;
pub(crate) mod scoreboard;
pub(crate) mod shortcomings;
pub(crate) mod speed_table;
pub(crate) mod summary;
pub(crate) mod sweep_faults;
pub(crate) mod systems_table;

use anyhow::Result;
use clap::Parser;

/// Make the project's pages, tables and limits anew
#[derive(Parser)]
#[command(name = "cargo maintain")]
enum Task {
    AttractorPower(attractor_power::Arguments),
    Calibrate(calibrate::Arguments),
    DriftMap(drift_map::Arguments),
    Nulls(nulls::Arguments),
    PowerCurve(power_curve::Arguments),
    Scoreboard(scoreboard::Arguments),
    Shortcomings(shortcomings::Arguments),
    SpeedTable(speed_table::Arguments),
    Summary(summary::Arguments),
    SweepFaults(sweep_faults::Arguments),
    SystemsTable(systems_table::Arguments),
}

fn main() -> Result<()> {
    match Task::parse() {
        Task::AttractorPower(arguments) => attractor_power::run(&arguments),
        Task::Calibrate(arguments) => calibrate::run(&arguments),
        Task::DriftMap(arguments) => drift_map::run(&arguments),
        Task::Nulls(arguments) => nulls::run(&arguments),
        Task::PowerCurve(arguments) => power_curve::run(&arguments),
        Task::Scoreboard(arguments) => scoreboard::run(&arguments),
        Task::Shortcomings(arguments) => shortcomings::run(&arguments),
        Task::SpeedTable(arguments) => speed_table::run(&arguments),
        Task::Summary(arguments) => summary::run(&arguments),
        Task::SweepFaults(arguments) => sweep_faults::run(&arguments),
        Task::SystemsTable(arguments) => systems_table::run(&arguments),
    }
}
