//! A guard continued from an evaluation by its own derivatives, of which all are known.
//!
//! The harmonic's derivatives repeat, an exponential's are multiples of it and the contact's follow
//! from its equation of motion, so that an evaluation knows the guard's Taylor series. Where a step
//! is shorter than [`REACH`] against the fastest rate of the motion, ten terms give the guard and
//! its first three derivatives to the last digit: what is left out of the third is REACH^8/8! =
//! 2e-17 of its size. A guess that comes so close is finished without a second evaluation, and the
//! state is carried along in one step, which rounds it once, as a second evaluation would. Most
//! guesses come closer than [`SHORT_REACH`]: there five terms leave SHORT_REACH^5/5! = 8e-18 of the
//! slope, and the higher derivatives follow from the equation of motion.

use crate::numeric::real::{Real, polynomial};

/// The longest step against the fastest rate of the motion.
pub const REACH: f64 = 0.03;

/// Terms kept up to there, that of order zero included.
pub const TERMS: usize = 11;

/// The longest step for which fewer terms do, in the same unit.
pub const SHORT_REACH: f64 = 1e-3;

/// Terms kept up to there.
pub const SHORT_TERMS: usize = 6;

/// 1/k!
pub const INVERSE_FACTORIALS: [f64; TERMS + 1] = {
    let mut table = [1.0; TERMS + 1];
    let mut k = 1;
    while k <= TERMS {
        table[k] = table[k - 1] / k as f64;
        k += 1;
    }
    table
};

/// The derivatives of orders 0 and on at an evaluation.
#[derive(Clone, Copy, Debug)]
pub struct Series<T, const N: usize>(pub [T; N]);

impl<const N: usize> Series<f64, N> {
    /// The guard's own orders, completed by its derivatives of orders four and on, one by one.
    #[inline]
    pub fn new(orders: &[f64; 4], mut next: impl FnMut() -> f64) -> Self {
        let mut derivatives = [0.0; N];
        derivatives[..4].copy_from_slice(orders);
        for derivative in &mut derivatives[4..] {
            *derivative = next();
        }
        Self(derivatives)
    }

    /// Second and third derivative a time `step` later.
    #[inline]
    pub fn bend_and_third(&self, step: f64) -> (f64, f64) {
        let (mut bend, mut third) = (0.0, 0.0);
        for k in (3..N).rev() {
            bend = self.0[k] * INVERSE_FACTORIALS[k - 2] + step * bend;
            third = self.0[k] * INVERSE_FACTORIALS[k - 3] + step * third;
        }
        (self.0[2] + step * bend, third)
    }
}

impl<T: Real, const N: usize> Series<T, N> {
    /// Value and slope a time `step` later; even and odd powers apart, so that the chains run side
    /// by side.
    #[inline(always)]
    pub fn value_and_slope(&self, step: T) -> (T, T) {
        let square = step * step;
        let zero = step.same(0.0);
        let (mut value, mut slope) = ([zero; 2], [zero; 2]);
        for k in (1..N).rev() {
            let (side, order) = (k % 2, self.0[k]);
            let [now, before] =
                [step.same(INVERSE_FACTORIALS[k]), step.same(INVERSE_FACTORIALS[k - 1])];
            value[side] = value[side].times_plus(square, order * now);
            slope[side] = slope[side].times_plus(square, order * before);
        }
        let [even, odd] = value;
        let [odd_slope, even_slope] = slope;
        let change = step.times_plus(odd, square * even);
        (self.0[0] + change, step.times_plus(odd_slope, even_slope))
    }

    /// Second derivative a time `step` later, without terms above order five.
    #[inline(always)]
    pub fn bend(&self, step: T) -> T {
        let [second, third, fourth, fifth] = [self.0[2], self.0[3], self.0[4], self.0[5]];
        let higher = (step * step.same(1.0 / 6.0)).times_plus(fifth, fourth * step.same(0.5));
        step.times_plus(step.times_plus(higher, third), second)
    }

    /// Integral from the evaluation to a time `step` later.
    #[inline(always)]
    pub fn integral(&self, step: T) -> T {
        let mut sum = step.same(0.0);
        for k in (0..N).rev() {
            sum = sum.times_plus(step, self.0[k] * step.same(INVERSE_FACTORIALS[k + 1]));
        }
        step * sum
    }
}

/// The orders of a guard that a harmonic force and an exponential make: the gap of a flight, and
/// the drift velocity in a progression.
pub struct PushedOrders<T> {
    omega2: T,
    rate: T,
    exponential: T,
    force: T,
    next: T,
}

impl<T: Real> PushedOrders<T> {
    /// The derivatives from the exponential that is left, whose third derivative is `rate`^3 times
    /// that, and the force with its derivative.
    #[inline(always)]
    pub fn new([omega2, rate]: [T; 2], left: T, [force, next]: [T; 2]) -> Self {
        Self { omega2, rate, exponential: left * (rate * rate * rate), force, next }
    }

