//! Numbers as text: the shortest form that reads back to the same f64.

/// Below this size, or from [`LARGE`] on, a number is written with an exponent.
const SMALL: f64 = 1e-5;
const LARGE: f64 = 1e16;

/// The shortest text that reads back to `value`; not finite: `nan`, `inf`, `-inf`.
#[must_use]
pub fn shortest(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        "nan".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "inf" } else { "-inf" }.to_owned()
    } else if size != 0.0 && !(SMALL..LARGE).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
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
