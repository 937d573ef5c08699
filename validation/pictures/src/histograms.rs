//! Histograms below each other on one axis.

use super::canvas::{Canvas, TextSide};
use super::frame::{AxisScale, Ruler};
use super::{Colour, Drawing, palette};

const ROW_HEIGHT: u32 = 46;
const HEAD_HEIGHT: u32 = 64;
const FOOT_HEIGHT: u32 = 80;
const TEXT_SIZE: f64 = 19.0;
const LEFT_EDGE: f64 = 350.0;
const RIGHT_EDGE: f64 = 1470.0;

/// A histogram with its name and its colour.
#[derive(Clone, Debug)]
pub struct HistogramRow {
    /// The histogram's name.
    pub name: String,
    /// The histogram's colour.
    pub colour: Colour,
    /// Edges of the bins as exponents of ten, one more than counts.
    pub edges: Vec<f64>,
    /// The count of each bin.
    pub counts: Vec<u64>,
}

/// A picture of histograms.
#[derive(Clone, Debug)]
pub struct Histograms {
    /// The title of the picture.
    pub title: String,
    /// The axis's name.
    pub label: String,
    /// The histograms from top to bottom.
    pub rows: Vec<HistogramRow>,
}

impl HistogramRow {
    /// Bins with something in them: edges and count.
    fn bins(&self) -> impl Iterator<Item = (f64, f64, u64)> + '_ {
        let pairs = self.edges.windows(2).zip(&self.counts);
        let bins = pairs.map(|(edges, count)| (edges[0], edges[1], *count));
        bins.filter(|(from, to, count)| *count > 0 && from.is_finite() && to.is_finite())
    }
}

impl Drawing for Histograms {
    fn size(&self) -> (u32, u32) {
        let rows = u32::try_from(self.rows.len()).unwrap_or(0).clamp(1, 200);
        (1500, HEAD_HEIGHT + rows * ROW_HEIGHT + FOOT_HEIGHT)
    }

    fn draw(&self, canvas: &mut Canvas) {
        let [head, height] = [HEAD_HEIGHT, ROW_HEIGHT].map(f64::from);
        canvas.title(&self.title);
        let edges =
            self.rows.iter().flat_map(HistogramRow::bins).flat_map(|(from, to, _)| [from, to]);
        let values = edges.map(|edge| 10.0_f64.powf(edge));
        let Some(ruler) = Ruler::over(AxisScale::Logarithmic, values) else {
            let at = (24.0, head + 20.0);
            return canvas.text(
                "nothing was measured",
                at,
                TEXT_SIZE,
                TextSide::Left,
                palette::INK,
            );
        };
        let bottom = head + self.rows.len() as f64 * height;
        let across = |place: f64| LEFT_EDGE + place * (RIGHT_EDGE - LEFT_EDGE);
        for (value, label) in &ruler.ticks {
            let x = across(ruler.fraction(*value));
            canvas.line((x, head), (x, bottom), 1.0, palette::GRID);
            canvas.text(label, (x, bottom + 20.0), TEXT_SIZE, TextSide::Middle, palette::INK);
        }
        for (i, row) in self.rows.iter().enumerate() {
            let base = head + (i + 1) as f64 * height;
            let most = row.bins().map(|bin| bin.2).max().unwrap_or(1) as f64;
            canvas.line((LEFT_EDGE, base), (RIGHT_EDGE, base), 1.0, palette::GRID);
            let at = (LEFT_EDGE - 16.0, base - height / 2.0);
            canvas.text(&row.name, at, TEXT_SIZE, TextSide::Right, palette::INK);
            for (from, to, count) in row.bins() {
                let tall = ((height - 8.0) * count as f64 / most).max(1.0);
                let [from, to] = [from, to].map(|edge| across(ruler.fraction(edge)));
                let corner = ((to - 1.0).max(from + 1.0), base);
                canvas.fill((from, base - tall), corner, row.colour);
            }
        }
        let middle = ((LEFT_EDGE + RIGHT_EDGE) / 2.0, bottom + 54.0);
        canvas.text(&self.label, middle, TEXT_SIZE + 1.0, TextSide::Middle, palette::INK);
    }
}
