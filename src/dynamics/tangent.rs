//! A small error and a small area, carried along the motion.
//!
//! Where the mass is on the slider p and q move as one, and errors form a plane. An area in it is
//! measured as dp ^ dy; in flight, which shears p by y, that measure does not change at all. So an
//! area changes on the slider, by the divergence of the field, and at impacts (see
//! [`super::lyapunov`]). Both may shrink by more than an f64 can hold, which is why logarithms are
//! kept: of a phase on the slider exactly, from its duration.

use crate::model::Model;
use crate::model::entry::Motion;
use crate::run::trajectory::Segment;
use crate::run::variation::{Matrix, P, Q, Y};

/// A contact is passed in pieces in which its slowest part shrinks by at most
/// exp(-MAX_DECAY_TIMES).
const MAX_DECAY_TIMES: f64 = 300.0;

/// Errors of (p, y, q), and the areas dp^dy, dp^dq and dy^dq of a pair of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct TangentVector {
    direction: [f64; 3],
    area: [f64; 3],
    /// Logarithm of the length's growth.
    pub length: f64,
    /// Logarithm of the area's growth.
    pub size: f64,
    two_xi: f64,
    slowest: f64,
}

/// The areas dp ^ dy, dp ^ dq and dy ^ dq of a motion on the slider, where dp = dq and one dp ^ dy
/// is left.
const SLIDER_AREA: [f64; 3] = [1.0, 0.0, -1.0];

impl TangentVector {
    /// Errors as a separation leaves them: with dp = dq.
    pub fn new(model: &Model) -> Self {
        let xi = model.parameters().xi;
        let [_, slowest] = contact_rates(xi);
        Self {
            // No direction that the motion could have a reason to prefer.
            direction: [0.6, 0.52, 0.6],
            area: SLIDER_AREA,
            length: 0.0,
            size: 0.0,
            two_xi: 2.0 * xi,
            slowest,
        }
    }

    /// Carries both vectors on by a time `elapsed` inside a phase.
    pub fn flow(&mut self, segment: &Segment, elapsed: f64) {
        match segment.motion() {
            Motion::NoContact(_) => {
                let variation = segment.variation(elapsed);
                self.turn(&variation);
                self.area = wedge(&variation, self.area);
            }
            Motion::Contact(_) => {
                let pieces = (elapsed * self.slowest / MAX_DECAY_TIMES).ceil().max(1.0);
                let variation = segment.variation(elapsed / pieces);
                for _ in 0..pieces as u64 {
                    self.turn(&variation);
                    self.stay_on_slider();
                }
                self.size -= self.two_xi * elapsed;
            }
            Motion::Progression(_) => {
                self.turn(&segment.variation(elapsed));
                self.stay_on_slider();
                self.size -= elapsed / self.two_xi;
            }
        }
    }

    /// Carries both vectors over the event that ends a phase.
    pub fn switch(&mut self, segment: &Segment) {
        if !matches!(segment.motion(), Motion::NoContact(_)) {
            return;
        }
        let saltation = segment.saltation();
        self.turn(&saltation);
        self.stay_on_slider();
        let [area, ..] = wedge(&saltation, self.area);
        self.size += libm::log(area.abs());
        self.area = SLIDER_AREA;
    }

    fn turn(&mut self, derivative: &Matrix) {
        let [p, y, q] = self.direction;
        let image = [P, Y, Q]
            .map(|row| derivative[row][P] * p + derivative[row][Y] * y + derivative[row][Q] * q);
        let [p, y, q] = image;
        let length = libm::hypot(libm::hypot(p, y), q);
        self.length += libm::log(length);
        // An error that has vanished altogether stays where it was: its logarithm tells.
        if length > 0.0 {
            self.direction = image.map(|part| part / length);
        }
    }

    /// What rounding separates.
    fn stay_on_slider(&mut self) {
        self.direction[0] = self.direction[2];
    }
}

/// The areas dp^dy, dp^dq, dy^dq after a derivative.
fn wedge(derivative: &Matrix, area: [f64; 3]) -> [f64; 3] {
    const COORDINATE_PAIRS: [(usize, usize); 3] = [(P, Y), (P, Q), (Y, Q)];
    COORDINATE_PAIRS.map(|(i, j)| {
        let minor = |(k, l): (usize, usize)| {
            derivative[i][k] * derivative[j][l] - derivative[i][l] * derivative[j][k]
        };
        COORDINATE_PAIRS.into_iter().zip(area).map(|(columns, size)| minor(columns) * size).sum()
    })
}

/// The rates at which the two parts of a free contact die out, the faster first.
pub(super) fn contact_rates(xi: f64) -> [f64; 2] {
    if xi <= 1.0 {
        [xi, xi]
    } else {
        let fast = xi + ((xi - 1.0) * (xi + 1.0)).sqrt();
        [fast, 1.0 / fast]
    }
}
