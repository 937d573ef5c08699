//! From one switch to the next: search, certificate, and the entry of the next segment.
//!
//! What every switch takes, guess, evaluation, root and landing, is inlined here: a processor has
//! to wait where a call has written words that are read back in pairs, and such calls cost a sixth
//! of a switch's time. What few switches take is kept out of the way.

use crate::crossing::candidate::CandidateSearch;
use crate::crossing::{Counters, Crossing, Guarded, Root, SearchHint};
use crate::flow::Point;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::flow::no_contact::NoContact;
use crate::flow::progression::Progression;
use crate::model::Model;
use crate::model::entry::{Entry, ModeEntry, Motion};
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::run::exit::Endless;
use crate::run::stages::{Staged, search_in_stages};
use crate::state::State;
use std::f64::consts::TAU;

/// How a phase begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begun {
    /// The instant and the state at which the phase begins.
    pub entry: Entry,
    /// The forcing angle at that instant.
    pub angle: EntryAngle<f64>,
    /// A guess of the time after which the phase ends.
    pub guess: Option<f64>,
}

/// How a segment ends, without the next entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The phase ends by a switch.
    Switch,
    /// The phase does not end before the horizon.
    Horizon,
    /// It is proved that the phase never ends.
    Endless(Endless),
    /// It is not decided within the limit of work ([`crate::crossing::limit`]).
    Undecidable,
}

/// A phase that may have come to its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhaseEnd {
    /// How it ends.
    pub end: End,
    /// How long it lasts; up to the horizon if that cuts it, infinite if it is endless, as far as
    /// it is proved if it is undecidable.
    pub duration: TwoWord,
}

/// What the search of a phase's end has found; a crossing leads to the next phase.
#[derive(Clone, Copy, Debug)]
enum SearchEnd {
    /// The phase ends by a crossing after this time.
    At(TwoWord),
    /// There is no crossing before the horizon.
    Horizon,
    /// There is never a crossing, which is proved.
    Never,
    /// There is no crossing until this time, when the motion is to be taken up again
    /// ([`Guarded::stage`]).
    Stage(f64),
    /// There is no crossing until this time, and no decision after it within the limit of work.
    Undecided(f64),
}

/// The forcing angle by which a phase is cut that has no horizon: in two words nothing is known of
/// the angle much later, and squares of times would overflow.
const MAX_PHASE_RADIANS: f64 = 1e30;

/// The forcing angle by which a search looks beyond its horizon, radians.
const LOOK_AHEAD_RADIANS: f64 = 0.1;

/// The forcing angle beyond the horizon up to which a switch next to it is looked for again,
/// radians: guesses see nothing of a horizon as far away, and the work that it takes stays small.
const SECOND_LOOK_RADIANS: f64 = 256.0;

/// How the phase that follows begins, by the phase that ends.
trait Landing: Guarded {
    /// The reason for which a phase of this kind has no end.
    const NO_END: Endless;

    /// State and mode of the next phase, with what is known imposed.
    fn land(&self, root: &Root) -> (State, ModeEntry);

    /// Searches on from where a stage has ended ([`Guarded::stage`]); only a contact has stages.
    fn in_stages(
        &self,
        _: &Model,
        _: (&Begun, &mut Begun),
        (from, _): (f64, f64),
        _: &mut Counters,
    ) -> SearchEnd {
        SearchEnd::Undecided(from)
    }
}

/// Finds how a phase ends; if by a switch, `next` becomes the one that follows, else it holds
/// nothing of use. Switches after `horizon` do not count.
pub(crate) fn pass(
    model: &Model,
    begun: &Begun,
    next: &mut Begun,
    horizon: Option<&Instant>,
    counters: &mut Counters,
) -> PhaseEnd {
    match Motion::new(model.constants(), &begun.entry, begun.angle) {
        Motion::NoContact(flight) => pass_by(&flight, model, (begun, next), horizon, counters),
        Motion::Contact(contact) => pass_by(&contact, model, (begun, next), horizon, counters),
        Motion::Progression(slip) => pass_by(&slip, model, (begun, next), horizon, counters),
    }
}

#[inline(always)]
fn pass_by<P: Landing>(
    phase: &P,
    model: &Model,
    (begun, next): (&Begun, &mut Begun),
    horizon: Option<&Instant>,
    counters: &mut Counters,
) -> PhaseEnd {
    let omega = model.parameters().omega;
    let instant = &begun.entry.instant;
    // The horizon in two words is computed only where it matters. It is looked beyond by more than
    // guesses err, so that a switch next to it is found as without it; its instant decides.
    let beyond = LOOK_AHEAD_RADIANS / omega;
    let (certain, limit) = horizon.map_or((f64::INFINITY, MAX_PHASE_RADIANS / omega), |h| {
        let (certain, limit) = h.since_roughly(instant, omega);
        (certain - beyond, limit + beyond)
    });
    match find_end(phase, model, (begun, next), limit, counters) {
        SearchEnd::At(elapsed) if elapsed.high <= certain => {
            counters.switches += 1;
            PhaseEnd { end: End::Switch, duration: elapsed }
        }
        found => pass_late(phase, model, (begun, next), (horizon, limit, found), counters),
    }
}

