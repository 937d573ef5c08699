//! The derivatives of a guard from order four on, one by one.
//!
//! A harmonic's derivatives repeat, an exponential's are multiples of it, and those of the force in
//! contact follow from its equation of motion.

use crate::numeric::real::Real;

/// The orders of a guard that a harmonic force and an exponential make: the gap of a flight, and
/// the slider's velocity in a progression.
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
