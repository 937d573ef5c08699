//! What several verbs share: flags and their values, the formats and places of output, names that
//! the user may have meant, progress, what is said on stderr, and exit codes. No verb stands here.

pub(super) mod compact;
pub(super) mod drift;
pub(super) mod exit_codes;
pub(super) mod format;
pub(super) mod gradients;
pub(super) mod horizon;
pub(super) mod judged;
pub(super) mod list;
pub(super) mod long_work;
pub(super) mod model;
pub(super) mod names;
pub(super) mod no_progress;
pub(super) mod output;
pub(super) mod outputs;
pub(super) mod parse;
pub(super) mod picture;
pub(super) mod plane;
pub(super) mod programs;
pub(super) mod progress;
pub(super) mod reports;
pub(super) mod run_arrays;
pub(super) mod run_ending;
pub(super) mod section;
pub(super) mod states;
pub(super) mod system_choice;
pub(super) mod terminal;
