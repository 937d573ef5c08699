//! The closed forms in f64 against the same forms in 106 bits: how many digits each regime keeps.
//!
//! `cargo test --release --test library closed_forms:: -- --nocapture` prints the constant of every
//! regime.

use crate::support::draws::{Pair, REGIMES};
use crate::support::random::Draw;
use percuss::affine::DoubleDouble;
use percuss::insides::Constants;
use percuss::insides::flow::Point;
use percuss::insides::flow::damped::Damping;
use percuss::number::Number;
use percuss::{Phase, State};

/// Phases drawn from each regime.
const DRAWS: usize = 40_000;

/// Allowed error of a state in units of eps (1 + |value|) times the growth of an entry's error, for
/// phases up to one forcing period: the project's own bound.
const STATE_EPS: f64 = 10.0;

/// Allowed error of a guard, and of the coefficients of its certificates, in eps of its largest
/// term: what the search sets aside (`crossing::slack`) for three roundings in the guard
/// and one in the coefficients.
const SLACK_EPS: f64 = 4.0;

const PHASES: [Phase; 3] = [Phase::NoContact, Phase::Contact, Phase::Progression];

fn error(found: f64, exact: DoubleDouble) -> f64 {
    (DoubleDouble::exact(found) - exact).to_f64().abs() / f64::EPSILON
}

/// How much errors of the entry state and of the forcing angle grow (the growth of one
/// phase): the norm of the gradient of p, y, q and v, at least 1.
///
/// The forms are linear in sine and cosine of the angle, so its share is a difference of two
/// values. An entry velocity grows in p without contact and in v in progression by the elapsed
/// time.
fn growth(pair: &Pair) -> [f64; 4] {
    let turned = values(&pair.rounded.with_angle(|angle| (angle.cos, -angle.sin)).at(pair.elapsed));
    let unforced = values(&pair.rounded.with_angle(|_| (0.0, 0.0)).at(pair.elapsed));
    let travel = match pair.rounded.phase() {
        Phase::NoContact => [pair.elapsed, 0.0, 0.0, 0.0],
        Phase::Contact => [0.0; 4],
        Phase::Progression => [0.0, 0.0, 0.0, pair.elapsed],
    };
    std::array::from_fn(|k| travel[k].hypot(turned[k] - unforced[k]).hypot(1.0))
}

fn values<T: Number>(point: &Point<T>) -> [T; 4] {
    let State { p, y, q } = point.state;
    [p, y, q, point.drift]
}

/// The unit of a state's errors: (1 + |value|) times growth.
///
/// In a contact both are those of the moment. Without contact and in progression p, y and v may
/// have been far away in the meantime (they have a quadratic and a linear part, and at omega = 0.01
/// reach thousands and return), and the sum keeps the roundings made there: the largest so far
/// counts. Nor can y be better than its linear part, which the harmonic may cancel at every moment.
fn scale(pair: &Pair) -> [f64; 4] {
    const PLACES: u32 = 16;
    let first = if pair.rounded.phase() == Phase::Contact { PLACES } else { 0 };
    let static_force = match pair.rounded.phase() {
        Phase::NoContact => pair.rounded.constants().b,
        Phase::Contact => 0.0,
        Phase::Progression => pair.rounded.constants().b - 1.0,
    };
    let mut scale = [0.0_f64; 4];
    scale[1] = 1.0 + (static_force * pair.elapsed).abs();
    for k in first..=PLACES {
        let elapsed = pair.elapsed * f64::from(k) / f64::from(PLACES);
        let earlier = Pair { elapsed, ..*pair };
        let (values, growth) = (values(&pair.rounded.at(elapsed)), growth(&earlier));
        for n in 0..4 {
            scale[n] = scale[n].max((1.0 + values[n].abs()) * growth[n]);
        }
    }
    scale
}

fn state_error(pair: &Pair) -> f64 {
    let (rounded, exact) = evaluate(pair);
    let (found, truth, scale) = (values(&rounded), values(&exact), scale(pair));
    (0..4).map(|k| error(found[k], truth[k]) / scale[k]).fold(0.0, f64::max)
}

/// The largest in a set of draws, with the draw that gave it.
#[derive(Default)]
struct Worst {
    value: f64,
    at: Option<Pair>,
}

impl Worst {
    fn see(&mut self, value: f64, pair: &Pair) {
        if value > self.value || value.is_nan() {
            *self = Self { value, at: Some(*pair) };
        }
    }

    fn hold(&self, bound: f64, what: &str, phase: Phase, regime: &str) {
        println!("{phase}, {regime}: {what} {:.2} eps", self.value);
        assert!(self.value <= bound, "{what} {} eps at {:?}", self.value, self.at);
    }
}

fn evaluate(pair: &Pair) -> (Point<f64>, Point<DoubleDouble>) {
    (pair.rounded.at(pair.elapsed), pair.exact.at(DoubleDouble::exact(pair.elapsed)))
}

