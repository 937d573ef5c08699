//! The search for the attractor of a motion that approaches none of those known so far.

use super::cells::CellSet;
use super::coordinates::Coordinates;
use super::known::{Evidence, KnownAttractor, Label};
use super::limits::SearchLimits;
use super::motions::{Motions, RunMeans, SpotOf, Stop, StopOf};
use super::recognition::Recognizer;
use super::thresholds::{
    DECISION_RETURNS, FIRST_LOOK_RETURNS, LATE_LOOKS, MAX_ATTRACTORS, MAX_ENDING_RETURNS,
    MAX_FIRST_PERIOD, MAX_TURNS_INTO_TRAP, MIN_PAIRS, NEUTRAL_TOLERANCE, REFERENCE_RETURNS,
    REPEAT_TOLERANCE, ROUNDING_TOLERANCE,
};
use super::trap_search::traps;
use super::{AttractorKind, MAX_POINTS, MIN_STANDARD_ERRORS};
use crate::dynamics::linear::{ReIm, modulus};

/// The outcome of a search for the attractor of a motion.
pub(crate) enum Settled<C: Coordinates> {
    /// The motion leads to a known attractor, escapes or ends, or it is not known where it leads.
    Label(Label),
    /// The motion leads to an attractor that was not met before.
    New(Box<KnownAttractor<C>>),
}

impl<C: Coordinates> Settled<C> {
    fn new(attractor: C::Attractor, evidence: Evidence<C>) -> Self {
        Self::New(Box::new(KnownAttractor::new(attractor, evidence)))
    }

    /// A new orbit with the run that led to it.
    fn after(self, coordinates: &C, run: &[C::Spot]) -> Self {
        match self {
            Self::New(mut new) => {
                new.transient = Some(CellSet::new(coordinates, run));
                Self::New(new)
            }
            known @ Self::Label(_) => known,
        }
    }
}

/// Looks for attractors that are not known yet.
pub(crate) struct AttractorSearch<'a, M: Motions> {
    pub motions: &'a M,
    pub known: &'a [KnownAttractor<M::Coordinates>],
    pub limits: SearchLimits,
}

/// The finding, if there is one; or the end of the motion.
type Found<M, T> = Result<Option<T>, StopOf<M>>;

