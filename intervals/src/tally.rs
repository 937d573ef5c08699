//! Events of the solver, examined one by one and counted.

use crate::ball::Ball;
use crate::frame::Frame;
use crate::guard::Guard;
use crate::proof::{Claim, MAX_SLACKS, Verdict, examine};
use crate::regimes::{Chance, Regime, Run};
use percuss::insides::Motion;
use percuss::insides::crossing::{Guarded, slack};
use percuss::{Exit, Model, Phase, Segment};

/// The number of examples kept of a regime's events that were not proved.
const MAX_EXAMPLES: usize = 20;

/// The counts of proved, open and contradicted events of a regime.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of events examined.
    pub switches: u64,
    /// Proved.
    pub confirmed: u64,
    /// Counted as undecidable by the solver itself, and not refuted.
    pub undecidable: u64,
    /// Neither proved nor refuted.
    pub open: u64,
    /// Refuted.
    pub contradicted: u64,
    /// The number of phases without an event.
    pub endless: u64,
    /// The largest distance of a proved event's guard from its threshold, in units of the slack.
    pub residual: f64,
    /// The largest error of a guard inside its phase, in units of eps times its largest term.
    pub rounding: f64,
    /// The first events that were not proved, in words.
    pub examples: Vec<String>,
}

/// An event as the solver found it.
pub struct Found<'a> {
    /// The phase that the event ends.
    pub segment: &'a Segment,
    /// The solver's claim about the phase.
    pub claim: Claim,
}

impl<'a> Found<'a> {
    /// The claim of a phase that ends at an event.
    #[must_use]
    pub fn new(segment: &'a Segment) -> Option<Self> {
        let Exit::Switch(next) = segment.exit() else { return None };
        let duration = segment.duration_two_word();
        let rises = match segment.phase() {
            Phase::NoContact => true,
            Phase::Contact => next.phase() == Phase::Progression,
            Phase::Progression => false,
        };
        let claim = |corridor, slack| Claim { duration, corridor, rises, slack };
        let claim = match segment.motion() {
            Motion::NoContact(it) => claim(it.corridor(), room(&it, duration.high)),
            Motion::Contact(it) => claim(it.corridor(), room(&it, duration.high)),
            Motion::Progression(it) => claim(it.corridor(), room(&it, duration.high)),
        };
        Some(Self { segment, claim })
    }

    /// The exact guard.
    #[must_use]
    pub fn guard(&self, frame: &Frame) -> Guard {
        frame.guard(&self.segment.motion(), &self.segment.entry().instant)
    }

    /// The error of the f64 guard at a share of the phase, in units of eps times its largest term.
    fn rounding(&self, guard: &Guard, share: f64) -> f64 {
        let elapsed = share * self.claim.duration.high;
        let jet = match self.segment.motion() {
            Motion::NoContact(it) => guard_and_term(&it, elapsed),
            Motion::Contact(it) => guard_and_term(&it, elapsed),
            Motion::Progression(it) => guard_and_term(&it, elapsed),
        };
        let exact = guard.at(Ball::exact(elapsed)).whole[0];
        let error = (exact - Ball::exact(jet[0])).size() - exact.upper() + exact.lower();
        error / (f64::EPSILON * jet[1] + 1e-285)
    }
}

/// The solver's own rounding room for its proof of the whole phase.
fn room<G: Guarded>(phase: &G, end: f64) -> f64 {
    slack(phase, &phase.entry(), &phase.at(end))
}

/// A guard and its largest term.
fn guard_and_term<G: Guarded>(phase: &G, elapsed: f64) -> [f64; 2] {
    let jet = phase.at(elapsed).guard;
    [jet.orders[0], jet.largest_term]
}

impl Tally {
    /// Examines the given number of events of a regime.
    #[must_use]
    pub fn new(regime: &Regime, switches: u64, chance: &mut Chance) -> Self {
        let mut tally = Self::default();
        while tally.switches < switches {
            for run in (regime.draw)(chance) {
                tally.follow(&run, regime.phases, switches, chance);
            }
        }
        tally
    }

    /// Follows a run; one that the library refuses counts for nothing.
    fn follow(&mut self, run: &Run, phases: usize, switches: u64, chance: &mut Chance) {
        let Ok(model) = Model::new(run.0) else { return };
        let Ok(entry) = model.start(&run.1) else { return };
        let frame = Frame::new(model.parameters());
        let horizon = entry.instant.after_periods(100_000, 1);
        let mut trajectory = model.trajectory(entry).until(horizon);
        for number in 0..phases {
            let before = trajectory.counters().undecidable;
            let Some(segment) = trajectory.next() else { return };
            let flagged = trajectory.counters().undecidable > before;
            let Some(found) = Found::new(&segment) else {
                self.endless += 1;
                return;
            };
            if self.switches >= switches {
                return;
            }
            if let Some(verdict) = self.count(&found, &frame, flagged, chance.unit())
                && self.examples.len() < MAX_EXAMPLES
            {
                self.examples
                    .push(format!("phase {number} of {run:?}: {verdict:?}, {:?}", found.claim));
            }
        }
    }

    /// Counts an event and returns a verdict that is to be looked at.
    fn count(
        &mut self,
        found: &Found<'_>,
        frame: &Frame,
        flagged: bool,
        share: f64,
    ) -> Option<Verdict> {
        let guard = found.guard(frame);
        let verdict = examine(&guard, &found.claim);
        self.switches += 1;
        self.rounding = self.rounding.max(found.rounding(&guard, share));
        match verdict {
            Verdict::Confirmed { residual } if !flagged => {
                self.confirmed += 1;
                self.residual = self.residual.max(residual);
                None
            }
            Verdict::Confirmed { .. } | Verdict::Open { .. } if flagged => {
                self.undecidable += 1;
                None
            }
            Verdict::Earlier { excess, .. } if flagged && excess <= MAX_SLACKS => {
                self.undecidable += 1;
                None
            }
            Verdict::Absent { .. } if flagged => {
                self.undecidable += 1;
                None
            }
            Verdict::Open { .. } => {
                self.open += 1;
                Some(verdict)
            }
            _ => {
                self.contradicted += 1;
                Some(verdict)
            }
        }
    }

    /// Adds another regime's counts.
    pub fn add(&mut self, other: &Self) {
        self.switches += other.switches;
        self.confirmed += other.confirmed;
        self.undecidable += other.undecidable;
        self.open += other.open;
        self.contradicted += other.contradicted;
        self.endless += other.endless;
        self.residual = self.residual.max(other.residual);
        self.rounding = self.rounding.max(other.rounding);
    }

    /// Whether nothing is contradicted, and of what the solver decided one in ten thousand is open
    /// at most.
    #[must_use]
    pub const fn holds(&self) -> bool {
        self.contradicted == 0 && self.open * 10_000 <= self.switches - self.undecidable
    }

    /// The counts as a row below [`HEADER`].
    #[must_use]
    pub fn row(&self, name: &str) -> String {
        let Self { switches, confirmed, undecidable, open, contradicted, .. } = self;
        let Self { residual, rounding, .. } = self;
        format!(
            "{name:<32} {switches:>9} {confirmed:>9} {undecidable:>11} {open:>13} \
             {contradicted:>12} {residual:>8.2} {rounding:>8.2}"
        )
    }
}

/// The header of the table.
pub const HEADER: &str = "regime                            switches confirmed undecidable \
                          not confirmed contradicted residual rounding";
