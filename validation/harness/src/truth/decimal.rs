//! Decimals of 25 digits as two words.

use percuss::TwoWord;

/// 10^22 is the largest power of ten that is an f64.
const MAX_EXACT_POWER: i32 = 22;
/// 36 digits are fewer than `u128` holds, and more than the tables have.
const MAX_DIGITS: usize = 36;

/// The decimal's value to about 100 bits; `None` if the text is no plain decimal.
pub(super) fn parse(text: &str) -> Option<TwoWord> {
    let (negative, unsigned) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (unsigned, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let significant = digits.trim_start_matches('0');
    if digits.is_empty()
        || significant.len() > MAX_DIGITS
        || !digits.bytes().all(|byte| byte.is_ascii_digit())
    {
        return None;
    }
    let integer = if significant.is_empty() { 0 } else { significant.parse::<u128>().ok()? };
    let scaled =
        scale(two_word(integer), exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?);
    Some(if negative { TwoWord::ZERO.minus(scaled) } else { scaled })
}

/// An integer below 2^106 exactly, a larger one to 106 bits.
fn two_word(integer: u128) -> TwoWord {
    let high = integer as f64;
    let rest = if high as u128 > integer {
        -((high as u128 - integer) as f64)
    } else {
        (integer - high as u128) as f64
    };
    TwoWord::sum(high, rest)
}

fn scale(mut value: TwoWord, mut exponent: i32) -> TwoWord {
    while exponent != 0 {
        let part = exponent.clamp(-MAX_EXACT_POWER, MAX_EXACT_POWER);
        let power = 10_f64.powi(part.abs());
        value = if part > 0 { value.times(power) } else { value.over(power) };
        if value.high == 0.0 {
            return TwoWord::ZERO;
        }
        exponent -= part;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_high_word_is_what_the_standard_library_reads() {
        for text in [
            "0",
            "-0.05000000000000000277555756",
            "483321946.8061220201759404",
            "3.8e-41",
            "1e22",
            "0.1",
        ] {
            let parsed = parse(text).map(|value| value.high);
            assert_eq!(parsed, text.parse().ok(), "{text}");
        }
    }

    #[test]
    fn the_low_word_holds_the_rest() {
        let tenth = parse("0.1").map(|value| value.minus(TwoWord::new(0.1)).value());
        // 0.1 as f64 is 0.1 + 5.551115123125783e-18.
        assert!(tenth.is_some_and(|rest| (rest + 5.551_115_123_125_783e-18).abs() < 1e-33));
    }

    #[test]
    fn nonsense_is_refused() {
        for text in [
            "",
            "-",
            "nan",
            "1e",
            "1.2.3",
            "0x1",
            "+1",
            "1e99999999999",
            "1234567890123456789012345678901234567890",
        ] {
            assert!(parse(text).is_none(), "{text}");
        }
    }
}
