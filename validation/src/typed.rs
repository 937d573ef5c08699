//! Numbers and sections as people type them, for the command and for the Python package.

use percuss::affine::Section;

/// The largest angle of a section, in radians.
pub const MAX_ANGLE_RADIANS: f64 = 1e15;

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
    number(text).filter(|angle| angle.abs() <= MAX_ANGLE_RADIANS)
}

/// A section as it is written: `strobe`, `strobe:ANGLE`, `EVENT` or `EVENT@MODE`.
#[derive(Clone, Debug, PartialEq)]
pub enum WrittenSection {
    /// The instants at which omega t has this angle.
    Strobe(f64),
    /// An event, in any mode or in one alone.
    Event {
        /// The name of the event.
        event: String,
        /// The name of the mode that holds it.
        mode: Option<String>,
    },
}

impl WrittenSection {
    /// The section that the text says, if it is one.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let is_name = |it: &str| {
            let is_part = |it: char| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '-';
            it.starts_with(|first: char| first.is_ascii_lowercase()) && it.chars().all(is_part)
        };
        let event = |event: &str, mode: Option<&str>| {
            let is_accepted = is_name(event) && mode.is_none_or(is_name);
            let (event, mode) = (event.to_owned(), mode.map(str::to_owned));
            is_accepted.then_some(Self::Event { event, mode })
        };
        match (text.strip_prefix("strobe:"), text.split_once('@')) {
            (Some(text), _) => angle(text).map(Self::Strobe),
            (_, Some((name, mode))) => event(name, Some(mode)),
            _ if text == "strobe" => Some(Self::Strobe(0.0)),
            _ => event(text, None),
        }
    }

    /// The section of a system's motions.
    #[must_use]
    pub fn section(&self) -> Section {
        match self {
            Self::Strobe(angle) => Section::strobe(*angle),
            Self::Event { event, mode: None } => Section::event(event),
            Self::Event { event, mode: Some(mode) } => Section::event(event).in_mode(mode),
        }
    }
}

/// The section that is written as `strobe`, `strobe:ANGLE`, `EVENT` or `EVENT@MODE`.
#[must_use]
pub fn section(text: &str) -> Option<Section> {
    WrittenSection::read(text).map(|it| it.section())
}
