//! The exact solver's run made again in 106 bits, from any start.
//!
//! It shares its closed forms with the solver, so what it measures is rounding and nothing else;
//! the tables of `reference_data/` vouch for the forms, and it is itself held against their digits.
//! The order of events is that of f64 with room to spare ([`super::cautious`]); each event's time
//! is refined in 106 bits, the state is landed there, and everything is carried on in 106 bits.

use super::DoubleDouble;
use super::cautious::crossing;
use super::forms::{TruthEntry, TruthForms, TruthMotion};
use super::landing::DECISION_TOLERANCE;
use percuss::insides::crossing::{Crossing, Root};
use percuss::insides::flow::Point;
use percuss::number::Number;
use percuss::{Entry, Instant, Parameters, Phase, State};

/// Why a run has no truth: a decision too close to be taken.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("undecided in 106 bits: {what} in the phase that begins {elapsed:e} after the start")]
pub struct Undecided {
    /// The decision that 106 bits leave open.
    pub what: &'static str,
    /// The time at which the phase began, since the start.
    pub elapsed: f64,
}

/// The state at which a phase begins.
#[derive(Clone, Copy, Debug)]
pub struct Beginning {
    /// The instant at which the phase begins.
    pub instant: Instant,
    /// Bounded co-ordinates.
    pub state: State<DoubleDouble>,
    /// Drift v.
    pub drift: DoubleDouble,
    motion: TruthMotion<DoubleDouble>,
}

/// A phase of the run.
#[derive(Clone, Copy, Debug)]
pub struct ReplayedPhase {
    /// The state at which the phase begins.
    pub begin: Beginning,
    /// The state at which the next phase begins; `None` at the horizon.
    pub next: Option<Beginning>,
    omega: f64,
}

/// The run, phase by phase up to its horizon.
pub struct Replay {
    forms: TruthForms,
    start: Instant,
    horizon: Instant,
    next: Option<Beginning>,
}

impl Beginning {
    /// The phase that begins.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.motion.phase()
    }

    /// p, y, q and v.
    #[must_use]
    pub fn values(&self) -> [DoubleDouble; 4] {
        [self.state.p, self.state.y, self.state.q, self.drift]
    }
}

impl ReplayedPhase {
    /// p, y, q and v at an instant inside the phase.
    #[must_use]
    pub fn at(&self, instant: &Instant) -> [DoubleDouble; 4] {
        let elapsed = instant.since(&self.begin.instant, self.omega);
        let point = self.begin.motion.at(elapsed.into());
        let State { p, y, q } = point.state;
        [p, y, q, self.begin.drift + point.drift]
    }

    /// Whether the phase is over by then.
    #[must_use]
    pub fn ends_by(&self, instant: &Instant) -> bool {
        self.next.is_some_and(|next| next.instant <= *instant)
    }
}

impl Replay {
    /// The run that begins at `entry`, whose f64 values are taken exactly.
    #[must_use]
    pub fn new(parameters: &Parameters, entry: &Entry, horizon: Instant) -> Self {
        let state = [entry.state.p, entry.state.y, entry.state.q].map(DoubleDouble::exact);
        Self::from_two_words(parameters, entry, state, horizon)
    }

    /// The run again from a start whose state is given in two words: for differences of
    /// neighbouring runs.
    #[must_use]
    pub fn from_two_words(
        parameters: &Parameters,
        entry: &Entry,
        state: [DoubleDouble; 3],
        horizon: Instant,
    ) -> Self {
        let forms = TruthForms::new(parameters);
        let (state, mode) = forms.start(entry, state);
        let drift = entry.drift.into();
        let first = begin(&forms, entry.instant, state, drift, mode);
        Self { forms, start: entry.instant, horizon, next: Some(first) }
    }

