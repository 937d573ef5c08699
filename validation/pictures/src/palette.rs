//! Colours that eyes of every kind tell apart (Okabe and Ito 2008), the same for a phase
//! everywhere.

use super::colour::Colour;
use percuss::Phase;

/// The colour of a phase.
pub(super) const fn phase(phase: Phase) -> Colour {
    match phase {
        Phase::NoContact => Colour(0, 114, 178),
        Phase::Contact => Colour(230, 159, 0),
        Phase::Progression => Colour(160, 20, 80),
    }
}

/// The colours of a mode of a system: that of its motion, and the light one behind it. The first
/// five are as far from each other as their tints allow; after twelve modes they begin again.
pub(super) fn mode(index: usize) -> (Colour, Colour) {
    let dark = MODES[index % MODES.len()];
    (dark, dark.mixed_with_white(MODE_TINT))
}

/// The share of white in the light colour of a mode.
const MODE_TINT: f64 = 0.82;

const MODES: [Colour; 12] = [
    Colour(0, 114, 178),
    Colour(205, 115, 0),
    Colour(0, 135, 100),
    Colour(160, 20, 80),
    Colour(95, 95, 95),
    Colour(105, 75, 170),
    Colour(130, 110, 0),
    Colour(215, 70, 60),
    Colour(120, 70, 30),
    Colour(60, 150, 205),
    Colour(30, 60, 120),
    Colour(190, 100, 160),
];

/// Text and frames.
pub(super) const INK: Colour = Colour(40, 40, 40);
/// The colour of jumps at resets.
pub(super) const RESET_JUMP: Colour = Colour(150, 150, 150);
/// Lines behind the data.
pub(super) const GRID: Colour = Colour(225, 225, 225);
/// Cells of which it is not known where they lead.
pub(super) const UNRESOLVED: Colour = Colour(176, 176, 176);
/// Cells at which no motion begins.
pub(super) const NO_START: Colour = Colour(112, 112, 112);
/// Cells whose motions end.
pub(super) const ENDED: Colour = Colour(226, 226, 226);

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