    /// The next order.
    #[inline(always)]
    pub fn step(&mut self) -> T {
        self.exponential = -(self.exponential * self.rate);
        (self.force, self.next) = (self.next, -(self.omega2 * self.force));
        self.next + self.exponential
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

/// The harmonic force after a short step, and what it has done to the velocity.
#[derive(Clone, Copy, Debug)]
pub struct Push<T> {
    /// The harmonic force with its first two derivatives.
    pub force: [T; 3],
    /// The integral of the harmonic force over the step.
    pub impulse: T,
}

impl<T: Real> Push<T> {
    /// The push over a `step` from an evaluation with this harmonic force and its rate.
    #[inline(always)]
    pub fn new(omega: T, [u, v]: [T; 2], step: T) -> Self {
        let x = omega * step;
        let square = x * x;
        let sin_over_x = polynomial(square, [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0]);
        let one_less_cos = polynomial(square, [0.5, -1.0 / 24.0, 1.0 / 720.0, -1.0 / 40320.0]);
        let (time, area) = (step * sin_over_x, step * step * one_less_cos);
        // u'' = -omega^2 u for the harmonic force u.
        let omega2 = omega * omega;
        let harmonic = time.times_plus(v, (omega2 * area).times_from(u, u));
        let rate = (omega2 * time).times_from(u, (omega2 * area).times_from(v, v));
        Self {
            force: [harmonic, rate, -(omega2 * harmonic)],
            impulse: time.times_plus(u, area * v),
        }
    }
}

/// exp(-z) - 1 for |z| up to [`REACH`].
#[inline(always)]
pub fn short_decay<T: Real>(z: T) -> T {
    let square = z * z;
    let even = polynomial(square, [0.5, 1.0 / 24.0, 1.0 / 720.0, 1.0 / 40320.0]);
    let odd = polynomial(square, [1.0 / 6.0, 1.0 / 120.0, 1.0 / 5040.0]);
    square.times_plus(z.times_from(odd, even), -z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crossing::Guarded;
    use crate::flow::constants::Constants;
    use crate::flow::contact::Contact;
    use crate::flow::forcing::EntryAngle;
    use crate::flow::no_contact::NoContact;
    use crate::flow::progression::Progression;
    use crate::parameters::Parameters;
    use crate::state::State;
    use proptest::prelude::*;

    fn agrees<G: Guarded>(phase: &G, d: f64, share: f64) -> Result<(), TestCaseError> {
        let [few_terms, all] = phase.reaches();
        agrees_by::<G, SHORT_TERMS>(phase, d, share * few_terms)?;
        agrees_by::<G, TERMS>(phase, d, share * all)
    }

    fn agrees_by<G: Guarded, const N: usize>(
        phase: &G,
        d: f64,
        step: f64,
    ) -> Result<(), TestCaseError> {
        let (from, to) = (phase.at(d), phase.at(d + step));
        let step = to.elapsed - from.elapsed;
        let series = phase.series::<N>(&from);
        let reached = phase.continued(&from, step, &series, series.value_and_slope(step));
        // Two evaluations, each within the four roundings of its terms that the search grants it.
        let rate = phase.fastest_rate();
        let size = 1.0 + from.guard.largest_term.max(to.guard.largest_term);
        let room = 16.0 * f64::EPSILON * size;
        for (order, (a, b)) in reached.guard.orders.iter().zip(to.guard.orders).enumerate() {
            let scale = rate.powi(order as i32);
            prop_assert!((a - b).abs() <= room * scale, "order {order}: {a:e} {b:e} {room:e}");
        }
        let of = |state: &State| [state.p, state.y, state.q];
        for (a, b) in of(&reached.state).into_iter().zip(of(&to.state)) {
            prop_assert!((a - b).abs() <= room * rate, "state {a:e} {b:e} {room:e}");
        }
        prop_assert!((reached.drift - to.drift).abs() <= room * (1.0 + d), "drift");
        Ok(())
    }

    #[test]
    fn a_short_decay_is_good_to_the_last_digit() {
        for k in -300..=300_i32 {
            let z = REACH * f64::from(k) / 300.0;
            let exact = libm::expm1(-z);
            let off = (short_decay(z) - exact).abs();
            // Half a unit each of the function and of the last difference, and of z^2/2 a little.
            assert!(off <= 1.1 * f64::EPSILON * z.abs(), "{z}: {off:e}");
        }
    }

    /// Within [`REACH`] the last terms are below rounding; at z = 1 all eight of them show.
    #[test]
    fn a_short_decay_has_the_terms_of_the_exponential() {
        for z in [1.0, -1.0_f64] {
            let terms = (1..=8).map(|k| (-z).powi(k) * INVERSE_FACTORIALS[k as usize]);
            let exact: f64 = terms.sum();
            let off = (short_decay(z) - exact).abs();
            // Eight terms of at most 1, each rounded once here and once there.
            assert!(off <= 16.0 * f64::EPSILON, "{z}: {off:e}");
        }
    }

    proptest! {
        #[test]
        fn a_series_leads_where_an_evaluation_does(
            (xi, omega) in (-6.0..2.5_f64, -2.0..2.0_f64).prop_map(|(x, o)| (x.exp(), o.exp())),
            (y, q, angle) in (-1.0..1.0_f64, 0.0..1.0_f64, 0.0..6.3_f64),
            (d, share) in (0.0..5.0_f64, -1.0..1.0_f64),
        ) {
            let parameters = Parameters { xi, omega, ..Parameters::default() };
            let constants = Constants::new(&parameters);
            let d = d + 0.1;
            let angle = EntryAngle { radians: angle, sin: angle.sin(), cos: angle.cos() };
            let entry = State { p: q + 0.02, y, q };
            agrees(&NoContact { constants, entry, angle, surface: None }, d, share)?;
            let offset = 2.0 * xi * y + q;
            agrees(&Contact { constants, entry, angle, offset, reference: 0.0 }, d, share)?;
            let closing = (1.0 - q) / (2.0 * xi);
            let drift_rate = y - closing;
            agrees(&Progression { constants, entry, angle, drift_rate, closing }, d, share)?;
        }
    }
}
