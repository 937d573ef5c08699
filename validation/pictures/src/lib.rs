//! Pictures, drawn by the program itself: PNG, and SVG where it stays small. Plotters draws the
//! SVG, and resvg renders the PNG from it. Their data are arrays for NumPy ([`arrays`]).

pub mod arrays;
mod axes;
mod axis_unit;
mod basin_map;
mod canvas;
mod caption;
mod colour;
mod curves;
mod encounter;
mod figure;
mod fitted;
mod font;
mod frame;
mod heat_map;
mod histograms;
mod key;
mod look;
mod motion;
mod palette;
mod piece;
mod print;
mod simplify;
mod system_motion;

pub use basin_map::{BASIN_COLOURS, BasinMap, ShownAttractor, basin_colours};
pub use canvas::Canvas;
pub use caption::{caption, caption_without, symbol};
pub use colour::Colour;
pub use curves::{Curve, Curves};
pub use encounter::{Encounter, Stage, TimeStretch, Trail};
pub use figure::{Figure, KeyEntry, Layer, Plot, PlotWindow, Raster, Stroke};
pub use frame::{Axis, AxisScale};
pub use heat_map::{HeatCell, HeatMap, Tint};
pub use histograms::{HistogramRow, Histograms};
pub use look::{Look, Marker, looks};
pub use motion::DrawnMotion;
pub use piece::MotionPiece;
pub use print::{DEFAULT_DPI, LAYOUT_DPI, Print};
pub use system_motion::{MAX_STATES, SampledSegment, SystemMotion, sampled};

use canvas::Letters;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, Tree};

/// The colour of a phase.
#[must_use]
pub const fn phase_colour(phase: percuss::Phase) -> Colour {
    palette::phase(phase)
}

/// The colour of the motion in a mode of a system.
#[must_use]
pub fn mode_colour(mode: usize) -> Colour {
    palette::mode(mode).0
}

/// The colour of text.
pub const INK: Colour = palette::INK;

/// A picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be drawn: {0}")]
pub struct DrawError(String);

impl DrawError {
    fn new(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// A picture: its file's name, and the file.
pub type Picture = (String, Vec<u8>);

/// A picture that can be drawn on a canvas.
pub trait Drawing {
    /// Width and height, in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws on a canvas of the picture's size.
    fn draw(&self, canvas: &mut Canvas);

    /// The smallest size at which [`Drawing::draw_within`] is legible, in pixels of the layout.
    fn least_size(&self) -> (u32, u32) {
        let (width, height) = self.size();
        let least = |it: u32| (f64::from(it) * MIN_SCALE).ceil() as u32;
        (least(width), least(height))
    }

    /// Draws on a canvas of another size: the whole picture, larger or smaller, unless its layout
    /// has a better way.
    fn draw_within(&self, canvas: &mut Canvas, size: (u32, u32)) {
        let own = self.size();
        let scales = [f64::from(size.0) / f64::from(own.0), f64::from(size.1) / f64::from(own.1)];
        canvas.draw_scaled(scales[0].min(scales[1]), |canvas| self.draw(canvas));
    }
}

/// The scale at which letters of a whole picture are as small as those of a formula's indices.
const MIN_SCALE: f64 = 0.7;

/// A drawing as an SVG.
#[must_use]
pub fn svg(drawing: &impl Drawing) -> String {
    svg_text(drawing, Letters::Text)
}

/// A drawing as a PNG, which is rendered from its SVG.
///
/// # Errors
/// [`DrawError`] with the rendering library's reason.
pub fn png(drawing: &impl Drawing) -> Result<Vec<u8>, DrawError> {
    // The library's own fonts would triple the time that it takes to compile.
    let svg = svg_text(drawing, Letters::Outlines);
    svg_in_pixels(&svg, drawing.size(), (1.0, 1.0))
}

/// An SVG in so many pixels across and down, each of its own being so many of these.
fn svg_in_pixels(
    svg: &str,
    (width, height): (u32, u32),
    scale: (f64, f64),
) -> Result<Vec<u8>, DrawError> {
    let tree = Tree::from_str(svg, &usvg::Options::default()).map_err(DrawError::new)?;
    let no_area = || DrawError::new("it has no area");
    let mut pixels = Pixmap::new(width, height).ok_or_else(no_area)?;
    let transform = Transform::from_scale(scale.0 as f32, scale.1 as f32);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    pixels.encode_png().map_err(DrawError::new)
}

fn svg_text(drawing: &impl Drawing, letters: Letters) -> String {
    let mut canvas = Canvas::new(drawing.size(), letters);
    drawing.draw(&mut canvas);
    canvas.finish()
}
