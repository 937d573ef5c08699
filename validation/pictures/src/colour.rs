//! Colours by their shares of red, green and blue.

use plotters::style::RGBColor;
use std::fmt;

/// Red, green and blue, each from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// White.
pub(super) const WHITE: Colour = Colour(255, 255, 255);

impl Colour {
    /// The colour with this share of white in it.
    pub(super) fn mixed_with_white(self, white: f64) -> Self {
        let mixed = |part: u8| (f64::from(part) * (1.0 - white) + 255.0 * white).round() as u8;
        Self(mixed(self.0), mixed(self.1), mixed(self.2))
    }
}

/// Writes the colour as style sheets and SVG do: `#0072b2`.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

impl From<Colour> for RGBColor {
    fn from(colour: Colour) -> Self {
        Self(colour.0, colour.1, colour.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_is_six_digits() {
        assert_eq!(Colour(0, 114, 178).to_string(), "#0072b2");
    }
}
