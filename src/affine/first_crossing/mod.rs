//! The first crossing of a segment's guards: proved, and found to the last digit.
//!
//! [`search`] is what a run asks. Where the segment is short beside the times in which its motion
//! changes, [`taylor`] proves the first crossing by the guards' Taylor polynomials ([`quotient`]);
//! beside one fast decay, [`taylor_with_decay`] does so by the polynomial of the rest and the decay
//! itself ([`quotient_with_decay`]). Elsewhere the segment is passed in pieces: [`reach`] says how
//! long each may be, and [`hull`] proves that a guard stays negative on it. [`crossing`] proves a
//! crossing shortly after a point, and [`settle`] brings its time to the last digit. Read `search`
//! first, then `taylor` and `reach`.

mod crossing;
mod hull;
mod quotient;
mod quotient_with_decay;
mod reach;
pub mod search;
mod settle;
pub mod taylor;
mod taylor_with_decay;
