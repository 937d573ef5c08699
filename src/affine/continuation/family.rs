//! The return maps of one parameter's values, and how they change with it.

use super::super::model::error::SystemError;
use super::super::model::system::System;
use super::super::returns::map::{Carried, SectionMap};
use super::super::returns::orbit::Way;
use super::super::returns::section::Section;
use super::super::returns::shooting::{Change, MAX_COORDINATES, Shots};
use super::super::run::parameter::CoefficientRates;
use super::super::run::place::Place;
use super::super::solver::Solver;
use std::cell::{OnceCell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// Points that are to be an orbit.
pub(super) type OrbitShots = Shots<Place<f64>, Way>;

/// The return maps of a section, one for each value of a parameter.
pub struct ReturnFamily<'a> {
    section: Section,
    longest: Option<f64>,
    system: &'a dyn Fn(f64) -> Result<System, SystemError>,
    /// The values that were prepared last, newest first.
    prepared: RefCell<VecDeque<Rc<Prepared>>>,
}

/// The solver of a value of the parameter, and how the system's coefficients change there.
struct Prepared {
    bits: u64,
    solver: Solver<f64>,
    rates: OnceCell<Option<Arc<CoefficientRates<f64>>>>,
}

/// Solvers that are kept: a corrector goes back and forth between few values.
const KEPT_SOLVERS: usize = 16;

/// The relative step of the differences of coefficients, which are exact but for the value's own
/// digits: these and the third order leave an error of about 1e-11.
const DIFFERENCE_STEP: f64 = 1.0 / 131_072.0;

/// Steps with their weights, over two steps: to both sides, or to one side where there is no system
/// on the other.
const DIFFERENCES: [&[(f64, i32)]; 3] = [
    &[(1.0, 1), (-1.0, -1)],
    &[(0.0, -3), (1.0, 4), (2.0, -1)],
    &[(0.0, 3), (-1.0, -4), (-2.0, 1)],
];

/// The derivative of a map that is large for a touch to be near, where it grows without bound.
const MIN_DERIVATIVE_AT_TOUCH: f64 = 100.0;

impl<'a> ReturnFamily<'a> {
    /// The family of a section; `system` is the system at a value, and `longest` the longest time
    /// of a return that is waited for, if not that of [`SectionMap::new`].
    pub fn new(
        section: Section,
        longest: Option<f64>,
        system: &'a dyn Fn(f64) -> Result<System, SystemError>,
    ) -> Self {
        Self { section, longest, system, prepared: RefCell::default() }
    }

    /// The family of the strobe of an angle that is larger by this.
    pub(super) fn turned(&self, by: f64) -> Option<Self> {
        Some(Self::new(self.section.turned(by)?, self.longest, self.system))
    }

    pub(super) fn section(&self) -> &Section {
        &self.section
    }

    /// What the map at a value has; none where there is no such map.
    pub(super) fn at<R>(
        &self,
        value: f64,
        then: impl FnOnce(&SectionMap<'_, f64>) -> Option<R>,
    ) -> Option<R> {
        self.at_section(value, &self.section, then)
    }

    /// Something of the map of another section at a value; none where there is no such map.
    pub(super) fn at_section<R>(
        &self,
        value: f64,
        section: &Section,
        then: impl FnOnce(&SectionMap<'_, f64>) -> Option<R>,
    ) -> Option<R> {
        let prepared = self.prepared(value)?;
        let map = SectionMap::new(&prepared.solver, section).ok()?;
        match self.longest {
            Some(longest) => then(&map.within(longest)),
            None => then(&map),
        }
    }

    fn prepared(&self, value: f64) -> Option<Rc<Prepared>> {
        let mut kept = self.prepared.borrow_mut();
        let bits = value.to_bits();
        if let Some(own) = kept.iter().find(|it| it.bits == bits) {
            return Some(Rc::clone(own));
        }
        let system = (self.system)(value).ok()?;
        let solver = Solver::new(&system).ok()?;
        let own = Rc::new(Prepared { bits, solver, rates: OnceCell::new() });
        kept.truncate(KEPT_SOLVERS - 1);
        kept.push_front(Rc::clone(&own));
        Some(own)
    }

    /// The derivatives by the parameter of the states with which a motion returns from a place, and
    /// where returns have times of their own of the time, which counts as a share of the forcing
    /// period: the place keeps its states and its share. None where there is no such map, no
    /// return, or no derivative.
    #[must_use]
    pub fn by_parameter(&self, value: f64, place: &Place<f64>) -> Option<Vec<f64>> {
        self.at_with_rates(value, |map, rates| {
            let entries = map.system().states.len() + usize::from(map.has_times());
            Some(map.by_parameter(place, rates)?[..entries].to_vec())
        })
    }

    /// The points of shots as places of any value's map.
    pub(super) fn carry(&self, value: f64, points: &[Place<f64>]) -> Option<Vec<Carried>> {
        self.at(value, |map| Some(points.iter().map(|it| map.carry(it)).collect()))
    }

    /// The derivatives of the images of all points by the parameter. Where a motion has none, they
    /// are zero: they steer the corrector and give the tangent, nothing else.
    pub(super) fn slopes(&self, value: f64, shots: &OrbitShots) -> Vec<Change> {
        let none = [0.0; MAX_COORDINATES];
        let slopes = self.at_with_rates(value, |map, rates| {
            let slope = |it| map.by_parameter(it, rates).unwrap_or(none);
            Some(shots.points.iter().map(slope).collect())
        });
        slopes.unwrap_or_else(|| vec![none; shots.points.len()])
    }

    /// Something of the map at a value and of the derivatives of its system's coefficients.
    fn at_with_rates<R>(
        &self,
        value: f64,
        then: impl FnOnce(&SectionMap<'_, f64>, &Arc<CoefficientRates<f64>>) -> Option<R>,
    ) -> Option<R> {
        let own = self.prepared(value)?;
        let rates = own.rates.get_or_init(|| self.rates(value).map(Arc::new)).as_ref()?;
        self.at(value, |map| then(map, rates))
    }

    /// The derivatives of the system's coefficients at a value.
    fn rates(&self, value: f64) -> Option<CoefficientRates<f64>> {
        let step = DIFFERENCE_STEP * if value == 0.0 { 1.0 } else { value.abs() };
        let step = (value + step) - value;
        DIFFERENCES.iter().find_map(|terms| {
            let system = |(steps, weight): &(f64, i32)| {
                Some(((self.system)(value + steps * step).ok()?, *weight))
            };
            let systems: Vec<_> = terms.iter().map(system).collect::<Option<_>>()?;
            CoefficientRates::new(&systems, 2.0 * step)
        })
    }
}

/// Whether a touch may be near to points that are to be an orbit.
pub(super) fn is_near_touch(shots: &OrbitShots) -> bool {
    shots.largest_derivative() >= MIN_DERIVATIVE_AT_TOUCH
}
