//! Pictures of a given size on paper, whose letters are as large as those of a paper's text.

use super::canvas::{Canvas, Letters, Sheet};
use super::{DrawError, Drawing, svg_in_pixels};

/// Pixels of a drawing's layout in an inch: at it the letters of an axis have a line height of 9
/// points, and a capital of 5.6, as in the captions of journals.
pub const LAYOUT_DPI: f64 = 160.0;

/// Pixels in an inch of a picture whose size is given, where nothing else is said.
pub const DEFAULT_DPI: f64 = 300.0;

/// The most pixels of a PNG.
const MAX_PIXELS: f64 = 64e6;

const MM_PER_INCH: f64 = 25.4;

/// The size of a picture on paper and the density of its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Print {
    /// Width and height in millimetres; without them the drawing has its own size.
    pub size_mm: Option<[f64; 2]>,
    /// Pixels in an inch; without it [`DEFAULT_DPI`] where a size is given, else [`LAYOUT_DPI`].
    pub dpi: Option<f64>,
}

/// A number of layout pixels in millimetres.
fn millimetres(pixels: u32) -> f64 {
    f64::from(pixels) * MM_PER_INCH / LAYOUT_DPI
}

impl Print {
    fn dpi(&self) -> f64 {
        self.dpi.unwrap_or(if self.size_mm.is_some() { DEFAULT_DPI } else { LAYOUT_DPI })
    }

    /// The size on paper of a drawing, and the size of its layout.
    fn sheet(&self, drawing: &impl Drawing) -> Result<Sheet, DrawError> {
        let Some(size_mm) = self.size_mm else {
            let size = drawing.size();
            return Ok(Sheet { size, size_mm: Some([millimetres(size.0), millimetres(size.1)]) });
        };
        let pixels = |mm: f64| (mm / MM_PER_INCH * LAYOUT_DPI).round() as u32;
        let size = (pixels(size_mm[0]), pixels(size_mm[1]));
        let least = drawing.least_size();
        if size.0 < least.0 || size.1 < least.1 {
            let [width, height] = [least.0, least.1].map(|it| millimetres(it).ceil());
            return Err(DrawError(format!(
                "{} x {} mm is too small for it: at least {width} x {height} mm is accepted",
                size_mm[0], size_mm[1]
            )));
        }
        Ok(Sheet { size, size_mm: Some(size_mm) })
    }

    fn drawn(&self, drawing: &impl Drawing, sheet: Sheet, letters: Letters) -> String {
        let mut canvas = Canvas::on(sheet, letters);
        match self.size_mm {
            Some(_) => drawing.draw_within(&mut canvas, sheet.size),
            None => drawing.draw(&mut canvas),
        }
        canvas.finish()
    }

    /// A drawing as an SVG of this size.
    ///
    /// # Errors
    /// [`DrawError`] where the size is too small for the drawing.
    pub fn svg(&self, drawing: &impl Drawing) -> Result<String, DrawError> {
        if *self == Self::default() {
            return Ok(super::svg(drawing));
        }
        Ok(self.drawn(drawing, self.sheet(drawing)?, Letters::Text))
    }

    /// A drawing as a PNG of this size and density, which the file states.
    ///
    /// # Errors
    /// [`DrawError`] where the size is too small for the drawing, where the pixels are too many,
    /// and with the rendering library's reason.
    pub fn png(&self, drawing: &impl Drawing) -> Result<Vec<u8>, DrawError> {
        if *self == Self::default() {
            return super::png(drawing);
        }
        let sheet = Sheet { size_mm: None, ..self.sheet(drawing)? };
        let size_mm = self.size_mm.unwrap_or([sheet.size.0, sheet.size.1].map(millimetres));
        let dpi = self.dpi();
        let [width, height] = size_mm.map(|mm| (mm / MM_PER_INCH * dpi).round().max(1.0));
        if width * height > MAX_PIXELS {
            return Err(DrawError(format!(
                "{width} x {height} pixels are too many: at most {:.0} million are accepted",
                MAX_PIXELS / 1e6
            )));
        }
        let svg = self.drawn(drawing, sheet, Letters::Outlines);
        let scale = (width / f64::from(sheet.size.0), height / f64::from(sheet.size.1));
        let bytes = svg_in_pixels(&svg, (width as u32, height as u32), scale)?;
        Ok(with_density(&bytes, dpi))
    }
}

/// The bytes of a PNG's signature and of its first chunk, after which the density may stand.
const HEAD_BYTES: usize = 33;

/// A PNG that states its pixels per metre.
fn with_density(png: &[u8], dpi: f64) -> Vec<u8> {
    let per_metre = (dpi / (MM_PER_INCH / 1000.0)).round() as u32;
    let mut chunk = b"pHYs".to_vec();
    chunk.extend(per_metre.to_be_bytes());
    chunk.extend(per_metre.to_be_bytes());
    // The unit of length is the metre.
    chunk.push(1);
    let check = crc32fast::hash(&chunk);
    let (head, rest) = png.split_at(HEAD_BYTES.min(png.len()));
    let mut bytes = head.to_vec();
    // The length counts neither the chunk's name nor its check.
    bytes.extend((chunk.len() as u32 - 4).to_be_bytes());
    bytes.extend(chunk);
    bytes.extend(check.to_be_bytes());
    bytes.extend(rest);
    bytes
}
