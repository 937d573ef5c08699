//! Verbs of periodic orbits: `orbit` finds one, `continue` follows it.

pub(super) mod find;
pub(super) mod follow;
pub(super) mod json;
mod of_system;
mod table;
