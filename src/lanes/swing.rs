//! A contact followed in strides of fixed length ([`crate::crossing::contact_parts`]).
//!
//! Clearly above critical damping the free part is carried as two exponentials, so that what is
//! left of it has the derivatives of the slow one when the quick one has died out. Steps then
//! begin as short as the quick one's life and double up to the length of all others.

use super::contact_shape::Forms;
use super::shape::Shape;
use super::wide::{Mask, Wide};
use crate::numeric::real::Real;
use pulp::Simd;

/// The trial force in parts.
#[derive(Clone, Copy)]
pub struct Parts<S: Simd> {
    /// Free part and its rate; clearly above critical damping the slow exponential and the quick
    /// one.
    pub free: [Wide<S>; 2],
    /// Forced part.
    pub forced: Wide<S>,
    /// The rate of the forced part over omega.
    pub quarter: Wide<S>,
    /// Whether some lanes may have exponentials.
    pub forms: Forms,
}

impl<S: Simd> Parts<S> {
    /// The parts that follow from the free part and its rate.
    #[inline(always)]
    pub fn new(
        shape: &Shape<Wide<S>>,
        forms: Forms,
        [x, rate]: [Wide<S>; 2],
        forced: Wide<S>,
        quarter: Wide<S>,
    ) -> Self {
        let mut free = [x, rate];
        if forms == Forms::Any {
            let over = shape.fast.above(0.0);
            // x' + slow x = -spread (quick part)
            let quick = -shape.lasting.times_plus(x, rate) / shape.spread;
            free = [over.choose(x - quick, x), over.choose(quick, rate)];
        }
        Self { free, forced, quarter, forms }
    }

    /// The parts after a step.
    #[inline(always)]
    pub fn after(&self, swing: &Swing<S>) -> Self {
        let Swing { sin, cos, free: [c, s, s_rate], .. } = *swing;
        let Self { free: [x, rate], forced, quarter, .. } = *self;
        Self {
            free: [x.times_plus(c, rate * s), x.times_from(s, rate * s_rate)],
            forced: forced.times_plus(cos, quarter * sin),
            quarter: forced.times_from(sin, quarter * cos),
            ..*self
        }
    }

    /// The free part and its first three derivatives.
    #[inline(always)]
    fn free_orders(&self, shape: &Shape<Wide<S>>) -> [Wide<S>; 4] {
        let two_xi = shape.two_xi;
        let [x, rate] = self.free;
        // x'' + 2 xi x' + x = 0
        let bend = -two_xi.times_plus(rate, x);
        let orders = [x, rate, bend, -two_xi.times_plus(bend, rate)];
        if self.forms == Forms::Usual {
            return orders;
        }
        let Shape { lasting: slow, fast, .. } = *shape;
        let (slowly, quickly) = (slow * x, fast * rate);
        let (slowly2, quickly2) = (slow * slowly, fast * quickly);
        let sums = [
            x + rate,
            -(slowly + quickly),
            slowly2 + quickly2,
            -(slow * slowly2 + fast * quickly2),
        ];
        each(shape.fast.above(0.0), sums, orders)
    }

    /// The guard, which counts from `reference`, and its first derivative.
    #[inline(always)]
    pub fn value_and_rate(&self, shape: &Shape<Wide<S>>, reference: Wide<S>) -> (Wide<S>, Wide<S>) {
        let [free, free_rate, ..] = self.free_orders(shape);
        let value = (shape.b - reference) + free + self.forced;
        (value, shape.omega.times_plus(self.quarter, free_rate))
    }

    /// The guard, which counts from `reference`, and its first three derivatives.
    #[inline(always)]
    pub fn orders(&self, shape: &Shape<Wide<S>>, reference: Wide<S>) -> [Wide<S>; 4] {
        let Shape { b, omega, omega2, .. } = *shape;
        let Self { forced, quarter, .. } = *self;
        let [free, free_rate, bend, third] = self.free_orders(shape);
        [
            (b - reference) + free + forced,
            omega.times_plus(quarter, free_rate),
            omega2.times_from(forced, bend),
            (omega * omega2).times_from(quarter, third),
        ]
    }

    /// A bound of the free part's eighth derivative from here on: every derivative obeys the same
    /// equation, and x^2 + x'^2 never grows.
    #[inline(always)]
    pub fn eighth(&self, shape: &Shape<Wide<S>>) -> Wide<S> {
        let [mut x, mut rate] = self.free;
        for _ in 0..8 {
            (x, rate) = (rate, -shape.two_xi.times_plus(rate, x));
        }
        x.times_plus(x, rate * rate).sqrt()
    }

