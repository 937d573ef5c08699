//! Pictures of the first missed or spurious event of a row: the guard against time around it, as it
//! truly is and as the engine had it, with the engine's steps and what its root finder saw.
//!
//! The suite observes truth and engine there ([`crate::suite::first_wrong`]); [`picture`] makes
//! the views of it from the parts of [`scene`].

mod draw;
mod picture;
mod scene;

pub use crate::suite::first_wrong::MismatchKind;
pub use picture::event_pictures;

use serde::Serialize;

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
    pub guard: String,
    /// The names of the system's modes; none of the oscillator, whose phases everyone knows.
    pub modes: Vec<String>,
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
    /// The true run.
    pub truth: ViewTrajectory,
    /// The engine's run.
    pub engine: ViewTrajectory,
    /// Ends of the engine's accepted steps.
    pub steps: Vec<f64>,
    /// The times at which the engine's root finder evaluated the guard, and what it found.
    pub looks: Vec<[f64; 2]>,
}

/// The part of a run that lies in a view.
#[derive(Clone, Debug, Serialize)]
pub struct ViewTrajectory {
    /// The phase, or the mode, that holds where the view begins.
    pub phase: String,
    /// The events in the view.
    pub events: Vec<EventMark>,
    /// The quantity at instants evenly spread over the view, both ends among them; none where the
    /// engine does not record them.
    pub values: Vec<f64>,
}

/// An event in a view.
#[derive(Clone, Debug, Serialize)]
pub struct EventMark {
    /// The time of the event, since [`EventPicture::centre`].
    pub t: f64,
    /// The phase, or the mode, that begins.
    pub phase: String,
    /// Whether truth and engine both have it.
    pub matched: bool,
}
