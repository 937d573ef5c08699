//! Brute-force diagrams of a system's returns: the points of a section after a transient, value by
//! value of a parameter.
//!
//! A motion escapes of which a state that is no drift passes 1e9 of its scales at a return, and it
//! may end before it has returned as often as was asked. It has no points then, and no value starts
//! from where it went.

use super::map::{Carried, SectionMap};
use super::section::Section;
use super::walk::{NoReturn, Return};
use crate::affine::model::error::SystemError;
use crate::affine::model::system::System;
use crate::affine::run::place::Place;
use crate::affine::solver::Solver;
use crate::dynamics::diagram::Follow;
use crate::dynamics::parallel;
use std::fmt;

/// A diagram of the returns to a section that is to be made.
#[derive(Clone, Debug)]
pub struct ReturnDiagram {
    /// The section.
    pub section: Section,
    /// The longest time of a return that is waited for; none is that of [`SectionMap::new`].
    pub longest: Option<f64>,
    /// The returns that are left out at each value.
    pub transient: u64,
    /// The returns that are kept at each value.
    pub returns: u32,
    /// The start of each value.
    pub follow: Follow,
}

/// The part of a diagram at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct ReturnDiagramStep {
    /// The parameter's value.
    pub value: f64,
    /// The returns; none where the motion is left out.
    pub points: Vec<Return<f64>>,
    /// The reason for which the motion is left out, if it is.
    pub left_out: Option<LeftOut>,
    /// The number of ties, touches, entries and conditions that rounding leaves undecided.
    pub undecidable: u64,
}

/// The reason for which a diagram has no points at a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// A state that is no drift passes 1e9 of its scales.
    Escapes,
    /// The motion does not return as often.
    NoReturn(NoReturn),
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Escapes => f.write_str("a state passes 1e9 of its scales"),
            Self::NoReturn(why) => why.fmt(f),
        }
    }
}

/// A value at which there is no system, or none with such a section.
#[derive(Clone, Debug)]
pub struct ValueError {
    /// The value.
    pub value: f64,
    /// The error of the system there.
    pub error: SystemError,
}

impl fmt::Display for ValueError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {}: {}", self.value, self.error)
    }
}

impl std::error::Error for ValueError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}

/// Values whose systems are prepared in one go: those of two such blocks are held in memory.
const BLOCK_VALUES: usize = 32;

/// The number of returns of a value after which who waits is heard.
const RETURNS_PER_LOOK: u64 = 1024;

impl ReturnDiagram {
    /// Makes the diagram at these values, of which each has a system; `seen` is told of how many
    /// values more are done, in any order, and of none now and then: who waits may end the work by
    /// unwinding it. Results are the same for any number of threads.
    ///
    /// # Errors
    /// A value at which there is no system with a start, or none with this section.
    pub fn steps(
        &self,
        values: &[f64],
        system: impl Fn(f64) -> Result<System, SystemError> + Sync + Send,
        seen: impl Fn(u64) + Sync + Send,
    ) -> Result<Vec<ReturnDiagramStep>, ValueError> {
        let solver = |value: &f64| {
            let solver = system(*value).and_then(|it| Solver::<f64>::new(&it));
            solver.map_err(|error| ValueError { value: *value, error })
        };
        match self.follow {
            Follow::Reset => {
                let alone = |value: &f64| {
                    let step = self.follow_value(*value, &solver(value)?, &mut None, &seen)?;
                    seen(1);
                    Ok(step)
                };
                let mut steps = Vec::with_capacity(values.len());
                for block in values.chunks(BLOCK_VALUES) {
                    let done: Result<Vec<_>, _> = parallel::map(block, alone).into_iter().collect();
                    steps.extend(done?);
                }
                Ok(steps)
            }
            Follow::Carry => self.carried_steps(values, solver, seen),
        }
    }

    /// The steps of values that each begin where the last one ended: the systems of a block are
    /// prepared while the block before it is followed.
    fn carried_steps(
        &self,
        values: &[f64],
        solver: impl Fn(&f64) -> Result<Solver<f64>, ValueError> + Sync + Send,
        seen: impl Fn(u64) + Sync + Send,
    ) -> Result<Vec<ReturnDiagramStep>, ValueError> {
        let mut steps = Vec::with_capacity(values.len());
        let (mut now, mut prepared): (&[f64], _) = (&[], Vec::new());
        let mut last = None;
        let mut follow = |values: &[f64], solvers: Vec<Result<Solver<f64>, ValueError>>| {
            for (value, solver) in values.iter().zip(solvers) {
                steps.push(self.follow_value(*value, &solver?, &mut last, &seen)?);
                seen(1);
            }
            Ok(())
        };
        for block in values.chunks(BLOCK_VALUES) {
            let prepare = || parallel::map(block, &solver);
            let solvers = std::mem::take(&mut prepared);
            let (next, done) = parallel::join(prepare, || follow(now, solvers));
            done?;
            (now, prepared) = (block, next);
        }
        follow(now, prepared)?;
        Ok(steps)
    }

    /// The step of a value from where the last one ended, which this one takes the place of unless
    /// it is left out; without a last one, from the start of its system.
    fn follow_value(
        &self,
        value: f64,
        solver: &Solver<f64>,
        last: &mut Option<Carried>,
        seen: &impl Fn(u64),
    ) -> Result<ReturnDiagramStep, ValueError> {
        let begun = SectionMap::new(solver, &self.section).and_then(|map| {
            let map = match self.longest {
                Some(longest) => map.within(longest),
                None => map,
            };
            let from = match &*last {
                Some(last) => map.take_up(last),
                None => solver.place(solver.system().start()?)?,
            };
            Ok((map, from))
        });
        let (map, from) = begun.map_err(|error| ValueError { value, error })?;
        let (step, place) = self.step(value, &map, &from, seen);
        if let Some(place) = place {
            *last = Some(map.carry(&place));
        }
        Ok(step)
    }

    /// The step of a value from a place, and the place of its last return if it has all.
    fn step(
        &self,
        value: f64,
        map: &SectionMap<'_, f64>,
        from: &Place<f64>,
        seen: &impl Fn(u64),
    ) -> (ReturnDiagramStep, Option<Place<f64>>) {
        let mut returns = map.returns_from(from);
        let mut points = Vec::with_capacity(self.returns as usize);
        let mut left_out = None;
        let all = self.transient + u64::from(self.returns);
        for (n, point) in (0..all).zip(returns.by_ref()) {
            if n % RETURNS_PER_LOOK == 0 {
                seen(0);
            }
            left_out = match &point {
                Ok(point) if map.has_escaped(&point.state) => Some(LeftOut::Escapes),
                Ok(_) => None,
                Err(why) => Some(LeftOut::NoReturn(*why)),
            };
            if left_out.is_some() {
                points = Vec::new();
                break;
            }
            if n >= self.transient {
                points.extend(point);
            }
        }
        let undecidable = returns.undecidable();
        let place = if left_out.is_none() { returns.place().ok() } else { None };
        (ReturnDiagramStep { value, points, left_out, undecidable }, place)
    }
}
