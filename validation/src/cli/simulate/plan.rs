//! The horizon and the ending of a run.

use super::Arguments;
use crate::case::Problem;
use crate::cli::shared::long_work::Bar;
use crate::cli::shared::parse::{MAX_PERIODS, Typed};
use crate::cli::shared::progress::Progress;
use crate::cli::shared::terminal::endless_words;
use anyhow::{Result, bail};
use percuss::{Endless, Exit, Instant, Segment, Trajectory};

/// Forcing periods after which a run that counts events stops, where `--max-periods` is not
/// given.
const DEFAULT_MAX_PERIODS: u64 = 1_000_000;

/// A picture of more forcing periods than this shows nothing.
const MAX_PICTURE_PERIODS: f64 = 5000.0;

/// A run to be made.
pub(super) struct PlannedRun {
    pub(super) problem: Problem,
    /// The instant at which the run ends at the latest.
    pub(super) horizon: Instant,
    /// It ends after so many events, if that is sooner.
    pub(super) events: Option<u64>,
    max_periods: u64,
    pub(super) progress: Progress,
}

impl PlannedRun {
    pub(super) fn new(problem: Problem, arguments: &Arguments, bar: Option<Bar>) -> Result<Self> {
        let start = problem.entry.instant;
        let periods = |count| start.after_periods(count, 1);
        let max_periods = arguments.max_periods.unwrap_or(DEFAULT_MAX_PERIODS);
        let horizon = match (arguments.periods, &arguments.until) {
            (Some(count), _) => periods(count),
            (None, Some(tau)) => horizon_of(&problem, tau)?,
            (None, None) => periods(max_periods),
        };
        let omega = problem.model.parameters().omega;
        let progress = Progress::new(bar, omega, start, &horizon);
        Ok(Self { problem, horizon, events: arguments.events, max_periods, progress })
    }

    pub(super) fn omega(&self) -> f64 {
        self.problem.model.parameters().omega
    }

    /// The run's phases, the last one ending with the run; none where no event is wanted.
    pub(super) fn segments(&self) -> Segments<'_> {
        let run = self.problem.model.trajectory(self.problem.entry).until(self.horizon);
        Segments { run, wanted: self.events, events: 0, progress: &self.progress }
    }

    /// What to say of a run whose last phase is `last` after the phases of `segments`.
    pub(super) fn ending(&self, last: Option<&Segment>, segments: &Segments<'_>) -> RunEnding {
        let undecided = last.filter(|segment| *segment.exit() == Exit::Undecidable);
        let how = match undecided {
            Some(segment) => Some(self.undecided_note(segment)),
            None => last.and_then(|last| self.how_it_ends(last, segments.events)),
        };
        RunEnding { how, touches: segments.touches(), undecided: undecided.is_some() }
    }

    fn undecided_note(&self, last: &Segment) -> String {
        format!(
            "undecidable: rounding hides how the phase {} ends that begins at tau = {:?}, it is \
             followed to tau = {:?}",
            last.phase(),
            last.entry().instant.tau(self.omega()),
            self.end_of(last).tau(self.omega())
        )
    }

    /// The instant at which the last of a run's phases is cut: by the horizon, or where it is no
    /// longer decided.
    pub(super) fn end_of(&self, last: &Segment) -> Instant {
        if *last.exit() == Exit::Undecidable {
            last.entry().instant.after(last.duration_two_word(), self.omega())
        } else {
            self.horizon
        }
    }

    fn how_it_ends(&self, last: &Segment, events: u64) -> Option<String> {
        let found = self.endless(last).map(|endless| {
            let since = last.entry().instant.tau(self.omega());
            format!("{} after tau = {since:?}", endless_words(endless))
        });
        match (self.events, found) {
            (Some(wanted), _) if events >= wanted => None,
            (Some(wanted), Some(found)) => Some(format!("{found}: {events} of {wanted} events")),
            (Some(wanted), None) => Some(format!(
                "stopped after {} forcing periods with {events} of {wanted} events",
                self.max_periods
            )),
            (None, Some(found)) => Some(format!("{found}: the run ends at its horizon")),
            (None, None) => None,
        }
    }

    /// Whether a last phase has no end at all, beyond the horizon too.
    fn endless(&self, last: &Segment) -> Option<Endless> {
        match last.exit() {
            Exit::Endless(endless) => Some(*endless),
            Exit::Horizon => {
                let whole = self.problem.model.trajectory(*last.entry()).next()?;
                if let Exit::Endless(endless) = whole.exit() { Some(*endless) } else { None }
            }
            _ => None,
        }
    }

    /// Refuses a picture that goes on to an instant, where it would show nothing.
    pub(super) fn check_picture(&self, instant: &Instant, is_reached: bool) -> Result<()> {
        let start = self.problem.entry.instant;
        let longest = MAX_PICTURE_PERIODS * self.problem.model.period();
        if is_reached && instant.since(&start, self.omega()).value() > longest {
            bail!(
                "a picture of more than {MAX_PICTURE_PERIODS} forcing periods is not accepted: \
                 --output or --format of csv or json is, or a shorter run"
            );
        }
        Ok(())
    }

    /// The instant at which the last of these phases ends.
    pub(super) fn last_instant(&self, segments: &[Segment]) -> Instant {
        if let Some(last) = segments.last().filter(|segment| *segment.exit() == Exit::Undecidable) {
            return self.end_of(last);
        }
        match (self.events, segments.last().map(|segment| (segment.entry(), segment.exit()))) {
            (_, Some((_, Exit::Switch(next)))) => next.instant,
            // Events were wanted and none came: the last phase is shown for a few periods.
            (Some(_), Some((entry, _))) => entry.instant.after_periods(2, 1),
            (Some(_), None) => self.problem.entry.instant,
            (None, _) => self.horizon,
        }
    }
}

