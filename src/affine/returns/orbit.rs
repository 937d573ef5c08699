//! Periodic orbits of a section's return map, stable or not.

use super::map::SectionMap;
use super::multipliers::multipliers;
use super::passage::Passage;
use super::section::Guard;
use super::shooting::{Change, Derivative, Image, MAX_COORDINATES, ReturnMap, Shots};
use super::walk::{NoReturn, Return};
use crate::affine::model::system::System;
use crate::affine::run::place::Place;
use crate::dynamics::orbit::newton::{minimal_orbit, solve};
use std::fmt;

/// The largest period that is looked for, in returns.
pub const LARGEST_PERIOD: u32 = 10_000;

/// A periodic orbit of a section's return map.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// The orbit's points, as many as its least period.
    pub points: Vec<Return<f64>>,
    /// The time of one whole period.
    pub time: f64,
    /// The events of one whole period, in order, from the first point on.
    pub events: Vec<Guard>,
    /// The multipliers of the whole orbit, real and imaginary part, largest modulus first, as many
    /// as states without [drifts](System::drifts); zero for a direction that a section or a reset
    /// removes.
    pub multipliers: Vec<[f64; 2]>,
    /// The mean change per return of each of the [drifts](System::drifts), in their order.
    pub drift_per_return: Vec<f64>,
    /// The largest distance of an image to the next point, over 1 + |point|.
    pub residual: f64,
    /// Whether rounding left no order of events open: where it did, the multipliers may be those of
    /// one side.
    pub is_decided: bool,
}

impl Orbit {
    /// The number of returns after which the orbit closes.
    #[must_use]
    pub fn period(&self) -> usize {
        self.points.len()
    }

    /// Whether all multipliers are inside the unit circle.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|[re, im]| libm::hypot(*re, *im) < 1.0)
    }

    /// The events by their names, as `impact@free`.
    #[must_use]
    pub fn event_names(&self, system: &System) -> Vec<String> {
        self.events.iter().map(|it| it.name(system)).collect()
    }
}

/// The reason for which no orbit was reached.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoOrbit {
    /// The period is not one of 1 to 10000 returns.
    Period(u32),
    /// The motion from the guess does not return.
    NoReturn(NoReturn),
    /// No step comes closer, or the steps come closer too slowly: this is the least residual.
    Stalled(f64),
    /// A state of rest was reached, such as the limit of impacts, which returns in this time.
    Rest(f64),
    /// The derivative of an orbit that was reached is not finite.
    NoDerivative(f64),
}

impl fmt::Display for NoOrbit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Period(period) => {
                write!(f, "period {period} is not accepted: 1 to {LARGEST_PERIOD} is")
            }
            Self::NoReturn(why) => write!(f, "no orbit: {why}"),
            Self::Stalled(residual) => {
                write!(f, "no orbit: no step comes closer, residual {residual:.3e}")
            }
            Self::Rest(time) => {
                write!(f, "no orbit: the motion is at rest, and returns in a time of {time:.3e}")
            }
            Self::NoDerivative(residual) => {
                write!(
                    f,
                    "no multipliers: the return map has no derivative, residual {residual:.3e}"
                )
            }
        }
    }
}

impl std::error::Error for NoOrbit {}

impl SectionMap<'_, f64> {
    /// The orbit that Newton's method reaches from a guess, of `period` returns or, if it closes
    /// sooner, of a divisor of them.
    ///
    /// # Errors
    /// [`NoOrbit`] says why none was reached and how close it came.
    pub fn orbit(&self, guess: &Place<f64>, period: u32) -> Result<Orbit, NoOrbit> {
        self.orbit_with_places(guess, period).map(|(orbit, _)| orbit)
    }

    /// The same orbit, and the places of its points.
    pub(in crate::affine) fn orbit_with_places(
        &self,
        guess: &Place<f64>,
        period: u32,
    ) -> Result<(Orbit, Vec<Place<f64>>), NoOrbit> {
        if !(1..=LARGEST_PERIOD).contains(&period) {
            return Err(NoOrbit::Period(period));
        }
        let shots = Shots::follow(self, &self.rebased(guess), period).map_err(NoOrbit::NoReturn)?;
        let shots = solve(self, shots).map_err(|it| NoOrbit::Stalled(it.residual))?;
        let shots = minimal_orbit(self, shots);
        let orbit = self.of_shots(&shots).ok_or(NoOrbit::NoDerivative(shots.residual))?;
        let first = &orbit.points[0];
        if self.is_rest(first.mode, &first.state, orbit.time) {
            return Err(NoOrbit::Rest(orbit.time));
        }
        Ok((orbit, shots.points))
    }

    /// The orbit that closed shots are.
    pub(in crate::affine) fn of_shots(&self, shots: &Shots<Place<f64>, Way>) -> Option<Orbit> {
        let ways = || shots.images.iter().map(|it| &it.way);
        let returns: Vec<_> = ways().map(|it| it.at_fixed_time.clone()).collect();
        let flow = || self.in_units(&self.rates(&shots.points[0]), 1.0);
        let flow = self.system().forcing.is_none().then(flow);
        let point = |it: &Place<f64>| Return {
            mode: it.mode,
            time: it.time.value(),
            state: it.state.clone(),
        };
        Some(Orbit {
            points: shots.points.iter().map(point).collect(),
            time: ways().map(|it| it.time).sum(),
            events: ways().flat_map(|it| it.events.iter().copied()).collect(),
            multipliers: multipliers(&returns, flow.as_deref())?,
            drift_per_return: mean_drift(ways(), shots.points.len()),
            residual: shots.residual,
            is_decided: ways().all(|it| it.is_decided),
        })
    }

    /// A multiple of the entries of states that are no drifts, in their
    /// [units](SectionMap::units).
    fn in_units(&self, entries: &[f64], factor: f64) -> Vec<f64> {
        let entries = entries.iter().zip(self.units()).enumerate();
        let kept = entries.filter(|(n, _)| !self.is_drift(*n));
        kept.map(|(_, (it, unit))| it * factor / unit).collect()
    }

    /// The derivative of a return's co-ordinates: the states, and the time where points have one.
    fn derivative(&self, from: &Place<f64>, passage: &Passage<f64>) -> Derivative {
        let states = from.state.len();
        let mut derivative = [[0.0; MAX_COORDINATES]; MAX_COORDINATES];
        for (j, (column, delay)) in passage.at_return.iter().zip(&passage.delays).enumerate() {
            (0..states).for_each(|i| derivative[i][j] = column[i]);
            derivative[states][j] = if self.has_times() { *delay } else { 0.0 };
        }
        if self.has_times() {
            let (column, delay) = self.by_time(from, passage);
            (0..states).for_each(|i| derivative[i][states] = column[i]);
            derivative[states][states] = delay;
        }
        for n in (0..states).filter(|n| self.is_drift(*n)) {
            derivative[n] = [0.0; MAX_COORDINATES];
            derivative.iter_mut().for_each(|row| row[n] = 0.0);
        }
        derivative
    }

    /// The changes of a return's states at its fixed time, without drifts and in their
    /// [units](SectionMap::units), by columns.
    fn at_fixed_time(&self, passage: &Passage<f64>) -> Vec<Vec<f64>> {
        let states = self.system().states.len();
        let columns = passage.at_fixed_time.iter().zip(self.units()).enumerate();
        let columns = columns.filter(|(n, _)| !self.is_drift(*n));
        columns.map(|(_, (column, unit))| self.in_units(&column[..states], *unit)).collect()
    }
}

