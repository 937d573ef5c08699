//! The oscillator's strobes as returns to a section.

use super::coordinates::Coordinates;
#[cfg(test)]
use super::known::Evidence;
use super::known::{KnownAttractor, Label};
use super::motions::{Motions, Observer, RunMeans, Stop, StopOf, Turn};
use super::recognition::Recognizer;
use super::thresholds::DIRECTIONS;
#[cfg(test)]
use super::trap::Trap;
use super::trap_search::metric;
use super::{Attractor, AttractorKind, horizon};
use crate::dynamics::ensemble::{self, Member, Watcher};
use crate::dynamics::linear::{IDENTITY, ReIm};
use crate::dynamics::lyapunov::Spectrum;
use crate::dynamics::orbit::Orbit;
use crate::dynamics::section::Section;
use crate::dynamics::strobe::{StrobeMap, StrobePoint};
use crate::model::entry::Entry;
use crate::phase::Phase;
use crate::run::exit::Endless;
use std::ops::ControlFlow;

/// The co-ordinates p, y, q of strobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StrobeCoordinates;

/// What is known of an attractor of the strobe map.
pub(super) type Known = KnownAttractor<StrobeCoordinates>;

/// The largest share of its terms by which p and q + g differ on the slider: some roundings.
const SLIDER_TOLERANCE: f64 = 1e-12;

impl Coordinates for StrobeCoordinates {
    type Point = StrobePoint;
    type Spot = StrobePoint;
    /// The gap, where only motions on the slider are meant: there p and q are one.
    type Piece = Option<f64>;
    type Step = StrobePoint;
    type Cell = [i64; 3];
    type Attractor = Attractor;

    fn spot(&self, point: &StrobePoint) -> StrobePoint {
        *point
    }

    fn at<'s>(&self, spot: &'s StrobePoint) -> &'s [f64] {
        spot
    }

    fn counts(&self, _: usize) -> bool {
        true
    }

    fn step(&self, from: &StrobePoint, to: &StrobePoint) -> StrobePoint {
        std::array::from_fn(|i| to[i] - from[i])
    }

    fn lies_on(&self, slider: &Option<f64>, [p, _, q]: &StrobePoint) -> bool {
        slider.is_none_or(|g| (p - q - g).abs() <= SLIDER_TOLERANCE * p.abs().max(q.abs()).max(g))
    }

    fn are_on_one_piece(&self, _: &StrobePoint, _: &StrobePoint) -> bool {
        true
    }

    fn cell(&self, spot: &StrobePoint, width: f64) -> [i64; 3] {
        spot.map(|x| (x / width).floor() as i64)
    }

    fn period(attractor: &Attractor) -> Option<u64> {
        attractor.period().map(u64::from)
    }

    fn points(attractor: &Attractor) -> &[StrobePoint] {
        &attractor.points
    }
}

/// The motions from strobe to strobe.
#[derive(Clone, Debug)]
pub(super) struct StrobeMotions {
    pub map: StrobeMap,
}

impl StrobeMotions {
    /// A recognition under way of the motion from here on, of which so many strobes after the first
    /// are looked at.
    fn motion<'a>(
        &'a self,
        known: &'a [Known],
        from: &Entry,
        most: u64,
        seen: &'a (dyn Fn(u64) + Sync),
    ) -> Member<'a, Recognition<'a>> {
        let (model, entry, first) = (self.map.model(), *from, from.instant);
        let recognizer = Recognizer::new(&StrobeCoordinates, known);
        let watcher = Recognition { recognizer, label: None, last: entry, met: 0, most, seen };
        Member { model, entry, first, horizon: Some(horizon(&first, most)), watcher }
    }

    fn spectrum(&self, from: &Entry, periods: u64) -> Spectrum {
        Spectrum::within(self.map.model(), *from, periods, horizon(&from.instant, periods))
    }
}

impl Motions for StrobeMotions {
    type Coordinates = StrobeCoordinates;
    type Start = StrobePoint;
    type Place = Entry;
    type Orbit = Orbit;

    const FIRST_RETURN_IS_START: bool = true;

    fn coordinates(&self) -> &StrobeCoordinates {
        &StrobeCoordinates
    }

    fn begin(&self, start: &StrobePoint) -> Result<Entry, Label> {
        self.map.entry(*start).map_err(|_| Label::Unresolved)
    }

    fn spot_of(&self, place: &Entry) -> StrobePoint {
        place.point()
    }

    fn piece_of(&self, place: &Entry) -> Option<f64> {
        (place.phase() != Phase::NoContact).then_some(self.map.model().parameters().g)
    }

    fn moved(&self, place: &Entry, step: &[f64]) -> Option<(Entry, StrobePoint)> {
        let centre = place.point();
        let mut start: StrobePoint = std::array::from_fn(|i| centre[i] + step[i]);
        if let Some(g) = self.piece_of(place) {
            start[2] = start[0] - g;
        }
        self.map.entry(start).ok().map(|entry| (entry, start))
    }

    fn follow(
        &self,
        from: &Entry,
        count: u64,
        see: &mut Observer<'_, Self>,
    ) -> Result<Entry, StopOf<Self>> {
        let trajectory = self.map.model().trajectory(*from);
        let until = trajectory.until(horizon(&from.instant, count));
        let mut section = Section::along(until, from.instant);
        let mut last = *from;
        for n in 0..count {
            last = section.next().ok_or(Stop::Label(Label::Unresolved))?;
            let point = last.point();
            let label = match escapes(section.endless()) {
                true => Some(Label::Escaping),
                false => see(n, &point, &point),
            };
            if let Some(label) = label {
                return Err(Stop::Label(label));
            }
        }
        Ok(last)
    }

