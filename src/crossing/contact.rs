//! The guards of a contact: the trial force rises to 1 (progression) or falls to 0 (separation).

use crate::crossing::allowances::STEP_ROUNDINGS;
use crate::crossing::certificate::Piece;
use crate::crossing::contact_parts::{ContactParts, ContactShape};
use crate::crossing::{Corridor, Guarded, Proof, SearchHint, ThresholdEnds, slack};
use crate::flow::constants::Constants;
use crate::flow::contact::{Contact, ContactOrders, orders};
use crate::flow::damped::Damping;
use crate::flow::forcing::{EntryAngle, Push};
use crate::flow::steps::Steps;
use crate::flow::{Jet, Point};
use crate::numeric::exponential::rough_decay;
use crate::numeric::series::{SHORT_REACH, Series};
use crate::state::State;
use std::borrow::Borrow;

/// The longest reach, a length times the rate at which derivatives repeat a rounding, at which
/// the slack has room for the derivatives in a piece's coefficients.
const MAX_REACH: f64 = 4.0;

/// The angle of the faster of forcing and free oscillation up to which one piece must do.
const MAX_PIECE_RADIANS: f64 = 2.0;

/// Contact's trial force split into what is forced for ever and what dies out.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// Free part and its first three derivatives.
    pub(super) free: [f64; 4],
    /// Amplitude of the forced part.
    pub(super) amplitude: f64,
}

impl<C: Borrow<Constants<f64>>> Contact<f64, C> {
    pub(super) fn split(&self, at: &Point<f64>) -> Split {
        let constants = self.constants.borrow();
        let forced = constants.steady.orders(at.force);
        let [f, f1, f2, f3] = at.guard.orders;
        let level = f + (self.reference - constants.b);
        let free = [level - forced[0], f1 - forced[1], f2 - forced[2], f3 - forced[3]];
        Split { free, amplitude: constants.steady.amplitude }
    }

    /// A bound of the eighth derivative of the free part from `at` on: x^2 + x'^2 never grows, of
    /// no derivative.
    pub(super) fn free_eighth(&self, at: &Point<f64>, split: &Split) -> f64 {
        /// The roundings of the recurrence, one in each of its eight steps, and of the sums here.
        const RECURRENCE_ROUNDINGS: f64 = 16.0;
        /// The squares of two numbers whose sum is smaller may underflow.
        const MIN_SQUARABLE_SUM: f64 = 1e-140;
        let [[a, b], [c, d]] = self.constants.borrow().free_eighth;
        let [x, rate, ..] = split.free;
        let [ax, br, cx, dr] = [a * x, b * rate, c * x, d * rate];
        let (eighth, ninth) = (ax + br, cx + dr);
        let terms = (ax.abs() + br.abs()) + (cx.abs() + dr.abs());
        let room = RECURRENCE_ROUNDINGS * f64::EPSILON * terms;
        // The norm of two numbers without squares is at most their sum.
        let norm = if terms > MIN_SQUARABLE_SUM {
            (eighth * eighth + ninth * ninth).sqrt()
        } else {
            eighth.abs() + ninth.abs()
        };
        let by_energy = norm + room;
        if let Damping::Over { fast, slow, .. } = self.constants.borrow().damping {
            // Eight derivatives of a stiff oscillation are rounding once its fast part has died
            // out.
            let fast_part = self.fast_amplitude(split) * rough_decay(fast * at.elapsed);
            let lasting = split.free[0].abs() + fast_part;
            return by_energy.min(fast_part * fast.powi(8) + lasting * slow.powi(8));
        }
        by_energy
    }

    /// What the coefficients of a long piece may round more than the guard itself, because
    /// derivatives stand in them times powers of the length, and each derivative repeats the
    /// rounding of the one below it times a rate: 2 xi or 1 where it is computed from the equation
    /// of motion, the slower decay or omega where the parts are differentiated one by one.
    #[inline(always)]
    pub(super) fn room_of_length(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let Constants { omega, two_xi, .. } = *self.constants.borrow();
        // Most pieces are short at any of the rates.
        let length = right.elapsed - left.elapsed;
        if length <= MAX_REACH && length * two_xi <= MAX_REACH && length * omega <= MAX_REACH {
            return 0.0;
        }
        self.room_of_a_long_piece(left, right)
    }

    #[cold]
    #[inline(never)]
    fn room_of_a_long_piece(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let Constants { omega, two_xi, damping, .. } = *self.constants.borrow();
        let rate = match damping {
            Damping::Over { fast, slow, .. } if fast * left.elapsed > 1.0 => slow.max(omega),
            _ => two_xi.max(1.0),
        };
        let reach = (right.elapsed - left.elapsed) * rate;
        if reach <= MAX_REACH {
            return 0.0;
        }
        // The derivatives' weights in the fourth coefficient of degree eight, the largest there
        // are.
        let weights = reach * (3.0 / 8.0 + reach * (3.0 / 56.0 + reach * (1.0 / 336.0)));
        f64::EPSILON * weights * left.guard.largest_term.max(right.guard.largest_term)
    }

