//! The harness: what is true ([`truth`]), how an engine's answer is scored ([`score`]), what is run
//! ([`suite`], [`power`]), how fast it is ([`mod@bench`]), and what the paper says ([`reproduce`]).

// Modules here name those of the packages below as if they were their own.
use percuss_engines::{case, engine, integration, integrators, number, system};
use percuss_pictures as picture;

pub mod arrays;
pub mod bench;
pub mod gradients;
pub mod power;
pub mod provenance;
pub mod reproduce;
pub mod score;
pub mod suite;
pub mod truth;
