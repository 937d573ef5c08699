//! Piecewise-affine systems as integrators are given them: plain numbers in f64.
//!
//! What a system's file may hold and what a run of it means is in `docs/SYSTEM_FORMAT.md`. In each
//! mode x' = A x + c + B (cos theta, sin theta), with theta = omega t + phi and t the time elapsed
//! since the start. A row is over (x, cos theta, sin theta, 1); a guard is negative inside its mode
//! and an event where it has risen to zero.

mod affine;
pub(crate) mod by_hand;
mod checked;
mod derivative_rows;
mod given;
mod numbers;
mod problem;
mod rates;
mod spectrum;

pub use affine::AffineEquations;
pub use checked::CheckedSystem;
pub use numbers::{MAX_GUARDS, MAX_STATES, Values};
pub use problem::SystemProblem;
pub use rates::CoefficientDerivatives;

/// Coefficients of x, cos theta, sin theta and 1.
pub type Row = Vec<f64>;

/// A system in f64, as it was written down.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct System {
    /// The system's name.
    pub name: String,
    /// The names of the states.
    pub states: Vec<String>,
    /// The places of the states that only add up what the others do, on which nothing depends: they
    /// are no part of a state's error.
    pub drift: Vec<usize>,
    /// The scale of each state, by which it is divided before any norm.
    pub scales: Vec<f64>,
    /// The time scale, by which times are divided before any comparison.
    pub time_scale: f64,
    /// The forcing's angular frequency; zero where the system is not forced, negative in a system
    /// that is run back in time.
    pub omega: f64,
    /// The forcing's angle at the start, in radians.
    pub phi: f64,
    /// The modes, in the file's order.
    pub modes: Vec<Mode>,
}

/// A mode.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mode {
    /// The mode's name.
    pub name: String,
    /// The matrix A, one row per state.
    pub a: Vec<Vec<f64>>,
    /// The matrix B: what cos theta and sin theta add to each state's rate.
    pub b: Vec<[f64; 2]>,
    /// The vector c.
    pub c: Vec<f64>,
    /// The events that end the mode, in the order of the file.
    pub until: Vec<Until>,
    /// The events that are only counted, in the file's order.
    pub watch: Vec<Watch>,
}

/// An event that ends its mode.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Until {
    /// The event's name.
    pub name: String,
    /// The guard, which is negative inside the mode.
    pub guard: Row,
    /// A row for each state after the event; without it the state stays.
    pub reset: Option<Vec<Row>>,
    /// The modes that may follow, each with the row that has to be positive for it: the first that
    /// is counts, and the last has none.
    pub next: Vec<(Option<Row>, usize)>,
}

/// An event that does not end its mode.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watch {
    /// The event's name.
    pub name: String,
    /// The guard.
    pub guard: Row,
    /// The crossing direction that makes an event.
    pub direction: Direction,
}

/// The direction in which a watched guard has to cross zero for an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// The guard becomes positive after it was negative.
    #[default]
    Rising,
    /// The guard becomes negative after it was positive.
    Falling,
    /// Crossings of both kinds count.
    Both,
}

impl Direction {
    /// The direction's name in files and messages.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Rising => "rising",
            Self::Falling => "falling",
            Self::Both => "both",
        }
    }
}

impl Mode {
    /// The rate of a state as a row.
    #[must_use]
    pub fn rate(&self, state: usize) -> Row {
        [self.a[state].as_slice(), &self.b[state], &[self.c[state]]].concat()
    }
}

impl System {
    /// The system run back in time: all rates change their sign, and so does the forcing's.
    #[must_use]
    pub fn backward(&self) -> Self {
        let mut other = self.clone();
        other.omega = -self.omega;
        for mode in &mut other.modes {
            let rates = mode.a.iter_mut().flatten().chain(mode.b.iter_mut().flatten());
            rates.chain(&mut mode.c).for_each(|rate| *rate = -*rate);
        }
        other
    }

    /// The name of an event: those that end a mode come before those that are only counted.
    #[must_use]
    pub fn event_name(&self, mode: usize, event: usize) -> Option<&str> {
        let mode = self.modes.get(mode)?;
        let names =
            mode.until.iter().map(|it| &it.name).chain(mode.watch.iter().map(|it| &it.name));
        names.map(String::as_str).nth(event)
    }
}
