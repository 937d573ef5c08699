//! The values of a system's tables: numbers, expressions, conditions and assignments.

use super::rational::Rational;
use serde::Deserialize;
use serde::de::{self, Deserializer, Visitor};
use std::fmt;

/// A number, or an expression; in a builder also a row.
#[derive(Clone, Debug)]
pub(super) enum Scalar {
    Integer(i64),
    Decimal(f64),
    Text(String),
    Exact(Rational),
    /// The factors of the states, of cos and sin in a forced system, and of 1.
    Row(Vec<Scalar>),
}

impl Scalar {
    /// The number of a text, or else the text as an expression.
    pub fn from_text(text: &str) -> Self {
        if let Ok(integer) = text.parse() {
            return Self::Integer(integer);
        }
        text.parse().map_or_else(|_| Self::Text(text.to_owned()), Self::Decimal)
    }

    /// The exact value of a number; none of text, of a row and of what is not finite.
    pub fn number(&self) -> Option<Rational> {
        match self {
            Self::Integer(integer) => Some(Rational::from(*integer)),
            Self::Decimal(decimal) => Rational::try_from(*decimal).ok(),
            Self::Exact(number) => Some(number.clone()),
            Self::Text(_) | Self::Row(_) => None,
        }
    }
}

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl Visitor<'_> for Read {
            type Value = Scalar;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or an expression")
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Scalar, E> {
                Ok(Scalar::Integer(value))
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Scalar, E> {
                Ok(Scalar::Decimal(value))
            }
            fn visit_str<E: de::Error>(self, value: &str) -> Result<Scalar, E> {
                Ok(Scalar::Text(value.to_owned()))
            }
        }
        deserializer.deserialize_any(Read)
    }
}

/// A condition, as text; in a builder also a row that is positive where the condition holds.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "String")]
pub(super) struct Condition(pub Scalar);

impl From<String> for Condition {
    fn from(text: String) -> Self {
        Self(Scalar::Text(text))
    }
}

/// An equation of a state or an assignment to one.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "String")]
pub(super) enum Assignment {
    /// Both sides as text, such as `x' = v`.
    Text(String),
    /// The right side alone, in a builder.
    To { state: String, value: Scalar },
}

impl From<String> for Assignment {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}
