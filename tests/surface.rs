//! Starts at which the trial force is exactly at a threshold: the first of its derivatives that is
//! not zero decides which phase begins.
//!
//! Each start is planted: the derivatives below a chosen one are zero to their rounding, and the
//! chosen one has a chosen sign. The expected phase follows from that sign, and is confirmed by an
//! integration of the equations of contact, which shares nothing with the solver.

use crate::support::original::Equations;
use crate::support::random::Draw;
use percuss::TwoWord;
use percuss::{Entry, Exit, Model, Parameters, Phase, Start};
use std::f64::consts::PI;

/// Starts for every derivative, threshold and sign.
const STARTS: usize = 200;

/// The sizes of a deciding derivative, against the sum of its terms' sizes: from far above its
/// rounding to all of it. The planted data and the forcing angle are rounded too, by less than a
/// hundred units.
const SIZES: [f64; 2] = [1e-13, 1.0];

/// A start on a threshold.
#[derive(Clone, Copy, Debug)]
struct Planted {
    parameters: Parameters,
    y: f64,
    threshold: f64,
    /// The sign of the first derivative of the trial force that is not zero.
    sign: f64,
}

impl Planted {
    fn entry(&self) -> (Model, Entry) {
        let Self { parameters, y, threshold, .. } = *self;
        let model = Model::new(parameters).unwrap();
        let q = threshold - 2.0 * parameters.xi * y;
        let start = Start { p: q + parameters.g, y, q: Some(q), ..Start::default() };
        (model, model.start(&start).unwrap())
    }

    fn expected_phase(&self) -> Phase {
        match (self.threshold == 0.0, self.sign > 0.0) {
            (true, false) => Phase::NoContact,
            (false, true) => Phase::Progression,
            _ => Phase::Contact,
        }
    }

    /// The height of a contact's trial force above the threshold after this time, by integration.
    fn above(&self, time: f64) -> f64 {
        let Self { parameters, y, threshold, .. } = *self;
        let equations = Equations { phase: Phase::Contact, parameters };
        let q = threshold - 2.0 * parameters.xi * y;
        let [_, y, q, _] = equations.integrate(parameters.phi, [0.0, y, q, 0.0], time);
        2.0 * parameters.xi * y + q - threshold
    }

    /// The start is decided as its sign demands.
    fn is_decided(&self) {
        assert_eq!(self.entry().1.phase(), self.expected_phase(), "{self:?}");
    }

    /// The trial force leaves the threshold to the side of the sign, and the solver's run with it,
    /// if the derivative is large: after this share of the fastest time that is far above any
    /// rounding, and the next derivative still does little. What rounding makes of the first
    /// moments, a flight of 1e-14, is over by then.
    fn leaves_to_its_side(&self, share: f64) {
        let Parameters { xi, omega, .. } = self.parameters;
        let time = share / omega.max(1.0).max(2.0 * xi);
        for part in [0.5, 1.0] {
            assert!(self.above(part * time) * self.sign > 0.0, "{self:?} {part}");
        }
        let (model, entry) = self.entry();
        let later = entry.instant.after(TwoWord::new(time), omega);
        let last = model.trajectory(entry).until(later).last().unwrap();
        assert_eq!(last.phase(), self.expected_phase(), "{self:?}");
    }
}

/// The free numbers of a start.
struct Free {
    xi: f64,
    omega: f64,
    a: f64,
    phi: f64,
    threshold: f64,
    sign: f64,
    size: f64,
}

impl Free {
    fn draw(draw: &mut Draw, threshold: f64, sign: f64) -> Self {
        Self {
            xi: draw.decades(0.02, 5.0),
            omega: draw.decades(0.1, 10.0),
            a: draw.decades(0.05, 5.0),
            phi: draw.between(0.0, 2.0 * PI),
            threshold,
            sign,
            size: draw.decades(SIZES[0], SIZES[1]),
        }
    }

    /// The harmonic part of the force and its first two derivatives.
    fn harmonic(&self) -> [f64; 3] {
        let (sin, cos) = libm::sincos(self.phi);
        let Self { a, omega, .. } = *self;
        [a * cos, -(a * omega * sin), -(a * omega * omega * cos)]
    }