    /// A bound of the free part's eighth derivative clearly above critical damping, where both
    /// exponentials only shrink.
    #[inline(always)]
    pub fn eighth_of_exponentials(&self, shape: &Shape<Wide<S>>) -> Wide<S> {
        let [slowly, quickly] = self.free;
        slowly.magnitude().times_plus(shape.lasting8, quickly.magnitude() * shape.fast8)
    }

    /// The size of all parts.
    #[inline(always)]
    pub fn size(&self) -> Wide<S> {
        let [x, rate] = self.free;
        x.magnitude() + rate.magnitude() + self.forced.magnitude() + self.quarter.magnitude()
    }
}

/// A stride.
#[derive(Clone, Copy)]
pub struct Swing<S: Simd> {
    /// How long it is.
    pub length: Wide<S>,
    /// Sine of omega times that.
    pub sin: Wide<S>,
    /// Cosine of omega times the step.
    pub cos: Wide<S>,
    /// C, S and S' of the free oscillation; clearly above critical damping the slow exponential,
    /// zero and the quick one.
    pub free: [Wide<S>; 3],
}

/// The strides of a contact: the first one, and all others up to doubling.
#[derive(Clone, Copy)]
pub struct Swings<S: Simd> {
    /// The present one.
    pub now: Swing<S>,
    full: Swing<S>,
    forms: Forms,
}

impl<S: Simd> Swings<S> {
    /// The strides of a guess.
    #[inline(always)]
    pub fn of_guess(shape: &Shape<Wide<S>>, forms: Forms) -> Self {
        let Shape { swing, swing_sin, swing_cos, swing_c, swing_s, swing_s_rate, .. } = *shape;
        let Shape { early_swing_sin, early_swing_cos, early_swing_c, early_swing_s_rate, .. } =
            *shape;
        let free = [swing_c, swing_s, swing_s_rate];
        let full = Swing { length: swing, sin: swing_sin, cos: swing_cos, free };
        let early = [early_swing_sin, early_swing_cos, early_swing_c, early_swing_s_rate];
        Self::new(shape, forms, full, early)
    }

    /// The strides from piece to piece of a certificate.
    #[inline(always)]
    pub fn of_pieces(shape: &Shape<Wide<S>>, forms: Forms) -> Self {
        let Shape { piece, piece_sin, piece_cos, piece_c, piece_s, piece_s_rate, .. } = *shape;
        let Shape { early_piece_sin, early_piece_cos, early_piece_c, early_piece_s_rate, .. } =
            *shape;
        let free = [piece_c, piece_s, piece_s_rate];
        let full = Swing { length: piece, sin: piece_sin, cos: piece_cos, free };
        let early = [early_piece_sin, early_piece_cos, early_piece_c, early_piece_s_rate];
        Self::new(shape, forms, full, early)
    }

    /// The strides up to the full one, from the early one's sine, cosine, C and S'.
    #[inline(always)]
    fn new(
        shape: &Shape<Wide<S>>,
        forms: Forms,
        full: Swing<S>,
        [sin, cos, c, s_rate]: [Wide<S>; 4],
    ) -> Self {
        let now = match forms {
            Forms::Usual => full,
            Forms::Any => {
                let [_, s, _] = full.free;
                Swing { length: full.length * shape.early, sin, cos, free: [c, s, s_rate] }
            }
        };
        Self { now, full, forms }
    }

    /// Goes on to the next one.
    #[inline(always)]
    pub fn next(&mut self) {
        if self.forms == Forms::Usual {
            return;
        }
        let Swing { length, sin, cos, free: [c, s, s_rate] } = self.now;
        let length = length + length;
        let doubled = Swing {
            length,
            sin: (sin + sin) * cos,
            cos: (sin + sin).times_from(sin, sin.same(1.0)),
            free: [c * c, s, s_rate * s_rate],
        };
        self.now = doubled.or(!(length * 1.5).less(self.full.length), self.full);
    }
}

impl<S: Simd> Swing<S> {
    #[inline(always)]
    fn or(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            length: mask.choose(other.length, self.length),
            sin: mask.choose(other.sin, self.sin),
            cos: mask.choose(other.cos, self.cos),
            free: each(mask, other.free, self.free),
        }
    }
}

/// Takes one of two where the mask holds, the other elsewhere. (Under run-time dispatch the
/// closures of an array's `map` are calls.)
#[inline(always)]
pub fn each<S: Simd, const N: usize>(
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
