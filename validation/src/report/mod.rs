//! The report of a `validate`, and the formats it is written in.
//!
//! Add a format by implementing [`Exporter`] and naming it in [`exporters`].

mod annotations;
mod baseline;
mod csv;
mod event;
mod evidence;
mod failing;
mod gather;
mod gradients;
mod grazing;
mod growth;
mod html;
mod json;
mod junit;
mod notes;
mod orders;
mod pictures;
mod ranking;
mod records;
mod row;
mod screen;
mod setting;
mod summary;
#[cfg(test)]
pub(crate) mod synthetic;
mod table;
mod trouble;
mod unanswered;
mod work_precision;

pub use annotations::{annotations, under_the_service};
pub use baseline::{Baseline, Compared, RowPlace};
pub use event::{EventMark, EventPicture, MismatchKind, View, ViewTrajectory, event_pictures};
pub use evidence::{
    CASES_FLAG, CaseNote, ErrorGrowth, FaultRow, GrazeRow, OSCILLATOR, ReportEvidence,
    RestartHistogram, SectionPair,
};
pub use gradients::{GradientCounts, GradientEntry};
pub use orders::{Order, orders};
pub use pictures::{PictureFile, pictures};
pub use ranking::{
    Cost, DefectUnits, Ranked, RankingFormat, RightRows, SettingCounts, ranking, ranking_text,
};
pub use records::{DefectQuantiles, FirstWrongRecord, JudgedRecords, Quantiles, TimeQuantiles};
pub use row::{EngineEntry, Report, ReportRow, Summary, ValidHorizons};
pub use screen::{MAX_LINES, ScreenParts, screen};
pub use table::WIDTH;
pub use unanswered::Unanswered;

use std::io::{self, Write};

/// A format of the report.
pub trait Exporter: Sync {
    /// The file it is written to.
    fn file_name(&self) -> &'static str;

    /// Writes the report, with what is shown beside its rows.
    ///
    /// # Errors
    /// What the writer says.
    fn write(
        &self,
        report: &Report,
        evidence: &ReportEvidence,
        out: &mut dyn Write,
    ) -> io::Result<()>;
}

/// All formats.
#[must_use]
pub fn exporters() -> &'static [&'static dyn Exporter] {
    &[&json::Json, &csv::Csv, &junit::Junit, &html::Html]
}
