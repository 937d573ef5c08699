//! How accurate an engine was asked to be, in words.

use super::ReportRow;

impl ReportRow {
    /// The tolerance, or the step as `h ...`, or nothing where there is none to choose.
    #[must_use]
    pub fn setting(&self) -> String {
        setting(self.tolerance, self.step)
    }

    /// The engine with its setting.
    #[must_use]
    pub fn who(&self) -> String {
        who(self.engine, &self.setting())
    }
}

/// An engine with its setting, where it has one.
pub(super) fn who(engine: &str, setting: &str) -> String {
    if setting.is_empty() { engine.to_owned() } else { format!("{engine} {setting}") }
}

pub(super) fn setting(tolerance: Option<f64>, step: Option<f64>) -> String {
    match (tolerance, step) {
        (Some(tolerance), _) => format!("{tolerance:e}"),
        (None, Some(step)) => format!("h {step}"),
        (None, None) => String::new(),
    }
}
