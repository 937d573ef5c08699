//! The ways in which a derivative is wrong at events, each with a name.

use std::fmt;

/// A wrong rule or a step of differences explains an answer if it leaves at most this share of what
/// the answer is off. Whatever that is, some of the sixteen derivatives that rules may give are off
/// by about as much: where one might leave half of it, two were found by chance for an engine whose
/// rules are right. A tenth loses no missing term of an engine that lacks one.
pub(super) const EXPLAINED_SHARE: f64 = 0.1;

/// The use of a term at an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Term {
    /// The term is that of its own side of the event.
    Own,
    /// The term is that of the other side.
    Other,
    /// The term is left out.
    None,
    /// The term has the other sign.
    Negated,
}

/// What is done with derivatives at an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rule {
    /// The derivative of the event's time, which is divided by the guard's rate on a side.
    pub time: Term,
    /// The field before the event, times that derivative.
    pub before: Term,
    /// The field after the event, times that derivative.
    pub after: Term,
    pub guard_moves: bool,
    pub reset_moves: bool,
    pub reset_applies: bool,
    /// Whether a row holds the state's derivative at the event's moving time.
    pub row_moves: bool,
}

pub(super) const RIGHT_RULE: Rule = Rule {
    time: Term::Own,
    before: Term::Own,
    after: Term::Own,
    guard_moves: true,
    reset_moves: true,
    reset_applies: true,
    row_moves: true,
};

/// A way in which derivatives at events are wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mechanism {
    /// The state's derivative does not see that the event's time moves.
    NoSaltation,
    /// The event's time has no derivative at all.
    NoTimeDerivative,
    /// What the reset itself changes with the name is left out.
    ResetNotDifferentiated,
    /// What the guard itself changes with the name is left out.
    GuardParameterForgotten,
    /// A field is taken on the wrong side of the event, or on one side only.
    WrongSideField,
    /// A term, or the whole derivative, has the other sign.
    Sign,
    /// The state's derivative is that at a fixed time, where the event's moves.
    FixedTime,
    /// The derivative is a difference over a step that is too large. Only answers that are said to
    /// be differences can have it: a step is a free number, which explains what is off in one cell
    /// whoever made it.
    CoarseDifferences,
}

impl Mechanism {
    /// All of them, in the order in which they are tried.
    pub const ALL: [Self; 8] = [
        Self::NoTimeDerivative,
        Self::NoSaltation,
        Self::ResetNotDifferentiated,
        Self::GuardParameterForgotten,
        Self::WrongSideField,
        Self::Sign,
        Self::FixedTime,
        Self::CoarseDifferences,
    ];

    /// The name in reports.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::NoSaltation => "no-saltation",
            Self::NoTimeDerivative => "no-time-derivative",
            Self::ResetNotDifferentiated => "reset-not-differentiated",
            Self::GuardParameterForgotten => "guard-parameter-forgotten",
            Self::WrongSideField => "wrong-side-field",
            Self::Sign => "sign",
            Self::FixedTime => "fixed-time",
            Self::CoarseDifferences => "coarse-differences",
        }
    }

    /// The rules at events that this may mean; none of what no rule at events makes.
    pub(super) fn rules(self) -> Vec<Rule> {
        use Term::{Negated, None, Other, Own};
        let fields = |before, after| Rule { before, after, ..RIGHT_RULE };
        match self {
            Self::NoSaltation => {
                let by_reset = fields(None, None);
                vec![by_reset, Rule { reset_applies: false, ..by_reset }]
            }
            Self::NoTimeDerivative => {
                let by_reset = Rule { time: None, ..RIGHT_RULE };
                vec![by_reset, Rule { reset_applies: false, ..by_reset }]
            }
            Self::ResetNotDifferentiated => vec![Rule { reset_moves: false, ..RIGHT_RULE }],
            Self::GuardParameterForgotten => vec![Rule { guard_moves: false, ..RIGHT_RULE }],
            Self::WrongSideField => vec![
                Rule { time: Other, ..RIGHT_RULE },
                fields(Own, None),
                fields(None, Own),
                fields(Other, Own),
                fields(Own, Other),
                Rule { time: Other, ..fields(Other, Own) },
            ],
            Self::Sign => vec![Rule { time: Negated, ..RIGHT_RULE }, fields(Negated, Negated)],
            Self::FixedTime => vec![Rule { row_moves: false, ..RIGHT_RULE }],
            Self::CoarseDifferences => Vec::new(),
        }
    }
}

impl fmt::Display for Mechanism {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}
