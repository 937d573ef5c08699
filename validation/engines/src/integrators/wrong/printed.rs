//! Eqs. (15) to (17) as printed: beta and delta by an arctangent, which loses their quadrant.

use percuss::Parameters;

/// y and q a time `d` after a contact began at (y0, q0) and the forcing angle `then`, xi < 1.
pub(super) fn contact(parameters: &Parameters, then: f64, [y0, q0]: [f64; 2], d: f64) -> [f64; 2] {
    let Parameters { a, b, xi, omega, .. } = *parameters;
    let nu = (1.0 - xi * xi).sqrt();
    let resonance = ((1.0 - omega * omega).powi(2) + 4.0 * xi * xi * omega * omega).sqrt();
    let steady = a / resonance;
    let alpha = ((1.0 - omega * omega) / (2.0 * xi * omega)).atan();
    let gamma = (omega / xi).atan();
    let c1 = q0 - b - steady * (then + alpha).sin();
    let swing = steady * (xi * xi + omega * omega).sqrt() * (then + alpha + gamma).sin();
    let c2 = (y0 + xi * (q0 - b) - swing) / nu;
    let beta = (c1 / c2).atan();
    let delta = ((nu * c2 - xi * c1) / (-nu * c1 - xi * c2)).atan();
    let now = then + omega * d;
    let free = (-xi * d).exp() * c1.hypot(c2);
    [
        free * (nu * d + delta).sin() + steady * omega * (now + alpha).cos(),
        b + free * (nu * d + beta).sin() + steady * (now + alpha).sin(),
    ]
}
