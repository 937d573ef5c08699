//! The proved tables of `reference_data/`, read and checked.

mod decimal;
mod library;
mod table;

pub use library::Library;
pub use table::{Row, Truth};
