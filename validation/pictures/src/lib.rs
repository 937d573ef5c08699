//! Pictures, drawn by the program itself: PNG, and SVG where it stays small.

mod axes;
mod basin_map;
mod canvas;
mod caption;
mod curves;
mod encounter;
mod figure;
mod font;
mod frame;
mod heat_map;
mod histograms;
mod look;
mod motion;
mod palette;
mod piece;

pub use basin_map::{BASIN_COLOURS, BasinMap, Shown, basin_colours};
pub use caption::{caption, caption_without, symbol};
pub use curves::{Curve, Curves};
pub use encounter::{Encounter, TimeStretch, Trail};
pub use figure::{Figure, KeyEntry, Layer, Plot, PlotWindow, Raster, Stroke};
pub use frame::{Axis, AxisScale};
pub use heat_map::{HeatCell, HeatMap, Tint};
pub use histograms::{HistogramRow, Histograms};
pub use look::{Look, Marker, looks};
pub use motion::DrawnMotion;
pub use piece::MotionPiece;
pub use plotters::style::RGBColor;

use plotters::coord::Shift;
use plotters::prelude::{BitMapBackend, DrawingArea, DrawingBackend, IntoDrawingArea, SVGBackend};

/// The colour of a phase.
#[must_use]
pub const fn phase_colour(phase: percuss::Phase) -> RGBColor {
    palette::phase(phase)
}

/// The colour of text.
pub const INK: RGBColor = palette::INK;

/// The bitmap is drawn so much larger and averaged: the drawing library does not smooth its lines.
const OVERSAMPLING: u32 = 3;

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

/// Something that can be drawn.
pub trait Drawing {
    /// Width and height, in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws on an area of that size times `scale`.
    ///
    /// # Errors
    /// [`DrawError`] with the drawing library's reason.
    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        scale: u32,
    ) -> Result<(), DrawError>;
}

/// A drawing as a PNG.
///
/// # Errors
/// [`DrawError`] with the drawing library's reason.
pub fn png(drawing: &impl Drawing) -> Result<Vec<u8>, DrawError> {
    font::register()?;
    let size = drawing.size();
    let large = (size.0 * OVERSAMPLING, size.1 * OVERSAMPLING);
    let mut pixels = vec![0; (large.0 * large.1 * 3) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, large).into_drawing_area();
        drawing.draw(&area, OVERSAMPLING)?;
        area.present().map_err(DrawError::new)?;
    }
    let pixels = averaged(&pixels, size);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.0, size.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(DrawError::new)?;
    writer.write_image_data(&pixels).map_err(DrawError::new)?;
    writer.finish().map_err(DrawError::new)?;
    Ok(bytes)
}

/// A drawing as an SVG.
///
/// # Errors
/// [`DrawError`] with the drawing library's reason.
pub fn svg(drawing: &impl Drawing) -> Result<String, DrawError> {
    font::register()?;
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, drawing.size()).into_drawing_area();
        drawing.draw(&area, 1)?;
        area.present().map_err(DrawError::new)?;
    }
    Ok(text)
}

/// Each pixel as the mean of the square that stands for it.
fn averaged(large: &[u8], size: (u32, u32)) -> Vec<u8> {
    let (width, height, times) = (size.0 as usize, size.1 as usize, OVERSAMPLING as usize);
    let mut small = Vec::with_capacity(width * height * 3);
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        for channel in 0..3 {
            let at = |i: usize| {
                ((row * times + i / times) * width * times + column * times + i % times) * 3
                    + channel
            };
            let sum: u32 = (0..times * times).map(|i| u32::from(large[at(i)])).sum();
            small.push(u8::try_from(sum / (OVERSAMPLING * OVERSAMPLING)).unwrap_or(u8::MAX));
        }
    }
    small
}
