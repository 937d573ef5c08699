//! Cases and answers as files: what a case asks, for readers of any language, and what a program
//! answered without percuss being there. Both are what the protocol says, in files.

mod answer;
mod case;
mod engine;
mod equations;
mod gradients;
mod layout;
mod rows;
mod table;
#[cfg(test)]
mod tests;

pub use case::CaseFile;
pub use engine::{Answerer, FileEngine};
pub use layout::{EVENT_COLUMNS, SAMPLE_COLUMNS, printed_column};
pub use table::{EVENTS_ENDING, GRADIENTS_ENDING, SAMPLES_ENDING};
