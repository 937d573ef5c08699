//! Brute-force bifurcation diagrams, as in Fig. 10: strobes after a transient, value by value.
//!
//! Fig. 10a follows an attractor by starting each value from where the last one ended
//! ([`Follow::Carry`]); Fig. 10b starts every value from the same state ([`Follow::Reset`]) and
//! jumps wherever that state changes basins.
//!
//! A motion escapes whose state passes [`ESCAPE_DISTANCE`] at a strobe, or is proved to pass it
//! sooner or later: the mass never returns, or the slider never stops. Its strobes are no part of a
//! diagram, and no value starts from where it went.

use super::batches::Batches;
use super::ensemble::{self, Member};
use super::section::{KeptStrobes, Section};
use super::strobe::{StrobeMap, StrobePoint};
use crate::error::InputError;
use crate::model::Model;
use crate::model::entry::Entry;
use crate::model::instant::Instant;
use crate::model::start::Start;
use crate::numeric::two_word::TwoWord;
use crate::parameters::{Parameter, Parameters};
use crate::run::exit::Endless;

/// How each value is started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// Each value starts from the last strobe of the value before that did not escape; from the
    /// start given where there is none.
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
    /// Strobes at the start's `tau` modulo the forcing period; none where the motion escapes.
    pub points: Vec<StrobePoint>,
    /// Mean drift per forcing period over these strobes; NaN where the motion escapes.
    pub drift_per_period: f64,
    /// The standard error of the mean drift, from the scatter of [`Batches`].
    pub drift_standard_error: f64,
    /// Whether the motion escapes.
    pub escapes: bool,
    /// Why the motion ends in a phase that never ends, where it does.
    pub endless: Option<Endless>,
    /// Whether rounding hides how a phase ends before the last strobe; the points are those before
    /// it.
    pub undecidable: bool,
}

/// A state farther away than this in p, y or q has escaped: starts are accepted up to there.
pub const ESCAPE_DISTANCE: f64 = 1e9;

/// Values that are looked at in one go: their models and strobes are held in memory meanwhile.
const BLOCK_VALUES: usize = 1024;

impl Diagram {
    /// The parameter's value at a step.
    #[must_use]
    pub fn value(&self, step: u32) -> f64 {
        value(self.from, self.to, self.steps, step)
    }

    /// Makes the diagram; `seen` is told how many more values are done, in any order, and of none
    /// now and then on the way to a value.
    ///
    /// # Errors
    /// [`InputError`] names what is out of range; with [`Follow::Reset`] also a start that some
    /// value does not admit.
    pub fn steps(&self, seen: impl Fn(u64) + Sync + Send) -> Result<Vec<DiagramStep>, InputError> {
        let steps: Vec<u32> = (0..self.steps).collect();
        match self.follow {
            Follow::Reset => {
                let mut done = Vec::with_capacity(steps.len());
                for block in steps.chunks(BLOCK_VALUES) {
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
                        // p = q + g with a larger g may leave the range of starts.
                        Some(point) => StrobeMap::new(model, self.instant(&model))
                            .entry(point)
                            .or_else(|_| model.start(&self.start))?,
                    };
                    let kept = ensemble::follow_alone(self.motion(&model, entry, &seen));
                    let next = self.step(&model, step, &kept.strobes);
                    last = next.points.last().copied().or(last);
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
        seen: &(impl Fn(u64) + Sync),
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
        seen: &'a (dyn Fn(u64) + Sync),
    ) -> Member<'a, KeptStrobes<'a>> {
        let first = entry.instant.after_periods(self.transient, 1);
        let horizon = Some(first.after_periods(u64::from(self.periods), 1));
        let watcher = KeptStrobes::new(self.periods as usize + 1, seen);
        Member { model, entry, first, horizon, watcher }
    }

    fn step(&self, model: &Model, step: u32, strobes: &[Entry]) -> DiagramStep {
        let shown = self.periods as usize;
        let endless = strobes.last().and_then(|last| Section::endless_at(model, last));
        let leaves = matches!(endless, Some(Endless::NeverReturns | Endless::NeverStops));
        let escapes = leaves || strobes.iter().any(is_far);
        let drifts: Vec<TwoWord> = strobes.iter().map(|strobe| strobe.drift).collect();
        let [drift_per_period, drift_standard_error] =
            if escapes { [f64::NAN; 2] } else { Batches::new(shown as u64).drift(&drifts) };
        let points = strobes.iter().take(if escapes { 0 } else { shown }).map(Entry::point);
        DiagramStep {
            value: self.value(step),
            points: points.collect(),
            drift_per_period,
            drift_standard_error,
            escapes,
            endless,
            undecidable: strobes.len() <= shown,
        }
    }
}

/// The values of a parameter at so many equal steps, both ends included; one is the first end.
#[must_use]
pub fn values(from: f64, to: f64, steps: u32) -> Vec<f64> {
    (0..steps).map(|step| value(from, to, steps, step)).collect()
}

fn value(from: f64, to: f64, steps: u32, step: u32) -> f64 {
    if step + 1 >= steps && step > 0 {
        return to;
    }
    let share = f64::from(step) / f64::from(steps.max(2) - 1);
    from + share * (to - from)
}

/// Whether a state has gone farther than any start.
fn is_far(strobe: &Entry) -> bool {
    strobe.point().iter().any(|x| x.is_nan() || x.abs() > ESCAPE_DISTANCE)
}
