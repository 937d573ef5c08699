//! Contacts ([`crate::flow::contact`]): evaluation and landing; guess and certificate are in
//! [`super::contact_ahead`].

use super::contact_constants::Forms;
use super::contact_steps::{LaneParts, choose_each};
use super::forcing::Angle;
use super::root::{Fineness, LanePhase, LaneRoot, find};
use super::series::LATER_ORDERS;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::crossing::contact_parts::ContactParts;
use crate::flow::contact::{ContactOrders, Pressed, Pressing, orders};
use crate::flow::damped::Free;
use crate::flow::forcing::Response;
use crate::flow::forcing::{Harmonic, Push};
use crate::numeric::real::Real;
use crate::numeric::remainders::short_decay;
use crate::numeric::series::REACH;
use pulp::Simd;

/// Contacts; their guard is the trial force less `reference`.
pub struct LaneContact<'a, S: Simd> {
    /// The model.
    pub shape: &'a Shape<Wide<S>>,
    /// The closed forms that are needed.
    pub forms: Forms,
    /// Forcing angle at the start.
    pub angle: Angle<S>,
    /// Velocity of the mass when the contact begins.
    pub y: Wide<S>,
    /// Displacement of the slider's top when the contact begins.
    pub q: Wide<S>,
    /// Value of the guard when the contact begins.
    pub offset: Wide<S>,
    /// The threshold, 0 or 1, from which it counts.
    pub reference: Wide<S>,
}

/// A contact at some time.
#[derive(Clone, Copy)]
pub struct Evaluated<S: Simd> {
    /// The guard and its first three derivatives.
    f: [Wide<S>; 4],
    /// F - b and its first two derivatives.
    force: [Wide<S>; 3],
    y: Wide<S>,
    q: Wide<S>,
    /// exp(-fast d) above critical damping.
    fast_exponential: Wide<S>,
    /// The largest terms of the guard.
    terms: Wide<S>,
}

/// The trial force reaches a threshold.
pub struct Release<S: Simd> {
    /// The time of the end: that of an evaluation, and the step from there to the root.
    pub elapsed: (Wide<S>, Wide<S>),
    /// Velocity of the mass.
    pub y: Wide<S>,
    /// The lanes in which the root is on the upper threshold.
    pub rises: Mask<S>,
    /// The lanes in which the event and all these values are proved.
    pub proved: Mask<S>,
}

/// A contact with the threshold that it is guessed to leave through.
struct Leaving<'a, 'b, S: Simd> {
    contact: &'b LaneContact<'a, S>,
    threshold: Wide<S>,
}

impl<S: Simd> LanePhase<S> for Leaving<'_, '_, S> {
    type At = Evaluated<S>;

    #[inline(always)]
    fn at(&self, d: Wide<S>) -> Evaluated<S> {
        self.contact.at(d)
    }

    #[inline(always)]
    fn excess(&self, at: &Evaluated<S>) -> [Wide<S>; 4] {
        let [value, slope, bend, third] = at.f;
        [value - self.threshold, slope, bend, third]
    }

    #[inline(always)]
    fn later_orders(&self, at: &Evaluated<S>) -> [Wide<S>; LATER_ORDERS] {
        let Shape { two_xi, omega2, .. } = *self.contact.shape;
        let mut higher = ContactOrders::new([omega2, two_xi], [at.force[0], at.force[1]], at.f);
        [(); LATER_ORDERS].map(|()| higher.step())
    }

    #[inline(always)]
    fn is_short(&self, _: Wide<S>, step: Wide<S>) -> Mask<S> {
        (step.magnitude() * self.contact.shape.quickest).below(REACH)
    }
}

