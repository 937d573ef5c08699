//! What a motion settles on that approaches no attractor known so far.

use super::cells::CellSet;
use super::known::{Evidence, KnownAttractor, Label};
use super::limits::SearchLimits;
use super::recognition::{Recognizer, escapes};
use super::thresholds::{
    CLOSE, DECISION, GLANCE, LATE_LOOKS, MOST_ATTRACTORS, NEUTRAL, OUTLASTING, PAIRS, REFERENCE,
    SHORT, TURNS_INTO_TRAP,
};
use super::trap::Trap;
use super::{Attractor, AttractorKind, ERRORS, horizon};
use crate::dynamics::lyapunov::Spectrum;
use crate::dynamics::orbit::Orbit;
use crate::dynamics::section::Section;
use crate::dynamics::strobe::{StrobeMap, StrobePoint};
use crate::model::entry::Entry;

/// Forcing periods of all runs that decide about an attractor that is no orbit.
pub(super) const LONG_RUN: u64 = GLANCE + REFERENCE + DECISION;

/// What a motion has settled on.
pub(super) enum Settled {
    /// The motion leads to a known attractor or escapes, or it is not known where it leads.
    Label(Label),
    /// The motion leads to an attractor that was not met before.
    New(Box<KnownAttractor>),
}

impl Settled {
    /// A new orbit with the run that led to it.
    fn after(self, run: &[StrobePoint]) -> Self {
        match self {
            Self::New(new) => {
                Self::New(Box::new(KnownAttractor { transient: Some(CellSet::of(run)), ..*new }))
            }
            known @ Self::Label(_) => known,
        }
    }
}

/// Looks for attractors of a map that are not known yet.
pub(super) struct AttractorSearch<'a> {
    pub map: &'a StrobeMap,
    pub known: &'a [KnownAttractor],
    pub limits: SearchLimits,
}

