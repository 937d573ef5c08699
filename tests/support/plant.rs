//! Guards written down a second time, and the question whether a claimed first crossing is one.

use super::original::Equations;
use percuss::{Exit, Parameters, Phase, Segment};
use proptest::test_runner::TestCaseError;

/// Roundings of the plain formulas below, of the planted data and of the solver together, in eps
/// times the sum of the guard's terms: each of the three makes at most five.
pub const ROUNDINGS: f64 = 16.0;

/// A guard's excess (negative inside), its slope, and the sum of the sizes of its terms.
#[derive(Clone, Copy, Debug)]
pub struct Guard {
    pub excess: f64,
    pub slope: f64,
    pub size: f64,
}

impl Guard {
    /// The size below which the excess is rounding.
    pub fn noise(&self) -> f64 {
        ROUNDINGS * f64::EPSILON * self.size
    }
}

/// cos x - 1 and sin x - x, by their series where they would cancel.
fn remainders(x: f64) -> (f64, f64) {
    if x.abs() > 1.0 {
        return (-2.0 * (0.5 * x).sin().powi(2), x.sin() - x);
    }
    let (mut cosine, mut sine, mut term) = (0.0, 0.0, 1.0);
    for k in 1..24 {
        term *= x / f64::from(k);
        match k % 4 {
            2 => cosine -= term,
            3 => sine -= term,
            0 => cosine += term,
            1 if k > 1 => sine += term,
            _ => {}
        }
    }
    (cosine, sine)
}

/// exp(-z) - 1 + z
fn relaxation(z: f64) -> f64 {
    if z > 0.5 {
        return (-z).exp_m1() + z;
    }
    let (mut sum, mut term) = (0.0, -z);
    for k in 2..24 {
        term *= -z / f64::from(k);
        sum += term;
    }
    sum
}

/// The harmonic force and its first and second integral over d for unit amplitude, with the sizes
/// of their terms.
pub struct Harmonic {
    pub force: f64,
    pub impulse: [f64; 2],
    pub displacement: [f64; 2],
}

pub fn harmonic(p: &Parameters, d: f64) -> Harmonic {
    let omega = p.omega;
    let (s, c) = p.phi.sin_cos();
    let angle = omega * d;
    let (cos_less_1, sin_less_x) = remainders(angle);
    // What the product's rounding took, to first order.
    let low = omega.mul_add(d, -angle);
    let sin = angle.sin() + low * (1.0 + cos_less_1);
    let cos_less_1 = cos_less_1 - low * sin;
    let sin_less_x = sin_less_x + low * cos_less_1;
    let impulse = (s * cos_less_1 + c * sin) / omega;
    let displacement = -(c * cos_less_1 - s * sin_less_x) / (omega * omega);
    Harmonic {
        force: c + (c * cos_less_1 - s * sin),
        impulse: [impulse, (sin.abs() - cos_less_1) / omega],
        displacement: [displacement, (sin_less_x.abs() - cos_less_1) / (omega * omega)],
    }
}

/// h of a flight from p, y, q with the mass away from the slider.
pub fn flight(p: &Parameters, [p0, y0, q0]: [f64; 3], d: f64) -> Guard {
    let rate = 0.5 / p.xi;
    let Harmonic { impulse, displacement, .. } = harmonic(p, d);
    let lag = q0 * (-rate * d).exp();
    let lift = 0.5 * p.b * d * d;
    let start = (p0 - p.g) - lag;
    Guard {
        excess: start + (y0 * d + (lift + p.a * displacement[0])),
        slope: y0 + p.b * d + p.a * impulse[0] + rate * lag,
        size: p0.abs() + p.g + q0.abs() + (y0 * d).abs() + lift.abs() + p.a * displacement[1],
    }
}

/// h of a flight after separation at velocity y0, in units that do not cancel.
pub fn flight_from_surface(p: &Parameters, y0: f64, d: f64) -> Guard {
    let rate = 0.5 / p.xi;
    let Harmonic { impulse, displacement, .. } = harmonic(p, d);
    let sink = 2.0 * p.xi * y0 * relaxation(rate * d);
    let lift = 0.5 * p.b * d * d;
    Guard {
        excess: sink + lift + p.a * displacement[0],
        slope: -y0 * (-rate * d).exp_m1() + p.b * d + p.a * impulse[0],
        size: sink.abs() + lift.abs() + p.a * displacement[1],
    }
}

