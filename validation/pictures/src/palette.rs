//! Colours that eyes of every kind tell apart (Okabe and Ito 2008), the same for a phase
//! everywhere.

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
/// Cells of which it is not known where they lead.
pub(super) const UNRESOLVED: RGBColor = RGBColor(176, 176, 176);

/// A basin's light colour and its attractor's dark one. The first pairs are near those of the
/// paper's Fig. 7: orange on yellow, black on purple, red on blue, green on pink; light ones differ
/// in hue and lightness, so that eyes of every kind tell them apart.
pub(super) const BASINS: [(RGBColor, RGBColor); 8] = [
    (RGBColor(250, 236, 150), RGBColor(196, 84, 0)),
    (RGBColor(150, 105, 190), RGBColor(20, 10, 40)),
    (RGBColor(95, 165, 225), RGBColor(178, 24, 24)),
    (RGBColor(220, 110, 170), RGBColor(0, 90, 45)),
    (RGBColor(98, 178, 150), RGBColor(0, 52, 44)),
    (RGBColor(222, 158, 96), RGBColor(92, 40, 0)),
    (RGBColor(70, 110, 180), RGBColor(8, 24, 84)),
    (RGBColor(214, 226, 226), RGBColor(74, 90, 92)),
];
