//! Ranges and ticks.

use std::ops::Range;

/// The empty margin around the data, as a share of their extent.
const MARGIN_SHARE: f64 = 0.06;

/// A range that holds all values with some room; of width 1 where they do not differ.
pub(super) fn around(values: impl Iterator<Item = f64>) -> Range<f64> {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| (low.min(it), high.max(it)));
    if low > high {
        return 0.0..1.0;
    }
    let room = if high > low { MARGIN_SHARE * (high - low) } else { 0.5 * low.abs().max(1.0) };
    low - room..high + room
}

/// A tick's label: as few digits as tell neighbours apart, with a true minus sign.
pub(super) fn label(value: f64, range: &Range<f64>) -> String {
    let extent = range.end - range.start;
    let digits = (2.0 - extent.log10()).ceil().clamp(0.0, 12.0) as usize;
    let text = if extent.log10().abs() > 6.0 {
        format!("{value:.2e}")
    } else {
        format!("{value:.digits$}")
    };
    let text = if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    };
    match text.strip_prefix('-') {
        Some("0") => "0".to_owned(),
        Some(size) => format!("\u{2212}{size}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_short_and_signed() {
        assert_eq!(label(-0.5, &(-1.0..1.0)), "\u{2212}0.5");
        assert_eq!(label(0.30000000000000004, &(0.0..1.0)), "0.3");
        assert_eq!(label(1200.0, &(0.0..2000.0)), "1200");
        assert_eq!(label(-0.0, &(-1.0..1.0)), "0");
    }

    #[test]
    fn a_range_is_never_empty() {
        let flat = around([2.0, 2.0].into_iter());
        assert!(flat.start < 2.0 && flat.end > 2.0);
        assert_eq!(around([f64::NAN].into_iter()), 0.0..1.0);
    }
}
