//! Impacts that follow one another, and what small changes gain from one to the next.

use crate::affine::arithmetic::vector::Vector;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::numeric::number::Number;

/// A guard of a mode whose impacts follow one another, and the mode after an impact: the same, or
/// one that a turn leads out of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RepeatedImpact {
    pub mode: usize,
    pub until: usize,
    pub after: usize,
}

impl RepeatedImpact {
    /// Those of which an event is one, if they may accumulate and leave their guard at zero.
    pub fn of<T: Number>(solver: &Solver<T>, event: &Event<T>) -> Option<Self> {
        let What::Until(mode, until) = event.what else { return None };
        let it = Self { mode, until, after: event.mode };
        solver.modes[mode].stays_zero[until].then_some(it)
    }

    /// Whether an event is the next one of these, and no turn lies between.
    pub fn go_on_by<T: Number>(self, to: &Event<T>) -> bool {
        self.mode == self.after && to.what == What::Until(self.mode, self.until)
    }

    /// The turn that an event is, from the mode after an impact back to that before it.
    pub fn turn<T: Number>(self, solver: &Solver<T>, to: &Event<T>) -> Option<usize> {
        let What::Until(mode, turn) = to.what else { return None };
        let leads_back = mode == self.after && to.mode == self.mode && mode != to.mode;
        (leads_back && solver.modes[mode].changes_nothing[turn]).then_some(turn)
    }
}

/// What changes have gained since an impact, at the turn that follows it.
#[derive(Clone, Debug)]
pub struct SinceImpact<T> {
    pub impacts: RepeatedImpact,
    pub gained: Gained<T>,
}

/// The gains of the state and of its changes since an impact.
#[derive(Clone, Debug)]
pub struct Gained<T> {
    pub state: Vector<T>,
    pub columns: Vec<Vector<T>>,
}
