//! One phase of a run: where it begins, how long it lasts, and anything inside it on demand.

use crate::constants::Constants;
use crate::crossing::search::first_crossing_and;
use crate::crossing::stepping;
use crate::crossing::{Counters, Crossing, Root};
use crate::entry::{Entry, Onset};
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::flow::progression::Progression;
use crate::flow::{Flow, Point};
use crate::instant::Instant;
use crate::model::{Model, Motion};
use crate::phase::Phase;
use crate::state::State;
use crate::surface::{self, FOUR_ULPS};
use crate::two_word::TwoWord;

/// The motion at some instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Bounded co-ordinates.
    pub state: State,
    /// Drift v.
    pub v: f64,
}

/// Why a phase has no end.
///
/// It stands in an [`Exit`] where a switch has other numbers. Behind a byte those would be copied across the
/// words in which they were written, for which a processor has to wait; so it is a whole word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Endless {
    /// The mass never returns to the slider (b too small).
    NeverReturns,
    /// The slider's bottom never stops (b too large).
    NeverStops,
    /// The mass rests on the slider for ever (a small).
    RestsForEver,
}

/// How a phase ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exit {
    /// By a switch; the next phase begins so.
    Switch(Entry),
    /// Not before the horizon.
    Horizon,
    /// Never: proved.
    Endless(Endless),
}

/// One phase of a run.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    entry: Entry,
    exit: Exit,
    duration: TwoWord,
    angle: EntryAngle<f64>,
    constants: Constants<f64>,
}

/// A phase that may have come to its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed {
    /// How it ends.
    pub exit: Exit,
    /// How long it lasts; up to the horizon if that cuts it, infinite if it is endless.
    pub duration: TwoWord,
    /// The forcing angle at which the next phase begins, if one does.
    pub angle: Option<EntryAngle<f64>>,
}

/// Finds how the phase that begins at `entry`, under this forcing angle, ends; switches after `horizon`
/// do not count.
pub(crate) fn pass(
    model: &Model,
    entry: &Entry,
    angle: EntryAngle<f64>,
    horizon: Option<&Instant>,
    counters: &mut Counters,
) -> Passed {
    let omega = model.parameters().omega;
    let motion = Motion::new(model.constants(), entry, angle);
    let strides = model.strides();
    // The horizon in two words is computed only where it matters. It is looked beyond by more than guesses
    // err, so that a switch next to it is found as without it; its instant decides.
    const BEYOND: f64 = 0.1;
    let (certain, limit) = horizon.map_or((f64::INFINITY, f64::INFINITY), |h| {
        let (certain, limit) = h.since_roughly(&entry.instant, omega);
        (certain, limit + BEYOND / omega)
    });
    let next = |root: &Root| {
        let instant = entry.instant.after(root.elapsed(), omega);
        (instant, model.forcing_angle(&instant))
    };
    let (crossing, next) = match &motion {
        Motion::NoContact(flight) => first_crossing_and((flight, strides), limit, counters, next),
        Motion::Contact(contact) => first_crossing_and((contact, strides), limit, counters, next),
        Motion::Progression(slip) => first_crossing_and((slip, strides), limit, counters, next),
    };
    let left = || horizon.map_or(f64::INFINITY, |h| h.since(&entry.instant, omega).value());
    let ended = |exit, duration| Passed { exit, duration: TwoWord::new(duration), angle: None };
    match (crossing, next) {
        (Crossing::At(root), Some((instant, angle))) => {
            let elapsed = root.elapsed();
            if elapsed.high > certain && horizon.is_some_and(|horizon| instant > *horizon) {
                return ended(Exit::Horizon, left());
            }
            counters.switches += 1;
            let next = Entry { instant, ..land(model, entry, &motion, &root) };
            Passed { exit: Exit::Switch(next), duration: elapsed, angle: Some(angle) }
        }
        (Crossing::Never, _) if certain > 0.0 || left() > 0.0 => {
            ended(Exit::Endless(endless(entry.phase())), f64::INFINITY)
        }
        _ => ended(Exit::Horizon, left()),
    }
}