/// Searches a phase's end: a candidate first, then the certificate that it is the first crossing.
///
/// The next phase begins at the candidate's root, before the certificate, so that the processor
/// works on both. If the certificate fails and the search finds another root, the phase begins
/// there; if it finds none, what has begun counts for nothing.
#[inline(always)]
fn find_end<P: Landing>(
    phase: &P,
    model: &Model,
    (begun, next): (&Begun, &mut Begun),
    limit: f64,
    counters: &mut Counters,
) -> SearchEnd {
    let solved = (phase, model.steps());
    let search = CandidateSearch::new(solved, begun.guess, limit);
    let mut candidate = None;
    if let Some(guess) = search.guess(limit) {
        candidate = Some(match CandidateSearch::candidate(phase, guess, limit, counters) {
            Ok(root) => {
                *next = begun.after(model, phase, &root);
                if search.confirm(solved, &root, limit) {
                    return SearchEnd::At(root.elapsed());
                }
                Ok(root)
            }
            Err(point) => Err(point),
        });
    }
    let verdict = search.search(solved, candidate, limit, counters);
    if let Crossing::At(root) = &verdict {
        *next = begun.after(model, phase, root);
    }
    SearchEnd::new(&verdict)
}

/// Settles how a phase ends next to a horizon, or where no switch has been found so far.
#[cold]
#[inline(never)]
fn pass_late<P: Landing>(
    phase: &P,
    model: &Model,
    (begun, next): (&Begun, &mut Begun),
    (horizon, limit, found): (Option<&Instant>, f64, SearchEnd),
    counters: &mut Counters,
) -> PhaseEnd {
    let (omega, instant) = (model.parameters().omega, &begun.entry.instant);
    let left = || horizon.map_or(MAX_PHASE_RADIANS / omega, |h| h.since(instant, omega).value());
    let ended = |end, duration| PhaseEnd { end, duration: TwoWord::new(duration) };
    let found = match found {
        SearchEnd::Stage(from) => phase.in_stages(model, (begun, next), (from, limit), counters),
        found => found,
    };
    match found {
        SearchEnd::At(elapsed) => {
            let elapsed = horizon.map_or(elapsed, |_| {
                let limit = limit + SECOND_LOOK_RADIANS / omega;
                found_later(phase, model, (begun, next), limit, counters).unwrap_or(elapsed)
            });
            if horizon.is_some_and(|it| next.entry.instant > *it) {
                return ended(End::Horizon, left());
            }
            counters.switches += 1;
            PhaseEnd { end: End::Switch, duration: elapsed }
        }
        SearchEnd::Never if left() > 0.0 => ended(End::Endless(P::NO_END), f64::INFINITY),
        SearchEnd::Undecided(elapsed) if elapsed < left() => ended(End::Undecidable, elapsed),
        // A horizon that is past leaves a phase of no length.
        _ => ended(End::Horizon, left().max(0.0)),
    }
}

/// The switch next to a horizon as it is found with a later one, or none: a search that looks no
/// further may come to it by another way, and so to other last digits.
fn found_later<P: Landing>(
    phase: &P,
    model: &Model,
    (begun, next): (&Begun, &mut Begun),
    limit: f64,
    counters: &mut Counters,
) -> Option<TwoWord> {
    let mut again = *begun;
    let mut counted = Counters::default();
    let found = match find_end(phase, model, (begun, &mut again), limit, &mut counted) {
        SearchEnd::Stage(from) => {
            phase.in_stages(model, (begun, &mut again), (from, limit), &mut counted)
        }
        found => found,
    };
    counters.evaluations += counted.evaluations;
    let SearchEnd::At(elapsed) = found else { return None };
    *next = again;
    Some(elapsed)
}

impl SearchEnd {
    fn new(crossing: &Crossing) -> Self {
        match crossing {
            Crossing::At(root) => Self::At(root.elapsed()),
            Crossing::Horizon => Self::Horizon,
            Crossing::Never => Self::Never,
            Crossing::Stage(elapsed) => Self::Stage(*elapsed),
            Crossing::Undecided(elapsed) => Self::Undecided(*elapsed),
        }
    }
}

impl Begun {
    /// A phase of which no more is known: its end is guessed when it is passed, but for a gap that
    /// closes soon.
    pub(crate) fn at(model: &Model, entry: Entry) -> Self {
        let angle = model.forcing_angle(&entry.instant);
        let guess = match Motion::new(model.constants(), &entry, angle) {
            Motion::NoContact(flight) => flight.first_closing(),
            Motion::Contact(_) | Motion::Progression(_) => None,
        };
        Self { entry, angle, guess }
    }

