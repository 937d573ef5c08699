//! The font travels with the program: no system library is asked for one.

use super::DrawError;
use plotters::style::{FontStyle, register_font};

/// The one family used.
pub(super) const FAMILY: &str = "sans-serif";

/// Makes the font known to the drawing library; again and again does no harm.
pub(super) fn register() -> Result<(), DrawError> {
    let bytes = dejavu::sans::regular();
    register_font(FAMILY, FontStyle::Normal, bytes)
        .map_err(|_| DrawError::new("its font is not accepted"))
}