impl AttractorSearch<'_> {
    /// What a motion settles on; none where that does not show so early. The `last` look takes
    /// orbits of long periods too.
    pub fn identified(&self, from: Entry, last: bool) -> Option<Settled> {
        let short = self.limits.max_period.min(SHORT);
        if let Some(orbit) = self.orbit_from(from, short) {
            return Some(orbit);
        }
        let glance = self.spectrum(from, GLANCE);
        // What clearly contracts is an orbit on the way, or a long one.
        let full = self.known.len() >= MOST_ATTRACTORS;
        let contracts =
            glance.exponents_per_period[0] < -ERRORS * glance.standard_error[0].max(NEUTRAL);
        match (contracts, full) {
            (true, _) if last => self.orbit_from(from, self.limits.max_period),
            (false, false) => self.reference(from),
            _ => None,
        }
    }

    /// The stable orbit, of at most so many periods, that the motion repeats from here on.
    fn orbit_from(&self, from: Entry, longest: u32) -> Option<Settled> {
        let count = 2 * u64::from(longest);
        let strobes: Vec<Entry> = self.section(from, count).take(count as usize).collect();
        self.orbit(&strobes)
    }

    /// The motion's strobes, of which so many are looked at.
    fn section(&self, from: Entry, strobes: u64) -> Section {
        let trajectory = self.map.model().trajectory(from);
        Section::along(trajectory.until(horizon(&from.instant, strobes)), from.instant)
    }

    /// The motion's exponents over so many forcing periods.
    fn spectrum(&self, from: Entry, periods: u64) -> Spectrum {
        Spectrum::within(self.map.model(), from, periods, horizon(&from.instant, periods))
    }

    /// The stable orbit that a motion reaches while its exponents are taken. Chaos may end then,
    /// and what lies on the way would be taken for an attractor of no kind.
    fn late_orbit(&self, from: Entry) -> Option<Settled> {
        let mut settled = from;
        for _ in 0..LATE_LOOKS {
            settled = self.section(settled, DECISION).nth(DECISION as usize)?;
            let orbit = self.orbit_from(settled, self.limits.max_period);
            if orbit.is_some() {
                return orbit;
            }
        }
        None
    }

    /// The stable orbit that some strobes repeat, if the motion is seen to enter its trap.
    fn orbit(&self, strobes: &[Entry]) -> Option<Settled> {
        let points: Vec<StrobePoint> = strobes.iter().map(Entry::point).collect();
        let last = strobes.last()?;
        let longest = self.limits.max_period as usize;
        let orbit = Orbit::find(self.map, last.point(), repeats(&points, longest)?).ok()?;
        if !orbit.is_stable() {
            return None;
        }
        if self.known.iter().any(|known| known.is_orbit(&orbit)) {
            let place =
                self.arrival(*last, self.known, TURNS_INTO_TRAP * u64::from(orbit.period()))?;
            return Some(Settled::Label(Label::Attractor(place)));
        }
        let traps = Trap::all(self.map, &orbit);
        let period = u64::from(orbit.period());
        let attractor = Attractor::periodic(self.map, orbit);
        let new = KnownAttractor { attractor, evidence: Evidence::Traps(traps), transient: None };
        self.arrival(*last, std::slice::from_ref(&new), TURNS_INTO_TRAP * period)?;
        Some(Settled::New(Box::new(new)))
    }

    /// The attractor of these that a motion is seen to approach within so many strobes.
    fn arrival(&self, from: Entry, known: &[KnownAttractor], strobes: u64) -> Option<usize> {
        let mut recognizer = Recognizer::new(known);
        let ahead = self.section(from, strobes);
        (0..strobes).zip(ahead).find_map(|(n, it)| recognizer.see(n, &it.point()))
    }

    /// A long run that may turn out to be on an attractor without period.
    fn reference(&self, from: Entry) -> Option<Settled> {
        let mut section = self.section(from, REFERENCE);
        let mut recognizer = Recognizer::new(self.known);
        let mut run = Vec::with_capacity(REFERENCE as usize);
        for n in 0..REFERENCE {
            let strobe = section.next()?;
            if escapes(section.endless()) {
                return Some(Settled::Label(Label::Escaping));
            }
            if let Some(known) = recognizer.see(n, &strobe.point()) {
                return Some(Settled::Label(Label::Attractor(known)));
            }
            run.push(strobe);
        }
        let late = run.len().saturating_sub(self.limits.strobes() as usize);
        let points: Vec<StrobePoint> = run.iter().map(Entry::point).collect();
        if let Some(orbit) = self.orbit(&run[late..]) {
            return Some(orbit.after(&points));
        }
        let last = *run.last()?;
        if self.known.iter().any(|known| known.is_led_to_by(&points)) {
            let place = self.arrival(last, self.known, OUTLASTING)?;
            return Some(Settled::Label(Label::Attractor(place)));
        }
        let spectrum = self.spectrum(last, DECISION);
        let longest = self.limits.max_period as usize;
        let kind = kind_of(&spectrum, repeats(&points, longest).is_some());
        if kind == AttractorKind::Unidentified
            && let Some(settled) = self.late_orbit(last)
        {
            return Some(settled.after(&points));
        }
        let attractor = Attractor::of_run(kind, &points, &spectrum);
        let evidence = Evidence::Cells(CellSet::of(&points));
        Some(Settled::New(Box::new(KnownAttractor { attractor, evidence, transient: None })))
    }
}

/// What a motion that is on no orbit known as stable is, by its exponents.
fn kind_of(spectrum: &Spectrum, repeats: bool) -> AttractorKind {
    let [largest, ..] = spectrum.exponents_per_period;
    if spectrum.is_chaotic(ERRORS) && largest > NEUTRAL {
        AttractorKind::Chaotic
    } else if largest.abs().max(spectrum.contraction_per_period.abs()) <= NEUTRAL && !repeats {
        AttractorKind::QuasiPeriodic
    } else {
        AttractorKind::Unidentified
    }
}

/// The least period, up to a longest one, with which the last strobes repeat.
pub(super) fn repeats(points: &[StrobePoint], longest: usize) -> Option<u32> {
    let repeats = |period: usize| {
        let pairs = period.max(PAIRS);
        let end = points.len();
        end >= period + pairs && (end - pairs..end).all(|i| near(&points[i], &points[i - period]))
    };
    (1..=longest).find(|period| repeats(*period)).and_then(|period| u32::try_from(period).ok())
}

fn near(a: &StrobePoint, b: &StrobePoint) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= CLOSE * (1.0 + b.abs()))
}