impl Leg {
    /// The phase that begins at `entry` ([`pass`]).
    pub(crate) fn new(
        model: &Model,
        entry: Entry,
        horizon: Option<&Instant>,
        counters: &mut Counters,
    ) -> Self {
        let angle = model.forcing_angle(&entry.instant);
        let Passed { exit, duration, .. } = pass(model, &entry, angle, horizon, counters);
        Self::passed(model, entry, angle, exit, duration)
    }

    /// The phase that has been passed so.
    #[inline]
    pub(crate) fn passed(
        model: &Model,
        entry: Entry,
        angle: EntryAngle<f64>,
        exit: Exit,
        duration: TwoWord,
    ) -> Self {
        Self { entry, exit, duration, angle, constants: *model.constants() }
    }

    pub(crate) fn constants(&self) -> &Constants<f64> {
        &self.constants
    }

    /// The closed form.
    pub(crate) fn motion(&self) -> Motion<'_> {
        Motion::new(&self.constants, &self.entry, self.angle)
    }

    /// Where the phase begins.
    #[must_use]
    pub fn entry(&self) -> &Entry {
        &self.entry
    }

    /// How it ends.
    #[must_use]
    pub fn exit(&self) -> &Exit {
        &self.exit
    }

    /// Which phase it is.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.entry.phase()
    }

    /// How long it lasts; up to the horizon if that cuts it, infinite if it is endless.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration.value()
    }

    /// The same in two words.
    #[must_use]
    pub fn duration_two_word(&self) -> TwoWord {
        self.duration
    }

    /// The motion a time `elapsed` after the phase began, at most [`Self::duration`].
    #[must_use]
    pub fn at(&self, elapsed: f64) -> Sample {
        self.at_two_word(TwoWord::new(elapsed))
    }

    /// As [`Self::at`]; late in a long phase the second word of the time matters.
    fn at_two_word(&self, elapsed: TwoWord) -> Sample {
        let (_, state, drift) = self.shifted_to(elapsed);
        Sample { state, v: drift.value() }
    }

    /// The nearest evaluation, and state and drift shifted by the second word of the time.
    fn shifted_to(&self, elapsed: TwoWord) -> (Point<f64>, State, TwoWord) {
        let point = self.point(elapsed.high);
        let rest = elapsed.low;
        let [p_rate, y_rate, q_rate, v_rate] = self.field(&point);
        let State { p, y, q } = point.state;
        let state = State { p: p + rest * p_rate, y: y + rest * y_rate, q: q + rest * q_rate };
        let drift = self.entry.drift.plus(TwoWord::sum(point.drift, rest * v_rate));
        (point, state, drift)
    }

    /// The right-hand sides of Eqs. (11) to (13): rates of p, y, q and v.
    pub(crate) fn field(&self, point: &Point<f64>) -> [f64; 4] {
        let [force, ..] = point.force;
        let [guard, ..] = point.guard.orders;
        let slider = point.slider_velocity;
        match self.motion() {
            Motion::NoContact(_) => [point.state.y, force, slider, 0.0],
            Motion::Contact(contact) => [slider, force - (contact.reference + guard), slider, 0.0],
            Motion::Progression(_) => [slider, force - 1.0, slider, guard],
        }
    }

    pub(crate) fn point(&self, elapsed: f64) -> Point<f64> {
        match self.motion() {
            Motion::NoContact(flight) => flight.at(elapsed),
            Motion::Contact(contact) => contact.at(elapsed),
            Motion::Progression(progression) => progression.at(elapsed),
        }
    }

    /// The motion at an instant inside the phase.
    #[must_use]
    pub fn at_instant(&self, instant: &Instant) -> Sample {
        self.at_two_word(instant.since(&self.entry.instant, self.constants.omega))
    }

    /// Time from the phase's beginning to an instant.
    #[must_use]
    pub fn elapsed_at(&self, instant: &Instant) -> f64 {
        instant.since(&self.entry.instant, self.constants.omega).value()
    }

    /// The phase taken up again at an instant inside it: a motion that begins there and goes on as
    /// this one does, to within rounding.
    #[must_use]
    pub fn entry_at(&self, instant: &Instant) -> Entry {
        let elapsed = instant.since(&self.entry.instant, self.constants.omega);
        if elapsed.value() <= 0.0 {
            return self.entry;
        }
        let (point, state, drift) = self.shifted_to(elapsed);
        let guard = point.guard.orders[0] + elapsed.low * point.guard.orders[1];
        let (state, onset) = match self.motion() {
            Motion::NoContact(flight) => {
                let constants = &flight.constants;
                if state.p < state.q + constants.g {
                    (state, Onset::Apart)
                } else {
                    surface::onset(constants, state, None, point.force)
                }
            }
            Motion::Contact(Contact { constants, reference, .. }) => {
                let f = reference + guard;
                if f.min(1.0 - f) > FOUR_ULPS {
                    (state, Onset::Contact { offset: guard, reference })
                } else {
                    surface::onset(constants, state, Some(f), point.force)
                }
            }
            Motion::Progression(Progression { constants, .. }) => {
                if guard > FOUR_ULPS * point.guard.largest_term {
                    let closing = point.slider_velocity;
                    (state, Onset::Progression { drift_rate: guard, closing })
                } else {
                    surface::onset(constants, state, None, point.force)
                }
            }
        };
        Entry { instant: *instant, state, drift, onset }
    }

    /// How long the phase lasts by plain one-sided stepping (the judge): infinite if it does not end
    /// within `horizon`, none if that takes more than `evaluations`.
    #[must_use]
    pub fn judged_duration(&self, horizon: f64, evaluations: u64) -> Option<f64> {
        let mut counters = Counters::default();
        let crossing = match self.motion() {
            Motion::NoContact(flight) => {
                stepping::first_crossing(&flight, horizon, evaluations, &mut counters)
            }
            Motion::Contact(contact) => {
                stepping::first_crossing(&contact, horizon, evaluations, &mut counters)
            }
            Motion::Progression(slip) => {
                stepping::first_crossing(&slip, horizon, evaluations, &mut counters)
            }
        };
        crossing.map(|crossing| match crossing {
            Crossing::At(root) => root.elapsed().value(),
            Crossing::Horizon | Crossing::Never => f64::INFINITY,
        })
    }

    /// Whether the phase is over by then.
    #[must_use]
    pub fn ends_by(&self, instant: &Instant) -> bool {
        matches!(&self.exit, Exit::Switch(next) if next.instant <= *instant)
    }
}

