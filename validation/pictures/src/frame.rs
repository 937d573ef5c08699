//! A framed panel with ticks on linear or logarithmic axes.

use super::canvas::{At, Canvas, TextSide};
use super::{axes, palette};

/// The scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisScale {
    /// Evenly.
    Linear,
    /// The axis goes by powers of ten; what is not above zero stands at its lower end.
    Logarithmic,
}

/// An axis and its name.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The name of the quantity on the axis.
    pub label: String,
    /// The scale of the axis.
    pub scale: AxisScale,
}

/// An axis over data: from, to, and its ticks.
pub(super) struct Ruler {
    scale: AxisScale,
    from: f64,
    to: f64,
    pub ticks: Vec<(f64, String)>,
}

const TEXT_SIZE: f64 = 20.0;
/// The largest number of ticks, about.
const MAX_TICKS: f64 = 8.0;

impl Ruler {
    /// `None` where there is nothing to show.
    pub fn over(scale: AxisScale, values: impl Iterator<Item = f64>) -> Option<Self> {
        let placed = values.filter_map(|value| match scale {
            AxisScale::Linear => Some(value),
            AxisScale::Logarithmic => (value > 0.0).then(|| value.log10()),
        });
        let finite: Vec<f64> = placed.filter(|value| value.is_finite()).collect();
        if finite.is_empty() {
            return None;
        }
        let range = axes::around(finite.iter().copied());
        let (from, to) = match scale {
            AxisScale::Linear => (range.start, range.end),
            AxisScale::Logarithmic => {
                let low = finite.iter().copied().fold(f64::INFINITY, f64::min);
                let high = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                ((low - 0.05).floor(), (high + 0.05).ceil())
            }
        };
        Some(Self::placed(scale, from, to, MAX_TICKS))
    }

    /// A linear axis from one value to another.
    pub fn between(from: f64, to: f64) -> Self {
        Self::placed(AxisScale::Linear, from, to, MAX_TICKS)
    }

    /// The axis with at most about so many ticks.
    pub fn with_ticks(self, most: f64) -> Self {
        Self::placed(self.scale, self.from, self.to, most)
    }

    fn placed(scale: AxisScale, from: f64, to: f64, most: f64) -> Self {
        let step = tick_step((to - from) / most, scale);
        let first = (from / step).ceil() as i64;
        let last = (to / step).floor() as i64;
        let label = |value: f64| match scale {
            AxisScale::Linear => axes::label(value, &(from..to)),
            AxisScale::Logarithmic => power_of_ten(value.round() as i64),
        };
        let tick = |k: i64| (k as f64 * step, label(k as f64 * step));
        // Where an axis is too narrow for its size its ticks cannot be told apart.
        let ticks = (first..=last).take(4 * most as usize).map(tick);
        Self { scale, from, to, ticks: ticks.collect() }
    }

    /// The place of a value on the axis, from 0 to 1.
    pub fn place(&self, value: f64) -> f64 {
        let placed = match self.scale {
            AxisScale::Linear => value,
            AxisScale::Logarithmic if value > 0.0 => value.log10(),
            AxisScale::Logarithmic => self.from,
        };
        self.fraction(placed)
    }

    /// The place of a tick on the axis, from 0 to 1.
    pub fn fraction(&self, placed: f64) -> f64 {
        (placed - self.from) / (self.to - self.from)
    }
}

/// The next of 1, 2, 5 times a power of ten.
fn tick_step(rough: f64, scale: AxisScale) -> f64 {
    let power = 10.0_f64.powf(rough.log10().floor());
    let nice = [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|k| *k >= rough);
    let nice = nice.unwrap_or(rough);
    if scale == AxisScale::Logarithmic { nice.ceil().max(1.0) } else { nice }
}

