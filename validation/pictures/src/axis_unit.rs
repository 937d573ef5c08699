//! The units of an axis, chosen so that its labels stay short: powers of ten, from a round value
//! on.

use super::axes::around;
use super::font;
use super::frame::{Ruler, power_of_ten};

/// The width of the longest label, in pixels; beyond it stands the name of a vertical axis.
const MAX_LABEL_PIXELS: f64 = 72.0;
const TEXT_SIZE: f64 = 20.0;

/// A figure is shown as (value - origin)/10^exponent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct AxisUnit {
    origin: f64,
    /// The power of ten of which the origin is a multiple.
    origin_power: i32,
    exponent: i32,
}

impl AxisUnit {
    /// The plainest unit in which the labels of an axis over these values are short.
    pub fn new(values: impl Iterator<Item = f64>) -> Self {
        let range = around(values);
        let largest = |origin: f64| (range.start - origin).abs().max((range.end - origin).abs());
        let exponent = |origin: f64| largest(origin).log10().floor() as i32;
        let power = (range.end - range.start).log10().ceil() as i32;
        let round = 10.0_f64.powi(power);
        let origin = (range.start / round).floor() * round;
        let plain = Self::default();
        let moved = Self { origin, origin_power: power, exponent: 0 };
        let units = [
            plain,
            Self { exponent: exponent(0.0), ..plain },
            moved,
            Self { exponent: exponent(origin), ..moved },
        ];
        let fits = |unit: &&Self| unit.has_short_labels(range.start, range.end);
        units.iter().find(fits).copied().unwrap_or(moved)
    }

    fn has_short_labels(&self, from: f64, to: f64) -> bool {
        let ruler = Ruler::between(self.shown(from), self.shown(to));
        let short = |label: &String| {
            !label.contains('e') && font::width(label, TEXT_SIZE) <= MAX_LABEL_PIXELS
        };
        ruler.ticks.iter().all(|(_, label)| short(label))
    }

    /// A value as the axis counts it.
    pub fn shown(&self, value: f64) -> f64 {
        let power = 10.0_f64.powi(self.exponent.abs());
        let moved = value - self.origin;
        if self.exponent < 0 { moved * power } else { moved / power }
    }

    /// The name of an axis, followed by its unit. The name is shortened to fit into `room` pixels;
    /// the unit is always kept whole, because without it the labels would be wrong.
    pub fn named(&self, name: &str, room: f64) -> String {
        let unit = self.words();
        let room = (room - font::width(&unit, TEXT_SIZE)).max(font::width("\u{2026}", TEXT_SIZE));
        font::shorten(name, TEXT_SIZE, room) + &unit
    }

    fn words(&self) -> String {
        let decimals = usize::try_from(-self.origin_power).unwrap_or(0);
        let size = format!("{:.decimals$}", self.origin.abs());
        let from = match self.origin {
            0.0 => String::new(),
            origin if origin < 0.0 => format!(" + {size}"),
            _ => format!(" \u{2212} {size}"),
        };
        match self.exponent {
            0 => from,
            exponent => format!("{from}, in {}", power_of_ten(exponent.into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(values: &[f64]) -> String {
        AxisUnit::new(values.iter().copied()).named("height", 900.0)
    }

    #[test]
    fn labels_are_short_whatever_the_size() {
        assert_eq!(named(&[0.0, 1.5]), "height");
        assert_eq!(named(&[16.0, 20.5]), "height");
        assert_eq!(named(&[-2.4e6, 1.8e6]), "height, in 10⁶");
        assert_eq!(named(&[0.0, 1.5e12]), "height, in 10¹²");
        assert_eq!(named(&[0.0, -3e-9]), "height, in 10⁻⁹");
        assert_eq!(named(&[1_000_134.0, 1_000_150.0]), "height \u{2212} 1000100");
        assert_eq!(named(&[-1_000_150.0, -1_000_134.0]), "height + 1000200");
        assert_eq!(named(&[2.0, 2.0 + 1e-9]), "height \u{2212} 1.99999999, in 10⁻⁸");
        for size in [1e-300, 1e-12, 1e-5, 0.3, 70.0, 99_999.0, 1e6, 1e15, 1e300] {
            for from in [0.0, size, -size, 1e3 * size] {
                let unit = AxisUnit::new([from, from + size].into_iter());
                let range = around([from, from + size].into_iter());
                assert!(unit.has_short_labels(range.start, range.end), "{size} from {from}");
            }
        }
    }

    #[test]
    fn what_an_axis_counts_in_is_never_cut() {
        let unit = AxisUnit::new([0.0, 1.5e6].into_iter());
        let name = unit.named("a_name_of_many_letters", 130.0);
        assert!(name.contains('\u{2026}') && name.ends_with(", in 10⁶"), "{name}");
        assert!((unit.shown(1.5e6) - 1.5).abs() < 1e-12);
    }
}
