//! Colours that eyes of every kind tell apart (Okabe and Ito 2008), the same for a phase
//! everywhere.

use super::colour::{Colour, WHITE};
use percuss::Phase;

/// The colour of a phase.
pub(super) const fn phase(phase: Phase) -> Colour {
    match phase {
        Phase::NoContact => Colour(0, 114, 178),
        Phase::Contact => Colour(230, 159, 0),
        Phase::Progression => Colour(160, 20, 80),
    }
}

/// The colour of a mode by its place in its system, and that of its name on it.
pub(super) const fn mode(place: usize) -> (Colour, Colour) {
    MODES[place % MODES.len()]
}

const MODES: [(Colour, Colour); 8] = [
    (Colour(0, 114, 178), WHITE),
    (Colour(230, 159, 0), INK),
    (Colour(160, 20, 80), WHITE),
    (Colour(0, 120, 90), WHITE),
    (Colour(86, 180, 233), INK),
    (Colour(213, 94, 0), WHITE),
    (Colour(204, 121, 167), INK),
    (Colour(100, 100, 100), WHITE),
];

/// Text and frames.
pub(super) const INK: Colour = Colour(40, 40, 40);
/// Lines behind the data.
pub(super) const GRID: Colour = Colour(225, 225, 225);
/// Cells of which it is not known where they lead.
pub(super) const UNRESOLVED: Colour = Colour(176, 176, 176);

/// A basin's light colour and its attractor's dark one. The first pairs are near those of the
/// paper's Fig. 7: orange on yellow, black on purple, red on blue, green on pink; light ones differ
/// in hue and lightness, so that eyes of every kind tell them apart.
pub(super) const BASINS: [(Colour, Colour); 8] = [
    (Colour(250, 236, 150), Colour(196, 84, 0)),
    (Colour(150, 105, 190), Colour(20, 10, 40)),
    (Colour(95, 165, 225), Colour(178, 24, 24)),
    (Colour(220, 110, 170), Colour(0, 90, 45)),
    (Colour(98, 178, 150), Colour(0, 52, 44)),
    (Colour(222, 158, 96), Colour(92, 40, 0)),
    (Colour(70, 110, 180), Colour(8, 24, 84)),
    (Colour(214, 226, 226), Colour(74, 90, 92)),
];
