//! Contact without progression, Eqs. (15) to (17), for every damping ratio and through resonance.
//!
//! The state at entry and the fundamental solutions C and S ([`crate::flow::damped`]) stand for the
//! paper's C1, C2, beta and delta; the complex response ([`crate::flow::forcing`]) stands for its
//! alpha and gamma.

use crate::flow::constants::Constants;
use crate::flow::damped::{Damping, Free};
use crate::flow::forcing::EntryAngle;
use crate::flow::forcing::Response;
use crate::flow::{Flow, Jet, Point};
use crate::numeric::complex::Complex;
use crate::numeric::number::Number;
use crate::numeric::real::Real;
use crate::state::State;
use std::borrow::Borrow;

/// One contact. Its guard is the trial force f = 2 xi y + q, which stays between 0 and 1; it is
/// carried as f less `reference`, so that a switch at either threshold begins with an exact zero.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T, C = Constants<T>> {
    /// The model's constants: its own, or borrowed while a switch is looked for.
    pub constants: C,
    /// State when the contact begins; p = q + g.
    pub entry: State<T>,
    /// Forcing angle when the contact begins.
    pub angle: EntryAngle<T>,
    /// f - `reference` when the contact begins: 0 exactly after a progression.
    pub offset: T,
    /// The threshold, 0 or 1, from which the guard counts.
    pub reference: T,
}

impl<T: Number, C: Borrow<Constants<T>>> Flow<T> for Contact<T, C> {
    #[inline(always)]
    fn at(&self, d: T) -> Point<T> {
        let Constants { a, b, g, two_xi, damping, forced, .. } = *self.constants.borrow();
        let State { y: y0, q: q0, .. } = self.entry;
        let harmonic = self.angle.harmonic(&self.constants.borrow().drive(), d);
        let free = damping.at(d);
        let response = forced.at(d, &harmonic.turn, &free);

        let begin = Pressing {
            parameters: [a, b, two_xi],
            angle: self.angle,
            state: [y0, q0],
            offset: self.offset,
            reference: self.reference,
        };
        let Pressed { excess, y, q, largest_term } =
            begin.after(d, &harmonic.force, &free, &response);
        let orders = self.orders(d, &harmonic.force, &free, excess, y);
        Point {
            elapsed: d,
            state: State { p: q + g, y, q },
            slider_velocity: y,
            drift: T::zero(),
            force: harmonic.force,
            guard: Jet { orders, largest_term },
        }
    }
}

/// The guard, counted from a threshold, and its first three derivatives, from its value and the
/// velocity of the mass: y' = F - f and f' = 2 xi (F - f) + y, differentiated twice more.
///
/// F and f may both be near the threshold, so that is taken off first: `level` is b less the
/// threshold, `force` F - b, F', F''.
#[inline(always)]
pub fn orders<T: Real>(two_xi: T, level: T, force: &[T; 3], (excess, y): (T, T)) -> [T; 4] {
    let pull = (force[0] + level) - excess;
    let rate = two_xi.times_plus(pull, y);
    let pull_rate = force[1] - rate;
    let rate2 = two_xi.times_plus(pull_rate, pull);
    let pull_rate2 = force[2] - rate2;
    [excess, rate, rate2, two_xi.times_plus(pull_rate2, pull_rate)]
}

/// A contact as it begins.
pub struct Pressing<T> {
    /// a, b and 2 xi.
    pub parameters: [T; 3],
    /// Forcing angle.
    pub angle: EntryAngle<T>,
    /// Velocity of the mass, and displacement of the slider's top.
    pub state: [T; 2],
    /// The guard.
    pub offset: T,
    /// The threshold from which the guard counts.
    pub reference: T,
}

/// A contact some time later.
pub struct Pressed<T> {
    /// The guard.
    pub excess: T,
    /// Velocity of the mass.
    pub y: T,
    /// Displacement of the slider's top.
    pub q: T,
    /// The largest term that went into the guard.
    pub largest_term: T,
}

