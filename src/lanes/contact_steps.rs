//! A contact followed in steps of fixed length ([`crate::crossing::contact_parts`]).
//!
//! Clearly above critical damping the free part is carried as two exponentials, so that what is
//! left of it has the derivatives of the slow one when the fast one has died out. Steps then
//! begin as short as the fast one's life and double up to the length of all others.

use super::contact_constants::Forms;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::crossing::contact_parts::ContactParts;
use crate::flow::steps::ContactStep;
use crate::numeric::real::Real;
use pulp::Simd;

/// The trial force in parts, in which exponentials may stand: clearly above critical damping the
/// free part is the slow one, and its rate the fast one.
#[derive(Clone, Copy)]
pub struct LaneParts<S: Simd> {
    /// The parts.
    pub parts: ContactParts<Wide<S>>,
    /// Whether some lanes may have exponentials.
    pub forms: Forms,
}

impl<S: Simd> LaneParts<S> {
    /// The parts that follow from the free part and its rate.
    #[inline(always)]
    pub fn new(shape: &Shape<Wide<S>>, forms: Forms, parts: ContactParts<Wide<S>>) -> Self {
        let ContactParts { free: x, free_rate: rate, .. } = parts;
        if forms == Forms::Usual {
            return Self { parts, forms };
        }
        let over = shape.fast.above(0.0);
        // x' + slow x = -spread (fast part)
        let fast_part = -shape.lasting.times_plus(x, rate) / shape.spread;
        let (free, free_rate) = (over.choose(x - fast_part, x), over.choose(fast_part, rate));
        Self { parts: ContactParts { free, free_rate, ..parts }, forms }
    }

    /// The parts after a step.
    #[inline(always)]
    pub fn after(&self, step: &ContactStep<Wide<S>>) -> Self {
        Self { parts: self.parts.after(step), ..*self }
    }

    /// The free part and its first three derivatives.
    #[inline(always)]
    fn free_orders(&self, shape: &Shape<Wide<S>>) -> [Wide<S>; 4] {
        let orders = self.parts.free_orders(shape.two_xi);
        if self.forms == Forms::Usual {
            return orders;
        }
        let Shape { lasting: slow, fast, .. } = *shape;
        let ContactParts { free: slowly, free_rate: quickly, .. } = self.parts;
        let (slowly1, quickly1) = (slow * slowly, fast * quickly);
        let (slowly2, quickly2) = (slow * slowly1, fast * quickly1);
        let sums = [
            slowly + quickly,
            -(slowly1 + quickly1),
            slowly2 + quickly2,
            -(slow * slowly2 + fast * quickly2),
        ];
        choose_each(shape.fast.above(0.0), sums, orders)
    }

    /// The guard, which counts from `reference`, and its first three derivatives.
    #[inline(always)]
    pub fn orders(&self, shape: &Shape<Wide<S>>, reference: Wide<S>) -> [Wide<S>; 4] {
        self.parts.orders(shape.b - reference, shape.omega, self.free_orders(shape))
    }

    /// A bound of the free part's eighth derivative from here on: every derivative obeys the same
    /// equation, and x^2 + x'^2 never grows.
    #[inline(always)]
    pub fn eighth(&self, shape: &Shape<Wide<S>>) -> Wide<S> {
        let ContactParts { free: mut x, free_rate: mut rate, .. } = self.parts;
        for _ in 0..8 {
            (x, rate) = (rate, -shape.two_xi.times_plus(rate, x));
        }
        x.times_plus(x, rate * rate).sqrt()
    }

    /// A bound of the free part's eighth derivative clearly above critical damping, where both
    /// exponentials only shrink.
    #[inline(always)]
    pub fn eighth_of_exponentials(&self, shape: &Shape<Wide<S>>) -> Wide<S> {
        let ContactParts { free: slowly, free_rate: quickly, .. } = self.parts;
        slowly.magnitude().times_plus(shape.lasting8, quickly.magnitude() * shape.fast8)
    }

    /// The size of all parts.
    #[inline(always)]
    pub fn size(&self) -> Wide<S> {
        let ContactParts { free, free_rate, forced, quarter, .. } = self.parts;
        free.magnitude() + free_rate.magnitude() + forced.magnitude() + quarter.magnitude()
    }
}