    /// The verdict, in which a touch counts only where the rounding room of the piece is narrow: a
    /// piece with a wide room is divided first, unless the guard is within rounding of its
    /// threshold at both ends, where shorter pieces touch as well.
    #[inline(always)]
    fn trusted_verdict(&self, verdict: Proof, room: f64, ends: [&Point<f64>; 2]) -> Proof {
        if verdict != Proof::Touches || room == 0.0 {
            return verdict;
        }
        let corridor = self.corridor();
        let on_it = |at: &Point<f64>| corridor.excess(at.guard.orders[0]) >= -slack(self, at, at);
        if ends.into_iter().all(on_it) { verdict } else { Proof::Open }
    }

    /// A bound of the size of the trial force's eighth derivative, from that of its free part.
    #[inline(always)]
    pub(super) fn eighth(&self, free: f64) -> f64 {
        free + self.constants.borrow().forced_eighth
    }

    /// A bound of the fast exponential's size at entry, over-damped: |x' + slow x|/spread, where
    /// |x| <= |f| + |b| + A and |x'| <= 2 xi (a + |b| + |f|) + |y| + omega A with A the forced
    /// amplitude, 2 xi/spread < 2 and slow < 1 < spread (from xi^2 - 1 > 1/2).
    fn fast_amplitude(&self, split: &Split) -> f64 {
        let constants = self.constants.borrow();
        let force = constants.a + constants.b.abs() + self.offset.abs() + self.reference;
        4.0 * force + self.entry.y.abs() + (1.0 + constants.omega) * split.amplitude
    }

    /// The threshold that is nearer to the static force.
    pub(crate) fn nearest_threshold(&self) -> f64 {
        if self.constants.borrow().b < 0.5 { 0.0 } else { 1.0 }
    }

    /// Whether what is left of the contact decides how it ends: its steady state lies around a
    /// threshold within much less than what dies out before.
    fn dies_out_next_to_a_threshold(&self) -> bool {
        /// A steady state of more than this has nine digits left when the rest has died out.
        const MIN_STEADY_SHARE: f64 = 1e-6;
        let Constants { b, two_xi, steady, .. } = *self.constants.borrow();
        let free = (self.offset + (self.reference - b)).abs() + (two_xi + 1.0) * self.entry.y.abs();
        (b - self.nearest_threshold()).abs() + steady.amplitude < MIN_STEADY_SHARE * free
    }

    /// The parts of the trial force, from their split.
    pub(super) fn parts(&self, at: &Point<f64>, split: &Split) -> ContactParts<f64> {
        let [free, free_rate, ..] = split.free;
        let [f, f1, ..] = at.guard.orders;
        let level = self.constants.borrow().b - self.reference;
        ContactParts {
            elapsed: at.elapsed,
            free,
            free_rate,
            forced: (f - level) - free,
            quarter: (f1 - free_rate) / self.constants.borrow().omega,
        }
    }

    /// What all places of the contact have in common.
    pub(super) fn shape(&self, eighth: f64, slack: f64) -> ContactShape {
        let Constants { b, two_xi, omega, .. } = *self.constants.borrow();
        ContactShape {
            level: b - self.reference,
            two_xi,
            omega,
            corridor: self.corridor(),
            eighth,
            slack,
        }
    }
}

impl<C: Borrow<Constants<f64>>> Guarded for Contact<f64, C> {
    fn corridor(&self) -> Corridor {
        Corridor { low: -self.reference, high: 1.0 - self.reference }
    }

    fn entry(&self) -> Point<f64> {
        let Constants { a, b, two_xi, omega, omega2, .. } = *self.constants.borrow();
        let EntryAngle { sin, cos, .. } = self.angle;
        let [u, v, w] = [a * cos, -(a * omega * sin), -(a * omega2 * cos)];
        let y = self.entry.y;
        let orders = orders(two_xi, b - self.reference, &[u, v, w], (self.offset, y));
        Point {
            elapsed: 0.0,
            state: self.entry,
            slider_velocity: y,
            drift: 0.0,
            force: [u, v, w],
            guard: Jet { orders, largest_term: self.offset.abs() },
        }
    }

    fn imposed(&self) -> ThresholdEnds {
        ThresholdEnds { left: self.offset == 0.0, left_double: false, right: false }
    }

    #[inline(always)]
    fn hint(&self, steps: &Steps, left: &Point<f64>, limit: f64) -> SearchHint {
        self.hint_ahead(steps, left, limit)
    }

    fn touches_for_ever(&self) -> bool {
        self.rests_by_rounding()
    }