impl<T: Real> Pressing<T> {
    /// The contact after a time `d`, from the harmonic force, the free oscillation and the response
    /// to the forcing then.
    #[inline(always)]
    pub fn after(
        &self,
        d: T,
        force: &[T; 3],
        free: &Free<T>,
        response: &Response<T>,
    ) -> Pressed<T> {
        let Self { parameters: [a, b, two_xi], state: [y0, q0], offset, reference, .. } = *self;
        let (driven, y_driven) =
            (self.driven_part(response.force), self.driven_part(response.rate));
        let q_driven = self.driven_part(response.displacement);
        let f_less_b = offset + (reference - b);
        let relaxing = f_less_b * free.s_rate_minus_1;
        let f_change = y0.times_plus(free.s, relaxing) + driven;
        let y_change = f_less_b.times_from(free.s, y0 * free.c_minus_1) + y_driven;
        let q_change = (q0 - b).times_plus(free.c_minus_1, y0 * free.s) + q_driven;
        let driven_bound = a * (response.force.re.magnitude() + response.force.im.magnitude());
        // The slopes count as well, times the length of a certificate: they carry the rounding of
        // y0 and of f - b even where the oscillation passes through zero or has died out, and that
        // of 2 xi (F - f), twice for the up to four times of decay.
        let one = d.broadcast(1.0);
        let pulls = force[0].magnitude() + (b - reference).magnitude();
        let carried = y0.magnitude() * d.smaller(one)
            + f_less_b.magnitude() * (d * d).smaller(one)
            + (pulls + pulls) * (two_xi * d).smaller(one);
        Pressed {
            excess: offset + f_change,
            y: y0 + y_change,
            q: q0 + q_change,
            largest_term: offset.magnitude() + relaxing.magnitude() + carried + driven_bound,
        }
    }

    /// What the forcing does, from the response to exp(i omega d).
    #[inline(always)]
    fn driven_part(&self, response: Complex<T>) -> T {
        let [a, ..] = self.parameters;
        a * self.angle.sin.times_from(response.im, self.angle.cos * response.re)
    }
}

impl<T: Number, C: Borrow<Constants<T>>> Contact<T, C> {
    /// The guard and its derivatives from its value and y; `force` is F - b, F', F''.
    #[inline]
    fn orders(&self, d: T, force: &[T; 3], free: &Free<T>, excess: T, y: T) -> [T; 4] {
        let Constants { b, two_xi, damping, .. } = *self.constants.borrow();
        if let Damping::Over { fast, slow, spread } = damping
            && fast * d > T::one()
        {
            return self.slow_and_fast(force, [fast, slow, spread], free.fast_exponential, excess);
        }
        orders(two_xi, b - self.reference, force, (excess, y))
    }

    /// Above critical damping, once the fast exponential has begun to die out: the equations of
    /// motion would multiply the rounding of f by 2 xi with each derivative, although what is left
    /// of f moves slowly. So its parts are differentiated one by one.
    #[inline]
    fn slow_and_fast(
        &self,
        force: &[T; 3],
        [fast, slow, spread]: [T; 3],
        fast_exponential: T,
        excess: T,
    ) -> [T; 4] {
        let Constants { a, b, two_xi, omega, steady, .. } = *self.constants.borrow();
        let EntryAngle { sin, cos, .. } = self.angle;
        let (a_cos, a_sin_omega) = (a * cos, a * sin * omega);
        let [then, then_rate, ..] = steady.orders([a_cos, -a_sin_omega, -(omega * omega * a_cos)]);
        let level = self.reference - b;
        // x = f - b - steady obeys x'' + 2 xi x' + x = 0: x' + slow x = -spread (fast part).
        let rate0 = two_xi * (a_cos - (self.offset + level)) + self.entry.y;
        let fast_part0 = -((rate0 - then_rate) + slow * (self.offset + level - then)) / spread;
        let forced = steady.orders(*force);
        let quickly = fast_part0 * fast_exponential;
        let slowly = (excess + level - forced[0]) - quickly;
        let (quickly1, slowly1) = (fast * quickly, slow * slowly);
        let (quickly2, slowly2) = (fast * quickly1, slow * slowly1);
        [
            excess,
            forced[1] - (slowly1 + quickly1),
            forced[2] + (slowly2 + quickly2),
            forced[3] - (slow * slowly2 + fast * quickly2),
        ]
    }
}

/// The orders of the trial force in contact: f'' + 2 xi f' + f = F + 2 xi F'.
pub struct ContactOrders<T> {
    omega2: T,
    two_xi: T,
    drive: T,
    next: T,
    before: T,
    last: T,
}

impl<T: Real> ContactOrders<T> {
    /// The derivatives from the force F with its derivative, and f with three.
    #[inline(always)]
    pub fn new([omega2, two_xi]: [T; 2], [u, v]: [T; 2], [.., second, third]: [T; 4]) -> Self {
        let drive = (two_xi * omega2).times_from(u, v);
        let next = -(omega2 * two_xi.times_plus(v, u));
        Self { omega2, two_xi, drive, next, before: second, last: third }
    }

    /// The next order.
    #[inline(always)]
    pub fn step(&mut self) -> T {
        let order = self.two_xi.times_from(self.last, self.next) - self.before;
        (self.before, self.last) = (self.last, order);
        (self.drive, self.next) = (self.next, -(self.omega2 * self.drive));
        order
    }
}