    /// The phase that begins at this root of this one.
    ///
    /// The guess does not wait for the new forcing angle, which takes two words and a table: the
    /// force at the root is known, and is as good. So the processor works on both, and then on the
    /// certificate of the phase that has ended.
    #[inline(always)]
    fn after<P: Landing>(&self, model: &Model, phase: &P, root: &Root) -> Self {
        let Root { point, .. } = root;
        let (instant, angle) = model.instant_after(&self.entry.instant, root.elapsed());
        let (state, mode) = phase.land(root);
        // Only a progression drifts.
        let still = point.drift == 0.0;
        let before = self.entry.drift;
        let drift = if still { before } else { before.plus(TwoWord::new(point.drift)) };
        let entry = Entry { instant, state, drift, mode };
        let about = roughly_after(&self.angle, model.constants(), point);
        Self { entry, angle, guess: guess(model, &entry, about) }
    }
}

/// The forcing angle at this point of a phase that began at `angle`, for guesses: a times its sine
/// and cosine are good to some roundings of the force.
#[inline]
fn roughly_after(
    angle: &EntryAngle<f64>,
    constants: &Constants<f64>,
    point: &Point<f64>,
) -> EntryAngle<f64> {
    let Constants { omega, per_a, per_omega, .. } = *constants;
    let radians = angle.radians + omega * point.elapsed;
    let turns = (radians * (1.0 / TAU)) as i64 as f64;
    EntryAngle {
        radians: radians - turns * TAU,
        sin: -(point.force[1] * (per_a * per_omega)),
        cos: point.force[0] * per_a,
    }
}

/// When the phase that begins at `entry`, at about this forcing angle, may end.
#[inline(always)]
fn guess(model: &Model, entry: &Entry, angle: EntryAngle<f64>) -> Option<f64> {
    let steps = model.steps();
    let hint = match Motion::new(model.constants(), entry, angle) {
        Motion::NoContact(flight) => flight.hint(steps, &flight.entry(), f64::INFINITY),
        Motion::Contact(contact) => contact.hint(steps, &contact.entry(), f64::INFINITY),
        Motion::Progression(slip) => slip.hint(steps, &slip.entry(), f64::INFINITY),
    };
    // What a hint proves is not to be proved from a rough angle.
    match hint {
        SearchHint::Root(time) => Some(time),
        _ => None,
    }
}

impl Landing for NoContact<f64, &Constants<f64>> {
    const NO_END: Endless = Endless::NeverReturns;

    #[inline]
    fn land(&self, root: &Root) -> (State, ModeEntry) {
        let Root { point, .. } = root;
        let f = self.constants.two_xi * point.guard.orders[1];
        let (state, mode) =
            ModeEntry::on_surface(self.constants, point.state, Some(f), point.force);
        match mode {
            // The gap closed, by however little: a contact, which may end at once.
            ModeEntry::Separation { .. } => {
                (state, ModeEntry::Contact { offset: f.max(0.0), reference: 0.0 })
            }
            mode => (state, mode),
        }
    }
}

impl Landing for Contact<f64, &Constants<f64>> {
    const NO_END: Endless = Endless::RestsForEver;

    #[inline]
    fn land(&self, root: &Root) -> (State, ModeEntry) {
        let y = root.point.state.y;
        let (threshold, mode) = if root.rises() {
            (1.0, ModeEntry::Progression { drift_rate: 0.0, closing: y })
        } else {
            (0.0, ModeEntry::Separation { h_rate: 0.0 })
        };
        let q = threshold - self.constants.two_xi * y;
        (State { p: q + self.constants.g, y, q }, mode)
    }

    fn in_stages(
        &self,
        model: &Model,
        (begun, next): (&Begun, &mut Begun),
        span: (f64, f64),
        counters: &mut Counters,
    ) -> SearchEnd {
        let Staged { contact, crossing } =
            search_in_stages(model, self, &begun.entry.instant, span, counters);
        if let Crossing::At(root) = &crossing {
            *next = begun.after(model, &contact, root);
        }
        SearchEnd::new(&crossing)
    }
}

impl Landing for Progression<f64, &Constants<f64>> {
    const NO_END: Endless = Endless::NeverStops;

    #[inline]
    fn land(&self, root: &Root) -> (State, ModeEntry) {
        let y = root.point.slider_velocity;
        let q = 1.0 - self.constants.two_xi * y;
        (
            State { p: q + self.constants.g, y, q },
            ModeEntry::Contact { offset: 0.0, reference: 1.0 },
        )
    }
}

#[cfg(test)]
#[path = "switch_tests.rs"]
mod tests;
