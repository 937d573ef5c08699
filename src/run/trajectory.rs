//! The run: phases joined at their switches (the method of Section 3), as an iterator over its
//! segments. A segment is one phase from its entry to its end, with anything inside it on demand.

use crate::crossing::Counters;
use crate::error::InputError;
use crate::flow::constants::Constants;
use crate::flow::forcing::EntryAngle;
use crate::model::Model;
use crate::model::entry::{Entry, Motion};
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::parameters::within;
use crate::phase::Phase;
use crate::run::exit::Exit;
use crate::run::switch::{Begun, End, PhaseEnd, pass};
use std::iter::FusedIterator;

/// An iterator over the phases of a run; memory does not grow with its length.
///
/// A run taken up at one of its phases goes on as it did to within rounding, not to the last bit: a
/// root is computed from where it was guessed, and what is guessed depends on the phase before.
///
/// It ends after a phase that reaches the horizon, never ends or is undecidable; without a horizon
/// and as long as switches come it goes on for ever. A phase is cut after a forcing angle of 1e30
/// where nothing else ends it: two words do not know the angle much later.
#[derive(Clone, Debug)]
pub struct Trajectory {
    model: Model,
    /// The phase that has begun, and a place for the next one: so none is copied.
    begun: [Begun; 2],
    /// Whether the phase that has begun is the second of these.
    second: bool,
    /// Whether no phase follows.
    over: bool,
    horizon: Option<Instant>,
    counters: Counters,
}

/// The phase that [`Trajectory::step`] has passed.
#[derive(Clone, Debug)]
pub enum Step<'a> {
    /// The phase ends by an event.
    Switch {
        /// How long the phase lasts.
        duration: TwoWord,
        /// How the next phase begins.
        next: &'a Entry,
    },
    /// It is the run's last: cut by the horizon, endless, or undecidable.
    Last(Box<Segment>),
}

impl Model {
    /// The run that begins at `entry`.
    #[must_use]
    pub fn trajectory(&self, entry: Entry) -> Trajectory {
        Trajectory {
            model: *self,
            begun: [Begun::at(self, entry); 2],
            second: false,
            over: false,
            horizon: None,
            counters: Counters::default(),
        }
    }
}

impl Trajectory {
    /// Ends the run at `horizon`: the last phase is cut there, unless it is proved to be endless
    /// ([`Exit::Endless`]), or undecidable before.
    ///
    /// A horizon that is not after the beginning of the phase that comes next leaves one phase of
    /// no length ([`Exit::Horizon`]). A run that is over stays over; to go on, begin a run at
    /// [`Segment::entry_at`] the horizon.
    ///
    /// [`Exit::Endless`]: crate::Exit::Endless
    /// [`Exit::Horizon`]: crate::Exit::Horizon
    #[must_use]
    pub fn until(mut self, horizon: Instant) -> Self {
        self.horizon = Some(horizon);
        self
    }

    /// Ends the run at the time tau, which is taken as the f64 value that it is ([`Self::until`]).
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] if tau is not between -1e15 and 1e15, or not a number.
    pub fn until_time(self, tau: f64) -> Result<Self, InputError> {
        within("tau", tau, -1e15, 1e15, "-1e15 <= tau <= 1e15")?;
        let horizon = Instant::at(self.model.parameters().omega, tau, 0);
        Ok(self.until(horizon))
    }

    /// Ends the run this many forcing periods after the beginning of the phase that comes next
    /// ([`Self::until`]).
    #[must_use]
    pub fn for_periods(self, periods: u64) -> Self {
        let begun = if self.second { &self.begun[1] } else { &self.begun[0] };
        let horizon = begun.entry.instant.after_periods(periods, 1);
        self.until(horizon)
    }

    /// Counts of the run so far: events, evaluations, undecidable touches and divided pieces.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Advances by one segment without building it, which costs less than [`Iterator::next`].
    #[inline]
    pub fn step(&mut self) -> Option<Step<'_>> {
        let passed = self.pass()?;
        let (begun, next) = self.last_and_next();
        Some(match passed.end {
            End::Switch => Step::Switch { duration: passed.duration, next: &next.entry },
            End::Horizon | End::Endless(_) | End::Undecidable => {
                Step::Last(Box::new(Segment::passed(&self.model, begun, &passed, &next.entry)))
            }
        })
    }

    /// Goes on to the next phase, if a switch leads to one.
    #[inline]
    fn pass(&mut self) -> Option<PhaseEnd> {
        if self.over {
            return None;
        }
        self.second = !self.second;
        let [first, second] = &mut self.begun;
        let (next, begun) = if self.second { (second, first) } else { (first, second) };
        let passed = pass(&self.model, begun, next, self.horizon.as_ref(), &mut self.counters);
        self.over = passed.end != End::Switch;
        Some(passed)
    }

    /// The phase that was passed last, and the one that a switch has led to.
    #[inline]
    fn last_and_next(&self) -> (&Begun, &Begun) {
        let [first, second] = &self.begun;
        if self.second { (first, second) } else { (second, first) }
    }

    /// The model that runs.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }
}

