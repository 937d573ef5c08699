//! Any piecewise-affine hybrid system, solved in closed form between its events.

mod accumulation;
mod beside;
mod bound;
mod build;
mod clock;
mod crossing;
mod enclosure;
mod error;
mod event;
mod expression;
mod fading;
mod file;
mod flow;
mod form;
mod hull;
mod known;
mod modal;
mod modal_state;
mod motion;
mod nilpotent;
mod nudge;
mod point;
mod quotient;
mod reach;
mod residue;
mod row;
mod run;
mod search;
mod series;
mod settle;
mod solver;
mod starts;
mod structural;
mod structure;
mod system;
mod taylor;
mod track;
mod vector;

pub use clock::Time;
pub use dashu_ratio::RBig as Rational;
pub use error::SystemError;
pub use event::{Ending, Errors, Event, What};
pub use file::SystemFile;
pub use run::Run;
pub use solver::{Solver, Unprepared};
pub use system::{
    Direction, Forcing, LARGEST_DIMENSION, Mode, Row, StartPoint, Successor, System, TROUBLE,
    Until, Watch,
};
pub use track::SearchWork;
