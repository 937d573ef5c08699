//! The motions between the returns to a section of any system.

use super::ReturnAttractor;
use super::coordinates::{SectionCoordinates, Spot};
use crate::affine::returns::exponents::Exponents;
use crate::affine::returns::map::SectionMap;
use crate::affine::returns::multipliers::orthonormal;
use crate::affine::returns::orbit::Orbit;
use crate::affine::returns::shooting::{Derivative, ReturnMap, identity};
use crate::affine::returns::walk::{NoReturn, Return};
use crate::affine::run::place::Place;
use crate::dynamics::attractor::coordinates::Coordinates;
use crate::dynamics::attractor::motions::{Motions, Observer, RunMeans, Stop, StopOf, Turn};
use crate::dynamics::attractor::thresholds::DIRECTIONS;
use crate::dynamics::attractor::trap_search::metric;
use crate::dynamics::attractor::{AttractorKind, Label};
use crate::dynamics::linear::{ReIm, product};

/// Returns in which small changes find their directions before exponents are taken.
const SETTLING_RETURNS: u64 = 64;
/// The largest number of returns by which the end of a motion is put off while they are amid events
/// of one instant.
const MAX_POSTPONED_RETURNS: u64 = 64;
/// Points of a trap's net on each of its shells for each dimension beyond three.
const DIRECTIONS_PER_DIMENSION: usize = 16;
/// Returns nearer to one another, beside 1 and their size, may be a state of rest.
const STAY_TOLERANCE: f64 = 1e-12;
/// The smallest change beside the largest one that is not a rounding of it.
const MIN_RELATIVE_CHANGE: f64 = 1e-12;

/// The motions from return to return.
#[derive(Clone, Copy)]
pub struct SectionMotions<'m> {
    pub map: &'m SectionMap<'m, f64>,
    pub coordinates: SectionCoordinates,
}

impl<'m> SectionMotions<'m> {
    pub fn new(map: &'m SectionMap<'m, f64>) -> Self {
        Self { map, coordinates: SectionCoordinates::new(map) }
    }

    /// The derivative of one turn from a place, and that of its last return.
    fn derivatives(&self, place: &Place<f64>, period: u64) -> Option<[Derivative; 2]> {
        let mut turn = identity();
        let mut last = turn;
        let mut at = place.clone();
        for _ in 0..period {
            let image = self.map.image(&at).ok()?;
            last = self.coordinates.scaled(&image.derivative);
            turn = product(&last, &turn);
            at = image.point;
        }
        Some([turn, last])
    }

    /// The axes along which a return with this derivative leaves changes; all states where it
    /// leaves nothing.
    fn axes(&self, last: &Derivative) -> Vec<Vec<f64>> {
        let dimension = self.coordinates.dimension;
        let column = |n: usize| last[..dimension].iter().map(|row| row[n]).collect::<Vec<f64>>();
        let columns: Vec<_> = (0..dimension).map(column).collect();
        let length = |it: &Vec<f64>| it.iter().map(|it| it * it).sum::<f64>().sqrt();
        let largest = columns.iter().map(length).fold(0.0, f64::max);
        let axes = orthonormal(columns, MIN_RELATIVE_CHANGE * largest);
        if !axes.is_empty() {
            return axes;
        }
        let unit = |n: usize| identity()[n][..dimension].to_vec();
        (0..dimension).filter(|n| self.coordinates.counts(*n)).map(unit).collect()
    }
}

