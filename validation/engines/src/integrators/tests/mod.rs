//! What every engine is held to whatever its library: it comes back from odd input, a run that is
//! watched is the run that is scored, and systems other than the oscillator follow closed forms.

mod odd_input;
mod systems;
mod watching;