/// 10 with its exponent raised.
pub(super) fn power_of_ten(exponent: i64) -> String {
    const RAISED_DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| match c.to_digit(10) {
        Some(digit) => RAISED_DIGITS.get(digit as usize).copied().unwrap_or(c),
        None => '⁻',
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

/// A panel between two corners.
pub(super) struct Panel {
    pub from: At,
    pub to: At,
    pub x: Ruler,
    pub y: Ruler,
}

impl Panel {
    /// The place of a point; `None` if it lies outside.
    pub fn at(&self, (x, y): At) -> Option<At> {
        let inside = |share: f64| (-1e-6..=1.0 + 1e-6).contains(&share);
        let is_inside = inside(self.x.place(x)) && inside(self.y.place(y));
        is_inside.then(|| self.place((x, y)))
    }

    /// The place of a point, inside the panel or not.
    pub fn place(&self, (x, y): At) -> At {
        let across = self.from.0 + self.x.place(x) * (self.to.0 - self.from.0);
        let down = self.to.1 - self.y.place(y) * (self.to.1 - self.from.1);
        (across, down)
    }

    pub fn draw(&self, canvas: &mut Canvas, below: &str, beside: &str) {
        self.grid(canvas);
        self.draw_over(canvas, below, beside);
    }

    /// Draws lines across at the ticks.
    pub fn grid(&self, canvas: &mut Canvas) {
        let (from, to) = (self.from, self.to);
        for (placed, _) in &self.x.ticks {
            let x = from.0 + self.x.fraction(*placed) * (to.0 - from.0);
            canvas.line((x, from.1), (x, to.1), 1.0, palette::GRID);
        }
        for (placed, _) in &self.y.ticks {
            let y = to.1 - self.y.fraction(*placed) * (to.1 - from.1);
            canvas.line((from.0, y), (to.0, y), 1.0, palette::GRID);
        }
    }

    /// Frame, labels and names without lines across: what is drawn already stays.
    pub fn draw_over(&self, canvas: &mut Canvas, below: &str, beside: &str) {
        self.draw_named(canvas, (below, 52.0), (beside, 96.0));
    }

    /// Frame, labels and names, which stand so far below the panel and beside it.
    pub fn draw_named(
        &self,
        canvas: &mut Canvas,
        (below, down): (&str, f64),
        (beside, left): (&str, f64),
    ) {
        let (from, to) = (self.from, self.to);
        for (placed, label) in &self.x.ticks {
            let x = from.0 + self.x.fraction(*placed) * (to.0 - from.0);
            canvas.line((x, to.1), (x, to.1 + 6.0), 1.0, palette::INK);
            canvas.text(label, (x, to.1 + 20.0), TEXT_SIZE, TextSide::Middle, palette::INK);
        }
        for (placed, label) in &self.y.ticks {
            let y = to.1 - self.y.fraction(*placed) * (to.1 - from.1);
            canvas.line((from.0 - 6.0, y), (from.0, y), 1.0, palette::INK);
            canvas.text(label, (from.0 - 10.0, y), TEXT_SIZE, TextSide::Right, palette::INK);
        }
        canvas.frame(from, to);
        let middle = ((from.0 + to.0) / 2.0, to.1 + down);
        canvas.text(below, middle, TEXT_SIZE + 2.0, TextSide::Middle, palette::INK);
        canvas.upright(beside, (from.0 - left, (from.1 + to.1) / 2.0), TEXT_SIZE + 2.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_logarithmic_axis_takes_what_it_is_given() {
        let values = [1e-9, 3e-4, 0.0, f64::NAN, f64::INFINITY, -1.0];
        let ruler = Ruler::over(AxisScale::Logarithmic, values.into_iter());
        assert!(ruler.is_some());
        let Some(ruler) = ruler else { return };
        assert_eq!((ruler.place(1e-10), ruler.place(0.0)), (0.0, 0.0));
        assert!((ruler.place(1e-3) - 1.0).abs() < 1e-12);
        assert_eq!(ruler.ticks.first().map(|tick| tick.1.as_str()), Some("10⁻¹⁰"));
        assert!(Ruler::over(AxisScale::Logarithmic, [0.0, f64::NAN].into_iter()).is_none());
        assert!(Ruler::over(AxisScale::Linear, [1e-300, 1e300].into_iter()).is_some());
    }
}
