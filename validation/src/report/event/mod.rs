//! Pictures of the first missed or spurious event of a row: the guard against time around it, as it
//! truly is and as the engine had it, with the engine's steps and what its root finder saw.
//!
//! The row's run is made again and watched around the event. The truth is the exact solver's run,
//! made again in 106 bits.

mod choice;
mod course;
mod draw;
mod guarded;
mod mismatch;
mod scales;

pub use choice::event_pictures;
pub use mismatch::MismatchKind;

use percuss::Phase;
use serde::{Serialize, Serializer};

/// The first wrong event of one row, at several scales of time.
#[derive(Clone, Debug, Serialize)]
pub struct EventPicture {
    /// The case.
    pub case: String,
    /// The engine.
    pub engine: String,
    /// The engine's tolerance, where it has one.
    pub tolerance: Option<f64>,
    /// The engine's step, where that is fixed.
    pub step: Option<f64>,
    /// What is wrong with the event.
    pub kind: MismatchKind,
    /// The event and what is wrong with it, in one sentence.
    pub title: String,
    /// The quantity that is drawn: an event is where it reaches zero.
    pub guard: &'static str,
    /// The time about which all views are drawn, since the start.
    pub centre: f64,
    /// The views, from the widest to the closest.
    pub views: Vec<View>,
    /// The closest view in which the truth's shape still shows beside the engine's error.
    pub telling: usize,
}

/// The guard over a stretch of time, in times since [`EventPicture::centre`].
#[derive(Clone, Debug, Serialize)]
pub struct View {
    /// The time at which the view begins.
    pub from: f64,
    /// The time at which the view ends.
    pub to: f64,
    /// What is true.
    pub truth: ViewCourse,
    /// What the engine made of it.
    pub engine: ViewCourse,
    /// Ends of the engine's accepted steps.
    pub steps: Vec<f64>,
    /// The times at which the engine's root finder evaluated the guard, and what it found.
    pub looks: Vec<[f64; 2]>,
}

/// The course of a run through a view.
#[derive(Clone, Debug, Serialize)]
pub struct ViewCourse {
    /// The phase that holds where the view begins.
    #[serde(serialize_with = "token")]
    pub phase: Phase,
    /// The events in the view.
    pub events: Vec<EventMark>,
    /// The quantity at instants evenly spread over the view, both ends among them; none where the
    /// engine does not record them.
    pub values: Vec<f64>,
}

/// An event in a view.
#[derive(Clone, Debug, Serialize)]
pub struct EventMark {
    /// When.
    pub t: f64,
    /// The phase that begins.
    #[serde(serialize_with = "token")]
    pub phase: Phase,
    /// Whether truth and engine both have it.
    pub matched: bool,
}

fn token<S: Serializer>(phase: &Phase, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(phase.as_str())
}