/// A run's phases up to the event that ends it.
pub(super) struct Segments<'a> {
    run: Trajectory,
    wanted: Option<u64>,
    events: u64,
    progress: &'a Progress,
}

impl Segments<'_> {
    /// The number of touches so far that rounding leaves undecided.
    fn touches(&self) -> u64 {
        self.run.counters().undecidable
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        if self.wanted == Some(self.events) {
            return None;
        }
        let segment = self.run.next()?;
        self.events += u64::from(matches!(segment.exit(), Exit::Switch(_)));
        let share = self.wanted.map_or(0.0, |wanted| self.events as f64 / wanted as f64);
        self.progress.at_least(&segment.entry().instant, share);
        Some(segment)
    }
}

/// The notes on a run's ending.
#[derive(Debug, Default)]
pub(super) struct RunEnding {
    /// The ending, if the run ended before its horizon.
    how: Option<String>,
    /// The number of touches that rounding leaves undecided.
    pub(super) touches: u64,
    /// Whether its last phase is undecidable.
    pub(super) undecided: bool,
}

impl RunEnding {
    /// The lines of the notes.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> {
        let touches = match self.touches {
            0 => None,
            1 => Some("1 touch lies within rounding of its threshold: counted as no event".into()),
            n => Some(format!(
                "{n} touches lie within rounding of their thresholds: counted as no events"
            )),
        };
        touches.into_iter().chain(self.how.clone())
    }
}

/// The horizon that `--until` states.
fn horizon_of(problem: &Problem, stated: &Typed<f64>) -> Result<Instant> {
    let tau = stated.value;
    let omega = problem.model.parameters().omega;
    let start = problem.entry.instant;
    // Beyond this omega tau is no longer reduced exactly.
    let representable = (omega * tau).abs() <= 4e21;
    let horizon = if representable { Instant::at(omega, tau, 0) } else { start };
    let span = horizon.since(&start, omega).value();
    if representable && horizon >= start && span <= MAX_PERIODS as f64 * problem.model.period() {
        return Ok(horizon);
    }
    let begins = start.tau(omega);
    bail!(
        "--until {stated} is not accepted: at or after the start, {begins:?}, and at most {MAX_PERIODS} forcing periods later"
    )
}
