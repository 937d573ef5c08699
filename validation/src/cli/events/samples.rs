//! The rows of `events --samples K`: the state at equal steps of the time, not at events.

use super::progress::{Passed, RunEnd};
use super::row::in_order;
use super::rows::{Limits, Outcome, Rows};
use super::sizes::Sizes;
use anyhow::Result;
use percuss::affine::{Arithmetic, EnclosedRun, Ending, Event, Rational, Time, What};
use percuss::number::Number;
use serde::Serialize;

/// The state at a time. Numbers are texts, because a reader's f64 would not hold their digits.
#[derive(Serialize)]
pub(super) struct SampleRow {
    pub(super) time: String,
    pub(super) mode: String,
    #[serde(serialize_with = "in_order")]
    pub(super) state: Vec<(String, String)>,
}

impl<T: Arithmetic> Rows<'_, T> {
    /// Runs the system from its start, with a row `samples` times in each unit of its time; where
    /// it is forced, in each period.
    pub(super) fn each_sample(
        &self,
        samples: u32,
        take: &mut dyn FnMut(SampleRow) -> Result<()>,
    ) -> Result<Outcome> {
        let times = SampleTimes::of(self, samples);
        let mut run = self.run(times.at(0))?;
        let (mut end, mut passed) = (RunEnd::default(), Passed::default());
        let mut last = run.start();
        let mut sizes = Sizes::of(&last);
        for n in 1_u64.. {
            let sampled = self.next_sample(&mut *run, &mut last, &mut passed, &mut end)?;
            let row = n as usize - 1;
            let Some(sample) = sampled else {
                let is_undecided = run.ending() == Some(&Ending::Undecided);
                if is_undecided && self.may_go_on && !run.is_exhausted() {
                    return Ok(Outcome::MoreBits(self.leave(&*run, row, None)));
                }
                break;
            };
            let needs_more_bits = self.needs_more_bits(&*run, &sample, &mut sizes);
            if row >= self.left.rows {
                if needs_more_bits {
                    return Ok(Outcome::MoreBits(self.leave(&*run, row, None)));
                }
                take(self.sample(&sample)?)?;
            }
            let next = times.at(n);
            if !times.are_before_end(next) || !run.go_on(next) {
                break;
            }
        }
        end.notes.extend(self.cause(&*run));
        Ok(Outcome::Ended(end))
    }

    /// The event at the horizon of a run; none where the run ends before, or has the events that
    /// are wanted.
    fn next_sample(
        &self,
        run: &mut dyn EnclosedRun<T>,
        last: &mut Event<T>,
        passed: &mut Passed<T>,
        end: &mut RunEnd,
    ) -> Result<Option<Event<T>>> {
        for event in run {
            if event.what == What::End(Ending::Horizon) {
                // The start itself has no rounding of modal co-ordinates.
                let is_start = passed.count == 0 && event.time.value() == last.time.value();
                return Ok(Some(if is_start { last.clone() } else { event }));
            }
            if self.is_stopped(&event, passed.count) {
                self.stopped(last, end);
                return Ok(None);
            }
            if !self.passes(&event, passed, end) {
                return Ok(None);
            }
            if let What::End(_) = event.what {
                self.name(&event, passed, end);
                return Ok(None);
            }
            if self.limits.events.is_some_and(|wanted| passed.count >= wanted) {
                return Ok(None);
            }
            *last = event;
        }
        Ok(None)
    }

    fn sample(&self, event: &Event<T>) -> Result<SampleRow> {
        let mode = self.system.modes[event.mode].name.clone();
        Ok(SampleRow { time: self.time(event), mode, state: self.state(event)? })
    }
}

/// The times of samples.
struct SampleTimes<T> {
    start: T,
    /// The unit of time, of which a step is one part of so many.
    unit: T,
    parts: T,
    until: T,
    is_backward: bool,
}

impl<T: Number> SampleTimes<T> {
    fn of(rows: &Rows<'_, T>, samples: u32) -> Self {
        let number = |it: &Rational| Time::<T>::of(it).value();
        let system = rows.system;
        let start = system.start.as_ref().map_or(T::zero(), |it| number(&it.time));
        let Limits { until, .. } = rows.limits;
        let is_backward = until < start.to_f64();
        let unit = match &system.forcing {
            Some(forcing) => full_turn::<T>() / number(&forcing.omega),
            None => T::exact(system.time_scale),
        };
        let unit = if is_backward { -unit } else { unit };
        let parts = T::exact(f64::from(samples));
        Self { start, unit, parts, until: T::exact(until), is_backward }
    }

    fn at(&self, n: u64) -> T {
        self.start + T::exact(n as f64) * self.unit / self.parts
    }

    fn are_before_end(&self, time: T) -> bool {
        if self.is_backward { time >= self.until } else { time <= self.until }
    }
}

/// 2 pi, by Newton's method for the zero of the sine, which triples the digits each time.
fn full_turn<T: Number>() -> T {
    /// From an f64 to more than 1,400 digits.
    const STEPS: usize = 4;
    let half = (0..STEPS).fold(T::exact(std::f64::consts::PI), |half, _| half + half.sin_cos().0);
    half + half
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::DoubleDouble;

    #[test]
    fn a_full_turn_has_the_digits_of_its_arithmetic() {
        // The words of 2 pi: 6.283185307179586476925286766559005768...
        let (high, low) = full_turn::<DoubleDouble>().words();
        assert_eq!(high, std::f64::consts::TAU);
        assert!((low - 2.449_293_598_294_706_4e-16).abs() < 1e-31, "{low:e}");
    }
}