/// The way of an orbit between two of its points.
#[derive(Clone, Debug)]
pub struct Way {
    pub(in crate::affine) events: Vec<Guard>,
    at_fixed_time: Vec<Vec<f64>>,
    time: f64,
    /// The change of each drift.
    drift: Vec<f64>,
    is_decided: bool,
}

/// The mean per return of the drifts' changes on the ways of an orbit.
fn mean_drift<'w>(ways: impl Iterator<Item = &'w Way> + Clone, returns: usize) -> Vec<f64> {
    let drifts = ways.clone().next().map_or(0, |it| it.drift.len());
    let mean = |n: usize| ways.clone().map(|it| it.drift[n]).sum::<f64>() / returns as f64;
    (0..drifts).map(mean).collect()
}

impl ReturnMap for SectionMap<'_, f64> {
    type Point = Place<f64>;
    type Way = Way;

    fn image(&self, point: &Place<f64>) -> Result<Image<Place<f64>, Way>, NoReturn> {
        let passage = self.passage(point)?;
        let way = Way {
            events: passage.events.clone(),
            at_fixed_time: self.at_fixed_time(&passage),
            time: passage.image.time.since(&point.time).value(),
            drift: {
                let [to, from] = [&passage.image, point].map(|it| self.drift_of(&it.state));
                to.iter().zip(from).map(|(to, from)| to - from).collect()
            },
            is_decided: passage.is_decided,
        };
        let derivative = self.derivative(point, &passage);
        Ok(Image { derivative, segments: passage.events.len() + 1, point: passage.image, way })
    }

    fn change_between(&self, from: &Place<f64>, to: &Place<f64>) -> Change {
        let mut change = [0.0; MAX_COORDINATES];
        for (n, (from, to)) in from.state.iter().zip(&to.state).enumerate() {
            change[n] = if self.is_drift(n) { 0.0 } else { to - from };
        }
        if self.has_times() {
            change[from.state.len()] = self.time_apart(from, to);
        }
        change
    }

    fn units(&self) -> Change {
        let mut units = [1.0; MAX_COORDINATES];
        units.iter_mut().zip(self.units()).for_each(|(it, unit)| *it = *unit);
        units
    }

    fn moved(&self, point: &Place<f64>, change: &Change, piece: &Place<f64>) -> Place<f64> {
        let state = point.state.iter().zip(change).map(|(it, by)| it + by).collect();
        piece.moved_to(point.time.after(change[point.state.len()]), state)
    }

    fn are_on_one_piece(&self, one: &Place<f64>, other: &Place<f64>) -> bool {
        one.mode == other.mode
    }

    fn size(&self, point: &Place<f64>, change: &Change) -> f64 {
        let system = self.system();
        let scales = system.scales.iter().copied().chain([system.time_scale]);
        // What is not a number stays so.
        let largest = |values: &mut dyn Iterator<Item = f64>| {
            let larger = |most: f64, it: f64| match most.is_nan() || most >= it.abs() {
                true => most,
                false => it.abs(),
            };
            values.fold(0.0, larger)
        };
        let own = point.state.iter().zip(&system.scales).enumerate();
        let own = own.filter(|(n, _)| !self.is_drift(*n)).map(|(_, (it, by))| it / by);
        let own = largest(&mut { own });
        largest(&mut change.iter().zip(scales).map(|(it, by)| it / by)) / (1.0 + own)
    }
}