    fn passage(&self, begin: Beginning) -> Result<ReplayedPhase, &'static str> {
        let omega = self.forms.omega;
        let span = self.horizon.since(&begin.instant, omega).value();
        // The search's horizon is a little late: whether an event comes before it is decided here.
        let limit = span.max(0.0) * (1.0 + 1e-12) + f64::MIN_POSITIVE;
        let passage = |next| Ok(ReplayedPhase { begin, next, omega });
        match crossing(&self.forms.rounded(&begin.motion), &self.forms.steps, limit) {
            (_, false) => Err("the margin of a graze"),
            (Crossing::Stage(_) | Crossing::Undecided(_), _) => Err("the end of a phase"),
            (Crossing::Horizon | Crossing::Never, _) => passage(None),
            (Crossing::At(root), _) => {
                let at = refine(&begin.motion, &root).ok_or("the time of an event")?;
                let elapsed = at.elapsed.into();
                let instant = begin.instant.after(elapsed, omega);
                if instant > self.horizon {
                    return passage(None);
                }
                let landing = self.forms.landing(&begin.motion, &at, root.rises());
                let (state, mode) = landing.ok_or("the force of an impact")?;
                passage(Some(self::begin(
                    &self.forms,
                    instant,
                    state,
                    begin.drift + at.drift,
                    mode,
                )))
            }
        }
    }
}

impl Iterator for Replay {
    type Item = Result<ReplayedPhase, Undecided>;

    fn next(&mut self) -> Option<Self::Item> {
        let begin = self.next.take()?;
        let passage = self.passage(begin).map_err(|what| {
            let elapsed = begin.instant.since(&self.start, self.forms.omega).value();
            Undecided { what, elapsed }
        });
        self.next = passage.ok().and_then(|passage| passage.next);
        Some(passage)
    }
}

fn begin(
    forms: &TruthForms,
    instant: Instant,
    state: State<DoubleDouble>,
    drift: DoubleDouble,
    mode: TruthEntry<DoubleDouble>,
) -> Beginning {
    Beginning { instant, state, drift, motion: forms.motion(&instant, state, mode) }
}

/// The crossing that f64 found, to 106 bits: Newton's method on the guard less its threshold.
fn refine(motion: &TruthMotion<DoubleDouble>, root: &Root) -> Option<Point<DoubleDouble>> {
    // From 1e-16 two steps do; next to a graze the root of a square root is found, and takes a few
    // more.
    const MAX_NEWTON_STEPS: usize = 12;
    // A root that f64 has misplaced by more is none.
    /// The largest relative error of a root in f64 that is made exact: one that is farther off is
    /// another.
    const MAX_ROOT_ERROR: f64 = 1e-5;
    let threshold = match motion {
        TruthMotion::Contact(contact) if root.rises() => DoubleDouble::one() - contact.reference,
        TruthMotion::Contact(contact) => -contact.reference,
        _ => DoubleDouble::zero(),
    };
    let first = root.elapsed();
    let mut elapsed = DoubleDouble::from(first);
    let mut last = f64::INFINITY;
    for _ in 0..MAX_NEWTON_STEPS {
        let point = motion.at(elapsed);
        let [guard, slope, bend, _] = point.guard.orders;
        let newton = -((guard - threshold) / slope);
        // The parabola's root, to first order in the bend.
        let step = newton * (DoubleDouble::one() - bend * newton / (slope + slope));
        let size = step.to_f64().abs();
        let resolved = size <= TIME_TOLERANCE * elapsed.to_f64();
        // Where rounding of the guard keeps the steps from falling further, the root is as good as
        // it gets.
        let settled = size >= 0.5 * last && size <= DECISION_TOLERANCE * (1.0 + elapsed.to_f64());
        if resolved || settled {
            let outward = slope.to_f64() * if leaves_upwards(motion, root) { 1.0 } else { -1.0 };
            let strayed = (elapsed - first.into()).to_f64().abs() > MAX_ROOT_ERROR * first.value();
            return (outward > 0.0 && !strayed).then_some(point);
        }
        elapsed = elapsed + step;
        last = size;
    }
    None
}

/// The time of an event to 2^-104 of itself.
const TIME_TOLERANCE: f64 = f64::EPSILON * f64::EPSILON;

fn leaves_upwards(motion: &TruthMotion<DoubleDouble>, root: &Root) -> bool {
    match motion {
        TruthMotion::NoContact(_) => true,
        TruthMotion::Contact(_) => root.rises(),
        TruthMotion::Progression(_) => false,
    }
}
