//! A run: its phases, how each one ends and what follows, and its derivative.

pub mod exit;
pub mod growth;
pub mod sample;
pub mod stages;
pub mod switch;
pub mod trajectory;
pub mod variation;
