//! What a motion settles on that approaches no attractor known so far.

use super::cells::CellSet;
use super::known::{Evidence, KnownAttractor};
use super::recognition::Recognizer;
use super::space::{Space, Spot, Stop};
use super::trap::Trap;
use super::{ERRORS, POINTS, ReturnAttractor, RunMeans};
use crate::affine::returns::exponents::Exponents;
use crate::affine::run::place::Place;
use crate::dynamics::attractor::thresholds::{
    CLOSE, DECISION, GLANCE, LATE_LOOKS, MOST_ATTRACTORS, NEUTRAL, OUTLASTING, PAIRS, REFERENCE,
    SHORT, TURNS_INTO_TRAP,
};
use crate::dynamics::attractor::{AttractorKind, Label, SearchLimits};

/// Returns in which small changes find their directions before exponents are taken.
const SETTLING: u64 = 64;

/// What a motion has settled on.
pub enum Settled {
    /// The motion leads to a known attractor or ends, or it is not known where it leads.
    Label(Label),
    /// The motion leads to an attractor that was not met before.
    New(Box<KnownAttractor>),
}

impl Settled {
    /// A new orbit with the run that led to it.
    fn after(self, run: &[Spot], dimension: usize) -> Self {
        match self {
            Self::New(mut new) => {
                new.transient = Some(CellSet::of(run, dimension));
                Self::New(new)
            }
            known @ Self::Label(_) => known,
        }
    }
}

/// Looks for attractors of a map that are not known yet.
pub struct AttractorSearch<'a> {
    pub space: &'a Space<'a>,
    pub known: &'a [KnownAttractor],
    pub limits: SearchLimits,
}

impl AttractorSearch<'_> {
    /// What a motion settles on; none where that does not show so early. The `last` look takes
    /// orbits of long periods too.
    pub fn identified(&self, from: &Place<f64>, last: bool) -> Option<Settled> {
        self.looked_at(from, last).unwrap_or_else(|stop| Some(self.stopped(stop)))
    }

    /// What a motion has settled on that leads to no further return.
    pub fn stopped(&self, stop: Stop) -> Settled {
        match stop {
            Stop::Label(label) => Settled::Label(label),
            Stop::Rest(point) => {
                let known = self.known.iter().position(|it| it.rests_at(self.space, &point));
                if let Some(place) = known {
                    return Settled::Label(Label::Attractor(place));
                }
                let (kind, means) = (AttractorKind::Equilibrium, RunMeans::UNKNOWN);
                let rest = ReturnAttractor::of_run(kind, &[point], means);
                Settled::New(Box::new(KnownAttractor::new(self.space, rest, Evidence::Rest)))
            }
        }
    }

    fn looked_at(&self, from: &Place<f64>, last: bool) -> Result<Option<Settled>, Stop> {
        let short = self.limits.max_period.min(SHORT);
        if let Some(orbit) = self.orbit_from(from, short)? {
            return Ok(Some(orbit));
        }
        let Some(means) = self.means(from, GLANCE) else { return Ok(None) };
        let [exponent, error] = means.largest_exponent;
        // What clearly contracts is an orbit on the way, or a long one.
        let full = self.known.len() >= MOST_ATTRACTORS;
        match (exponent < -ERRORS * error.max(NEUTRAL), full) {
            (true, _) if last => self.orbit_from(from, self.limits.max_period),
            (false, false) => self.reference(from).map(Some),
            _ => Ok(None),
        }
    }

    /// The stable orbit, of at most so many returns, that the motion repeats from here on.
    fn orbit_from(&self, from: &Place<f64>, longest: u32) -> Result<Option<Settled>, Stop> {
        let mut spots = Vec::new();
        let last = self.space.follow(from, 2 * u64::from(longest), &mut |_, _, spot| {
            spots.push(spot.clone());
            None
        })?;
        self.orbit(&spots, &last)
    }

    /// The means of the motion over so many returns. Exponents that are zero for any motion are
    /// those along the flow of a system that is not forced, and along drifts.
    fn means(&self, from: &Place<f64>, returns: u64) -> Option<RunMeans> {
        let map = self.space.map;
        let found = map.exponents(from, SETTLING, returns, &mut |_| ()).ok()?;
        let is_autonomous = map.system().forcing.is_none();
        let neutral = found.drift_per_return.len() + usize::from(is_autonomous);
        Some(RunMeans {
            largest_exponent: largest_of(&found, neutral),
            drift: found.drift_per_return,
            drift_error: found.drift_standard_error,
        })
    }

    /// The stable orbit that a motion reaches while its exponents are taken. Chaos may end then,
    /// and what lies on the way would be taken for an attractor of no kind.
    fn late_orbit(&self, from: &Place<f64>) -> Result<Option<Settled>, Stop> {
        let mut settled = from.clone();
        for _ in 0..LATE_LOOKS {
            settled = self.space.follow(&settled, DECISION, &mut |_, _, _| None)?;
            let orbit = self.orbit_from(&settled, self.limits.max_period)?;
            if orbit.is_some() {
                return Ok(orbit);
            }
        }
        Ok(None)
    }

    /// The stable orbit that some returns repeat, if the motion is seen to enter its trap.
    fn orbit(&self, spots: &[Spot], last: &Place<f64>) -> Result<Option<Settled>, Stop> {
        let (space, longest) = (self.space, self.limits.max_period as usize);
        let Some(period) = repeats(space, spots, longest) else { return Ok(None) };
        let Ok((orbit, places)) = space.map.orbit_with_places(last, period) else {
            return Ok(None);
        };
        if !orbit.is_stable() {
            return Ok(None);
        }
        let turns = TURNS_INTO_TRAP * orbit.period() as u64;
        let own: Vec<Spot> = places.iter().map(|it| space.spot_of(it)).collect();
        if self.known.iter().any(|it| it.is_orbit(space, own.len() as u64, &own)) {
            let place = self.arrival(last, self.known, turns)?;
            return Ok(place.map(|it| Settled::Label(Label::Attractor(it))));
        }
        let traps = Trap::all(space, &places);
        let attractor = ReturnAttractor::periodic(space.map, orbit, &places);
        let new = KnownAttractor::new(space, attractor, Evidence::Traps(traps));
        let arrives = self.arrival(last, std::slice::from_ref(&new), turns)?;
        Ok(arrives.map(|_| Settled::New(Box::new(new))))
    }

    /// The attractor of these that a motion is seen to approach within so many returns.
    fn arrival(
        &self,
        from: &Place<f64>,
        known: &[KnownAttractor],
        returns: u64,
    ) -> Result<Option<usize>, Stop> {
        let mut recognizer = Recognizer::new(self.space, known);
        let found = self
            .space
            .follow(from, returns, &mut |n, _, spot| recognizer.see(n, spot).map(Label::Attractor));
        match found {
            Ok(_) => Ok(None),
            Err(Stop::Label(Label::Attractor(place))) => Ok(Some(place)),
            Err(stop) => Err(stop),
        }
    }

    /// A long run that may turn out to be on an attractor without period.
    fn reference(&self, from: &Place<f64>) -> Result<Settled, Stop> {
        let (space, longest) = (self.space, self.limits.max_period as usize);
        let mut recognizer = Recognizer::new(space, self.known);
        let (mut points, mut spots) = (Vec::new(), Vec::with_capacity(REFERENCE as usize));
        let last = space.follow(from, REFERENCE, &mut |n, point, spot| {
            if n + POINTS as u64 >= REFERENCE {
                points.push(point.clone());
            }
            spots.push(spot.clone());
            recognizer.see(n, spot).map(Label::Attractor)
        })?;
        let late = spots.len().saturating_sub(2 * longest);
        if let Some(orbit) = self.orbit(&spots[late..], &last)? {
            return Ok(orbit.after(&spots, space.dimension));
        }
        if self.known.iter().any(|known| known.is_led_to_by(&spots)) {
            let place = self.arrival(&last, self.known, OUTLASTING)?;
            return Ok(Settled::Label(place.map_or(Label::Unresolved, Label::Attractor)));
        }
        let means = self.means(&last, DECISION).unwrap_or(RunMeans::UNKNOWN);
        let kind = kind_of(means.largest_exponent, repeats(space, &spots, longest).is_some());
        if kind == AttractorKind::Unidentified
            && let Some(settled) = self.late_orbit(&last)?
        {
            return Ok(settled.after(&spots, space.dimension));
        }
        let attractor = ReturnAttractor::of_run(kind, &points, means);
        let evidence = Evidence::Cells(CellSet::of(&spots, space.dimension));
        Ok(Settled::New(Box::new(KnownAttractor::new(space, attractor, evidence))))
    }
}

