//! Colours that eyes of every kind tell apart (Okabe and Ito 2008), the same for a phase everywhere.

use percuss::Phase;
use plotters::style::RGBColor;

/// The colour of a phase.
pub(super) const fn phase(phase: Phase) -> RGBColor {
    match phase {
        Phase::NoContact => RGBColor(0, 114, 178),
        Phase::Contact => RGBColor(230, 159, 0),
        Phase::Progression => RGBColor(160, 20, 80),
    }
}

/// Text and frames.
pub(super) const INK: RGBColor = RGBColor(40, 40, 40);
/// Lines behind the data.
pub(super) const GRID: RGBColor = RGBColor(225, 225, 225);
