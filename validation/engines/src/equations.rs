//! The interface through which an integrator sees a system: the equations of each mode, the guards
//! at which modes end, and the mode and state after an event.
//!
//! The types of states and guards belong to the system, so that a system whose dimension is
//! known beforehand is integrated on arrays of that size, and one whose dimension is read from a
//! file on numbers that know how many they are. Integrators see the system's own dimension in both.

use std::fmt::Debug;

/// Numbers side by side: the states of a system, or a mode's guards.
pub trait Numbers: Copy + Debug + Default + PartialEq + AsRef<[f64]> + AsMut<[f64]> {
    /// Holds a copy of these numbers.
    fn from_slice(values: &[f64]) -> Self;

    /// Repeats a value `count` times; an array ignores `count`, because its length is fixed.
    fn all(count: usize, value: f64) -> Self;
}

impl<const N: usize> Numbers for [f64; N]
where
    [f64; N]: Default,
{
    fn from_slice(values: &[f64]) -> Self {
        std::array::from_fn(|i| values[i])
    }

    fn all(_: usize, value: f64) -> Self {
        [value; N]
    }
}

/// The value in place of a guard that a mode does not have.
pub(crate) const NO_GUARD: f64 = -1.0;

/// Guards of a mode that are known to be zero, or to end the mode, at its entry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Entered {
    /// The guards that are zero at the entry, one bit per guard.
    pub zeros: u64,
    /// The guard that ends the mode at its entry.
    pub fires: Option<usize>,
}

impl Entered {
    /// Whether a guard is zero at the entry.
    #[must_use]
    pub fn is_zero(self, guard: usize) -> bool {
        self.zeros >> guard & 1 == 1
    }
}

/// The equations of motion of a system with modes, in the time elapsed since the start.
///
/// A mode is its place among the modes of the system. Guards are negative inside a mode and rise to
/// zero at an event.
pub trait Equations: Copy {
    /// The states, as many as the system has.
    type State: Numbers;
    /// The values of the guards of one mode.
    type Guards: Numbers;

    /// The number of states.
    fn dimension(&self) -> usize;

    /// How many guards the mode with the most of them has; as many are asked of a library that
    /// wants their number beforehand.
    fn most_guards(&self) -> usize;

    /// The number of guards of a mode.
    fn count(&self, mode: usize) -> usize;

    /// The right-hand side.
    fn derivatives(&self, mode: usize, t: f64, u: &[f64], du: &mut [f64]);

    /// The derivatives' derivative along `w`.
    fn jacobian_product(&self, mode: usize, w: &[f64], dw: &mut [f64]);

    /// The mode's guards.
    fn guards(&self, mode: usize, t: f64, u: &[f64]) -> Self::Guards;

    /// The guards' rates by the equations of motion.
    fn rates(&self, mode: usize, t: f64, u: &[f64]) -> Self::Guards;

    /// The mode and the state after the event at which a guard has risen to zero.
    fn after_event(
        &self,
        mode: usize,
        guard: usize,
        t: f64,
        u: &Self::State,
    ) -> (usize, Self::State);

    /// Whether a guard ends its mode; crossings of one that does not are counted only.
    fn ends(&self, _mode: usize, _guard: usize) -> bool {
        true
    }

    /// The event of its mode that a guard belongs to.
    fn event(&self, _mode: usize, guard: usize) -> usize {
        guard
    }

    /// The guards that are known at the entry of a mode, after an event of another mode or at the
    /// start.
    fn enter(
        &self,
        _after: Option<(usize, usize)>,
        _mode: usize,
        _t: f64,
        _u: &Self::State,
    ) -> Entered {
        Entered::default()
    }

    /// Sets guards to zero that are zero at their mode's entry but for rounding.
    fn settle(&self, entered: Entered, u: &[f64], guards: &mut Self::Guards);

    /// Whether the end of a mode is the end of the run, as it is back in time.
    fn leaves_domain(&self) -> bool {
        false
    }

    /// A state in the co-ordinates that are compared with the truth.
    fn reported(&self, u: &Self::State) -> Self::State {
        *u
    }
}