    fn after(&self, from: &Entry, returns: u64) -> Result<Entry, StopOf<Self>> {
        let later = from.instant.after_periods(returns, 1);
        let trajectory = self.map.model().trajectory(*from).until(later);
        Section::along(trajectory, later).next().ok_or(Stop::Label(Label::Unresolved))
    }

    fn turn(&self, place: &Entry, period: u64) -> Option<Turn> {
        let rows = |matrix: [[f64; 3]; 3]| matrix.map(|row| row.to_vec()).to_vec();
        let metric = metric(&self.map.passage(place, period).free_jacobian())?;
        Some(Turn { metric: rows(metric), axes: rows(IDENTITY) })
    }

    /// A spiral by the golden angle.
    fn directions(_: usize) -> Vec<Vec<f64>> {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let direction = |k: u32| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(DIRECTIONS);
            let (sin, cos) = libm::sincos(f64::from(k) * golden);
            let across = (1.0 - z * z).sqrt();
            vec![across * cos, across * sin, z]
        };
        (0..DIRECTIONS).map(direction).collect()
    }

    fn means(&self, from: &Entry, returns: u64) -> Option<RunMeans> {
        let found = self.spectrum(from, returns);
        Some(RunMeans {
            largest_exponent: [found.exponents_per_period[0], found.standard_error[0]],
            contraction: found.contraction_per_period,
            drift: vec![found.drift_per_period],
            drift_error: vec![found.drift_standard_error],
        })
    }

    fn exponent(&self, from: &Entry, returns: u64) -> f64 {
        self.spectrum(from, returns).exponents_per_period[0]
    }

    fn orbit(&self, from: &Entry, period: u32) -> Option<(Orbit, Vec<Entry>)> {
        let orbit = Orbit::find(&self.map, from.point(), period).ok()?;
        let places = orbit.points.iter().map(|it| self.map.entry(*it)).collect::<Result<_, _>>();
        places.ok().map(|places| (orbit, places))
    }

    fn multipliers(orbit: &Orbit) -> &[ReIm] {
        &orbit.multipliers
    }

    fn periodic(&self, orbit: Orbit, _: &[Entry]) -> Attractor {
        Attractor::periodic(&self.map, orbit)
    }

    fn of_run(kind: AttractorKind, run: &[StrobePoint], means: &RunMeans) -> Attractor {
        Attractor::of_run(kind, run, means)
    }

    fn recognise(
        &self,
        known: &[Known],
        from: &Entry,
        returns: u64,
    ) -> Result<Entry, StopOf<Self>> {
        ensemble::follow_alone(self.motion(known, from, returns, &|_| {})).outcome()
    }

    /// The motions in the lanes of an ensemble.
    fn recognised_all(
        &self,
        known: &[Known],
        from: &[&Entry],
        returns: u64,
        seen: &(dyn Fn(u64) + Sync),
    ) -> Vec<Result<Entry, StopOf<Self>>> {
        let begin = |number: usize| self.motion(known, from[number], returns, seen);
        ensemble::follow(from.len(), begin).into_iter().map(Recognition::outcome).collect()
    }
}

/// Watches for what is known.
struct Recognition<'a> {
    recognizer: Recognizer<'a, StrobeCoordinates>,
    label: Option<Label>,
    last: Entry,
    /// Strobes met, and the number after which it is given up.
    met: u64,
    most: u64,
    seen: &'a (dyn Fn(u64) + Sync),
}

impl Recognition<'_> {
    /// The motion's state, or its label if it has one.
    fn outcome(self) -> Result<Entry, StopOf<StrobeMotions>> {
        self.label.map_or(Ok(self.last), |label| Err(Stop::Label(label)))
    }
}

impl Watcher for Recognition<'_> {
    fn see(&mut self, strobe: &Entry, endless: Option<Endless>) -> ControlFlow<()> {
        self.label = if escapes(endless) {
            Some(Label::Escaping)
        } else {
            self.recognizer.see(self.met, &strobe.point()).map(Label::Attractor)
        };
        (self.last, self.met) = (*strobe, self.met + 1);
        if self.label.is_some() {
            (self.seen)(1);
            return ControlFlow::Break(());
        }
        if self.met > self.most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Whether a motion is in a phase that never ends, other than rest on the slider, which is an
/// orbit.
fn escapes(endless: Option<Endless>) -> bool {
    matches!(endless, Some(Endless::NeverReturns | Endless::NeverStops))
}

/// An attractor of period 1 at a point, with a ball as its trap.
#[cfg(test)]
pub(super) fn known_point(centre: StrobePoint, radius: f64) -> Known {
    let attractor = Attractor {
        kind: AttractorKind::Periodic,
        orbit: None,
        points: vec![centre],
        drift_per_period: 0.0,
        drift_standard_error: 0.0,
        lyapunov_per_period: -1.0,
        lyapunov_error: 0.0,
    };
    let (metric, ways) = (IDENTITY.concat(), Vec::new());
    let ball = Trap { centre, piece: None, metric, radius, rest: 0.0, ways };
    Known::new(attractor, Evidence::Traps(vec![ball]))
}