/// The largest exponent and its error, without so many of those nearest to zero.
fn largest_of(found: &Exponents, neutral: usize) -> [f64; 2] {
    let pairs = found.per_return.iter().zip(&found.standard_error);
    let mut all: Vec<[f64; 2]> = pairs.map(|(exponent, error)| [*exponent, *error]).collect();
    all.sort_by(|a, b| a[0].abs().total_cmp(&b[0].abs()));
    let kept = all.into_iter().skip(neutral);
    kept.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or([f64::NEG_INFINITY, f64::NAN])
}

/// What a motion that is on no orbit known as stable is, by its largest exponent and the error.
fn kind_of([exponent, error]: [f64; 2], repeats: bool) -> AttractorKind {
    if exponent > ERRORS * error && exponent > NEUTRAL {
        AttractorKind::Chaotic
    } else if exponent.abs() <= NEUTRAL && !repeats {
        AttractorKind::QuasiPeriodic
    } else {
        AttractorKind::Unidentified
    }
}

/// The least period, up to a longest one, with which the last returns repeat.
pub fn repeats(space: &Space<'_>, spots: &[Spot], longest: usize) -> Option<u32> {
    let repeats = |period: usize| {
        let pairs = period.max(PAIRS);
        let end = spots.len();
        let is_near = |n: usize| near(space, &spots[n - period], &spots[n]);
        end >= period + pairs && (end - pairs..end).all(is_near)
    };
    (1..=longest).find(|period| repeats(*period)).and_then(|period| u32::try_from(period).ok())
}

fn near(space: &Space<'_>, from: &Spot, to: &Spot) -> bool {
    let step = space.step(from, to);
    let small = |(by, at): (&f64, &f64)| by.abs() <= CLOSE * (1.0 + at.abs());
    from.mode == to.mode && step.iter().zip(&from.at).all(small)
}
