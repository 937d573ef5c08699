//! Where a contact may end, guessed, or proved to go on.

use crate::crossing::allowances::GUESS_STEPS;
use crate::crossing::contact::Split;
use crate::crossing::{Guarded, SearchHint};
use crate::flow::Point;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::damped::Damping;
use crate::flow::steps::Steps;
use crate::numeric::roots::first_root;
use std::borrow::Borrow;

impl<C: Borrow<Constants<f64>>> Contact<f64, C> {
    /// A guess, or a proof, about what comes after `left`.
    #[inline(always)]
    pub(super) fn hint_ahead(&self, steps: &Steps, left: &Point<f64>, limit: f64) -> SearchHint {
        if let Some(time) = self.early_exit(left) {
            return SearchHint::Root(time);
        }
        let split = self.split(left);
        let onward = match self.exit(steps, left, &split) {
            Ok(time) => return SearchHint::Root(time),
            Err(time) => SearchHint::Onward(time.min(limit)),
        };
        if self.rests(&split) || self.rests_on_one_side(left, &split) {
            return SearchHint::ClearFrom(left.elapsed);
        }
        match self.calm_time(left, &split) {
            calm if calm > 8.0 => SearchHint::ClearUntil(left.elapsed + calm),
            _ => onward,
        }
    }

    /// Whether f can never again leave [0, 1] by more than rounding: amplitude and energy norm of
    /// the free part fit inside. At rest on a threshold, with no force, they fit exactly.
    fn rests(&self, split: &Split) -> bool {
        let reach = split.amplitude + split.free[0].hypot(split.free[1]);
        self.fits(reach, reach)
    }

    /// Whether the steady state, which the trial force approaches, fits inside by rounding alone.
    pub(super) fn rests_by_rounding(&self) -> bool {
        /// The amplitude is good to a few eps, and [`Self::fits`] allows four of them.
        const AMPLITUDE_FACTOR: f64 = 1.0 + 16.0 * f64::EPSILON;
        let Constants { b, steady, .. } = *self.constants.borrow();
        let reach = AMPLITUDE_FACTOR * steady.amplitude;
        reach > 1.0 - b || reach > b
    }

    /// Whether f = b + `up` and f = b - `down` lie in [0, 1], but for the rounding of these two. A
    /// steady state beyond a threshold by its last digit is beyond it, so b itself gets no room:
    /// 1 - b is exact for b of at least 1/2, and else half a unit of what fits into it.
    fn fits(&self, up: f64, down: f64) -> bool {
        /// The factor that allows for the rounding of the two forces.
        const ROUNDING_FACTOR: f64 = 1.0 - 4.0 * f64::EPSILON;
        let b = self.constants.borrow().b;
        ROUNDING_FACTOR * up <= 1.0 - b && ROUNDING_FACTOR * down <= b
    }

    /// Looks from critical damping on, where what dies out keeps its sign: for x = f - b less
    /// the forced part, u = x' + fast x obeys u' = -slow u; where x and u are positive they stay
    /// so, because x' < 0 would need x > 0. Then the trial force stays on one side of its steady
    /// state.
    pub(super) fn rests_on_one_side(&self, left: &Point<f64>, split: &Split) -> bool {
        /// The rounding of a sum from which on its sign is believed, beside its terms.
        const ROUNDING_TOLERANCE: f64 = 16.0 * f64::EPSILON;
        let Constants { a, b, xi, two_xi, omega, .. } = *self.constants.borrow();
        if xi < 1.0 {
            return false;
        }
        let (_, fast) = self.constants.borrow().decays();
        let [x, rate, ..] = split.free;
        let guard = left.guard;
        let level = (b - self.reference).abs();
        let terms = guard.largest_term + guard.orders[0].abs() + level + a + split.amplitude;
        let rates = two_xi * terms + left.state.y.abs() + omega * split.amplitude;
        let (sure, sure_rate) = (ROUNDING_TOLERANCE * terms, ROUNDING_TOLERANCE * rates);
        let above = x > sure && fast * x + rate > sure_rate;
        let below = x < -sure && fast * x + rate < -sure_rate;
        if !(above || below) {
            return false;
        }
        // On its way back it does not turn again.
        let far = if x * rate <= 0.0 { x.abs() } else { x.hypot(rate) };
        let (up, down) = if above { (far, 0.0) } else { (0.0, far) };
        self.fits(split.amplitude + up, split.amplitude + down)
    }

