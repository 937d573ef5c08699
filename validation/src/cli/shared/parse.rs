//! Values of flags, with errors that say what is accepted.

use crate::case::accepted;
use crate::picture::PlotWindow;
use crate::typed::{self, WrittenSection, number};
use percuss::dynamics::attractor::Window;
use percuss::{Parameter, Phase, UnknownName};
use regex::Regex;
use std::fmt;

/// The longest horizon, in forcing periods.
pub(in crate::cli) const MAX_PERIODS: u64 = 1_000_000_000;

/// The longest transient of a grid's starts, in forcing periods: with its extensions fifteen times
/// that.
pub(in crate::cli) const MAX_TRANSIENT_PERIODS: u64 = 10_000_000;

/// Most cells of a grid of starts.
const MAX_CELLS: u64 = 1 << 24;

/// A value and the text that it was read from, which errors repeat.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Typed<T> {
    pub(in crate::cli) value: T,
    pub(in crate::cli) text: String,
}

impl<T> fmt::Display for Typed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// A number; its range is checked where its meaning is known, and stated here where it has a name.
pub(in crate::cli) fn named(
    name: &'static str,
) -> impl Fn(&str) -> Result<Typed<f64>, String> + Clone {
    move |text| {
        let value = number(text).ok_or_else(|| match accepted(name) {
            Some(range) => format!("accepted is a number, {range}"),
            None => "accepted is a number".to_owned(),
        })?;
        Ok(Typed { value, text: text.to_owned() })
    }
}

