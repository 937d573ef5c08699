//! Arithmetic beyond that of f64: two words, angles, complex numbers, elementary functions and
//! their remainders.

pub mod angle;
pub mod bound;
pub mod circle;
pub mod complex;
#[cfg(feature = "affine")]
pub mod double_double;
pub mod exponential;
pub mod number;
pub mod real;
pub mod remainders;
pub mod roots;
pub mod series;
pub mod two_word;
#[cfg(feature = "affine")]
pub mod wide;
