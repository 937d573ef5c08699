//! Small systems to begin with, as the texts of their files.
//!
//! The documentation's examples run them; copy one and change it. `docs/SYSTEM_FORMAT.md` in the
//! repository has the whole format.
//!
//! ```
//! use percuss::{System, gallery};
//!
//! for text in [gallery::BOUNCING_BALL, gallery::IMPACT_OSCILLATOR, gallery::THERMOSTAT] {
//!     let system = System::from_toml(text)?;
//!     let solver = system.solver::<f64>()?;
//!     assert_eq!(solver.run().events(3)?.count(), 3);
//! }
//! # Ok::<(), percuss::SystemError>(())
//! ```

/// A ball that falls from the height 1 and loses half of its speed at each impact: one mode, a
/// reset, and impacts that accumulate.
pub const BOUNCING_BALL: &str = include_str!("bouncing_ball.system.toml");

/// A forced oscillator that strikes a rigid stop: forcing, a reset and a watched guard.
pub const IMPACT_OSCILLATOR: &str = include_str!("impact_oscillator.system.toml");

/// A room whose heater a thermostat switches: two modes without resets.
pub const THERMOSTAT: &str = include_str!("thermostat.system.toml");