    fn planted_start(&self, b: f64, y: f64) -> Planted {
        let Self { xi, omega, a, phi, threshold, sign, .. } = *self;
        let parameters = Parameters { a, b, xi, omega, g: 0.02, phi };
        Planted { parameters, y, threshold, sign }
    }

    /// f' = 2 xi (F - f) + y has the sign.
    fn first(&self, b: f64) -> Planted {
        let pull = b + self.harmonic()[0] - self.threshold;
        let terms = 2.0 * self.xi * (self.a + b.abs() + self.threshold);
        self.planted_start(b, self.sign * self.size * terms - 2.0 * self.xi * pull)
    }

    /// f' = 0 and f'' = 2 xi F' + F - f has the sign.
    fn second(&self) -> Planted {
        let terms = 2.0 * self.xi * self.a * self.omega + self.a + self.threshold;
        self.without_first(self.sign * self.size * terms)
    }

    /// f' = f'' = 0; f''' = 2 xi F'' + F' has the sign, by the forcing angle.
    fn third(mut self) -> Planted {
        // sin(phi - zero) sets it: -a omega sqrt(1 + (2 xi omega)^2) sin(phi - zero).
        let zero = -libm::atan(2.0 * self.xi * self.omega);
        let angle = libm::asin(self.size);
        let near = zero - self.sign * angle;
        let far = zero + PI + self.sign * angle;
        self.phi = if self.phi < PI { near } else { far };
        self.without_first(0.0)
    }

    /// f' = f'' = f''' = 0; f'''' = omega^2 (b - f) has the sign, by the half turn.
    fn fourth(mut self) -> Planted {
        let zero = -libm::atan(2.0 * self.xi * self.omega);
        self.phi = if self.sign > 0.0 { zero + PI } else { zero };
        self.without_first(0.0)
    }

    /// f' = 0 and f'' has this value, by b and y.
    fn without_first(&self, second: f64) -> Planted {
        let [force, rate, _] = self.harmonic();
        let pull = second - 2.0 * self.xi * rate;
        self.planted_start(self.threshold + pull - force, -2.0 * self.xi * pull)
    }
}

/// Puts starts for both thresholds and both signs to a test.
fn for_each_side(seed: u64, test: impl Fn(&mut Draw, Free)) {
    let mut draw = Draw(seed);
    for threshold in [0.0, 1.0] {
        for sign in [-1.0, 1.0] {
            for _ in 0..STARTS {
                let free = Free::draw(&mut draw, threshold, sign);
                test(&mut draw, free);
            }
        }
    }
}

/// Starts whose deciding derivative is of any size, and starts where it is large.
fn examine(planted: Planted, size: f64, share: f64) {
    planted.is_decided();
    if size > 0.1 {
        planted.leaves_to_its_side(share);
    }
}

#[test]
fn the_first_derivative_decides() {
    for_each_side(31, |draw, free| {
        let b = draw.between(-2.0, 2.0);
        examine(free.first(b), free.size, 0.01);
    });
}

#[test]
fn the_second_derivative_decides_where_the_first_is_zero() {
    for_each_side(32, |_, free| examine(free.second(), free.size, 0.02));
}

#[test]
fn the_third_derivative_decides_where_two_are_zero() {
    for_each_side(33, |_, free| {
        let size = free.size;
        examine(free.third(), size, 0.05);
    });
}

#[test]
fn the_fourth_derivative_decides_where_three_are_zero() {
    for_each_side(34, |_, free| examine(free.fourth(), 1.0, 0.3));
}

/// A force that stays on its threshold for ever: the mass rests on the slider.
#[test]
fn a_force_that_stays_on_its_threshold_is_a_contact() {
    for threshold in [0.0, 1.0] {
        let parameters =
            Parameters { a: 0.0, b: threshold, xi: 0.3, omega: 1.4, g: 0.02, phi: 0.0 };
        let (model, entry) = Planted { parameters, y: 0.0, threshold, sign: 0.0 }.entry();
        let segment = model.trajectory(entry).next().unwrap();
        assert_eq!(segment.phase(), Phase::Contact);
        assert!(!matches!(segment.exit(), Exit::Switch(_)), "{segment:?}");
    }
}

