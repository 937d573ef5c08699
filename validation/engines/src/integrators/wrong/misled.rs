//! Equations of a system that mislead an integrator at the entry into a mode, and what it keeps in
//! mind of its run.

use crate::engine::Outcome;
use crate::equations::{Entered, Equations};
use crate::integration::Integration;
use crate::system::{AffineEquations, Values};
use std::cell::{Cell, RefCell};

/// The fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SystemFault {
    None,
    /// Back in time a watched guard counts where it would forward in time.
    ForwardDirections,
    /// Back in time the forcing's clock goes on ahead.
    ForwardForcing,
    /// Back in time the boundary of a mode does not end the run.
    PastBoundary,
    /// A watched guard counts in both directions.
    BothDirections,
    /// A guard that is zero at the start is an event there.
    FiresAtStart,
    /// An event at the start is not noticed.
    MissesAtStart,
    /// States in a step that an event cuts short are those of the whole step.
    UncutOutput,
    /// An event is reported with the state before its reset.
    StateBefore,
    /// Only the first of the events in one instant is noticed.
    OneAtOnce,
    /// For a while after an event none is noticed.
    Cooldown,
}

/// The memory of a faulty run.
#[derive(Default)]
pub(super) struct Memory {
    /// A guard that went past zero without being noticed, until it is inside again.
    overlooked: Cell<Option<usize>>,
    /// The states before each reset.
    before: RefCell<Vec<Values>>,
}

impl Memory {
    pub(super) fn overlook(&self, guard: usize) {
        self.overlooked.set(Some(guard));
    }

    pub(super) fn overlooks(&self, guard: usize) -> bool {
        self.overlooked.get() == Some(guard)
    }

    /// Notices a guard again that is inside.
    pub(super) fn notice_what_is_inside(&self, guards: &[f64]) {
        let inside = |guard: &usize| guards.get(*guard).is_some_and(|value| *value < 0.0);
        self.overlooked.set(self.overlooked.get().filter(|guard| !inside(guard)));
    }

    /// Gives events that end a mode the states before their resets.
    pub(super) fn put_back(
        &self,
        outcome: &mut Outcome,
        integration: &Integration<'_, Misled<'_>>,
    ) {
        let mut before = self.before.take().into_iter();
        let mut mode = integration.mode;
        for event in &mut outcome.events {
            let equations = &integration.equations;
            let guards = 0..equations.count(mode);
            let ends = guards.into_iter().any(|guard| {
                equations.event(mode, guard) == event.event && equations.ends(mode, guard)
            });
            if ends && let Some(state) = before.next() {
                event.state = state;
            }
            mode = event.mode;
        }
    }
}

/// Sound equations, and what misleads them.
#[derive(Clone, Copy)]
pub(super) struct Misled<'a> {
    pub(super) sound: AffineEquations<'a>,
    pub(super) slip: SystemFault,
    pub(super) memory: &'a Memory,
}

impl Equations for Misled<'_> {
    type State = Values;
    type Guards = <AffineEquations<'static> as Equations>::Guards;

    fn dimension(&self) -> usize {
        self.sound.dimension()
    }

    fn most_guards(&self) -> usize {
        self.sound.most_guards()
    }

    fn count(&self, mode: usize) -> usize {
        self.sound.count(mode)
    }

    fn derivatives(&self, mode: usize, t: f64, u: &[f64], du: &mut [f64]) {
        self.sound.derivatives(mode, t, u, du);
    }

    fn jacobian_product(&self, mode: usize, w: &[f64], dw: &mut [f64]) {
        self.sound.jacobian_product(mode, w, dw);
    }

    fn guards(&self, mode: usize, t: f64, u: &[f64]) -> Self::Guards {
        self.sound.guards(mode, t, u)
    }

    fn rates(&self, mode: usize, t: f64, u: &[f64]) -> Self::Guards {
        self.sound.rates(mode, t, u)
    }

    fn after_event(&self, mode: usize, guard: usize, t: f64, u: &Values) -> (usize, Values) {
        self.memory.before.borrow_mut().push(*u);
        self.sound.after_event(mode, guard, t, u)
    }

    fn ends(&self, mode: usize, guard: usize) -> bool {
        self.sound.ends(mode, guard)
    }

    fn event(&self, mode: usize, guard: usize) -> usize {
        self.sound.event(mode, guard)
    }

    fn enter(&self, after: Option<(usize, usize)>, mode: usize, t: f64, u: &Values) -> Entered {
        let entered = self.sound.enter(after, mode, t, u);
        let deaf = match self.slip {
            SystemFault::MissesAtStart => after.is_none(),
            SystemFault::OneAtOnce => after.is_some(),
            _ => false,
        };
        self.memory.overlooked.set(entered.fires.filter(|_| deaf));
        if deaf {
            return Entered { fires: None, ..entered };
        }
        if self.slip == SystemFault::FiresAtStart && after.is_none() {
            let zero = |guard: &usize| entered.is_zero(*guard) && self.ends(mode, *guard);
            return Entered { fires: (0..self.count(mode)).find(zero), ..entered };
        }
        entered
    }

    fn settle(&self, entered: Entered, u: &[f64], guards: &mut Self::Guards) {
        self.sound.settle(entered, u, guards);
    }

    fn leaves_domain(&self) -> bool {
        self.sound.leaves_domain()
    }
}
