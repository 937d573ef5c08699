//! Drawing in the picture's own pixels, whatever the scale of the area.

use super::font::FAMILY;
use super::look::Marker;
use super::{DrawError, palette};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A place in pixels.
pub(super) type At = (f64, f64);

pub(super) struct Canvas<'a, B: DrawingBackend> {
    pub area: &'a DrawingArea<B, Shift>,
    pub scale: u32,
}

/// The side of its place on which a text stands.
#[derive(Clone, Copy)]
pub(super) enum TextSide {
    Left,
    Middle,
    Right,
}

impl<B: DrawingBackend> Canvas<'_, B> {
    fn pixel(&self, at: At) -> (i32, i32) {
        let scaled = |value: f64| (value * f64::from(self.scale)).round() as i32;
        (scaled(at.0), scaled(at.1))
    }

    fn wide(&self, width: f64) -> u32 {
        ((width * f64::from(self.scale)).round() as u32).max(1)
    }

    pub fn paper(&self) -> Result<(), DrawError> {
        self.area.fill(&WHITE).map_err(DrawError::new)
    }

    pub fn line(&self, from: At, to: At, width: f64, colour: RGBColor) -> Result<(), DrawError> {
        let path = [self.pixel(from), self.pixel(to)];
        let element = PathElement::new(path, colour.stroke_width(self.wide(width)));
        self.area.draw(&element).map_err(DrawError::new)
    }

    /// A line through several places. In an SVG it is one path; the scale is that of a picture of
    /// pixels otherwise, where the drawing library leaves a notch at each joint of a thick path.
    pub fn trace(&self, places: &[At], width: f64, colour: RGBColor) -> Result<(), DrawError> {
        if self.scale == 1 {
            let path: Vec<_> = places.iter().map(|at| self.pixel(*at)).collect();
            let element = PathElement::new(path, colour.stroke_width(self.wide(width)));
            return self.area.draw(&element).map_err(DrawError::new);
        }
        places.windows(2).try_for_each(|pair| {
            self.line(pair[0], pair[1], width, colour)?;
            self.marker(Marker::Circle, pair[1], width / 2.0, colour)
        })
    }

    pub fn fill(&self, from: At, to: At, colour: RGBColor) -> Result<(), DrawError> {
        let corners = [self.pixel(from), self.pixel(to)];
        self.area.draw(&Rectangle::new(corners, colour.filled())).map_err(DrawError::new)
    }

    pub fn frame(&self, from: At, to: At) -> Result<(), DrawError> {
        let corners = [self.pixel(from), self.pixel(to)];
        let style = palette::INK.stroke_width(self.wide(1.0));
        self.area.draw(&Rectangle::new(corners, style)).map_err(DrawError::new)
    }

    pub fn text(
        &self,
        text: &str,
        at: At,
        size: f64,
        side: TextSide,
        colour: RGBColor,
    ) -> Result<(), DrawError> {
        let side = match side {
            TextSide::Left => HPos::Left,
            TextSide::Middle => HPos::Center,
            TextSide::Right => HPos::Right,
        };
        let font = (FAMILY, size * f64::from(self.scale)).into_font();
        let style = font.color(&colour).pos(Pos::new(side, VPos::Center));
        self.area.draw_text(text, &style, self.pixel(at)).map_err(DrawError::new)
    }

    /// Text from below to above, its middle at `at`.
    pub fn upright(&self, text: &str, at: At, size: f64) -> Result<(), DrawError> {
        let font = (FAMILY, size * f64::from(self.scale)).into_font();
        let font = font.transform(FontTransform::Rotate270);
        let style = font.color(&palette::INK).pos(Pos::new(HPos::Center, VPos::Center));
        self.area.draw_text(text, &style, self.pixel(at)).map_err(DrawError::new)
    }

    pub fn marker(
        &self,
        marker: Marker,
        at: At,
        size: f64,
        colour: RGBColor,
    ) -> Result<(), DrawError> {
        let place = |(x, y): At| (at.0 + size * x, at.1 + size * y);
        let shape = |corners: &[At]| {
            let corners: Vec<_> = corners.iter().map(|it| self.pixel(place(*it))).collect();
            self.area.draw(&Polygon::new(corners, colour.filled())).map_err(DrawError::new)
        };
        let stroke = |from, to| self.line(place(from), place(to), size / 2.5, colour);
        match marker {
            Marker::Circle => {
                let size = i32::try_from(self.wide(size)).unwrap_or(1);
                let circle = Circle::new(self.pixel(at), size, colour.filled());
                self.area.draw(&circle).map_err(DrawError::new)
            }
            Marker::Square => shape(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            Marker::Triangle => shape(&[(0.0, -1.2), (1.15, 0.9), (-1.15, 0.9)]),
            Marker::Nabla => shape(&[(0.0, 1.2), (1.15, -0.9), (-1.15, -0.9)]),
            Marker::Diamond => shape(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
            Marker::Cross => {
                stroke((-0.95, -0.95), (0.95, 0.95))?;
                stroke((-0.95, 0.95), (0.95, -0.95))
            }
            Marker::Plus => {
                stroke((0.0, -1.25), (0.0, 1.25))?;
                stroke((-1.25, 0.0), (1.25, 0.0))
            }
        }
    }
}