impl<S: Simd> LaneContact<'_, S> {
    /// The motion after `d`.
    #[inline(always)]
    fn at(&self, d: Wide<S>) -> Evaluated<S> {
        let Shape { a, b, two_xi, .. } = *self.shape;
        let Harmonic { force, turn, .. } = self.angle.after(self.shape, d);
        let free = Free::after(self.shape, self.forms, d);
        let response = Response::after(self.shape, self.forms, d, &turn, &free);
        let begin = Pressing {
            parameters: [a, b, two_xi],
            angle: self.angle,
            state: [self.y, self.q],
            offset: self.offset,
            reference: self.reference,
        };
        let Pressed { excess, y, q, largest_term: terms } =
            begin.after(d, &force, &free, &response);
        let f =
            self.orders_one_by_one(d, self.orders(force, excess, y), force, free.fast_exponential);
        Evaluated { f, force, y, q, fast_exponential: free.fast_exponential, terms }
    }

    /// The guard and its derivatives; `force` is F - b, F', F''.
    #[inline(always)]
    fn orders(&self, force: [Wide<S>; 3], excess: Wide<S>, y: Wide<S>) -> [Wide<S>; 4] {
        let Shape { b, two_xi, .. } = *self.shape;
        orders(two_xi, b - self.reference, &force, (excess, y))
    }

    /// The first four orders of the guard at the start.
    #[inline(always)]
    fn first(&self) -> [Wide<S>; 4] {
        self.orders(self.angle.force(self.shape), self.offset, self.y)
    }

    /// Clearly above critical damping, once the fast exponential has begun to die out, the
    /// equations of motion would multiply the rounding of f by 2 xi with each derivative, although
    /// what is left of f moves slowly. There its parts are differentiated one by one.
    #[inline(always)]
    fn orders_one_by_one(
        &self,
        elapsed: Wide<S>,
        orders: [Wide<S>; 4],
        [u, v, w]: [Wide<S>; 3],
        fast_exponential: Wide<S>,
    ) -> [Wide<S>; 4] {
        let Shape { b, omega, fast, steady, steady_rate, .. } = *self.shape;
        let dying = (fast * elapsed).above(1.0);
        if self.forms == Forms::Usual || !dying.any() {
            return orders;
        }
        let quickly = self.parts(self.first()).parts.free_rate * fast_exponential;
        let forced = steady_rate.times_plus(v, steady * u);
        let quarter = steady_rate.times_plus(w, steady * v) / omega;
        let slowly = ((orders[0] - (b - self.reference)) - forced) - quickly;
        let parts = ContactParts { elapsed, free: slowly, free_rate: quickly, forced, quarter };
        let parts = LaneParts { parts, forms: self.forms };
        let [_, rate, bend, third] = parts.orders(self.shape, self.reference);
        choose_each(dying, [orders[0], rate, bend, third], orders)
    }

    /// The switches that end the contacts.
    #[inline(always)]
    pub fn release(&self, fineness: Fineness) -> Release<S> {
        let first = self.first();
        let (guess, threshold, guessed) = self.first_exit(first);
        let LaneRoot { at, elapsed, series, step, found, .. } =
            find(&Leaving { contact: self, threshold }, guess, guessed);
        // y' = F - f
        let [u, v, _] = at.force;
        let Push { force, impulse } = Push::new(self.shape.omega, [u, v], step);
        let rest = (self.shape.b - self.reference) - threshold;
        let y = at.y + (rest.times_plus(step, impulse) - series.integral(step));
        let fast_exponential =
            at.fast_exponential + at.fast_exponential * short_decay(self.shape.fast * step);
        let last = self.orders_one_by_one(
            elapsed,
            self.orders(force, threshold, y),
            force,
            fast_exponential,
        );
        let rises = !(threshold + self.reference).below(0.5);
        let outward = rises.choose(last[1], -last[1]).above(0.0);
        let proved =
            found & outward & self.stays_inside(first, last, elapsed + step, at.terms, fineness);
        Release { elapsed: (elapsed, step), y, rises, proved }
    }

    /// Displacement of the slider's top, velocity and guard at some time, and their rates.
    #[inline(always)]
    pub fn state(&self, d: Wide<S>) -> ([Wide<S>; 3], [Wide<S>; 3]) {
        let at = self.at(d);
        let pull = (at.force[0] + (self.shape.b - self.reference)) - at.f[0];
        ([at.q, at.y, at.f[0]], [at.y, pull, at.f[1]])
    }

    /// The force in parts at the start, from its orders there.
    #[inline(always)]
    pub fn parts(&self, [f, f1, ..]: [Wide<S>; 4]) -> LaneParts<S> {
        let Shape { b, omega, steady, steady_rate, .. } = *self.shape;
        let [u, v, w] = self.angle.force(self.shape);
        let level = b - self.reference;
        let free = (f - level) - steady_rate.times_plus(v, steady * u);
        let free_rate = f1 - steady_rate.times_plus(w, steady * v);
        let (forced, quarter) = ((f - level) - free, (f1 - free_rate) / omega);
        let elapsed = f.broadcast(0.0);
        let parts = ContactParts { elapsed, free, free_rate, forced, quarter };
        LaneParts::new(self.shape, self.forms, parts)
    }
}
