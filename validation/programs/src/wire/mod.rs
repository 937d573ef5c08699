//! The messages, as `docs/PROTOCOL.md` describes them: what is written to a program, and what is
//! read from it.

mod ask;
mod numbers;
mod reply;
#[cfg(test)]
mod schema_tests;

pub(crate) use ask::{Ask, Asked, ModeAsk, RatesAsk, RunAsk, TimesAsk, samples};
pub(crate) use numbers::{BoundedList, Count, StateReply};
pub use reply::{Capabilities, EventsBy, SetUp};
pub(crate) use reply::{
    EventGradientReply, EventReply, GradientReply, ReplyContent, RunReply, decode,
};

/// The version of the protocol, which every message names.
pub const PROTOCOL: u64 = 1;