/// -w of a progression from y, q.
pub fn slip(p: &Parameters, [y0, q0]: [f64; 2], d: f64) -> Guard {
    let rate = 0.5 / p.xi;
    let Harmonic { force, impulse, .. } = harmonic(p, d);
    let closing = (1.0 - q0) * rate;
    let lag = closing * (-rate * d).exp();
    let push = (p.b - 1.0) * d;
    Guard {
        excess: lag - (y0 + (push + p.a * impulse[0])),
        slope: -(p.b - 1.0 + p.a * force + rate * lag),
        // The start's force 2 xi y + q is known to an eps of 1, the drift velocity to 1/(2 xi)
        // more.
        size: y0.abs() + (1.0 + q0.abs()) * rate + push.abs() + p.a * impulse[1],
    }
}

/// Whether f of a contact counts against 1 or against 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Side {
    Rises,
    Falls,
}

/// f of a contact from y, q, by integration; `None` for the nearer threshold.
pub fn contact(p: &Parameters, [y0, q0]: [f64; 2], d: f64, side: Option<Side>) -> Guard {
    let equations = Equations { phase: Phase::Contact, parameters: *p };
    let [_, y, q, _] = equations.integrate(p.phi, [0.0, y0, q0, 0.0], d);
    let two_xi = 2.0 * p.xi;
    let f = two_xi * y + q;
    let rate = two_xi * (p.b + p.a * harmonic(p, d).force - f) + y;
    let side = side.unwrap_or(if f >= 0.5 { Side::Rises } else { Side::Falls });
    let (excess, slope) = if side == Side::Rises { (f - 1.0, rate) } else { (-f, -rate) };
    // Errors of the integration: an eps of the largest part per step, added up as a random walk.
    let parts = two_xi * y.abs().max(y0.abs()) + q0.abs() + p.b.abs() + 1.0;
    let size = parts * (1.0 + equations.steps(d).sqrt());
    Guard { excess, slope, size }
}

/// Whether the solver found what was planted, or something earlier that is a crossing too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finding {
    Recovered,
    Earlier,
    Later,
}

fn fail(message: String) -> TestCaseError {
    TestCaseError::fail(message)
}

/// Holds a segment against its guard: no sample before its end is outside, its end is a crossing,
/// and its duration is right to (noise of the guard)/slope.
pub fn examine(
    segment: &Segment,
    guard: impl Fn(f64) -> Guard,
    planted: f64,
    samples: u32,
) -> Result<Finding, TestCaseError> {
    let found = segment.duration();
    if found.is_nan() || found < 0.0 {
        return Err(fail(format!("duration {found}")));
    }
    let until = if found.is_finite() { found } else { 3.0 * planted };
    let even = (1..samples).map(|k| until * f64::from(k) / f64::from(samples));
    let graded = (1..samples / 4).map(|k| until * 0.5_f64.powi(k as i32));
    for d in even.chain(graded) {
        let at = guard(d);
        if at.excess > at.noise() {
            return Err(fail(format!("outside at {d:e} before the end at {found:e}: {at:?}")));
        }
    }
    if !matches!(segment.exit(), Exit::Switch(_)) {
        return Ok(Finding::Later);
    }
    let end = guard(found);
    // A time is known to an eps of itself, and the crossing to noise/slope: together in the excess.
    let clock = 2.0 * f64::EPSILON * found * end.slope.abs();
    if end.excess.abs() > end.noise() + clock {
        return Err(fail(format!(
            "no crossing at the end {found:e} (planted {planted:e}): {end:?}"
        )));
    }
    let goal = guard(planted);
    let room = 2.0 * goal.noise() / goal.slope + 4.0 * f64::EPSILON * planted;
    if goal.slope > 0.0 && (found - planted).abs() <= room {
        return Ok(Finding::Recovered);
    }
    Ok(if found < planted { Finding::Earlier } else { Finding::Later })
}

/// Whether a crossing is too steep to be a graze: its parabola's crest outside the noise.
pub fn is_steep(at: &Guard, bend: f64) -> bool {
    at.slope * at.slope > 8.0 * at.noise() * bend
}
