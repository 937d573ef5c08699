//! The return maps of one parameter's values, and how they change with it.

use super::super::model::error::SystemError;
use super::super::model::system::System;
use super::super::returns::map::{Carried, SectionMap};
use super::super::returns::orbit::Way;
use super::super::returns::section::Section;
use super::super::returns::shooting::{Change, Image, MAX_COORDINATES, ReturnMap, Shots};
use super::super::run::place::Place;
use super::super::solver::Solver;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// Points that are to be an orbit.
pub(super) type OrbitShots = Shots<Place<f64>, Way>;

/// The return maps of a section, one for each value of a parameter.
pub struct ReturnFamily<'a> {
    section: Section,
    longest: Option<f64>,
    system: &'a dyn Fn(f64) -> Result<System, SystemError>,
    /// The solvers that were made last, by their values' bits.
    prepared: RefCell<VecDeque<(u64, Rc<Solver<f64>>)>>,
}

/// Solvers that are kept: a corrector goes back and forth between few values.
const KEPT_SOLVERS: usize = 16;

/// Relative steps of the differences, longest first: the first balances truncation and rounding,
/// the others are for neighbourhoods of a corner.
const DIFFERENCE_STEPS: [f64; 4] = [6e-6, 6e-8, 6e-9, 6e-11];
/// Further steps next to a touch, and where differences of one side do not agree.
const STEPS_AT_TOUCH: [f64; 2] = [6e-12, 6e-13];
/// The derivative of a map that is large for a touch to be near, where it grows without bound.
const MIN_DERIVATIVE_AT_TOUCH: f64 = 100.0;
/// The number of the first step at which a difference of one side serves.
const FIRST_OF_ONE_SIDE: usize = 2;
/// The share by which differences of one side may change from a step to the next: next to a touch
/// the image changes by a root, and they grow by the root of the steps' quotient.
const MAX_CHANGE_OF_ONE_SIDE: f64 = 0.001;

/// The share by which changes to both sides may differ on a smooth piece, where they are larger
/// than so many sizes of the states.
const MAX_ODDNESS: f64 = 0.5;
const MAX_SMALL_CHANGE: f64 = 1e-8;

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
        let solver = self.solver(value)?;
        let map = SectionMap::new(&solver, section).ok()?;
        match self.longest {
            Some(longest) => then(&map.within(longest)),
            None => then(&map),
        }
    }

    fn solver(&self, value: f64) -> Option<Rc<Solver<f64>>> {
        let mut prepared = self.prepared.borrow_mut();
        let bits = value.to_bits();
        if let Some((_, solver)) = prepared.iter().find(|it| it.0 == bits) {
            return Some(Rc::clone(solver));
        }
        let system = (self.system)(value).ok()?;
        let solver = Rc::new(Solver::new(&system).ok()?);
        prepared.truncate(KEPT_SOLVERS - 1);
        prepared.push_front((bits, Rc::clone(&solver)));
        Some(solver)
    }

    /// The points of shots as places of any value's map.
    pub(super) fn carry(&self, value: f64, points: &[Place<f64>]) -> Option<Vec<Carried>> {
        self.at(value, |map| Some(points.iter().map(|it| map.carry(it)).collect()))
    }

    /// The derivatives of the images of all points by the parameter, by differences.
    ///
    /// They steer the corrector and give the tangent, nothing else: a point that is accepted
    /// satisfies the map itself, and its multipliers are those of the exact derivative. Where a
    /// corner is near, the difference is taken on the shots' own side of it.
    pub(super) fn slopes(&self, value: f64, shots: &OrbitShots, scale: f64) -> Vec<Change> {
        let Some(points) = self.carry(value, &shots.points) else {
            return vec![[0.0; MAX_COORDINATES]; shots.points.len()];
        };
        let is_at_touch = is_near_touch(shots);
        let pairs = shots.images.iter().zip(&points);
        pairs.map(|(here, point)| self.slope(value, here, point, scale, is_at_touch)).collect()
    }

    fn slope(
        &self,
        value: f64,
        here: &Image<Place<f64>, Way>,
        point: &Carried,
        scale: f64,
        is_at_touch: bool,
    ) -> Change {
        // The image of the point at another value, less its image here, and whether it has the same
        // events.
        let beside = |step: f64| {
            let carried = self.at(value + step, |map| {
                let image = map.image(&map.take_up(point)).ok()?;
                let same =
                    image.way.events == here.way.events && image.point.mode == here.point.mode;
                Some((map.carry(&image.point), same))
            });
            let (image, same) = carried?;
            self.at(value, |map| {
                Some((map.change_between(&here.point, &map.take_up(&image)), same))
            })
        };
        let size = value.abs().max(scale);
        let quotient = |a: Change, b: Change, span: f64| -> Change {
            std::array::from_fn(|n| (a[n] - b[n]) / span)
        };
        let none = [0.0; MAX_COORDINATES];
        let (mut fallback, mut longest, mut last) = (None, None, None);
        let steps = DIFFERENCE_STEPS.iter().chain(&STEPS_AT_TOUCH).map(|relative| relative * size);
        for (n, step) in steps.enumerate() {
            if n >= DIFFERENCE_STEPS.len() && longest.is_none() && !is_at_touch {
                break;
            }
            let (up, down) = ((value + step) - value, value - (value - step));
            let own_side = match (beside(up), beside(-down)) {
                (Some((above, true)), Some((below, true))) => {
                    let both = quotient(above, below, up + down);
                    if self.is_smooth(value, &here.point, [&above, &below]) {
                        return both;
                    }
                    fallback = fallback.or(Some(both));
                    continue;
                }
                (Some((above, true)), _) => quotient(above, none, up),
                (_, Some((below, true))) => quotient(none, below, down),
                (Some((above, _)), Some((below, _))) => {
                    fallback = Some(quotient(above, below, up + down));
                    continue;
                }
                _ => continue,
            };
            if n < FIRST_OF_ONE_SIDE {
                continue;
            }
            // The longer one has the smaller rounding.
            if let Some(before) = last.filter(|before| are_alike(before, &own_side)) {
                return before;
            }
            (longest, last) = (longest.or(Some(own_side)), Some(own_side));
        }
        longest.or(fallback).unwrap_or(none)
    }

    /// Whether changes of an image to both sides are those of a smooth map. Where an event comes
    /// earlier because its guard is touched, the image jumps, and the events are the same.
    fn is_smooth(&self, value: f64, at: &Place<f64>, [above, below]: [&Change; 2]) -> bool {
        let odd: Change = std::array::from_fn(|n| above[n] + below[n]);
        let sizes = self.at(value, |map| Some([above, below, &odd].map(|it| map.size(at, it))));
        let Some([above, below, odd]) = sizes else { return false };
        let size = above.max(below);
        size <= MAX_SMALL_CHANGE || odd <= MAX_ODDNESS * size
    }
}

/// Whether a touch may be near to points that are to be an orbit.
pub(super) fn is_near_touch(shots: &OrbitShots) -> bool {
    shots.largest_derivative() >= MIN_DERIVATIVE_AT_TOUCH
}

fn are_alike(one: &Change, other: &Change) -> bool {
    let size = one.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    let pairs = one.iter().zip(other);
    pairs.into_iter().all(|(a, b)| (a - b).abs() <= MAX_CHANGE_OF_ONE_SIDE * size)
}
