//! Builds a system in Rust and writes its events with proved digits.
//!
//! A block on a spring is pulled by a belt: it sticks to the belt until the spring is stronger than
//! friction, and slips until it is as fast as the belt again.
//!
//! `cargo run --release --example own_system`

use percuss::system::{ModeBuilder, UntilBuilder};
use percuss::{Proved, System, SystemError};
use std::error::Error;
use std::io::Write;

/// The block and its belt.
pub fn stick_slip() -> Result<System, SystemError> {
    System::builder("stick-slip")
        .states(["x", "v"])
        .parameter("belt", 0.5)
        .parameter("static_friction", 1.0)
        .parameter("sliding_friction", 0.25)
        .mode(
            ModeBuilder::new("stick")
                .equation("x' = belt")
                .equation("v' = 0")
                .until(UntilBuilder::new("slip", "x > static_friction").next("slip")),
        )
        .mode(
            ModeBuilder::new("slip")
                .equation("x' = v")
                .equation("v' = sliding_friction - x")
                .until(UntilBuilder::new("stick", "v > belt").assign("v", "belt").next("stick")),
        )
        .start("stick", [("x", "0"), ("v", "belt")])
        .build()
}

/// The first eight events: name, mode, time, and position.
pub fn write(mut out: impl Write) -> Result<(), Box<dyn Error>> {
    let solver = stick_slip()?.solver::<Proved>()?;
    writeln!(out, "{:<6} {:<6} {:>20} {:>20}", "event", "mode", "time", "x")?;
    for event in solver.run().events(8)? {
        let (time, x) = (event.time(), &event.state()[0]);
        writeln!(out, "{:<6} {:<6} {time:>20} {x:>20}", event.name(), event.mode())?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    write(std::io::stdout().lock())
}