/// A derivative counts from four units in the last place of its terms on. All numbers here are
/// exact.
#[test]
fn a_derivative_below_four_units_of_its_terms_counts_as_zero() {
    // f' = 2 xi (b - f) + y = y + 1 at xi = 1/2, b = 1, f = 0, with terms that add up to 2; f'' = b
    // = 1.
    for (units, expected) in [(-9.0, Phase::NoContact), (-7.0, Phase::Contact)] {
        let parameters = Parameters { a: 0.0, b: 1.0, xi: 0.5, omega: 1.0, g: 0.0, phi: 0.0 };
        let y = -1.0 + units * f64::EPSILON;
        let planted = Planted { parameters, y, threshold: 0.0, sign: 1.0 };
        assert_eq!(planted.entry().1.phase(), expected, "{units}");
    }
    // At the threshold 1 with b = -1 and y = 2: f' = y - 2 of terms that add up to 4, and f'' = -2.
    for (units, expected) in [(18.0, Phase::Progression), (14.0, Phase::Contact)] {
        let parameters = Parameters { a: 0.0, b: -1.0, xi: 0.5, omega: 1.0, g: 0.0, phi: 0.0 };
        let y = 2.0 + units * f64::EPSILON;
        let planted = Planted { parameters, y, threshold: 1.0, sign: 1.0 };
        assert_eq!(planted.entry().1.phase(), expected, "{units}");
    }
}

/// A force within four units in the last place of a threshold is on it, and one further away is
/// not. All numbers here are exact; a force on the threshold falls below 0 and below 1, as b = -4
/// pulls.
#[test]
fn a_force_within_four_units_of_a_threshold_is_on_it() {
    let parameters = Parameters { a: 0.0, b: -4.0, xi: 0.5, omega: 1.0, g: 0.0, phi: 0.0 };
    let model = Model::new(parameters).unwrap();
    let phase = |y: f64, q: f64| {
        model.start(&Start { p: q, y, q: Some(q), ..Start::default() }).unwrap().phase()
    };
    // 0 = y + q, with terms of 1.
    assert_eq!(phase(-1.0, 1.0 + 3.0 * f64::EPSILON), Phase::NoContact);
    assert_eq!(phase(-1.0, 1.0 + 5.0 * f64::EPSILON), Phase::Contact);
    // 1 = y + q, with terms of 1/2 each: a unit of 1 counts.
    assert_eq!(phase(0.5, 0.5 + 3.0 * f64::EPSILON), Phase::Contact);
    assert_eq!(phase(0.5, 0.5 + 5.0 * f64::EPSILON), Phase::Progression);
}

/// The start by which a wrong sign of the second derivative was seen: its contact lasted 5e-324.
#[test]
fn a_contact_with_a_second_derivative_of_thirty_per_cent_lasts() {
    let parameters = Parameters { a: 0.3, b: 0.0, xi: 0.5, omega: 1.0, g: 0.02, phi: 0.0 };
    let planted = Planted { parameters, y: -0.3, threshold: 0.0, sign: 1.0 };
    let (model, entry) = planted.entry();
    let segment = model.trajectory(entry).next().unwrap();
    assert_eq!(segment.phase(), Phase::Contact);
    // The end by integration: a bracket of 1.871 whose ends have different signs.
    assert!(planted.above(1.870) > 0.0 && planted.above(1.872) < 0.0);
    assert!((segment.duration() - 1.871).abs() < 1e-3, "{}", segment.duration());
}

/// A force of the smallest number, whose rate vanishes, imposes f = 0: q becomes -2 xi y.
#[test]
fn a_force_without_a_rate_is_at_the_threshold() {
    const MIN_POSITIVE: f64 = 5e-324;
    let parameters = Parameters { xi: 4.0, g: 0.0, ..Parameters::default() };
    let model = Model::new(parameters).unwrap();
    for (y, q, imposed) in [
        (-MIN_POSITIVE, 7.0 * MIN_POSITIVE, 8.0 * MIN_POSITIVE),
        (-2.0 * MIN_POSITIVE, 15.0 * MIN_POSITIVE, 16.0 * MIN_POSITIVE),
    ] {
        let start = Start { p: q, y, q: Some(q), ..Start::default() };
        let state = model.start(&start).unwrap().state;
        assert_eq!((state.q, state.p), (imposed, imposed), "{y:e} {q:e}");
    }
}
