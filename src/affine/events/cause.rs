//! The cause of an ending that the solver could not decide.

use super::event::Kind;
use crate::affine::model::system::System;
use crate::affine::run::Run;
use crate::affine::solver::event::{Ending, What};
use crate::numeric::number::{Bound, Number};
use std::fmt;

/// The cause for which a run ended as [undecided](super::event::Ending::Undecided) or
/// [beyond a guard](super::event::Ending::BeyondGuard). Printed it is a sentence.
///
/// ```
/// use percuss::{Cause, Ending, Proved, System};
///
/// // The ball is to start inside the floor.
/// let text = percuss::gallery::BOUNCING_BALL.replace("x = 1", "x = -1");
/// let solver = System::from_toml(&text)?.solver::<Proved>()?;
/// let mut events = solver.run().until(2.0)?;
/// assert_eq!(events.next().and_then(|it| it.ending()), Some(Ending::BeyondGuard));
/// let cause = events.cause().expect("a cause");
/// assert_eq!(cause.to_string(), "the guard of \"impact\" is positive there");
/// assert!(matches!(cause, Cause::BeyondGuard { event } if event == "impact"));
/// # Ok::<(), percuss::SystemError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// A mode was entered where the guard of this event is positive.
    BeyondGuard {
        /// The name of the event.
        event: String,
    },
    /// The guards of these events cross so close to one another that their order is open.
    Order {
        /// The names of the events.
        events: Vec<String>,
        /// The time to which the search came.
        searched: f64,
    },
    /// A guard comes so close to zero that it may or may not cross.
    Guard {
        /// The name of the event, where it is one.
        event: Option<String>,
        /// The size below which the guard is not known, such as `1e-31`.
        resolution: Option<String>,
        /// The time to which the search came.
        searched: f64,
    },
    /// The search for the next event takes more work than is accepted.
    Work {
        /// The time to which the search came.
        searched: f64,
    },
    /// The state, or a bound of its error, is too large for the arithmetic.
    TooLarge {
        /// The time to which the search came.
        searched: f64,
    },
}

impl Cause {
    /// The cause of a run's ending, if it has one.
    pub(super) fn new<T: Number>(run: &Run<'_, T>, system: &System) -> Option<Self> {
        let name = |it: &What<T>| Kind::new(it).name(system).to_owned();
        match run.ending()? {
            Ending::BeyondGuard => {
                Some(Self::BeyondGuard { event: name(&run.event_beyond_guard()?) })
            }
            Ending::Undecided => {
                let searched = run.searched().value().to_f64();
                if run.overflows() {
                    return Some(Self::TooLarge { searched });
                }
                let events: Vec<String> = run.tie().iter().map(name).collect();
                if !events.is_empty() {
                    return Some(Self::Order { events, searched });
                }
                if run.is_exhausted() {
                    return Some(Self::Work { searched });
                }
                let event = run.doubtful_event().as_ref().map(name);
                let resolution = run.resolution().map(size).filter(|_| event.is_some());
                Some(Self::Guard { event, resolution, searched })
            }
            _ => None,
        }
    }
}

impl Cause {
    /// Whether the cause is the guards of events that it names.
    pub(super) fn names_a_guard(&self) -> bool {
        !matches!(self, Self::Guard { event: None, .. } | Self::Work { .. } | Self::TooLarge { .. })
    }

    /// The cause, with the guards that another one names where this search names none.
    pub(super) fn or_named(self, other: Option<&Self>) -> Self {
        let (Self::Guard { event: None, searched, .. } | Self::Work { searched }) = self else {
            return self;
        };
        match other {
            Some(Self::Guard { event, .. }) => {
                Self::Guard { event: event.clone(), resolution: None, searched }
            }
            Some(Self::Order { events, .. }) => Self::Order { events: events.clone(), searched },
            _ => self,
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let came = |searched: &f64| {
            format!("its search for the next event came to about {}", about(*searched))
        };
        match self {
            Self::BeyondGuard { event } => write!(f, "the guard of \"{event}\" is positive there"),
            Self::Work { searched } => {
                write!(f, "{}, where it takes more work than is accepted", came(searched))
            }
            Self::TooLarge { searched } => {
                let searched = about(*searched);
                write!(f, "its state at about {searched} is too large for its bounds to be numbers")
            }
            Self::Order { events, searched } => {
                let quoted: Vec<_> = events.iter().map(|it| format!("\"{it}\"")).collect();
                let (last, others) = quoted.split_last().map_or(("", &[][..]), |(a, b)| (a, b));
                let (came, others) = (came(searched), others.join(", "));
                write!(
                    f,
                    "{came}, where rounding leaves open which of the guards of {others} and {last} \
                     crosses first"
                )
            }
            Self::Guard { event: None, searched, .. } => f.write_str(&came(searched)),
            Self::Guard { event: Some(name), resolution, searched } => {
                let came = came(searched);
                write!(
                    f,
                    "{came}, where rounding leaves open whether the guard of \"{name}\" crosses"
                )?;
                let Some(near) = resolution else { return Ok(()) };
                write!(f, ": nearer to zero than {near} it is not known")
            }
        }
    }
}

/// The order of a size, which may be beyond the exponents of f64.
fn size<B: Bound>(size: B) -> String {
    let (mantissa, exponent) = size.parts();
    let power = mantissa.log10() + exponent as f64 * std::f64::consts::LOG10_2;
    format!("1e{}", power.ceil())
}

/// A number to six digits, with an exponent where it is large.
fn about(number: f64) -> String {
    let rounded = format!("{number:.5e}").parse().unwrap_or(number);
    let text = format!("{rounded:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
