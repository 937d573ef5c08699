//! Values of flags, with errors that say what is accepted.

use crate::case::accepted;
use percuss::dynamics::attractor::Window;
use percuss::{Parameter, Phase, UnknownName};
use regex::Regex;
use std::fmt;

/// The longest horizon, in forcing periods.
pub(in crate::cli) const MAX_PERIODS: u64 = 1_000_000_000;

/// The longest transient of a grid's starts, in forcing periods: with its extensions fifteen times
/// that.
pub(in crate::cli) const MAX_TRANSIENT: u64 = 10_000_000;

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
        let value = text.parse().map_err(|_| match accepted(name) {
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

/// An integer from `least` to `most`.
pub(in crate::cli) fn whole<T: TryFrom<u64>>(
    least: u64,
    most: u64,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|it| (least..=most).contains(it));
        let number = number.and_then(|it| T::try_from(it).ok());
        number.ok_or_else(|| format!("accepted is an integer, {least} to {most}"))
    }
}

/// An angle, in radians.
pub(in crate::cli) fn angle(text: &str) -> Result<f64, String> {
    let angle = text.parse().ok().filter(|angle: &f64| angle.abs() <= 1e15);
    angle.ok_or_else(|| "accepted is a number, -1e15 to 1e15".to_owned())
}

/// A cycle's number.
pub(in crate::cli) fn cycle(text: &str) -> Result<Typed<i64>, String> {
    let value = text.parse().ok();
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
    window.filter(|window| window.check().is_ok()).ok_or_else(|| {
        "accepted is pmin,pmax,ymin,ymax with each pair rising, within 1e9".to_owned()
    })
}

/// I/N, a shard of so many.
pub(in crate::cli) fn shard(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once('/').map(|(shard, shards)| [shard.parse(), shards.parse()]);
    match parts {
        Some([Ok(shard), Ok(shards)]) if shard < shards => Ok([shard, shards]),
        _ => Err("accepted is I/N, shard I of N, from 0/N to N - 1".to_owned()),
    }
}
