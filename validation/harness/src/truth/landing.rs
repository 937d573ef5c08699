//! The next phase at an event, and the first phase of a run, with the known values imposed.

use super::DoubleDouble;
use super::forms::{TruthEntry, TruthForms, TruthMotion};
use percuss::insides::flow::Point;
use percuss::number::Number;
use percuss::{Entry, Phase, State};

/// A decision closer than this, in units of the terms it is made from, is not taken. A million
/// times the unit of 106 bits times the growth of a long run is below it, and that a run meets it
/// by chance has a probability of about 1e-18 an event.
pub(super) const DECISION_TOLERANCE: f64 = 1e-18;

/// The rule of the f64 starts: within four units in the last place counts as on the surface or on a
/// threshold, and is then imposed exactly.
const FOUR_ULPS: f64 = 4.0 * f64::EPSILON;

impl TruthForms {
    /// A start of the phase of `entry`, its state taken exactly but for what that phase imposes.
    pub(super) fn start(
        &self,
        entry: &Entry,
        [p, y, q]: [DoubleDouble; 3],
    ) -> (State<DoubleDouble>, TruthEntry<DoubleDouble>) {
        let (one, zero) = (DoubleDouble::one(), DoubleDouble::zero());
        let (g, rate, damper) = (self.constants.g, self.constants.rate, self.constants.two_xi * y);
        let size = |x: DoubleDouble| x.abs().to_f64();
        let largest = size(p).max(size(q)).max(size(g));
        let phase = entry.phase();
        if phase == Phase::NoContact && size(p - q - g) > FOUR_ULPS * largest {
            return (State { p, y, q }, TruthEntry::Apart);
        }
        let f = damper + q;
        let largest = size(damper).max(size(q));
        let threshold = if size(f) <= FOUR_ULPS * largest {
            Some(zero)
        } else {
            (size(f - one) <= FOUR_ULPS * largest.max(1.0)).then_some(one)
        };
        let q = threshold.map_or(q, |threshold| threshold - damper);
        let mode = match (phase, threshold) {
            (Phase::NoContact, Some(_)) => TruthEntry::Surface { h_rate: zero },
            (Phase::NoContact, None) => TruthEntry::Surface { h_rate: f * rate },
            (Phase::Contact, Some(reference)) => TruthEntry::Contact { offset: zero, reference },
            (Phase::Contact, None) => TruthEntry::Contact { offset: f, reference: zero },
            (Phase::Progression, Some(_)) => {
                TruthEntry::Progression { drift_rate: zero, closing: y }
            }
            (Phase::Progression, None) => {
                TruthEntry::Progression { drift_rate: (f - one) * rate, closing: (one - q) * rate }
            }
        };
        (State { p: q + g, y, q }, mode)
    }

    /// What begins at the crossing `at` that ends `motion`; `None` if an impact's force is too near
    /// the threshold to be told from it.
    pub(super) fn landing(
        &self,
        motion: &TruthMotion<DoubleDouble>,
        at: &Point<DoubleDouble>,
        rises: bool,
    ) -> Option<(State<DoubleDouble>, TruthEntry<DoubleDouble>)> {
        let (one, zero) = (DoubleDouble::one(), DoubleDouble::zero());
        let (g, rate, two_xi) = (self.constants.g, self.constants.rate, self.constants.two_xi);
        let on_surface = |y: DoubleDouble, q: DoubleDouble| State { p: q + g, y, q };
        Some(match motion {
            TruthMotion::NoContact(_) => {
                let State { y, q, .. } = at.state;
                let f = two_xi * at.guard.orders[1];
                let excess = f - one;
                if excess.to_f64().abs() <= DECISION_TOLERANCE {
                    return None;
                }
                let mode = if excess > zero {
                    TruthEntry::Progression { drift_rate: excess * rate, closing: (one - q) * rate }
                } else {
                    TruthEntry::Contact { offset: f, reference: zero }
                };
                (on_surface(y, q), mode)
            }
            TruthMotion::Contact(_) if rises => {
                let y = at.state.y;
                let mode = TruthEntry::Progression { drift_rate: zero, closing: y };
                (on_surface(y, one - two_xi * y), mode)
            }
            TruthMotion::Contact(_) => {
                let y = at.state.y;
                (on_surface(y, -(two_xi * y)), TruthEntry::Surface { h_rate: zero })
            }
            TruthMotion::Progression(_) => {
                let y = at.slider_velocity;
                let mode = TruthEntry::Contact { offset: zero, reference: one };
                (on_surface(y, one - two_xi * y), mode)
            }
        })
    }
}
