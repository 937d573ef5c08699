//! Starts whose guard has a crest at a chosen time and height, from the plain closed forms.
//!
//! The functions of libm are the same on every machine, so that the starts are, to the last bit.
//! The crest's height is met to some roundings of the guard's terms.

use libm::{cos, exp, sin};
use percuss::{Parameters, Start};

/// The crest of a guard for which a start is planted.
#[derive(Clone, Copy, Debug)]
pub struct Crest {
    /// The time from the start, at the angle phi, to the crest.
    pub elapsed: f64,
    /// The height of the crest above the guard's threshold.
    pub above: f64,
}

fn start(parameters: &Parameters, p: f64, y: f64, q: f64) -> Start {
    let gap = q + parameters.g - p;
    // Rounding must not put the mass inside the slider.
    let p = if gap < 0.0 { q + parameters.g } else { p };
    Start { p, y, q: Some(q), ..Start::default() }
}

/// The harmonic force's parts in the velocity and the displacement after a time d.
fn harmonic(parameters: &Parameters, d: f64) -> (f64, f64) {
    let Parameters { a, omega, phi, .. } = *parameters;
    let impulse = (a / omega) * (sin(omega * d + phi) - sin(phi));
    let displacement =
        (a / (omega * omega)) * (cos(phi) - omega * d * sin(phi) - cos(omega * d + phi));
    (impulse, displacement)
}

/// A flight from a slider at q: h = p0 - g - q exp(-d/(2 xi)) + y0 d + b d^2/2 + (a/omega^2)
/// (cos phi - omega d sin phi - cos(omega d + phi)).
pub fn flight(parameters: &Parameters, q: f64, crest: Crest) -> Start {
    let Parameters { b, xi, g, .. } = *parameters;
    let (d, rate) = (crest.elapsed, 0.5 / xi);
    let lag = q * exp(-rate * d);
    let (impulse, displacement) = harmonic(parameters, d);
    let y = -(b * d + impulse + rate * lag);
    let p = crest.above + g + lag - y * d - 0.5 * b * d * d - displacement;
    start(parameters, p, y, q)
}

/// A contact, under-damped, whose trial force f is highest at 1 or, with `falls`, lowest at 0:
/// f'' + 2 xi f' + f = F + 2 xi F'.
pub fn contact(parameters: &Parameters, falls: bool, crest: Crest) -> Start {
    let Parameters { a, b, xi, omega, g, phi } = *parameters;
    let d = crest.elapsed;
    // The forced part is the real part of a (1 + 2 i xi omega)/(1 - omega^2 + 2 i xi omega)
    // exp(i (omega d + phi)).
    let (pull, lag) = (1.0 - omega * omega, 2.0 * xi * omega);
    let size = pull * pull + lag * lag;
    let (re, im) = (a * (pull + lag * lag) / size, a * lag * (pull - 1.0) / size);
    let forced = |d: f64| {
        let (s, c) = (sin(omega * d + phi), cos(omega * d + phi));
        (b + re * c - im * s, -omega * (re * s + im * c))
    };
    let threshold = if falls { -crest.above } else { 1.0 + crest.above };
    let (level, rate) = forced(d);
    let (x, x_rate) = (threshold - level, -rate);
    // The free part, backwards from the crest.
    let nu = (1.0 - xi * xi).sqrt();
    let quadrature = (x_rate + xi * x) / nu;
    let (s, c) = (sin(nu * d), cos(nu * d));
    let (free, free_quadrature) = (x * c - quadrature * s, x * s + quadrature * c);
    let (level, rate) = forced(0.0);
    let force = level + exp(xi * d) * free;
    let force_rate = rate + exp(xi * d) * (nu * free_quadrature - xi * free);
    let y = force_rate - 2.0 * xi * (b + a * cos(phi) - force);
    let q = force - 2.0 * xi * y;
    start(parameters, q + g, y, q)
}

/// A progression of a slider whose velocity is `closing` at the start, and the static force with
/// which its drift velocity w = y - q' is lowest at 0 at the crest.
pub fn slip(parameters: &Parameters, closing: f64, crest: Crest) -> (Parameters, Start) {
    let Parameters { a, xi, omega, phi, g, .. } = *parameters;
    let (d, rate) = (crest.elapsed, 0.5 / xi);
    let lag = closing * exp(-rate * d);
    // w' = F - 1 + q'/(2 xi) vanishes at the crest.
    let b = 1.0 - a * cos(omega * d + phi) - rate * lag;
    let (impulse, _) = harmonic(parameters, d);
    let y = lag - crest.above - (b - 1.0) * d - impulse;
    let q = 1.0 - 2.0 * xi * closing;
    let parameters = Parameters { b, ..*parameters };
    (parameters, start(&parameters, q + g, y, q))
}

/// A flight off the surface, the slider's q0 = -2 xi y0, and the static force with which h is
/// highest at its threshold at the crest: h = y0 2 xi (exp(-z) - 1 + z) + b d^2/2 + (a/omega^2)
/// (cos phi - omega d sin phi - cos(omega d + phi)) with z = d/(2 xi).
pub fn flight_from_surface(parameters: &Parameters, crest: Crest) -> (Parameters, Start) {
    let Parameters { xi, g, .. } = *parameters;
    let d = crest.elapsed;
    let z = 0.5 * d / xi;
    let (sink, sink_rate) = (2.0 * xi * (exp(-z) - 1.0 + z), 1.0 - exp(-z));
    let (lift, lift_rate) = (0.5 * d * d, d);
    let (forced_rate, forced) = harmonic(parameters, d);
    // h = above and h' = 0 in y0 and b.
    let determinant = sink * lift_rate - lift * sink_rate;
    let y = ((crest.above - forced) * lift_rate + lift * forced_rate) / determinant;
    let b = (-sink * forced_rate - sink_rate * (crest.above - forced)) / determinant;
    let q = -2.0 * xi * y;
    let parameters = Parameters { b, ..*parameters };
    (parameters, start(&parameters, q + g, y, q))
}
