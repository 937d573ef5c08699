//! Which phase begins on the contact surface: the trial force decides, then its derivatives.
//!
//! f = 2 xi y + q at the thresholds 0 and 1 is decided by the first derivative that is not zero. As
//! the contact sees it f' = 2 xi (F - f) + y, f'' = 2 xi (F' - f') + F - f; the other phases'
//! guards have these derivatives divided by 2 xi, so the two sides cannot contradict each other.

use crate::crossing::allowances::FOUR_ULPS;
use crate::flow::constants::Constants;
use crate::model::entry::ModeEntry;
use crate::state::State;

/// The state with its force imposed where it lies on a threshold, and the phase that begins.
///
/// `force` is the harmonic force with its first two derivatives; `f` is the trial force if it is
/// known better than as 2 xi y + q.
#[inline(always)]
pub(crate) fn mode_entry(
    constants: &Constants<f64>,
    mut state: State,
    f: Option<f64>,
    force: [f64; 3],
) -> (State, ModeEntry) {
    let Constants { two_xi, g, rate, .. } = *constants;
    let (damper, spring) = (two_xi * state.y, state.q);
    let largest = damper.abs().max(spring.abs());
    let f = f.unwrap_or(damper + spring);
    if f.abs() <= FOUR_ULPS * largest {
        state.q = -damper;
        state.p = state.q + g;
        return (state, on_threshold(constants, &state, 0.0, force));
    }
    if (f - 1.0).abs() <= FOUR_ULPS * largest.max(1.0) {
        state.q = 1.0 - damper;
        state.p = state.q + g;
        return (state, on_threshold(constants, &state, 1.0, force));
    }
    state.p = state.q + g;
    let mode = if f < 0.0 {
        let h_rate = f * rate;
        if h_rate == 0.0 {
            // Of a force without a speed nothing is known but that it is at the threshold.
            state.q = -damper;
            state.p = state.q + g;
            return (state, on_threshold(constants, &state, 0.0, force));
        }
        ModeEntry::Separation { h_rate }
    } else if f < 1.0 {
        ModeEntry::Contact { offset: f, reference: 0.0 }
    } else {
        match slipping(constants, &state) {
            // What is known of f and the state are rounded apart: where the state does not slip, f
            // is within rounding of the threshold.
            ModeEntry::Progression { drift_rate, .. } if drift_rate <= 0.0 => {
                state.q = 1.0 - damper;
                state.p = state.q + g;
                return (state, on_threshold(constants, &state, 1.0, force));
            }
            mode => mode,
        }
    };
    (state, mode)
}

/// A progression under way. Its drift velocity is y - q' and not (f - 1)/(2 xi), which would carry
/// 1/(2 xi) times the rounding of f: 1 - q is exact where the slider is nearly compressed. It must
/// be that of the state after an impact too, although f is known by itself there: the closed form
/// goes by the drift velocity at first and by y later, and would jump where it changes over.
pub(crate) fn slipping(constants: &Constants<f64>, state: &State) -> ModeEntry {
    let closing = (1.0 - state.q) * constants.rate;
    ModeEntry::Progression { drift_rate: state.y - closing, closing }
}

/// Which phase begins where the trial force is at a threshold, 0 or 1, computed or stated: its
/// derivatives decide. A phase stated against them would have no length.
pub(crate) fn on_threshold(
    constants: &Constants<f64>,
    state: &State,
    threshold: f64,
    force: [f64; 3],
) -> ModeEntry {
    let direction = first_derivative_off_zero(constants, state.y, threshold, force);
    if threshold == 0.0 { at_zero(direction) } else { at_one(direction, state.y) }
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

/// The first derivative of the trial force, on a threshold, that is not zero within its rounding.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::two_word::TwoWord;
    use crate::parameters::Parameters;

    /// The speed f/(2 xi) is zero in f64: a separation under a force that pushes back would never
    /// have ended.
    #[test]
    fn a_force_without_a_speed_is_on_the_threshold() {
        let parameters = Parameters { b: 0.0, xi: 1e4, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let y = -1.112_536_929_256e-312;
        let state = State { p: 0.02, y, q: f64::MIN_POSITIVE };
        let (_, pushed) = mode_entry(&constants, state, None, [0.1, 0.0, 0.0]);
        assert_eq!(pushed, ModeEntry::Contact { offset: 0.0, reference: 0.0 });
        let (_, pulled) = mode_entry(&constants, state, None, [-0.1, 0.0, 0.0]);
        assert_eq!(pulled, ModeEntry::Separation { h_rate: 0.0 });
    }

    /// Nothing is rounded where mass and slider are at rest without a force: the rate decides.
    #[test]
    fn a_slider_at_rest_is_left_by_a_mass_that_is_pulled() {
        let parameters = Parameters { b: 0.0, ..Parameters::default() };
        let constants = Constants::new(&parameters);
        let rest = State { p: 0.02, y: 0.0, q: 0.0 };
        let (_, pulled) = mode_entry(&constants, rest, None, [-0.1, 0.0, 0.0]);
        assert_eq!(pulled, ModeEntry::Separation { h_rate: 0.0 });
        let (_, pushed) = mode_entry(&constants, rest, None, [0.1, 0.0, 0.0]);
        assert_eq!(pushed, ModeEntry::Contact { offset: 0.0, reference: 0.0 });
    }

    /// The room next to f = 1 is four units of one, where no term is larger.
    #[test]
    fn a_force_six_units_below_one_is_a_contact_under_way() {
        let constants = Constants::new(&Parameters::default());
        let at = |units: f64| {
            let q = 1.0 - units * f64::EPSILON;
            let (state, mode) =
                mode_entry(&constants, State { p: q + 0.02, y: 0.0, q }, None, [-0.3, 0.0, 0.0]);
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
        let (_, mode) = mode_entry(&constants, State { p: q + 0.02, y, q }, None, [0.0; 3]);
        let ModeEntry::Progression { drift_rate, .. } = mode else { unreachable!("f exceeds 1") };
        let exact = TwoWord::new(y).minus(TwoWord::new(1.0 - q).over(2.0 * xi)).value();
        // Roundings of the rate, of its product and of the difference.
        assert!((drift_rate - exact).abs() <= 2.0 * f64::EPSILON * y, "{drift_rate} {exact}");
    }
}