impl FusedIterator for Trajectory {}

impl Iterator for Trajectory {
    type Item = Segment;

    // Inlined into its caller, so that what the caller does not use of a segment is not copied.
    #[inline]
    fn next(&mut self) -> Option<Segment> {
        let passed = self.pass()?;
        let (begun, next) = self.last_and_next();
        Some(Segment::passed(&self.model, begun, &passed, &next.entry))
    }
}

/// A segment of a run: one phase from its entry to its end.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    entry: Entry,
    exit: Exit,
    duration: TwoWord,
    angle: EntryAngle<f64>,
    constants: Constants<f64>,
}

impl Segment {
    /// The phase that has begun; if a switch ends it, `next` becomes the one that follows
    /// ([`pass`]).
    pub(crate) fn new(
        model: &Model,
        begun: &Begun,
        next: &mut Begun,
        horizon: Option<&Instant>,
        counters: &mut Counters,
    ) -> Self {
        let passed = pass(model, begun, next, horizon, counters);
        Self::passed(model, begun, &passed, &next.entry)
    }

    /// The phase that has been passed so, and how the next one begins if a switch has ended it.
    #[inline]
    pub(crate) fn passed(model: &Model, begun: &Begun, passed: &PhaseEnd, next: &Entry) -> Self {
        let Begun { entry, angle, .. } = *begun;
        let exit = match passed.end {
            End::Switch => Exit::Switch(*next),
            End::Horizon => Exit::Horizon,
            End::Endless(why) => Exit::Endless(why),
            End::Undecidable => Exit::Undecidable,
        };
        Self { entry, exit, duration: passed.duration, angle, constants: *model.constants() }
    }

    pub(crate) fn constants(&self) -> &Constants<f64> {
        &self.constants
    }

    /// The closed form from which the end of the phase was found, with all that is known exactly at
    /// its entry.
    #[doc(hidden)]
    #[must_use]
    pub fn motion(&self) -> Motion<'_> {
        Motion::new(&self.constants, &self.entry, self.angle)
    }

    /// The entry at which the phase begins.
    #[must_use]
    pub fn entry(&self) -> &Entry {
        &self.entry
    }

    /// How the segment ends.
    #[must_use]
    pub fn exit(&self) -> &Exit {
        &self.exit
    }

    /// The segment's phase.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.entry.phase()
    }

    /// How long it lasts; up to the horizon if that cuts it, infinite if it is endless, as far as
    /// it is proved if it is undecidable.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration.value()
    }

    /// The phase's duration in two words.
    #[must_use]
    pub fn duration_two_word(&self) -> TwoWord {
        self.duration
    }

    /// Time from the phase's beginning to an instant.
    #[must_use]
    pub fn elapsed_at(&self, instant: &Instant) -> f64 {
        instant.since(&self.entry.instant, self.constants.omega).value()
    }

    /// Whether the instant lies later than an undecidable phase is proved to last.
    #[must_use]
    pub fn is_undecided_at(&self, instant: &Instant) -> bool {
        self.exit == Exit::Undecidable && self.elapsed_at(instant) > self.duration()
    }

    /// Whether an event ends the phase at this instant or before.
    #[must_use]
    pub fn ends_by(&self, instant: &Instant) -> bool {
        matches!(&self.exit, Exit::Switch(next) if next.instant <= *instant)
    }
}