/// The steps of a contact: the first one, and all others up to doubling.
#[derive(Clone, Copy)]
pub struct ContactSteps<S: Simd> {
    /// The step that is due.
    pub now: ContactStep<Wide<S>>,
    full: ContactStep<Wide<S>>,
    forms: Forms,
}

impl<S: Simd> ContactSteps<S> {
    /// The steps of a guess.
    #[inline(always)]
    pub fn of_guess(shape: &Shape<Wide<S>>, forms: Forms) -> Self {
        let Shape {
            contact_guess_step,
            contact_guess_step_sin,
            contact_guess_step_cos,
            contact_guess_step_c,
            contact_guess_step_s,
            contact_guess_step_s_rate,
            ..
        } = *shape;
        let Shape {
            early_contact_guess_step_sin,
            early_contact_guess_step_cos,
            early_contact_guess_step_c,
            early_contact_guess_step_s_rate,
            ..
        } = *shape;
        let full = ContactStep {
            length: contact_guess_step,
            sin: contact_guess_step_sin,
            cos: contact_guess_step_cos,
            c: contact_guess_step_c,
            s: contact_guess_step_s,
            s_rate: contact_guess_step_s_rate,
        };
        let early = [
            early_contact_guess_step_sin,
            early_contact_guess_step_cos,
            early_contact_guess_step_c,
            early_contact_guess_step_s_rate,
        ];
        Self::new(shape, forms, full, early)
    }

    /// The steps from piece to piece of a certificate.
    #[inline(always)]
    pub fn of_pieces(shape: &Shape<Wide<S>>, forms: Forms) -> Self {
        let Shape { piece, piece_sin, piece_cos, piece_c, piece_s, piece_s_rate, .. } = *shape;
        let Shape { early_piece_sin, early_piece_cos, early_piece_c, early_piece_s_rate, .. } =
            *shape;
        let full = ContactStep {
            length: piece,
            sin: piece_sin,
            cos: piece_cos,
            c: piece_c,
            s: piece_s,
            s_rate: piece_s_rate,
        };
        let early = [early_piece_sin, early_piece_cos, early_piece_c, early_piece_s_rate];
        Self::new(shape, forms, full, early)
    }

    /// The steps up to the full one, from the early one's sine, cosine, C and S'.
    #[inline(always)]
    fn new(
        shape: &Shape<Wide<S>>,
        forms: Forms,
        full: ContactStep<Wide<S>>,
        [sin, cos, c, s_rate]: [Wide<S>; 4],
    ) -> Self {
        let now = match forms {
            Forms::Usual => full,
            Forms::Any => {
                let length = full.length * shape.early;
                ContactStep { length, sin, cos, c, s_rate, ..full }
            }
        };
        Self { now, full, forms }
    }

    /// Goes on to the next step: twice as long, until the full length is reached.
    #[inline(always)]
    pub fn next(&mut self) {
        if self.forms == Forms::Usual {
            return;
        }
        let ContactStep { length, sin, cos, c, s, s_rate } = self.now;
        let length = length + length;
        let doubled = ContactStep {
            length,
            sin: (sin + sin) * cos,
            cos: (sin + sin).times_from(sin, sin.broadcast(1.0)),
            c: c * c,
            s,
            s_rate: s_rate * s_rate,
        };
        self.now = doubled.or(!(length * 1.5).less(self.full.length), self.full);
    }
}

impl<S: Simd> ContactStep<Wide<S>> {
    #[inline(always)]
    fn or(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            length: mask.choose(other.length, self.length),
            sin: mask.choose(other.sin, self.sin),
            cos: mask.choose(other.cos, self.cos),
            c: mask.choose(other.c, self.c),
            s: mask.choose(other.s, self.s),
            s_rate: mask.choose(other.s_rate, self.s_rate),
        }
    }
}

/// Takes one of two where the mask holds, the other elsewhere. (Under run-time dispatch the
/// closures of an array's `map` are calls.)
#[inline(always)]
pub fn choose_each<S: Simd, const N: usize>(
    mask: Mask<S>,
    yes: [Wide<S>; N],
    no: [Wide<S>; N],
) -> [Wide<S>; N] {
    let mut chosen = no;
    for (k, value) in chosen.iter_mut().enumerate() {
        *value = mask.choose(yes[k], *value);
    }
    chosen
}
