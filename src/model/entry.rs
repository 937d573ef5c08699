//! How a phase begins: its instant and state (a row of Table 1), which phase it is, and its motion.
//!
//! Where the mass meets the slider the trial force decides, then its derivatives: f = 2 xi y + q at
//! the thresholds 0 and 1 is decided by the first derivative that is not zero. As the contact sees
//! it f' = 2 xi (F - f) + y, f'' = 2 xi (F' - f') + F - f; the other phases' guards have these
//! derivatives divided by 2 xi, so the two sides cannot contradict each other.

use crate::crossing::allowances::FOUR_ULPS;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::phase::Phase;
use crate::state::State;

/// The state and the instant at which a phase begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The instant of the entry.
    pub instant: Instant,
    /// Bounded co-ordinates.
    pub state: State,
    /// Displacement of the slider's bottom, v, in two words: it grows without bound by small steps.
    pub drift: TwoWord,
    pub(crate) mode: ModeEntry,
}

/// How a phase begins: its kind, and what is known exactly at that instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ModeEntry {
    /// No contact, the mass away from the slider: only ever at a start.
    Apart,
    /// No contact, on the surface with this rate of h; zero at a separation.
    Separation { h_rate: f64 },
    /// Contact with trial force `reference + offset`.
    Contact { offset: f64, reference: f64 },
    /// Progression with this drift velocity and velocity of the slider's top.
    Progression { drift_rate: f64, closing: f64 },
}

impl Entry {
    /// The phase that begins.
    #[must_use]
    pub fn phase(&self) -> Phase {
        match self.mode {
            ModeEntry::Apart | ModeEntry::Separation { .. } => Phase::NoContact,
            ModeEntry::Contact { .. } => Phase::Contact,
            ModeEntry::Progression { .. } => Phase::Progression,
        }
    }

    /// The bounded co-ordinates in the order (p, y, q).
    #[must_use]
    pub const fn point(&self) -> [f64; 3] {
        let State { p, y, q } = self.state;
        [p, y, q]
    }

    /// Drift v, rounded to one word.
    #[must_use]
    pub fn v(&self) -> f64 {
        self.drift.value()
    }
}

impl ModeEntry {
    /// The state with its force imposed where it lies on a threshold, and the phase that begins.
    ///
    /// `force` is the harmonic force with its first two derivatives; `f` is the trial force if it
    /// is known better than as 2 xi y + q.
    #[inline(always)]
    pub(crate) fn on_surface(
        constants: &Constants<f64>,
        State { y, q, .. }: State,
        f: Option<f64>,
        force: [f64; 3],
    ) -> (State, Self) {
        let Constants { two_xi, g, rate, .. } = *constants;
        let (damper, spring) = (two_xi * y, q);
        let largest = damper.abs().max(spring.abs());
        let f = f.unwrap_or(damper + spring);
        let at = |q: f64| State { p: q + g, y, q };
        let imposed = |threshold: f64, q: f64| {
            let state = at(q);
            (state, Self::on_threshold(constants, &state, threshold, force))
        };
        if f.abs() <= FOUR_ULPS * largest {
            return imposed(0.0, -damper);
        }
        if (f - 1.0).abs() <= FOUR_ULPS * largest.max(1.0) {
            return imposed(1.0, 1.0 - damper);
        }
        let state = at(q);
        if f < 0.0 {
            let h_rate = f * rate;
            // A force whose speed underflows is known only to be at the threshold.
            if h_rate == 0.0 { imposed(0.0, -damper) } else { (state, Self::Separation { h_rate }) }
        } else if f < 1.0 {
            (state, Self::Contact { offset: f, reference: 0.0 })
        } else {
            match Self::slipping(constants, &state) {
                // What is known of f and the state are rounded apart: where the state does not
                // slip, f is within rounding of the threshold.
                Self::Progression { drift_rate, .. } if drift_rate <= 0.0 => {
                    imposed(1.0, 1.0 - damper)
                }
                mode => (state, mode),
            }
        }
    }

    /// A progression under way. Its drift velocity is y - q' and not (f - 1)/(2 xi), which would
    /// carry 1/(2 xi) times the rounding of f: 1 - q is exact where the slider is nearly
    /// compressed. It must be that of the state after an impact too, although f is known by itself
    /// there: the closed form goes by the drift velocity at first and by y later, and would jump
    /// where it changes over.
    pub(crate) fn slipping(constants: &Constants<f64>, state: &State) -> Self {
        let closing = (1.0 - state.q) * constants.rate;
        Self::Progression { drift_rate: state.y - closing, closing }
    }

    /// Which phase begins where the trial force is at a threshold, 0 or 1, computed or stated: its
    /// derivatives decide. A phase stated against them would have no length.
    pub(crate) fn on_threshold(
        constants: &Constants<f64>,
        state: &State,
        threshold: f64,
        force: [f64; 3],
    ) -> Self {
        let direction = first_derivative_off_zero(constants, state.y, threshold, force);
        if threshold == 0.0 { at_zero(direction) } else { at_one(direction, state.y) }
    }
}

fn at_zero(direction: f64) -> ModeEntry {
    if direction < 0.0 {
        ModeEntry::Separation { h_rate: 0.0 }
    } else {
        ModeEntry::Contact { offset: 0.0, reference: 0.0 }
    }
}

fn at_one(direction: f64, y: f64) -> ModeEntry {
    if direction > 0.0 {
        ModeEntry::Progression { drift_rate: 0.0, closing: y }
    } else {
        ModeEntry::Contact { offset: 0.0, reference: 1.0 }
    }
}