impl Motions for SectionMotions<'_> {
    type Coordinates = SectionCoordinates;
    type Start = Place<f64>;
    type Place = Place<f64>;
    type Orbit = Orbit;

    const FIRST_RETURN_IS_START: bool = false;

    fn coordinates(&self) -> &SectionCoordinates {
        &self.coordinates
    }

    fn begin(&self, start: &Place<f64>) -> Result<Place<f64>, Label> {
        match self.map.solver().admits(start) {
            true => Ok(start.clone()),
            false => Err(Label::Inadmissible),
        }
    }

    fn spot_of(&self, place: &Place<f64>) -> Spot {
        self.coordinates.spot_of(place)
    }

    fn piece_of(&self, place: &Place<f64>) -> usize {
        place.mode
    }

    fn moved(&self, place: &Place<f64>, step: &[f64]) -> Option<(Place<f64>, Spot)> {
        let moved = self.coordinates.moved(place, step);
        let spot = self.spot_of(&moved);
        Some((moved, spot))
    }

    fn follow(
        &self,
        from: &Place<f64>,
        count: u64,
        see: &mut Observer<'_, Self>,
    ) -> Result<Place<f64>, StopOf<Self>> {
        let mut returns = self.map.returns_after(from);
        let mut last: Option<(f64, Spot)> = None;
        for n in 0..count + MAX_POSTPONED_RETURNS {
            if n >= count
                && let Ok(place) = returns.place()
            {
                return Ok(place);
            }
            let point = match returns.next() {
                Some(Ok(point)) => point,
                Some(Err(NoReturn::Equilibrium)) => return Err(Stop::Rest(returns.given_up())),
                Some(Err(NoReturn::Ended(_))) => return Err(Stop::Label(Label::Ended)),
                Some(Err(NoReturn::AmidEvents | NoReturn::AmidImpacts)) | None => break,
            };
            if self.map.has_escaped(&point.state) {
                return Err(Stop::Label(Label::Escaping));
            }
            let spot = Spot { way: returns.fired(), ..self.coordinates.spot(&point) };
            // Several returns of one instant are no rest.
            let stays = last.is_some_and(|(time, at)| {
                point.time > time
                    && self.coordinates.are_near(&at, &spot, STAY_TOLERANCE)
                    && self.map.is_rest(point.mode, &point.state, point.time - time)
            });
            if stays {
                return Err(Stop::Rest(point));
            }
            last = Some((point.time, spot.clone()));
            if let Some(label) = see(n + 1, &point, &spot) {
                return Err(Stop::Label(label));
            }
        }
        Err(Stop::Label(Label::Unresolved))
    }

    fn after(&self, from: &Place<f64>, returns: u64) -> Result<Place<f64>, StopOf<Self>> {
        self.follow(from, returns, &mut |_, _, _| None)
    }

    fn turn(&self, place: &Place<f64>, period: u64) -> Option<Turn> {
        let [turn, last] = self.derivatives(place, period)?;
        let dimension = self.coordinates.dimension;
        let metric = metric(&turn)?;
        let rows = metric[..dimension].iter().map(|row| row[..dimension].to_vec());
        Some(Turn { metric: rows.collect(), axes: self.axes(&last) })
    }

    /// Normal numbers of an evenly spread sequence (Roberts' generalised golden ratio, 2018), made
    /// of length 1.
    fn directions(dimension: usize) -> Vec<Vec<f64>> {
        if dimension == 1 {
            return vec![vec![1.0], vec![-1.0]];
        }
        let pairs = dimension.div_ceil(2);
        let golden = golden_ratio(2 * pairs);
        let part =
            |k: usize, n: usize| (0.5 + (k + 1) as f64 * golden.powi(-(n as i32 + 1))).fract();
        let direction = |k: usize| {
            let pair = |n: usize| {
                let length = (-2.0 * libm::log(part(k, 2 * n).max(f64::MIN_POSITIVE))).sqrt();
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * part(k, 2 * n + 1));
                [length * cos, length * sin]
            };
            let mut numbers: Vec<f64> = (0..pairs).flat_map(pair).collect();
            numbers.truncate(dimension);
            let size = numbers.iter().map(|it| it * it).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
            numbers.into_iter().map(|it| it / size).collect()
        };
        (0..DIRECTIONS as usize + DIRECTIONS_PER_DIMENSION * dimension.saturating_sub(3))
            .map(direction)
            .collect()
    }

    /// The means without the exponents that are zero for any motion: those along the flow of a
    /// system that is not forced, and along drifts.
    fn means(&self, from: &Place<f64>, returns: u64) -> Option<RunMeans> {
        let found = self.map.exponents(from, SETTLING_RETURNS, returns, &mut |_| ()).ok()?;
        let is_autonomous = self.map.system().forcing.is_none();
        let neutral = found.drift_per_return.len() + usize::from(is_autonomous);
        Some(RunMeans {
            largest_exponent: largest_of(&found, neutral),
            contraction: 0.0,
            drift: found.drift_per_return,
            drift_error: found.drift_standard_error,
        })
    }

    fn exponent(&self, from: &Place<f64>, returns: u64) -> f64 {
        let found = self.map.exponents(from, 0, returns, &mut |_| ());
        found.ok().and_then(|it| it.per_return.first().copied()).unwrap_or(f64::NAN)
    }

    fn orbit(&self, from: &Place<f64>, period: u32) -> Option<(Orbit, Vec<Place<f64>>)> {
        self.map.orbit_with_places(from, period).ok()
    }

    fn multipliers(orbit: &Orbit) -> &[ReIm] {
        &orbit.multipliers
    }

    fn periodic(&self, orbit: Orbit, places: &[Place<f64>]) -> ReturnAttractor {
        ReturnAttractor::periodic(self.map, orbit, places)
    }

    fn of_run(kind: AttractorKind, run: &[Return<f64>], means: &RunMeans) -> ReturnAttractor {
        ReturnAttractor::of_run(kind, run, means)
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

/// The root above 1 of x^(d+1) = x + 1.
fn golden_ratio(dimension: usize) -> f64 {
    let power = 1.0 / (dimension + 1) as f64;
    (0..64).fold(1.5, |x, _| libm::pow(1.0 + x, power))
}