/// An end of an interval of a parameter.
pub(in crate::cli) fn end(text: &str) -> Result<Typed<f64>, String> {
    let value = text.parse();
    let value =
        value.map_err(|_| "accepted is a number, in the range of --parameter".to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// A tolerance; which are accepted is known where the suite is.
pub(in crate::cli) fn tolerance(text: &str) -> Result<Typed<f64>, String> {
    let value = text.parse();
    let value = value.map_err(|_| "accepted is a tolerance of the suite, as 1e-6".to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// A time.
pub(in crate::cli) fn time(text: &str) -> Result<Typed<f64>, String> {
    let value = text.parse();
    let value = value.map_err(|_| "accepted is a number, at or after the start".to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// Integers up to this size, 2^53, are the same as doubles.
const MAX_EXACT_INTEGER: f64 = 9_007_199_254_740_992.0;

/// An integer, in digits or with an exponent as 1e6.
fn integer(text: &str) -> Option<i64> {
    let exponent = |text: &str| {
        let value: f64 = text.parse().ok().filter(|_| text.contains(['e', 'E']))?;
        (value.fract() == 0.0 && value.abs() <= MAX_EXACT_INTEGER).then_some(value as i64)
    };
    text.parse().ok().or_else(|| exponent(text))
}

/// A period of an orbit.
pub(in crate::cli) fn period(text: &str) -> Result<u32, String> {
    whole(1, u64::from(percuss::dynamics::orbit::LARGEST_PERIOD))(text)
}

/// An integer from `least` to `most`.
pub(in crate::cli) fn whole<T: TryFrom<u64>>(
    least: u64,
    most: u64,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let exponent = || integer(text).and_then(|it| u64::try_from(it).ok());
        let number = text.parse().ok().or_else(exponent).filter(|it| (least..=most).contains(it));
        let number = number.and_then(|it| T::try_from(it).ok());
        number.ok_or_else(|| format!("accepted is an integer, {least} to {most}"))
    }
}

/// A parameter of a system with its value.
pub(in crate::cli) fn parameter_value(text: &str) -> Result<(String, f64), String> {
    let parsed = text.split_once('=').and_then(|(name, value)| {
        Some((name.trim(), value.trim().parse().ok().filter(|it: &f64| it.is_finite())?))
    });
    let parsed = parsed.map(|(name, value)| (name.to_owned(), value));
    parsed.ok_or_else(|| "accepted is NAME=VALUE with a finite number".to_owned())
}

/// A state of a start with its value, a number or an expression.
pub(in crate::cli) fn start_value(text: &str) -> Result<[String; 2], String> {
    let parts = text.split_once('=').map(|(state, value)| [state.trim(), value.trim()]);
    let parts = parts.filter(|it| it.iter().all(|part| !part.is_empty()));
    let parts = parts.map(|it| it.map(str::to_owned));
    parts.ok_or_else(|| "accepted is STATE=VALUE with a number or an expression".to_owned())
}

/// The section of a motion, as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) enum SectionChoice {
    /// A number alone: an angle of the impact oscillator.
    Angle(f64),
    /// A section of a SYSTEM.
    OfSystem(WrittenSection),
}

/// A section.
pub(in crate::cli) fn section(text: &str) -> Result<Typed<SectionChoice>, String> {
    let of_system = || WrittenSection::read(text).map(SectionChoice::OfSystem);
    let value = typed::angle(text).map(SectionChoice::Angle).or_else(of_system);
    let accepted = "accepted is a number, -1e15 to 1e15, or with SYSTEM strobe, strobe:ANGLE, \
                    EVENT or EVENT@MODE";
    let value = value.ok_or_else(|| accepted.to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// A positive number.
pub(in crate::cli) fn positive(text: &str) -> Result<Typed<f64>, String> {
    let value = number(text).filter(|it| *it > 0.0 && it.is_finite());
    let value = value.ok_or_else(|| "accepted is a positive number".to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// A cycle's number.
pub(in crate::cli) fn cycle(text: &str) -> Result<Typed<i64>, String> {
    let value = integer(text);
    let value = value.ok_or_else(|| "accepted is an integer, -2^53 to 2^53".to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// A phase's token.
pub(in crate::cli) fn phase(text: &str) -> Result<Phase, String> {
    text.parse().map_err(|_| "accepted are no-contact, contact, progression".to_owned())
}

/// A regular expression on names.
pub(in crate::cli) fn pattern(text: &str) -> Result<Regex, String> {
    Regex::new(text).map_err(|_| "accepted is a regular expression".to_owned())
}

/// A parameter's name.
pub(in crate::cli) fn parameter(text: &str) -> Result<Parameter, String> {
    text.parse().map_err(|_: UnknownName| "accepted are a, b, xi, omega, g, phi".to_owned())
}

/// NXxNY, cells along p and along y.
pub(in crate::cli) fn grid(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(columns, rows)| [columns.parse(), rows.parse()]);
    match sides {
        Some([Ok(columns), Ok(rows)])
            if columns > 0 && rows > 0 && u64::from(columns) * u64::from(rows) <= MAX_CELLS =>
        {
            Ok([columns, rows])
        }
        _ => Err(format!("accepted is NXxNY with at most {MAX_CELLS} cells, as 200x200")),
    }
}

/// pmin,pmax,ymin,ymax.
pub(in crate::cli) fn window(text: &str) -> Result<Window, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let window = match numbers.as_deref() {
        Ok([p_low, p_high, y_low, y_high]) => {
            Some(Window { p: [*p_low, *p_high], y: [*y_low, *y_high] })
        }
        _ => None,
    };
    // What rounding leaves of a narrower pair is no window.
    let rises = |[from, to]: [f64; 2]| from.is_finite() && to.is_finite() && from.next_up() <= to;
    let window = window.filter(|window| rises(window.p) && rises(window.y));
    window.ok_or_else(|| "accepted is pmin,pmax,ymin,ymax with each pair rising".to_owned())
}

/// WxH, a size on paper in millimetres.
pub(in crate::cli) fn millimetres(text: &str) -> Result<Typed<[f64; 2]>, String> {
    let sides = text.split_once('x').map(|(width, height)| [width.parse(), height.parse()]);
    match sides {
        Some([Ok(width), Ok(height)])
            if [width, height].iter().all(|it| (10.0..=2000.0).contains(it)) =>
        {
            Ok(Typed { value: [width, height], text: text.to_owned() })
        }
        _ => Err("accepted is WxH in millimetres, each 10 to 2000, as 80x60".to_owned()),
    }
}

/// Pixels in an inch.
pub(in crate::cli) fn dpi(text: &str) -> Result<Typed<f64>, String> {
    let value = text.parse().ok().filter(|it| (30.0..=2400.0).contains(it));
    let value = value.ok_or_else(|| "accepted is a number, 30 to 2400".to_owned())?;
    Ok(Typed { value, text: text.to_owned() })
}

/// LO,HI of the vertical axis, or LO,HI,LO,HI of both: an axis that is not named has no end.
pub(in crate::cli) fn range(text: &str) -> Result<Typed<PlotWindow>, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let all = (f64::NEG_INFINITY, f64::INFINITY);
    let value = match numbers.as_deref() {
        Ok([low, high]) => Some([all, (*low, *high)]),
        Ok([left, right, low, high]) => Some([(*left, *right), (*low, *high)]),
        _ => None,
    };
    let is_given = |numbers: &[f64]| numbers.iter().all(|it| it.is_finite());
    let value = value
        .filter(|it| numbers.as_deref().is_ok_and(is_given) && it.iter().all(|it| it.0 < it.1));
    let value = value.ok_or_else(|| {
        "accepted is LO,HI of the vertical axis, or LO,HI,LO,HI of both, each pair rising"
            .to_owned()
    })?;
    Ok(Typed { value, text: text.to_owned() })
}

/// LO,HI, two numbers that rise.
pub(in crate::cli) fn rising(text: &str) -> Result<Typed<[f64; 2]>, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok([low, high]) if low < high && low.is_finite() && high.is_finite() => {
            Ok(Typed { value: [*low, *high], text: text.to_owned() })
        }
        _ => Err("accepted is LO,HI, two numbers of which the second is larger".to_owned()),
    }
}

/// I/N, a shard of so many.
pub(in crate::cli) fn shard(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once('/').map(|(shard, shards)| [shard.parse(), shards.parse()]);
    match parts {
        Some([Ok(shard), Ok(shards)]) if shard < shards => Ok([shard, shards]),
        _ => Err("accepted is I/N, shard I of N, from 0/N to N - 1".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn multiples_of_pi_are_numbers() {
        let cases = [
            ("pi/2", PI / 2.0),
            ("-pi", -PI),
            ("2pi", 2.0 * PI),
            ("3*pi/4", 0.75 * PI),
            ("-0.5*pi", -0.5 * PI),
            ("1e-3", 1e-3),
        ];
        for (text, value) in cases {
            assert_eq!(number(text), Some(value), "{text}");
        }
        for text in ["", "pie", "pi*2", "pi/", "*pi", "--pi", "pi/-2", "pi/inf", "nanpi", "2 pi"] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn integers_may_have_an_exponent() {
        let accepts = whole::<u64>(0, 1_000_000_000);
        for (text, value) in [("1e6", 1_000_000), ("1.5E3", 1500), ("1e9", 1_000_000_000), ("7", 7)]
        {
            assert_eq!(accepts(text), Ok(value), "{text}");
        }
        for text in ["1e10", "1.5", "1e-1", "-1e3", "1e300", "e3", "inf", "nan"] {
            assert!(accepts(text).is_err(), "{text}");
        }
        assert_eq!(integer("-1e15"), Some(-1_000_000_000_000_000));
        assert_eq!(whole::<u64>(0, u64::MAX)("18446744073709551615"), Ok(u64::MAX));
    }
}