/// The lowest derivative of the trial force, on a threshold, that is not zero within rounding; zero
/// if none of the first four is.
fn first_derivative_off_zero(constants: &Constants<f64>, y: f64, f: f64, force: [f64; 3]) -> f64 {
    let Constants { a, b, two_xi, omega, .. } = *constants;
    let pull = force[0] + (b - f);
    // On the threshold with all lower derivatives zero each is the one before, differentiated.
    let derivatives = [
        (two_xi * pull + y, two_xi * (a + b.abs() + f) + y.abs()),
        (two_xi * force[1] + pull, two_xi * a * omega + a + b.abs() + f),
        (two_xi * force[2] + force[1], a * omega * (two_xi * omega + 1.0)),
        (omega * omega * (b - f), omega * omega * (b.abs() + f)),
    ];
    derivatives
        .iter()
        .find(|(value, size)| value.abs() > FOUR_ULPS * size)
        .map_or(0.0, |(value, _)| *value)
}

/// The closed form of one phase, with the constants of its model.
#[derive(Clone, Copy, Debug)]
pub enum Motion<'a> {
    /// The mass flies.
    NoContact(NoContact<f64, &'a Constants<f64>>),
    /// The mass moves with the slider's top, and the slider's bottom sticks.
    Contact(Contact<f64, &'a Constants<f64>>),
    /// The mass moves with the slider's top, and the slider's bottom slips.
    Progression(Progression<f64, &'a Constants<f64>>),
}

impl<'a> Motion<'a> {
    /// The motion that begins so, at this forcing angle.
    #[inline]
    pub(crate) fn new(
        constants: &'a Constants<f64>,
        begun: &Entry,
        angle: EntryAngle<f64>,
    ) -> Self {
        let entry = begun.state;
        let flight = |surface| Self::NoContact(NoContact { constants, entry, angle, surface });
        match begun.mode {
            ModeEntry::Apart => flight(None),
            ModeEntry::Separation { h_rate } => flight(Some(h_rate)),
            ModeEntry::Contact { offset, reference } => {
                Self::Contact(Contact { constants, entry, angle, offset, reference })
            }
            ModeEntry::Progression { drift_rate, closing } => {
                Self::Progression(Progression { constants, entry, angle, drift_rate, closing })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;

    /// The speed f/(2 xi) is zero in f64: a separation under a force that pushes back would never
    /// have ended.
    #[test]
    fn a_force_without_a_speed_is_on_the_threshold() {
        let parameters = Parameters { b: 0.0, xi: 1e4, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let y = -1.112_536_929_256e-312;
        let state = State { p: 0.02, y, q: f64::MIN_POSITIVE };
        let (_, pushed) = ModeEntry::on_surface(&constants, state, None, [0.1, 0.0, 0.0]);
        assert_eq!(pushed, ModeEntry::Contact { offset: 0.0, reference: 0.0 });
        let (_, pulled) = ModeEntry::on_surface(&constants, state, None, [-0.1, 0.0, 0.0]);
        assert_eq!(pulled, ModeEntry::Separation { h_rate: 0.0 });
    }

    /// Nothing is rounded where mass and slider are at rest without a force: the rate decides.
    #[test]
    fn a_slider_at_rest_is_left_by_a_mass_that_is_pulled() {
        let parameters = Parameters { b: 0.0, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let rest = State { p: 0.02, y: 0.0, q: 0.0 };
        let (_, pulled) = ModeEntry::on_surface(&constants, rest, None, [-0.1, 0.0, 0.0]);
        assert_eq!(pulled, ModeEntry::Separation { h_rate: 0.0 });
        let (_, pushed) = ModeEntry::on_surface(&constants, rest, None, [0.1, 0.0, 0.0]);
        assert_eq!(pushed, ModeEntry::Contact { offset: 0.0, reference: 0.0 });
    }

    /// The room next to f = 1 is four units of one, where no term is larger.
    #[test]
    fn a_force_six_units_below_one_is_a_contact_under_way() {
        let constants = Constants::new(&Parameters::default());
        let at = |units: f64| {
            let q = 1.0 - units * f64::EPSILON;
            let (state, mode) = ModeEntry::on_surface(
                &constants,
                State { p: q + 0.02, y: 0.0, q },
                None,
                [-0.3, 0.0, 0.0],
            );
            (state.q - q, mode)
        };
        let (q, under_way) = (1.0 - 6.0 * f64::EPSILON, at(6.0));
        assert_eq!(under_way, (0.0, ModeEntry::Contact { offset: q, reference: 0.0 }));
        let imposed = ModeEntry::Contact { offset: 0.0, reference: 1.0 };
        assert_eq!(at(3.0), (3.0 * f64::EPSILON, imposed));
    }

    /// A start in mid-slip at 1/(2 xi) = 5000: (f - 1)/(2 xi) was wrong by thousands of eps.
    #[test]
    fn a_slip_under_way_keeps_the_digits_of_its_drift_velocity() {
        let xi = 1e-4;
        let constants = Constants::new(&Parameters { xi, ..Parameters::default() });
        let (y, q) = (0.108_015_697_104_435_81, 0.999_999_999_999_754_3);
        let (_, mode) =
            ModeEntry::on_surface(&constants, State { p: q + 0.02, y, q }, None, [0.0; 3]);
        let ModeEntry::Progression { drift_rate, .. } = mode else { unreachable!("f exceeds 1") };
        let exact = TwoWord::new(y).minus(TwoWord::new(1.0 - q).over(2.0 * xi)).value();
        // Roundings of the rate, of its product and of the difference.
        assert!((drift_rate - exact).abs() <= 2.0 * f64::EPSILON * y, "{drift_rate} {exact}");
    }
}
