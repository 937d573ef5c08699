//! The bracket of a root, and where to look in it next.

use super::guard_values::GuardValues;
use crate::equations::Numbers;

/// A root is narrowed down to this many roundings of its time.
const ROOT_ROUNDINGS: f64 = 4.0;
/// Roundings of time from the root within which an evaluation doubles the distance by which the
/// next one goes past it.
const NEAR_ROOT_ROUNDINGS: f64 = 64.0;
/// Three evaluations have to narrow a bracket down to this share of its width, or the next one
/// halves it.
const MAX_WIDTH_RATIO: f64 = 0.125;

/// Two looks between which a guard rises to zero.
pub(super) struct Bracket<G> {
    guard: usize,
    inside: GuardValues<G>,
    pub(super) outside: GuardValues<G>,
    looks: u32,
    /// The width three looks ago.
    width: f64,
    /// How far past the cubic's root the next look is, in roundings of time: twice as far each time
    /// that it was past the root by less than the rounding of the guard.
    past: f64,
}

impl<G: Numbers> Bracket<G> {
    pub(super) fn new(guard: usize, left: &GuardValues<G>, right: &GuardValues<G>) -> Self {
        let (inside, outside, width) = (*left, *right, f64::INFINITY);
        Self { guard, inside, outside, looks: 0, width, past: 1.0 }
    }

    /// So many roundings of time.
    fn roundings(&self, count: f64) -> f64 {
        count * f64::EPSILON * self.outside.t.abs()
    }

    /// The time of the next look; none where the guard is zero to rounding.
    pub(super) fn next(&mut self) -> Option<f64> {
        let Self { guard, inside, outside, .. } = *self;
        let (begin, end) = (inside.t, outside.t);
        let middle = begin + 0.5 * (end - begin);
        let nearest = self.roundings(ROOT_ROUNDINGS);
        let is_zero = outside.value(guard) <= nearest * outside.rate(guard);
        let is_narrow = end - begin <= nearest || middle <= begin || middle >= end;
        if outside.value(guard) == 0.0 || is_zero || is_narrow {
            return None;
        }
        self.looks += 1;
        let slow = self.looks.is_multiple_of(3) && end - begin > MAX_WIDTH_RATIO * self.width;
        if self.looks.is_multiple_of(3) {
            self.width = end - begin;
        }
        let cubic = inside.cubic_to(&outside, guard);
        // Past the root, seen from the look that is nearer to it.
        let past = self.roundings(self.past).copysign(if cubic.is_nearer_at_the_left() {
            1.0
        } else {
            -1.0
        });
        let t = cubic.root() + past;
        Some(if t > begin && t < end && !slow { t } else { middle })
    }

    pub(super) fn take(&mut self, look: GuardValues<G>) {
        let [value, rate] = [look.value(self.guard), look.rate(self.guard)].map(f64::abs);
        let close = value <= self.roundings(NEAR_ROOT_ROUNDINGS) * rate;
        let side = if look.value(self.guard) < 0.0 { &mut self.inside } else { &mut self.outside };
        *side = look;
        self.past = if close { 2.0 * self.past } else { 1.0 };
    }
}
