//! The differential equations (11)-(13) themselves, solved by their Taylor series in double-double.
//!
//! Nothing here knows a closed form: the coefficients follow from the right-hand sides alone.

use percuss::affine::DoubleDouble;
use percuss::insides::Constants;
use percuss::number::Number;
use percuss::{Phase, State};

/// Coefficients carried: at a step of a quarter of the fastest time the first one left out is
/// 0.25^24/24!, 6e-39 of the largest.
const TERMS: usize = 24;

/// The largest step in units of the fastest time for which the above holds.
pub const MAX_STEP: f64 = 0.25;

type Real = DoubleDouble;

/// Taylor coefficients of p, y, q and v about one instant.
pub struct Series {
    pub p: [Real; TERMS],
    pub y: [Real; TERMS],
    pub q: [Real; TERMS],
    pub v: [Real; TERMS],
}

/// The fastest rate among the motions of a phase.
pub fn fastest_rate(phase: Phase, constants: &Constants<Real>) -> f64 {
    let slider = if phase == Phase::Contact { constants.two_xi } else { constants.rate };
    1.0_f64.max(constants.omega.to_f64()).max(slider.to_f64())
}

/// The series of the solution that passes through `state`, with v = 0, where the forcing angle has
/// this sine and cosine.
pub fn series(
    phase: Phase,
    constants: &Constants<Real>,
    state: &State<Real>,
    (mut sin, mut cos): (Real, Real),
) -> Series {
    let Constants { a, b, omega, two_xi, .. } = *constants;
    let zero = Real::zero();
    let mut of = Series { p: [zero; TERMS], y: [zero; TERMS], q: [zero; TERMS], v: [zero; TERMS] };
    (of.p[0], of.y[0], of.q[0]) = (state.p, state.y, state.q);
    for k in 0..TERMS - 1 {
        // Constants have one coefficient only.
        let constant = |c: Real| if k == 0 { c } else { zero };
        let (y, q) = (of.y[k], of.q[k]);
        let force = a * cos + constant(b);
        let [p_rate, y_rate, q_rate, v_rate] = match phase {
            Phase::NoContact => [y, force, -(q / two_xi), zero],
            Phase::Contact => [y, force - two_xi * y - q, y, zero],
            Phase::Progression => {
                let closing = (constant(Real::one()) - q) / two_xi;
                [closing, force - constant(Real::one()), closing, y - closing]
            }
        };
        let next = Real::one() / Real::exact((k + 1) as f64);
        of.p[k + 1] = p_rate * next;
        of.y[k + 1] = y_rate * next;
        of.q[k + 1] = q_rate * next;
        of.v[k + 1] = v_rate * next;
        let turn = omega * next;
        (sin, cos) = (cos * turn, -(sin * turn));
    }
    of
}

impl Series {
    /// State and drift a time `step` later.
    pub fn at(&self, step: Real) -> [Real; 4] {
        [&self.p, &self.y, &self.q, &self.v]
            .map(|terms| terms.iter().rev().fold(Real::zero(), |sum, c| sum * step + *c))
    }

    /// Value and three derivatives of the guard, by its definition: h = p - q - g without contact,
    /// f - reference in contact, v' = y + (q - 1)/(2 xi) in progression.
    pub fn guard(&self, phase: Phase, constants: &Constants<Real>, reference: Real) -> [Real; 4] {
        let Constants { g, two_xi, .. } = *constants;
        let mut factorial = Real::one();
        std::array::from_fn(|k| {
            let constant = |c: Real| if k == 0 { c } else { Real::zero() };
            let (p, y, q) = (self.p[k], self.y[k], self.q[k]);
            let coefficient = match phase {
                Phase::NoContact => p - q - constant(g),
                Phase::Contact => two_xi * y + q - constant(reference),
                Phase::Progression => y + (q - constant(Real::one())) / two_xi,
            };
            factorial = if k == 0 { factorial } else { factorial.times(k as f64) };
            coefficient * factorial
        })
    }
}
