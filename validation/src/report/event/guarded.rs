//! The quantity whose zero is an event.

use crate::engine::GuardSample;
use crate::truth::DoubleDouble;
use percuss::number::Number;
use percuss::{Parameters, Phase};

/// The gap, or the trial force less the threshold that the event crosses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GuardCurve {
    /// Mass and slider meet.
    Gap,
    /// The force rises to 1, where the slider begins to move, or falls back to it.
    SlidingForce,
    /// The force falls to 0, where mass and slider part.
    PartingForce,
}

impl GuardCurve {
    /// What ends the phase `before` where `begins` follows it.
    pub(super) fn of(before: Phase, begins: Phase) -> Self {
        match (before, begins) {
            (Phase::NoContact, _) => Self::Gap,
            (Phase::Contact, Phase::NoContact) => Self::PartingForce,
            _ => Self::SlidingForce,
        }
    }

    /// The guard's name on an axis.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Gap => "gap p \u{2212} q \u{2212} g",
            Self::SlidingForce => "trial force 2\u{3be}y + q \u{2212} 1",
            Self::PartingForce => "trial force 2\u{3be}y + q",
        }
    }

    /// The guard's value where p, y and q are known to 106 bits.
    pub(super) fn of_truth(self, it: &Parameters, [p, y, q]: [DoubleDouble; 3]) -> f64 {
        let exact = DoubleDouble::exact;
        let force = || exact(2.0 * it.xi) * y + q;
        let value = match self {
            Self::Gap => p - q - exact(it.g),
            Self::SlidingForce => force() - DoubleDouble::one(),
            Self::PartingForce => force(),
        };
        value.to_f64()
    }

    /// The guard's value at an engine's state.
    pub(super) fn of_state(self, it: &Parameters, state: &[f64]) -> f64 {
        let [p, y, q] = [state[0], state[1], state[2]];
        match self {
            Self::Gap => p - q - it.g,
            Self::SlidingForce => 2.0 * it.xi * y + q - 1.0,
            Self::PartingForce => 2.0 * it.xi * y + q,
        }
    }

    /// The guard's value where a search looked at it; `None` where it looked at other guards.
    pub(super) fn of_look(self, look: &GuardSample) -> Option<f64> {
        match (self, Phase::ALL[look.mode], look.guard) {
            (Self::Gap, Phase::NoContact, 0) | (Self::SlidingForce, Phase::Contact, 0) => {
                Some(look.value)
            }
            (Self::SlidingForce, Phase::Progression, 0)
            | (Self::PartingForce, Phase::Contact, 1) => Some(-look.value),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Equations, place};
    use crate::integration::{GUARDS, Oscillator};

    /// A look at an engine's guard shows what the curve shows at the same state.
    #[test]
    fn looks_lie_on_the_curve() {
        let parameters = Parameters::default();
        let state = [0.62, 1.7, 0.55, 2.5];
        let equations = Oscillator::of(&parameters, 0.3);
        let mut seen = 0;
        for phase in Phase::ALL {
            for (guard, value) in
                equations.guards(place(phase), 0.7, &state).into_iter().enumerate()
            {
                let look = GuardSample { t: 0.0, mode: place(phase), guard, value };
                for it in [GuardCurve::Gap, GuardCurve::SlidingForce, GuardCurve::PartingForce] {
                    let Some(shown) = it.of_look(&look) else { continue };
                    seen += 1;
                    assert!((shown - it.of_state(&parameters, &state)).abs() < 1e-15, "{it:?}");
                    let exact = [state[0], state[1], state[2]].map(DoubleDouble::exact);
                    assert!((shown - it.of_truth(&parameters, exact)).abs() < 1e-15, "{it:?}");
                }
            }
        }
        assert_eq!(seen, 2 * GUARDS);
    }

    #[test]
    fn an_impact_is_where_the_gap_closes_whatever_follows() {
        use Phase::{Contact, NoContact, Progression};
        assert_eq!(GuardCurve::of(NoContact, Progression), GuardCurve::Gap);
        assert_eq!(GuardCurve::of(Contact, Progression), GuardCurve::SlidingForce);
        assert_eq!(GuardCurve::of(Progression, Contact), GuardCurve::SlidingForce);
        assert_eq!(GuardCurve::of(Contact, NoContact), GuardCurve::PartingForce);
    }
}