    /// A time for which f certainly stays inside, by one of two slow changes.
    ///
    /// With x = f - b the equation x'' + 2 xi x' + x = a cos(..) - 2 xi a omega sin(..) lets the
    /// energy norm of (x, x') grow no faster than the amplitude of its right-hand side: that
    /// carries over many oscillations where the forcing is weak, resonant or not. And the steady
    /// part moves no faster than its amplitude times omega, around which the free part keeps
    /// within its own energy norm: that carries where the forcing is slow.
    fn calm_time(&self, left: &Point<f64>, split: &Split) -> f64 {
        /// The least distance of the trial force from its thresholds, far above rounding.
        const FORCE_TOLERANCE: f64 = 1e-12;
        let Constants { a, b, two_xi, omega, .. } = *self.constants.borrow();
        let f = left.guard.orders[0] + self.reference;
        let push = a * 1.0_f64.hypot(two_xi * omega);
        let weak = (b.min(1.0 - b) - (f - b).hypot(left.guard.orders[1]) - FORCE_TOLERANCE) / push;
        let free = split.free[0].hypot(split.free[1]);
        let steady = f - split.free[0];
        let slow = (steady.min(1.0 - steady) - free - FORCE_TOLERANCE) / (split.amplitude * omega);
        weak.max(slow)
    }

    /// The first place where a cubic from `left` leaves the corridor, if that is soon.
    #[inline(always)]
    fn early_exit(&self, left: &Point<f64>) -> Option<f64> {
        /// The longest time for which a cubic is followed, in the shortest time of the contact.
        const CUBIC_REACH: f64 = 0.4;
        let [f, f1, f2, f3] = left.guard.orders;
        let horizon = CUBIC_REACH / self.fastest_rate();
        let cubic = |d: f64| f + d * (f1 + d * (0.5 * f2 + d * (f3 * (1.0 / 6.0))));
        let corridor = self.corridor();
        let beyond = |d: &f64| corridor.excess(cubic(*d)) >= 0.0;
        let outside = [0.5 * horizon, horizon].into_iter().find(beyond)?;
        let high = cubic(outside) >= corridor.high;
        let (threshold, outward) = if high { (corridor.high, 1.0) } else { (corridor.low, -1.0) };
        let time = if f == threshold {
            // The cubic without its zero at the start.
            first_root(outward * f1, outward * 0.5 * f2, outward * f3 / 3.0)?
        } else {
            let mut d = outside;
            for _ in 0..4 {
                d -= (cubic(d) - threshold) / (f1 + d * (f2 + d * (0.5 * f3)));
            }
            d
        };
        // Newton may have left the interval.
        let time = if time > 0.0 && time < outside { time } else { outside };
        Some(left.elapsed + time)
    }

    /// A guess of the first exit, or where the look-out for it has ended: in steps as the free
    /// oscillation moves, about which a fast forcing only ripples; in shorter and then longer ones
    /// under strong damping, as its fast part lives and dies.
    #[inline(always)]
    fn exit(&self, steps: &Steps, left: &Point<f64>, split: &Split) -> Result<f64, f64> {
        /// The number of short steps while the fast part lives.
        const QUICK_STEPS: usize = 16;
        // exp(-40) is below the rounding of what it is added to.
        const NEGLIGIBLE_DECAY_TIMES: f64 = 40.0;
        let shape = self.shape(0.0, 0.0);
        let mut parts = self.parts(left, split);
        let mut guess_step = &steps.contact_guess_step;
        if let Damping::Over { fast, .. } = self.constants.borrow().damping {
            if fast * left.elapsed > NEGLIGIBLE_DECAY_TIMES {
                guess_step = &steps.slow_guess_step;
            } else {
                match parts.first_exit(&shape, &steps.quick_guess_step, QUICK_STEPS) {
                    Ok(time) => return Ok(time),
                    Err(further) => parts = further,
                }
            }
        }
        parts.first_exit(&shape, guess_step, GUESS_STEPS).map_err(|further| further.elapsed)
    }
}
