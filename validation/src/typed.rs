//! Numbers and sections as people type them, for the command and for the Python package.

use percuss::affine::Section;

/// The largest angle of a section, in radians.
pub const LARGEST_ANGLE: f64 = 1e15;

/// A number, or a multiple of pi such as `pi/2`, `-pi`, `2pi` or `3*pi/4`: the double nearest to pi
/// times the factor, over the divisor.
#[must_use]
pub fn number(text: &str) -> Option<f64> {
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let (size, sign) = text.strip_prefix('-').map_or((text, 1.0), |size| (size, -1.0));
    let (factor, divisor) = size.split_once("pi")?;
    let plain =
        |text: &str| text.parse().ok().filter(|_| text.starts_with(|c: char| c.is_ascii_digit()));
    let factor: f64 = match factor.strip_suffix('*') {
        None if factor.is_empty() => 1.0,
        times => plain(times.unwrap_or(factor))?,
    };
    let divisor: f64 = if divisor.is_empty() { 1.0 } else { plain(divisor.strip_prefix('/')?)? };
    Some(sign * factor * std::f64::consts::PI / divisor)
}

/// An angle, in radians.
#[must_use]
pub fn angle(text: &str) -> Option<f64> {
    number(text).filter(|angle| angle.abs() <= LARGEST_ANGLE)
}

/// The section that is written as `strobe`, `strobe:ANGLE`, `EVENT` or `EVENT@MODE`.
#[must_use]
pub fn section(text: &str) -> Option<Section> {
    let is_name = |it: &str| {
        let is_part = |it: char| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '-';
        it.starts_with(|first: char| first.is_ascii_lowercase()) && it.chars().all(is_part)
    };
    match (text.strip_prefix("strobe:"), text.split_once('@')) {
        (Some(text), _) => angle(text).map(Section::strobe),
        (_, Some((event, mode))) => {
            (is_name(event) && is_name(mode)).then(|| Section::event(event).in_mode(mode))
        }
        _ if text == "strobe" => Some(Section::strobe(0.0)),
        _ => is_name(text).then(|| Section::event(text)),
    }
}
