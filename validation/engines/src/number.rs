//! Numbers as text: the shortest form that reads back to the same f64.

use std::fmt;

/// The smallest size that is written without an exponent.
const MIN_PLAIN_SIZE: f64 = 1e-5;
/// The size from which on a number is written with an exponent.
const MAX_PLAIN_SIZE: f64 = 1e16;

/// The shortest text that reads back to `value`; not finite: `nan`, `inf`, `-inf`.
#[must_use]
pub fn shortest(value: f64) -> String {
    Shortest(value).to_string()
}

/// A number that prints as [`shortest`] has it, for those who write many.
pub struct Shortest(pub f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (value, size) = (self.0, self.0.abs());
        if value.is_nan() {
            f.write_str("nan")
        } else if value.is_infinite() {
            f.write_str(if value > 0.0 { "inf" } else { "-inf" })
        } else if size != 0.0 && !(MIN_PLAIN_SIZE..MAX_PLAIN_SIZE).contains(&size) {
            write!(f, "{value:e}")
        } else {
            write!(f, "{value}")
        }
    }
}

/// Two significant digits, for people; small whole numbers as they are.
#[must_use]
pub fn brief(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e4 {
        format!("{}", value + 0.0)
    } else if value.is_finite() {
        format!("{value:.1e}")
    } else {
        shortest(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_reads_back() {
        for value in
            [0.0, -0.0, 0.1, 1e-7, 1.5e300, f64::MIN_POSITIVE, 5e-324, 1e16, 123_456.789, -2.5e-5]
        {
            let text = shortest(value);
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()), "{text}");
        }
        assert_eq!(shortest(1e-7), "1e-7");
        assert_eq!(shortest(1.0), "1");
        assert_eq!(shortest(f64::NEG_INFINITY), "-inf");
        assert_eq!(shortest(f64::NAN), "nan");
    }
}