impl<M: Motions> AttractorSearch<'_, M> {
    /// The outcome of the search; none where it does not show so early. The `last` look takes
    /// orbits of long periods too.
    pub fn identify(&self, from: &M::Place, last: bool) -> Option<Settled<M::Coordinates>> {
        self.look_at(from, last).unwrap_or_else(|stop| match self.outcome_of_stop(stop) {
            Settled::Label(Label::Unresolved) => None,
            settled => Some(settled),
        })
    }

    /// The outcome of a motion that leads to no further return.
    pub fn outcome_of_stop(&self, stop: StopOf<M>) -> Settled<M::Coordinates> {
        match (stop.label(self.motions.coordinates(), self.known), stop) {
            (Some(label), _) | (None, Stop::Label(label)) => Settled::Label(label),
            (None, Stop::Rest(point)) => {
                let rest = M::of_run(AttractorKind::Equilibrium, &[point], &RunMeans::UNKNOWN);
                Settled::new(rest, Evidence::Rest)
            }
        }
    }

    fn look_at(&self, from: &M::Place, last: bool) -> Found<M, Settled<M::Coordinates>> {
        let short = self.limits.max_period.min(MAX_FIRST_PERIOD);
        if let Some(orbit) = self.orbit_from(from, short)? {
            return Ok(Some(orbit));
        }
        let Some(means) = self.motions.means(from, FIRST_LOOK_RETURNS) else { return Ok(None) };
        let [exponent, error] = means.largest_exponent;
        // What clearly contracts is an orbit on the way, or a long one.
        let full = self.known.len() >= MAX_ATTRACTORS;
        match (exponent < -MIN_STANDARD_ERRORS * error.max(NEUTRAL_TOLERANCE), full) {
            (true, _) if last => self.orbit_from(from, self.limits.max_period),
            (false, false) => self.reference(from),
            _ => Ok(None),
        }
    }

    /// The stable orbit, of at most so many returns, that the motion repeats from here on.
    fn orbit_from(&self, from: &M::Place, longest: u32) -> Found<M, Settled<M::Coordinates>> {
        let mut spots = Vec::new();
        let last = self.motions.follow(from, 2 * u64::from(longest), &mut |_, _, spot| {
            spots.push(spot.clone());
            None
        })?;
        self.orbit(&spots, &last)
    }

    /// The stable orbit that a motion reaches while its exponents are taken. Chaos may end then,
    /// and what lies on the way would be taken for an attractor of no kind.
    fn late_orbit(&self, from: &M::Place) -> Found<M, Settled<M::Coordinates>> {
        let mut settled = from.clone();
        for _ in 0..LATE_LOOKS {
            settled = self.motions.after(&settled, DECISION_RETURNS)?;
            let orbit = self.orbit_from(&settled, self.limits.max_period)?;
            if orbit.is_some() {
                return Ok(orbit);
            }
        }
        Ok(None)
    }

    /// The stable orbit that some returns repeat, if the motion is seen to enter its trap. A motion
    /// on a neutral orbit, which it neither leaves nor approaches however long it is followed, is
    /// unresolved.
    fn orbit(&self, spots: &[SpotOf<M>], last: &M::Place) -> Found<M, Settled<M::Coordinates>> {
        let (motions, coordinates) = (self.motions, self.motions.coordinates());
        let repeated = repeats(coordinates, spots, self.limits.max_period as usize);
        let found = repeated.and_then(|period| motions.orbit(last, period));
        let Some((orbit, places)) = found else { return Ok(None) };
        let multipliers = M::multipliers(&orbit);
        let stays = || repeats_with(coordinates, spots, places.len(), ROUNDING_TOLERANCE);
        if are_neutral(multipliers) && stays() {
            return Ok(Some(Settled::Label(Label::Unresolved)));
        }
        if !multipliers.iter().all(|it| modulus(*it) < 1.0) {
            return Ok(None);
        }
        let period = places.len() as u64;
        let own: Vec<_> = places.iter().map(|it| motions.spot_of(it)).collect();
        if self.known.iter().any(|it| it.is_orbit(coordinates, period, own.iter())) {
            let place = self.arrival(last, self.known, MAX_TURNS_INTO_TRAP * period)?;
            return Ok(place.map(|it| Settled::Label(Label::Attractor(it))));
        }
        let evidence = Evidence::Traps(traps(motions, &places));
        let new = KnownAttractor::new(motions.periodic(orbit, &places), evidence);
        let arrives =
            self.arrival(last, std::slice::from_ref(&new), MAX_TURNS_INTO_TRAP * period)?;
        Ok(arrives.map(|_| Settled::New(Box::new(new))))
    }

    /// The attractor of these that a motion is seen to approach within so many returns.
    fn arrival(
        &self,
        from: &M::Place,
        known: &[KnownAttractor<M::Coordinates>],
        returns: u64,
    ) -> Found<M, usize> {
        // The start of a motion is the first of these returns where the map counts it.
        let further = returns - u64::from(M::FIRST_RETURN_IS_START);
        match self.motions.recognise(known, from, further) {
            Ok(_) => Ok(None),
            Err(Stop::Label(Label::Attractor(place))) => Ok(Some(place)),
            Err(stop) => Err(stop),
        }
    }

    /// A long run that may turn out to be on an attractor without period.
    fn reference(&self, from: &M::Place) -> Found<M, Settled<M::Coordinates>> {
        let (motions, coordinates) = (self.motions, self.motions.coordinates());
        let longest = self.limits.max_period as usize;
        let mut recognizer = Recognizer::new(coordinates, self.known);
        let (mut points, mut spots) = (Vec::new(), Vec::with_capacity(REFERENCE_RETURNS as usize));
        let last = motions.follow(from, REFERENCE_RETURNS, &mut |n, point, spot| {
            if n + MAX_POINTS as u64 >= REFERENCE_RETURNS {
                points.push(point.clone());
            }
            spots.push(spot.clone());
            recognizer.see(n, spot).map(Label::Attractor)
        })?;
        let late = spots.len().saturating_sub(self.limits.returns() as usize);
        if let Some(orbit) = self.orbit(&spots[late..], &last)? {
            return Ok(Some(orbit.after(coordinates, &spots)));
        }
        if self.known.iter().any(|it| it.is_led_to_by(coordinates, &spots)) {
            let place = self.arrival(&last, self.known, MAX_ENDING_RETURNS)?;
            return Ok(place.map(|it| Settled::Label(Label::Attractor(it))));
        }
        let means = motions.means(&last, DECISION_RETURNS).unwrap_or(RunMeans::UNKNOWN);
        let kind = kind_of(&means, repeats(coordinates, &spots, longest).is_some());
        if kind == AttractorKind::Unidentified
            && let Some(settled) = self.late_orbit(&last)?
        {
            return Ok(Some(settled.after(coordinates, &spots)));
        }
        let attractor = M::of_run(kind, &points, &means);
        Ok(Some(Settled::new(attractor, Evidence::Cells(CellSet::new(coordinates, &spots)))))
    }
}

/// Whether the largest of an orbit's multipliers cannot be told from one on the unit circle.
fn are_neutral(multipliers: &[ReIm]) -> bool {
    let excess = multipliers.iter().map(|it| modulus(*it) - 1.0).fold(f64::NEG_INFINITY, f64::max);
    excess.abs() <= ROUNDING_TOLERANCE
}

/// The kind of the attractor of a motion that is on no orbit known as stable, by its exponents.
fn kind_of(means: &RunMeans, repeats: bool) -> AttractorKind {
    let [exponent, error] = means.largest_exponent;
    if exponent > MIN_STANDARD_ERRORS * error && exponent > NEUTRAL_TOLERANCE {
        AttractorKind::Chaotic
    } else if exponent.abs().max(means.contraction.abs()) <= NEUTRAL_TOLERANCE && !repeats {
        AttractorKind::QuasiPeriodic
    } else {
        AttractorKind::Unidentified
    }
}

/// The least period, up to a longest one, with which the last returns repeat.
pub(crate) fn repeats<C: Coordinates>(
    coordinates: &C,
    spots: &[C::Spot],
    longest: usize,
) -> Option<u32> {
    let repeats = |period: &usize| repeats_with(coordinates, spots, *period, REPEAT_TOLERANCE);
    (1..=longest).find(repeats).and_then(|period| u32::try_from(period).ok())
}

/// Whether the last returns repeat with a period to within a tolerance.
fn repeats_with<C: Coordinates>(
    coordinates: &C,
    spots: &[C::Spot],
    period: usize,
    tolerance: f64,
) -> bool {
    let pairs = period.max(MIN_PAIRS);
    let end = spots.len();
    let is_near = |n: usize| coordinates.are_near(&spots[n - period], &spots[n], tolerance);
    end >= period + pairs && (end - pairs..end).all(is_near)
}