fn endless(phase: Phase) -> Endless {
    match phase {
        Phase::NoContact => Endless::NeverReturns,
        Phase::Contact => Endless::RestsForEver,
        Phase::Progression => Endless::NeverStops,
    }
}

/// The next phase's beginning (its instant still that of `entry`), with what is known imposed.
fn land(model: &Model, entry: &Entry, motion: &Motion, root: &Root) -> Entry {
    let point = &root.point;
    let constants = model.constants();
    let (state, onset) = match motion {
        Motion::NoContact(_) => {
            let f = constants.two_xi * point.guard.orders[1];
            let (state, onset) = surface::onset(constants, point.state, Some(f), point.force);
            match onset {
                // The gap closed, by however little: a contact, which may end at once.
                Onset::Separation { .. } => {
                    (state, Onset::Contact { offset: f.max(0.0), reference: 0.0 })
                }
                onset => (state, onset),
            }
        }
        Motion::Contact(_) => {
            let threshold = if root.rises() { 1.0 } else { 0.0 };
            let y = point.state.y;
            let q = threshold - constants.two_xi * y;
            let onset = if root.rises() {
                Onset::Progression { drift_rate: 0.0, closing: y }
            } else {
                Onset::Separation { h_rate: 0.0 }
            };
            (State { p: q + constants.g, y, q }, onset)
        }
        Motion::Progression(_) => {
            let y = point.slider_velocity;
            let q = 1.0 - constants.two_xi * y;
            (State { p: q + constants.g, y, q }, Onset::Contact { offset: 0.0, reference: 1.0 })
        }
    };
    // Only a progression drifts.
    let still = point.drift == 0.0;
    let drift = if still { entry.drift } else { entry.drift.plus(TwoWord::new(point.drift)) };
    Entry { instant: entry.instant, state, drift, onset }
}
