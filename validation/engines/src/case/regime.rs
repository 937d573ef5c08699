//! The regimes of motion that cases stand for.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Regimes with their names in case files.
macro_rules! regimes {
    ($($(#[$doc:meta])* $regime:ident = $name:literal,)*) => {
        /// The regime of motion that a case stands for.
        #[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(from = "String", into = "String")]
        pub enum Regime {
            $($(#[$doc])* $regime,)*
            /// A regime that percuss does not know.
            Other(String),
        }

        impl Regime {
            /// The name, as in case files.
            #[must_use]
            pub fn as_str(&self) -> &str {
                match self {
                    $(Self::$regime => $name,)*
                    Self::Other(name) => name,
                }
            }
        }

        impl From<String> for Regime {
            fn from(name: String) -> Self {
                match name.as_str() {
                    $($name => Self::$regime,)*
                    _ => Self::Other(name),
                }
            }
        }
    };
}

regimes! {
    /// Errors grow for ever; there is no progression.
    Chaos = "chaos",
    /// Errors grow for ever, and the slider drifts.
    ChaosWithProgression = "chaos with progression",
    /// The motion repeats after one or a few forcing periods.
    Periodic = "periodic",
    /// The motion repeats after two forcing periods, and the slider drifts.
    PeriodTwoWithProgression = "period two with progression",
    /// The gap turns within a little of the surface.
    Grazing = "grazing",
    /// A phase that never ends is reached.
    Endless = "endless",
    /// The contact is as good as critically damped: xi is near 1.
    CriticalContact = "critical contact",
    /// The contact does not oscillate: xi is above 1.
    OverDamped = "over-damped",
    /// The forcing has nearly the frequency of the elastic contact.
    ResonanceInContact = "resonance in contact",
    /// One of a series of falling damping ratios, at which the slider's relaxation is stiff.
    StiffnessSeries = "stiffness ladder",
    /// The start lies on two thresholds at once.
    DegenerateStart = "degenerate start",
    /// The start lies late in time, where a time in one number has lost digits.
    LateStart = "late start",
    /// The forcing is much faster than the contact.
    FastForcing = "fast forcing",
    /// The forcing is much slower than the contact.
    SlowForcing = "slow forcing",
    /// The static force is small.
    SmallStaticForce = "small static force",
    /// An impact at which the slider progresses at once.
    ImpactIntoProgression = "impact straight into progression",
}

impl Regime {
    /// Whether errors grow for ever.
    #[must_use]
    pub fn is_chaotic(&self) -> bool {
        matches!(self, Self::Chaos | Self::ChaosWithProgression)
    }
}

impl From<Regime> for String {
    fn from(regime: Regime) -> Self {
        regime.as_str().to_owned()
    }
}

impl fmt::Display for Regime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::embedded;

    #[test]
    fn percuss_has_a_word_for_every_regime_of_its_cases() {
        let cases = embedded().unwrap_or_default();
        assert!(!cases.is_empty());
        for case in cases.iter().filter_map(|it| it.oscillator.as_ref()) {
            assert!(!matches!(case.regime, Regime::Other(_)), "{}", case.regime);
        }
    }

    #[test]
    fn a_regime_without_a_word_keeps_its_name() {
        let own = Regime::from("two masses".to_owned());
        assert_eq!(own.as_str(), "two masses");
        assert!(!own.is_chaotic() && Regime::from("chaos".to_owned()).is_chaotic());
    }
}
