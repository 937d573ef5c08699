//! The harness: what is true ([`truth`]), how an engine's answer is scored ([`score`]) and its
//! derivatives are judged ([`gradients`]), and what is run ([`suite`], [`power`]).

// Modules here name those of the package below as if they were their own.
use percuss_engines::{case, engine, integration, integrators, number, system};

pub mod gradients;
pub mod power;
pub mod provenance;
pub mod score;
pub mod suite;
pub mod truth;
