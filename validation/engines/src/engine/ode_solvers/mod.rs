//! ode_solvers, whose methods locate no events: what its engines have in common.
//!
//! - Each runs at most one forcing period of one phase at a time; `solout` stops it at the end of a
//!   step that leaves the phase, and the harness locates the switch ([`GuardSearch`]).
//! - Steps are at most an eighth of a forcing period, so that no step hides a whole phase.
//! - Stiffness detection (`n_stiff`) is switched off: it gives up on light damping, where the
//!   integration is dear but right.
//! - Times are elapsed since the start: the library's dense output fails for negative ones.
//!
//! [`GuardSearch`]: super::location::GuardSearch

mod dop853;
pub(super) mod dopri5;
mod rk4;

use super::field::{Equations, Oscillator};
use super::meter::Meter;
use super::original::OriginalOscillator;
use super::{Colours, Role};
use ::ode_solvers::{SVector, System};
use percuss::Phase;

pub(super) use dop853::Dop853;
pub(super) use dopri5::Dopri5;
pub(super) use rk4::Rk4;

pub(super) static DOPRI5: Dopri5<Oscillator> =
    Dopri5::new("ode_solvers-dopri5", Role::Representative);
pub(super) static DOPRI5_ORIGINAL: Dopri5<OriginalOscillator> =
    Dopri5::new("ode_solvers-dopri5-original", Role::Rows);
pub(super) static DOP853: Dop853<4> = Dop853 { name: "ode_solvers-dop853", role: Role::Rows };
pub(super) static DOP853_TIME: Dop853<5> =
    Dop853 { name: "ode_solvers-dop853-time", role: Role::Damping };

const LIBRARY: &str = "ode_solvers";
/// Red to orange.
const COLOURS: Colours = Colours::Hues(8.0, 42.0);
/// The longest step, in forcing periods.
const LONGEST_STEP: f64 = 0.125;
/// Instead of the library's limit of steps: the meter's is the one that counts.
const STEPS: u32 = u32::MAX - 1;
/// Switches its stiffness detection off.
const NEVER_STIFF: u32 = u32::MAX;

/// The right-hand side of one phase, and the end of it. A fifth component of the state is time.
#[derive(Clone, Copy)]
struct TimedField<'a, E> {
    equations: E,
    phase: Phase,
    meter: &'a Meter,
    /// The state at the phase's beginning: on the surface, and no way out of the phase.
    from: [f64; 4],
    /// A time at which another phase's derivative is taken: the fault of a restart that keeps the
    /// old one. No engine that is scored has it.
    stale: Option<(f64, Phase)>,
}

impl<E: Equations, const N: usize> System<f64, SVector<f64, N>> for TimedField<'_, E> {
    fn system(&self, t: f64, u: &SVector<f64, N>, du: &mut SVector<f64, N>) {
        let clock = u.as_slice().get(4);
        let t = clock.copied().unwrap_or(t);
        let phase = self.stale.filter(|stale| stale.0 == t).map_or(self.phase, |stale| stale.1);
        self.equations.derivatives(phase, t, u.as_slice(), du.as_mut_slice());
        if let Some(rate) = du.as_mut_slice().get_mut(4) {
            *rate = 1.0;
        }
        self.meter.rhs(du.as_slice());
    }

    fn solout(&mut self, _: f64, u: &SVector<f64, N>, _: &SVector<f64, N>) -> bool {
        let guards = self.equations.guards(self.phase, u.as_slice());
        plain(u) != self.from && guards.iter().any(|guard| *guard >= 0.0)
    }
}

/// A state, with its time where that is carried along.
fn packed<const N: usize>(t: f64, state: &[f64; 4]) -> SVector<f64, N> {
    SVector::from_fn(|i, _| state.get(i).copied().unwrap_or(t))
}

fn plain<const N: usize>(u: &SVector<f64, N>) -> [f64; 4] {
    [u[0], u[1], u[2], u[3]]
}
