//! Pictures, drawn by the program itself: PNG, and SVG where it stays small.

mod axes;
mod font;
mod look;
mod motion;
mod palette;

pub use look::{Look, Marker, looks};
pub use motion::Motion;

use plotters::prelude::*;

/// Width and height, in pixels.
const SIZE: (u32, u32) = (1500, 860);
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

/// The motion as a PNG.
///
/// # Errors
/// [`DrawError`] with the drawing library's reason.
pub fn png(motion: &Motion) -> Result<Vec<u8>, DrawError> {
    font::register()?;
    let large = (SIZE.0 * OVERSAMPLING, SIZE.1 * OVERSAMPLING);
    let mut pixels = vec![0; (large.0 * large.1 * 3) as usize];
    {
        let area = BitMapBackend::with_buffer(&mut pixels, large).into_drawing_area();
        motion.draw(&area, OVERSAMPLING)?;
        area.present().map_err(DrawError::new)?;
    }
    let pixels = averaged(&pixels);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(DrawError::new)?;
    writer.write_image_data(&pixels).map_err(DrawError::new)?;
    writer.finish().map_err(DrawError::new)?;
    Ok(bytes)
}

/// The motion as an SVG.
///
/// # Errors
/// [`DrawError`] with the drawing library's reason.
pub fn svg(motion: &Motion) -> Result<String, DrawError> {
    font::register()?;
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        motion.draw(&area, 1)?;
        area.present().map_err(DrawError::new)?;
    }
    Ok(text)
}

/// Each pixel as the mean of the square that stands for it.
fn averaged(large: &[u8]) -> Vec<u8> {
    let (width, height, times) = (SIZE.0 as usize, SIZE.1 as usize, OVERSAMPLING as usize);
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