#[test]
fn states_keep_their_digits() {
    let mut draw = Draw(3);
    for phase in PHASES {
        for regime in &REGIMES {
            let mut worst = Worst::default();
            for _ in 0..DRAWS {
                let pair = regime.pair(phase, &mut draw).while_it_lasts();
                worst.see(state_error(&pair), &pair);
            }
            worst.hold(STATE_EPS, "state", phase, regime.name);
        }
    }
}

/// The search counts on this: a guard's rounding error is within the slack that its largest term
/// buys.
#[test]
fn largest_term_bounds_the_rounding_of_the_guard() {
    let mut draw = Draw(4);
    for phase in PHASES {
        for regime in &REGIMES {
            let mut worst = Worst::default();
            for _ in 0..DRAWS {
                let pair = regime.pair(phase, &mut draw);
                let (rounded, exact) = evaluate(&pair);
                let error = error(rounded.guard.orders[0], exact.guard.orders[0]);
                worst.see(error / rounded.guard.largest_term, &pair);
            }
            worst.hold(SLACK_EPS, "guard", phase, regime.name);
        }
    }
}

/// Bernstein coefficients of degree eight of the interpolant next to one end
/// (`crossing::certificate`).
fn coefficients<T: Number>(orders: &[T; 4], length: T) -> [T; 4] {
    let [value, first, second, third] = *orders;
    let seventh = |n: f64, term: T, d: f64| term * T::exact(n) / T::exact(d);
    let (first, second, third) =
        (first * length, second * length * length, third * length * length * length);
    [
        value,
        value + seventh(1.0, first, 8.0),
        value + seventh(2.0, first, 8.0) + seventh(1.0, second, 56.0),
        value + seventh(3.0, first, 8.0) + seventh(3.0, second, 56.0) + seventh(1.0, third, 336.0),
    ]
}

/// A piece that certificates use: a few of the fastest times at most; and in contact any that is
/// short against the forcing, once what is fast has died out.
fn piece(pair: &Pair, draw: &mut Draw) -> (f64, f64) {
    let constants = pair.rounded.constants();
    let contact = pair.rounded.phase() == Phase::Contact;
    let fastest = if contact { constants.two_xi.max(1.0) } else { constants.rate };
    let length = pair.elapsed.min(4.0 / constants.omega.max(fastest));
    if draw.once_in(2) {
        return (0.0, length);
    }
    let slowest = if constants.xi > 1.0 { 1.0 / constants.two_xi } else { constants.xi };
    let calm = pair.elapsed - 40.0 / slowest;
    if contact && calm > length {
        let length = draw.decades(length, calm.min(4.0 / constants.omega).max(length));
        return (pair.elapsed - length, pair.elapsed);
    }
    (pair.elapsed - length, pair.elapsed)
}

/// What the rounding of a piece's coefficients may be, in eps of the largest term: more in long
/// pieces of contact, in which each derivative repeats the rounding of the one below it
/// (`Contact::room`).
fn allowed_rounding(pair: &Pair, left: f64, length: f64) -> f64 {
    let Constants { omega, two_xi, damping, .. } = *pair.rounded.constants();
    let rate = match damping {
        Damping::Over { fast, slow, .. } if fast * left > 1.0 => slow.max(omega),
        _ => two_xi.max(1.0),
    };
    let reach = length * rate;
    if pair.rounded.phase() != Phase::Contact || reach <= 4.0 {
        return SLACK_EPS;
    }
    SLACK_EPS + 3.0 / 8.0 * reach + 3.0 / 56.0 * reach.powi(2) + reach.powi(3) / 336.0
}

/// And on this: so are the coefficients of its certificates, which add the derivatives' errors.
#[test]
fn largest_term_bounds_the_rounding_of_the_coefficients() {
    let mut draw = Draw(5);
    for phase in PHASES {
        for regime in &REGIMES {
            let mut worst = Worst::default();
            for _ in 0..DRAWS {
                let pair = regime.pair(phase, &mut draw);
                let (left, right) = piece(&pair, &mut draw);
                let at = |d: f64| (pair.rounded.at(d), pair.exact.at(DoubleDouble::exact(d)));
                let ((left, exact_left), (right, exact_right)) = (at(left), at(right));
                let length = right.elapsed - left.elapsed;
                let largest = left.guard.largest_term.max(right.guard.largest_term);
                let ends = [(left, exact_left, length), (right, exact_right, -length)];
                let mut greatest = 0.0_f64;
                let mut size = 0.0_f64;
                for (rounded, exact, length) in ends {
                    let found = coefficients(&rounded.guard.orders, length);
                    let exact = coefficients(&exact.guard.orders, DoubleDouble::exact(length));
                    for (found, exact) in found.into_iter().zip(exact) {
                        greatest = greatest.max(error(found, exact));
                        size = size.max(found.abs());
                    }
                }
                // The certificate adds one eps of the largest coefficient.
                let rounding = (greatest - size).max(0.0) / largest;
                worst.see(rounding / allowed_rounding(&pair, left.elapsed, length), &pair);
            }
            worst.hold(1.0, "share of the room", phase, regime.name);
        }
    }
}
