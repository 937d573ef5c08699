//! ode_solvers, whose methods locate no events: what its engines have in common.
//!
//! - Each runs at most one forcing period of one mode at a time; `solout` stops it at the end of a
//!   step that leaves the mode, and the harness locates the event ([`GuardSearch`]).
//! - Steps are at most an eighth of a forcing period, so that no step hides a whole mode.
//! - States are vectors of the system's own size. The compiler knows it where there are two or four
//!   states, as in most systems; all others are the library's dynamic vectors.
//! - Stiffness detection (`n_stiff`) is switched off: it gives up on light damping, where the
//!   integration is dear but right.
//! - Times are elapsed since the start: the library's dense output fails for negative ones.
//!
//! [`GuardSearch`]: crate::integration::GuardSearch

mod dop853;
pub(super) mod dopri5;
mod rk4;

use crate::engine::{Colours, Role};
use crate::equations::{Equations, Numbers};
use crate::integration::{Meter, OriginalOscillator, Oscillator};
use ::ode_solvers::{OVector, System};
use nalgebra::allocator::Allocator;
use nalgebra::{Const, DefaultAllocator, Dim};

pub(super) use dop853::Dop853;
pub(super) use dopri5::Dopri5;
pub(super) use rk4::Rk4;

pub(super) static DOPRI5: Dopri5<Oscillator> =
    Dopri5::new("ode_solvers-dopri5", Role::Representative);
pub(super) static DOPRI5_ORIGINAL: Dopri5<OriginalOscillator> =
    Dopri5::new("ode_solvers-dopri5-original", Role::Rows);
pub(super) static DOP853: Dop853 =
    Dop853 { name: "ode_solvers-dop853", role: Role::Rows, clock: false };
pub(super) static DOP853_TIME: Dop853 =
    Dop853 { name: "ode_solvers-dop853-time", role: Role::Damping, clock: true };

const LIBRARY: &str = "ode_solvers";
/// Red to orange.
const COLOURS: Colours = Colours::Hues(8.0, 42.0);
/// The value of the library's limit of steps, which it never reaches: the meter's is the one that
/// counts.
const MAX_LIBRARY_STEPS: u32 = u32::MAX - 1;
/// The value that turns the library's stiffness detection off.
const NO_STIFFNESS_TEST: u32 = u32::MAX;

/// Calls a function of an integration's vectors with those of so many states. The library allocates
/// each dynamic vector anew: a step of `Dop853` takes ten times as long on them.
macro_rules! on_vectors_of {
    ($states:expr, $run:ident($($argument:expr),*)) => {
        match $states {
            2 => $run::<_, nalgebra::U2>($($argument),*),
            4 => $run::<_, nalgebra::U4>($($argument),*),
            _ => $run::<_, nalgebra::Dyn>($($argument),*),
        }
    };
}
pub(in crate::integrators) use on_vectors_of;

/// The right-hand side of one mode, and the end of it. One more component of the state than the
/// system has is time.
#[derive(Clone, Copy)]
struct TimedField<'a, E: Equations> {
    equations: E,
    mode: usize,
    meter: &'a Meter,
    /// The state at the mode's beginning: on the surface, and no way out of the mode.
    from: E::State,
    /// A time at which another mode's derivative is taken: the fault of a restart that keeps the
    /// old one. No engine that is scored has it.
    stale: Option<(f64, usize)>,
}

impl<E: Equations, D: Dim> System<f64, OVector<f64, D>> for TimedField<'_, E>
where
    DefaultAllocator: Allocator<D>,
{
    fn system(&self, t: f64, u: &OVector<f64, D>, du: &mut OVector<f64, D>) {
        let (u, rates) = (u.as_slice(), du.as_mut_slice());
        let size = self.equations.dimension();
        let t = u.get(size).copied().unwrap_or(t);
        let mode = self.stale.filter(|stale| stale.0 == t).map_or(self.mode, |stale| stale.1);
        self.equations.derivatives(mode, t, &u[..size], &mut rates[..size]);
        if let Some(rate) = rates.get_mut(size) {
            *rate = 1.0;
        }
        self.meter.rhs(rates);
    }

    fn solout(&mut self, t: f64, u: &OVector<f64, D>, _: &OVector<f64, D>) -> bool {
        let u = &u.as_slice()[..self.equations.dimension()];
        let guards = self.equations.guards(self.mode, t, u);
        let ends =
            |(guard, value): (usize, &f64)| *value >= 0.0 && self.equations.ends(self.mode, guard);
        u != self.from.as_ref() && guards.as_ref().iter().enumerate().any(ends)
    }
}

/// A state in the library's vectors, with its time where that is carried along.
fn packed<D: Dim>(t: f64, state: &[f64], clock: bool) -> OVector<f64, D>
where
    DefaultAllocator: Allocator<D>,
{
    let values = state.iter().copied().chain(clock.then_some(t));
    let size = D::from_usize(state.len() + usize::from(clock));
    OVector::from_iterator_generic(size, Const::<1>, values)
}

/// The states of a system in one of the library's vectors.
fn plain<E: Equations, D: Dim>(equations: &E, u: &OVector<f64, D>) -> E::State
where
    DefaultAllocator: Allocator<D>,
{
    E::State::from_slice(&u.as_slice()[..equations.dimension()])
}