    fn certify(
        &self,
        steps: &Steps,
        left: &Point<f64>,
        right: &Point<f64>,
        ends: ThresholdEnds,
    ) -> Proof {
        let corridor = self.corridor();
        let room = self.room_of_length(left, right);
        let slack = slack(self, left, right) + room;
        let length = right.elapsed - left.elapsed;
        let split = self.split(left);
        let free = self.free_eighth(left, &split);
        let eighth = self.eighth(free);
        let whole = Piece::between(left, right, (-eighth, eighth));
        let verdict =
            self.trusted_verdict(whole.verdict(&corridor, ends, slack), room, [left, right]);
        if verdict != Proof::Open {
            return verdict;
        }
        if length * self.constants.borrow().omega.max(1.0) < MAX_PIECE_RADIANS {
            let inside = whole.stays_inside_in_parts(&corridor, ends, slack);
            return if inside { Proof::Inside } else { verdict };
        }
        self.certify_long(steps, (left, &split, free), right, (ends, room))
    }

    fn stage(&self) -> f64 {
        /// The length of a stage in decay times, over which the trial force loses three to four of
        /// its sixteen digits.
        const STAGE_DECAY_TIMES: f64 = 8.0;
        if self.dies_out_next_to_a_threshold() {
            STAGE_DECAY_TIMES / self.constants.borrow().decays().0
        } else {
            f64::INFINITY
        }
    }

    fn underflow(&self) -> f64 {
        self.constants.borrow().underflow
    }

    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        let piece = Piece::between(left, right, (0.0, 0.0));
        if piece.length * self.fastest_rate() > 4.0 {
            return left.elapsed + 0.5 * piece.length;
        }
        piece.worst_place(left.elapsed, &self.corridor())
    }

    fn short_reach(&self) -> f64 {
        match self.constants.borrow().damping {
            Damping::Over { .. } => 0.0,
            _ => SHORT_REACH,
        }
    }

    fn series<const N: usize>(&self, at: &Point<f64>) -> Series<f64, N> {
        let Constants { two_xi, omega2, .. } = *self.constants.borrow();
        let force = [at.force[0], at.force[1]];
        let mut higher = ContactOrders::new([omega2, two_xi], force, at.guard.orders);
        Series::new(&at.guard.orders, || higher.step())
    }

    #[inline(always)]
    fn continued<const N: usize>(
        &self,
        at: &Point<f64>,
        step: f64,
        series: &Series<f64, N>,
        (value, slope): (f64, f64),
    ) -> Point<f64> {
        let Constants { b, g, omega, two_xi, damping, .. } = *self.constants.borrow();
        let Push { force, impulse } = Push::new(omega, [at.force[0], at.force[1]], step);
        let y =
            at.state.y + ((b * step + impulse) - (self.reference * step + series.integral(step)));
        let (bend, third) = if matches!(damping, Damping::Over { .. }) {
            series.bend_and_third(step)
        } else {
            // f' = 2 xi (F - f) + y
            let pull = (force[0] + (b - self.reference)) - value;
            let pull_rate = force[1] - slope;
            let bend = two_xi * pull_rate + pull;
            (bend, two_xi * (force[2] - bend) + pull_rate)
        };
        let orders = [value, slope, bend, third];
        let q = (self.reference + value) - two_xi * y;
        Point {
            elapsed: at.elapsed + step,
            state: State { p: q + g, y, q },
            slider_velocity: y,
            drift: 0.0,
            force,
            guard: Jet { orders, ..at.guard },
        }
    }

    fn fastest_rate(&self) -> f64 {
        1.0_f64.max(self.constants.borrow().omega).max(self.constants.borrow().two_xi)
    }
}

impl<C: Borrow<Constants<f64>>> Contact<f64, C> {
    /// Certifies a long piece step by step; or, where the forcing is fast, by the free part alone,
    /// in a corridor narrowed by the forced amplitude.
    fn certify_long(
        &self,
        steps: &Steps,
        (left, split, free): (&Point<f64>, &Split, f64),
        right: &Point<f64>,
        (ends, room): (ThresholdEnds, f64),
    ) -> Proof {
        /// Under stronger damping the free part's derivatives would multiply its rounding.
        const MAX_DAMPING: f64 = 4.0;
        let Constants { b, two_xi, omega, .. } = *self.constants.borrow();
        let slack = slack(self, left, right);
        let [x, x1, x2, x3] = split.free;
        let length = right.elapsed - left.elapsed;
        if two_xi < MAX_DAMPING {
            let size = split.amplitude + x.abs() + x1.abs();
            let stepped = slack + STEP_ROUNDINGS * f64::EPSILON * (size + b.abs());
            let shape = self.shape(self.eighth(free), stepped);
            let right = (right.elapsed, &right.guard.orders);
            let step = &steps.contact_piece;
            let parts = self.parts(left, split);
            if parts.stays_inside(&left.guard.orders, right, ends, &shape, step) {
                return Proof::Inside;
            }
        }
        if length * omega < 2.0 {
            return Proof::Open;
        }
        let level = b - self.reference;
        let [z, z1, z2, z3] = self.split(right).free;
        let unforced = Piece {
            left: [x + level, x1, x2, x3],
            right: [z + level, z1, z2, z3],
            length,
            eighth: (-free, free),
        };
        let corridor = self.corridor().narrowed(split.amplitude);
        self.trusted_verdict(
            unforced.verdict(&corridor, ThresholdEnds::FREE, slack + room),
            room,
            [left, right],
        )
    }
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
