//! The return maps of two parameters' values, and the lines on which one of them varies.

use super::super::model::error::SystemError;
use super::super::model::system::System;
use super::super::returns::section::Section;
use super::curve::Curve;
use super::family::ReturnFamily;

/// The return maps of a section, one for each pair of values of two parameters in a window.
#[derive(Clone)]
pub struct ReturnPlane<'a> {
    section: Section,
    longest: Option<f64>,
    system: &'a dyn Fn([f64; 2]) -> Result<System, SystemError>,
    /// The least and the largest value of each parameter.
    window: [[f64; 2]; 2],
}

/// The parameter that varies on a line of the plane: 0 or 1.
pub(super) type Axis = usize;

/// A direction, or a way, in the plane, in widths of the window.
pub(super) type Way = [f64; 2];

impl<'a> ReturnPlane<'a> {
    /// The plane of a section and of a window, which has the ends of each parameter's interval;
    /// `system` is the system at a pair of values, and `longest` the longest time of a return that
    /// is waited for, if not that of [`ReturnFamily::new`].
    pub fn new(
        section: Section,
        longest: Option<f64>,
        window: [[f64; 2]; 2],
        system: &'a dyn Fn([f64; 2]) -> Result<System, SystemError>,
    ) -> Self {
        let window = window.map(|[a, b]| [a.min(b), a.max(b)]);
        Self { section, longest, system, window }
    }

    /// The plane of the strobe of an angle that is larger by this, of a section that is a strobe.
    pub(super) fn turned(&self, by: f64) -> Option<Self> {
        Some(Self { section: self.section.turned(by)?, ..self.clone() })
    }

    /// Asks the curve of orbits on the line through `at` on which one parameter varies; none where
    /// there is no such system.
    pub(super) fn on_line<R>(
        &self,
        axis: Axis,
        at: [f64; 2],
        then: impl FnOnce(&Curve<'_>) -> Option<R>,
    ) -> Option<R> {
        let line = |value: f64| {
            let mut there = at;
            there[axis] = value;
            (self.system)(there)
        };
        let family = ReturnFamily::new(self.section.clone(), self.longest, &line);
        then(&Curve::about(&family, at[axis], self.width(axis))?)
    }

    /// The width of the window along an axis; 1 where both ends are one.
    pub(super) fn width(&self, axis: Axis) -> f64 {
        let [low, high] = self.window[axis];
        if high > low { high - low } else { 1.0 }
    }

    /// The way from one place to another.
    pub(super) fn way(&self, from: [f64; 2], to: [f64; 2]) -> Way {
        std::array::from_fn(|axis| (to[axis] - from[axis]) / self.width(axis))
    }

    /// The place a way from another one.
    pub(super) fn moved(&self, from: [f64; 2], way: Way) -> [f64; 2] {
        std::array::from_fn(|axis| from[axis] + way[axis] * self.width(axis))
    }

    /// The end of an axis beyond which a value lies, if it does.
    pub(super) fn passed(&self, axis: Axis, value: f64) -> Option<f64> {
        let [low, high] = self.window[axis];
        match value {
            it if it < low => Some(low),
            it if it > high => Some(high),
            _ => None,
        }
    }

    /// The distance from a place to the window's edge along a way, in widths of the window.
    pub(super) fn room(&self, from: [f64; 2], way: Way) -> f64 {
        let rooms = (0..2).filter(|axis| way[*axis] != 0.0).map(|axis| {
            let edge = self.window[axis][usize::from(way[axis] > 0.0)];
            (edge - from[axis]) / self.width(axis) / way[axis]
        });
        rooms.fold(f64::INFINITY, f64::min).max(0.0)
    }
}

/// The length of a way.
pub(super) fn length([across, up]: Way) -> f64 {
    libm::hypot(across, up)
}

/// The cosine between two ways.
pub(super) fn cosine(one: Way, other: Way) -> f64 {
    (one[0] * other[0] + one[1] * other[1]) / (length(one) * length(other))
}
