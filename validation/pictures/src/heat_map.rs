//! A table of tinted cells: engines by something.

use super::canvas::{Canvas, TextSide};
use super::{Colour, Drawing, palette};

const ROW_HEIGHT: u32 = 38;
const HEAD_HEIGHT: u32 = 110;
const LABEL_WIDTH: u32 = 330;
const MARGIN: u32 = 24;
const TEXT_SIZE: f64 = 19.0;

/// The meaning of a cell's colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tint {
    /// All is right.
    Good,
    /// Right, with a remark.
    Fair,
    /// The cell is not quite good.
    Poor,
    /// Wrong.
    Bad,
    /// The cell has no colour.
    None,
}

/// A cell.
#[derive(Clone, Debug)]
pub struct HeatCell {
    /// The text in the cell.
    pub text: String,
    /// The cell's tint.
    pub tint: Tint,
}

/// A table of cells.
#[derive(Clone, Debug)]
pub struct HeatMap {
    /// The title of the picture.
    pub title: String,
    /// A note on how to read the picture.
    pub note: String,
    /// Names of the columns; cells may go beyond them.
    pub columns: Vec<String>,
    /// Name and cells of each row.
    pub rows: Vec<(String, Vec<HeatCell>)>,
}

impl HeatMap {
    fn columns(&self) -> usize {
        self.rows.iter().map(|row| row.1.len()).chain([self.columns.len(), 1]).max().unwrap_or(1)
    }

    /// Width of a cell: a table of few columns is not stretched, one of many is not cut.
    fn cell(&self) -> f64 {
        (1120.0 / self.columns() as f64).clamp(110.0, 190.0)
    }
}

impl Drawing for HeatMap {
    fn size(&self) -> (u32, u32) {
        let width = 2 * MARGIN + LABEL_WIDTH + (self.cell() * self.columns() as f64).ceil() as u32;
        let rows = u32::try_from(self.rows.len()).unwrap_or(0).clamp(1, 400);
        (width.clamp(900, 4000), HEAD_HEIGHT + rows * ROW_HEIGHT + MARGIN)
    }

    fn draw(&self, canvas: &mut Canvas) {
        let [margin, head, row, label] =
            [MARGIN, HEAD_HEIGHT, ROW_HEIGHT, LABEL_WIDTH].map(f64::from);
        let left = margin + label;
        let middle = |i: usize| left + self.cell() * (i as f64 + 0.5);
        canvas.title(&self.title);
        canvas.text(&self.note, (margin, 58.0), TEXT_SIZE - 2.0, TextSide::Left, palette::INK);
        for (i, name) in self.columns.iter().enumerate() {
            canvas.text(name, (middle(i), head - 16.0), TEXT_SIZE, TextSide::Middle, palette::INK);
        }
        for (j, (name, cells)) in self.rows.iter().enumerate() {
            let top = head + j as f64 * row;
            canvas.text(name, (margin, top + row / 2.0), TEXT_SIZE, TextSide::Left, palette::INK);
            for (i, cell) in cells.iter().enumerate() {
                let from = left + self.cell() * i as f64;
                let (paper, ink) = colours(cell.tint);
                let to = (from + self.cell() - 2.0, top + row - 2.0);
                canvas.fill((from, top), to, paper);
                let at = (middle(i) - 1.0, top + row / 2.0 - 1.0);
                canvas.text(&cell.text, at, TEXT_SIZE - 1.0, TextSide::Middle, ink);
            }
        }
    }
}

const fn colours(tint: Tint) -> (Colour, Colour) {
    match tint {
        Tint::Good => (Colour(220, 242, 232), Colour(10, 110, 79)),
        Tint::Fair => (Colour(223, 237, 251), Colour(11, 83, 148)),
        Tint::Poor => (Colour(252, 236, 200), Colour(122, 77, 0)),
        Tint::Bad => (Colour(251, 227, 224), Colour(179, 38, 30)),
        Tint::None => (Colour(240, 242, 244), Colour(91, 100, 112)),
    }
}
