//! Brute-force bifurcation diagrams, as in Fig. 10: strobes after a transient, value by value.
//!
//! Fig. 10a follows an attractor by starting each value from where the last one ended
//! ([`Follow::Carry`]); Fig. 10b starts every value from the same state ([`Follow::Reset`]) and
//! jumps wherever that state changes basins.

use super::ensemble::{self, Member};
use super::section::{KeptStrobes, Section};
use super::strobe::{StrobeMap, StrobePoint};
use crate::error::InputError;
use crate::model::Model;
use crate::model::entry::Entry;
use crate::model::instant::Instant;
use crate::model::start::Start;
use crate::parameters::{Parameter, Parameters};
use crate::run::exit::Endless;

/// How each value is started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// Each value starts from the last strobe of the value before.
    Carry,
    /// Each value starts from the start given.
    Reset,
}

/// A diagram to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagram {
    /// The parameters other than the one that varies.
    pub parameters: Parameters,
    /// The start of the first value, and of every value with [`Follow::Reset`].
    pub start: Start,
    /// The parameter that varies.
    pub parameter: Parameter,
    /// The parameter's first value.
    pub from: f64,
    /// The parameter's last value, which may be the smaller one.
    pub to: f64,
    /// How many values, both ends included; one is `from`.
    pub steps: u32,
    /// Forcing periods that are left out.
    pub transient: u64,
    /// Strobes that are kept, one a forcing period.
    pub periods: u32,
    /// How each value is started.
    pub follow: Follow,
}

/// What the diagram shows at one value.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagramStep {
    /// The parameter's value.
    pub value: f64,
    /// Strobes at the start's `tau` modulo the forcing period.
    pub points: Vec<StrobePoint>,
    /// Mean drift per forcing period over these strobes.
    pub drift_per_period: f64,
    /// Why the motion ends in a phase that never ends, where it does.
    pub endless: Option<Endless>,
    /// Whether rounding hides how a phase ends before the last strobe; the points are those before
    /// it.
    pub undecidable: bool,
}

/// Values that are looked at in one go: their models and strobes are held in memory meanwhile.
const BLOCK: usize = 1024;

impl Diagram {
    /// The parameter's value at a step.
    #[must_use]
    pub fn value(&self, step: u32) -> f64 {
        if step + 1 >= self.steps && step > 0 {
            return self.to;
        }
        let share = f64::from(step) / f64::from(self.steps.max(2) - 1);
        self.from + share * (self.to - self.from)
    }

    /// Makes the diagram; `seen` is called as values are done, in any order.
    ///
    /// # Errors
    /// [`InputError`] names what is out of range; with [`Follow::Reset`] also a start that some
    /// value does not admit.
    pub fn steps(&self, seen: impl Fn() + Sync + Send) -> Result<Vec<DiagramStep>, InputError> {
        let steps: Vec<u32> = (0..self.steps).collect();
        match self.follow {
            Follow::Reset => {
                let mut done = Vec::with_capacity(steps.len());
                for block in steps.chunks(BLOCK) {
                    done.extend(self.reset(block, &seen)?);
                }
                Ok(done)
            }
            Follow::Carry => {
                let mut last: Option<StrobePoint> = None;
                let mut done = Vec::with_capacity(steps.len());
                for step in steps {
                    let model = self.model(step)?;
                    let entry = match last {
                        None => model.start(&self.start)?,
                        // A motion that has left for good leaves the range of starts too.
                        Some(point) => StrobeMap::new(model, self.instant(&model))
                            .entry(point)
                            .or_else(|_| model.start(&self.start))?,
                    };
                    let kept = ensemble::follow_alone(self.motion(&model, entry, &seen));
                    let next = self.step(&model, step, &kept.strobes);
                    last = next.points.last().copied();
                    done.push(next);
                }
                Ok(done)
            }
        }
    }

    fn model(&self, step: u32) -> Result<Model, InputError> {
        Model::new(self.parameter.set(self.parameters, self.value(step)))
    }

    fn instant(&self, model: &Model) -> Instant {
        Instant::at(model.parameters().omega, self.start.tau, self.start.cycle)
    }

    /// Computes steps that do not depend on each other.
    fn reset(
        &self,
        steps: &[u32],
        seen: &(impl Fn() + Sync),
    ) -> Result<Vec<DiagramStep>, InputError> {
        let begun = |step: &u32| {
            let model = self.model(*step)?;
            let entry = model.start(&self.start)?;
            Ok((model, entry))
        };
        let begun: Vec<(Model, Entry)> = steps.iter().map(begun).collect::<Result<_, _>>()?;
        let kept = ensemble::follow(begun.len(), |number| {
            let (model, entry) = &begun[number];
            self.motion(model, *entry, seen)
        });
        let done = kept.into_iter().zip(&begun).zip(steps);
        Ok(done.map(|((kept, (model, _)), step)| self.step(model, *step, &kept.strobes)).collect())
    }

    /// The strobes that are shown, and one more, which closes the last period.
    fn motion<'a>(
        &self,
        model: &'a Model,
        entry: Entry,
        seen: &'a (dyn Fn() + Sync),
    ) -> Member<'a, KeptStrobes<'a>> {
        let first = entry.instant.after_periods(self.transient, 1);
        let horizon = Some(first.after_periods(u64::from(self.periods), 1));
        let watcher = KeptStrobes::new(self.periods as usize + 1, seen);
        Member { model, entry, first, horizon, watcher }
    }

    fn step(&self, model: &Model, step: u32, strobes: &[Entry]) -> DiagramStep {
        let shown = self.periods as usize;
        let drift_per_period = match strobes {
            [first, .., last] if strobes.len() > shown => (last.v() - first.v()) / shown as f64,
            _ => f64::NAN,
        };
        let points = strobes.iter().take(shown).map(Entry::point).collect();
        let endless = strobes.last().and_then(|last| Section::endless_at(model, last));
        let undecidable = strobes.len() <= shown;
        DiagramStep { value: self.value(step), points, drift_per_period, endless, undecidable }
    }
}
