//! A system's equations as integrators are given them.

use super::checked::{CheckedMode, Successor};
use super::derivative_rows::{Leading, value};
use super::numbers::Guards;
use super::{CheckedSystem, Values};
use crate::equations::{Entered, Equations, NO_GUARD, Numbers};

/// The equations of a system.
///
/// The methods are not compiled into every stage of every integrator: that would take half as long
/// again, and a call costs little beside the loops that it runs.
#[derive(Clone, Copy, Debug)]
pub struct AffineEquations<'a> {
    system: &'a CheckedSystem,
}

impl<'a> AffineEquations<'a> {
    /// The equations of a system that was checked.
    #[must_use]
    pub fn new(system: &'a CheckedSystem) -> Self {
        Self { system }
    }

    fn mode(&self, mode: usize) -> &'a CheckedMode {
        &self.system.modes[mode]
    }

    /// cos theta and sin theta.
    fn forcing(&self, t: f64) -> [f64; 2] {
        let system = self.system.system();
        let (sin, cos) = (system.omega * t + system.phi).sin_cos();
        [cos, sin]
    }

    /// The values of a derivative of all guards of a mode.
    fn all(&self, mode: usize, order: usize, t: f64, u: &[f64]) -> Guards {
        let CheckedMode { guards, guards_forced, .. } = self.mode(mode);
        let forcing = if guards_forced[order] { self.forcing(t) } else { [0.0; 2] };
        let mut values = Guards::all(self.system.most_guards, NO_GUARD);
        for (place, guard) in values.iter_mut().zip(guards) {
            *place = value(&guard.chain.rows[order], u, forcing).0;
        }
        values
    }

    /// The successor whose condition holds, for a state after the reset.
    fn successor(&self, mode: usize, guard: usize, t: f64, u: &[f64]) -> &'a Successor {
        let next = &self.mode(mode).until[guard].next;
        let forcing = self.forcing(t);
        let holds = |successor: &&Successor| match &successor.when {
            Some(when) => {
                let leading = when.leading(successor.when_zeros, t, u, forcing);
                leading.is_some_and(|it| it.positive)
            }
            None => true,
        };
        // The last has no condition.
        next.iter().find(holds).unwrap_or(&next[next.len() - 1])
    }
}

impl Equations for AffineEquations<'_> {
    type State = Values;
    type Guards = Guards;

    fn dimension(&self) -> usize {
        self.system.system().states.len()
    }

    fn most_guards(&self) -> usize {
        self.system.most_guards
    }

    fn count(&self, mode: usize) -> usize {
        self.mode(mode).guards.len()
    }

    #[inline(never)]
    fn derivatives(&self, mode: usize, t: f64, u: &[f64], du: &mut [f64]) {
        let mode = self.mode(mode);
        self.jacobian(mode, u, du);
        for (rate, constant) in du.iter_mut().zip(&mode.c) {
            *rate += constant;
        }
        if mode.forced {
            let [cos, sin] = self.forcing(t);
            for (rate, [by_cos, by_sin]) in du.iter_mut().zip(&mode.b) {
                *rate += by_cos * cos + by_sin * sin;
            }
        }
    }

    #[inline(never)]
    fn jacobian_product(&self, mode: usize, w: &[f64], dw: &mut [f64]) {
        self.jacobian(self.mode(mode), w, dw);
    }

    #[inline(never)]
    fn guards(&self, mode: usize, t: f64, u: &[f64]) -> Guards {
        self.all(mode, 0, t, u)
    }

    #[inline(never)]
    fn rates(&self, mode: usize, t: f64, u: &[f64]) -> Guards {
        self.all(mode, 1, t, u)
    }

    #[inline(never)]
    fn after_event(&self, mode: usize, guard: usize, t: f64, u: &Values) -> (usize, Values) {
        let forcing = self.forcing(t);
        let reset = &self.mode(mode).until[guard].reset;
        let mut state = *u;
        for (place, row) in state.iter_mut().zip(reset) {
            *place = value(row, u, forcing).0;
        }
        (self.successor(mode, guard, t, &state).mode, state)
    }

    fn ends(&self, mode: usize, guard: usize) -> bool {
        self.mode(mode).guards.get(guard).is_some_and(|guard| guard.ends)
    }

    fn event(&self, mode: usize, guard: usize) -> usize {
        self.mode(mode).guards[guard].event
    }

    /// A guard that ends the mode fires at once where its first derivative that is not zero is
    /// positive. One that is positive itself, but on its way back, is what is left of an error: it
    /// was found at an event of another guard, or late.
    #[inline(never)]
    fn enter(&self, after: Option<(usize, usize)>, mode: usize, t: f64, u: &Values) -> Entered {
        let forcing = self.forcing(t);
        let zeros = after.and_then(|(before, guard)| {
            let next = &self.mode(before).until[guard].next;
            next.iter().find(|successor| successor.mode == mode).map(|it| &it.zeros)
        });
        let mut entered = Entered::default();
        for (k, guard) in self.mode(mode).guards.iter().enumerate() {
            let known = zeros.map_or(0, |zeros| zeros[k]);
            let leading = guard.chain.leading(known, t, u, forcing);
            let Some(Leading { order, positive }) = leading else {
                entered.zeros |= 1 << k;
                continue;
            };
            entered.zeros |= u64::from(order > 0) << k;
            let closes = || value(&guard.chain.rows[1], u, forcing).0 > 0.0;
            if guard.ends && positive && (order > 0 || closes()) && entered.fires.is_none() {
                entered.fires = Some(k);
            }
        }
        entered
    }

    #[inline(never)]
    fn settle(&self, entered: Entered, _: &[f64], guards: &mut Guards) {
        for (k, guard) in guards.iter_mut().enumerate() {
            if entered.is_zero(k) {
                *guard = 0.0;
            }
        }
    }

    fn leaves_domain(&self) -> bool {
        self.system.is_backward()
    }
}

impl AffineEquations<'_> {
    fn jacobian(&self, mode: &CheckedMode, w: &[f64], dw: &mut [f64]) {
        for (rate, row) in dw.iter_mut().zip(mode.a.chunks_exact(w.len())) {
            *rate = row.iter().zip(w).map(|(entry, w)| entry * w).sum();
        }
    }
}
