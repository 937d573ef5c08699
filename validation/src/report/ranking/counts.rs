//! What is counted of rows: whether one is right, and how many are at each setting.

use super::DefectUnits;
use crate::report::records::finite;
use crate::report::{JudgedRecords, ReportRow};
use crate::score::{Spread, Verdict};
use serde::{Serialize, Serializer};

/// A number for each setting, from coarse to fine; a map with these keys in files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SettingCounts(pub Vec<(String, usize)>);

impl SettingCounts {
    /// The sum over the settings.
    #[must_use]
    pub fn total(&self) -> usize {
        self.0.iter().map(|it| it.1).sum()
    }
}

impl Serialize for SettingCounts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, count)| (key, count)))
    }
}

impl ReportRow {
    /// Whether the engine is the exact solver, which has no accuracy to choose.
    #[must_use]
    pub const fn is_exact(&self) -> bool {
        self.tolerance.is_none() && self.step.is_none()
    }

    /// Whether nothing excuses that it is out of bounds, or without a result.
    #[must_use]
    pub const fn is_unexpected(&self) -> bool {
        matches!(self.verdict, Verdict::Fail | Verdict::Error)
    }

    /// Whether the row is wholly right: within its bounds, with its samples judged. Exact engines
    /// are judged by the tables alone.
    #[must_use]
    pub fn is_right(&self) -> bool {
        let within = matches!(self.verdict, Verdict::Pass | Verdict::Undecidable);
        let is_judged = self.is_sampled && self.records.defect.sample.max.is_some();
        within && (self.is_exact() || is_judged)
    }

    /// The setting as a key: `1e-6`, `h=1/16`, or `exact`.
    #[must_use]
    pub fn setting_key(&self) -> String {
        match (self.tolerance, self.step) {
            (Some(tolerance), _) => format!("{tolerance:e}"),
            (None, Some(step)) if step.recip().fract() == 0.0 => format!("h=1/{}", step.recip()),
            (None, Some(step)) => format!("h={step}"),
            (None, None) => "exact".to_owned(),
        }
    }

    /// How coarse the setting is.
    pub(in crate::report) fn coarseness(&self) -> f64 {
        self.tolerance.or(self.step).unwrap_or(0.0)
    }
}

/// The settings of some rows, from coarse to fine.
pub(in crate::report) fn settings(rows: &[&ReportRow]) -> Vec<String> {
    let mut settings: Vec<(f64, String)> =
        rows.iter().map(|row| (row.coarseness(), row.setting_key())).collect();
    settings.sort_by(|a, b| b.0.total_cmp(&a.0));
    settings.dedup();
    settings.into_iter().map(|it| it.1).collect()
}

/// How many rows of each setting are of a kind.
pub(super) fn of_settings(rows: &[&ReportRow], is: impl Fn(&ReportRow) -> bool) -> SettingCounts {
    let count = |setting: String| {
        let own = rows.iter().filter(|row| row.setting_key() == setting && is(row));
        let count = own.count();
        (setting, count)
    };
    SettingCounts(settings(rows).into_iter().map(count).collect())
}

/// The sum of a count over the rows that have it.
pub(super) fn sum(rows: &[&ReportRow], count: fn(&JudgedRecords) -> Option<usize>) -> usize {
    rows.iter().filter_map(|row| count(&row.records)).sum()
}

/// The quantiles over rows of their largest defect.
pub(super) fn defect_units(rows: &[&ReportRow]) -> DefectUnits {
    let largest = |row: &&ReportRow| {
        let defect = row.records.defect;
        [defect.time.size.max, defect.state.max].into_iter().flatten().reduce(f64::max)
    };
    let spread = Spread::new(rows.iter().filter_map(largest).collect());
    DefectUnits { median: finite(spread.median), q99: finite(spread.q99) }
}
