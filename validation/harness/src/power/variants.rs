//! Wrong answers, made of an engine's right one: what the local judgement has to catch.
//!
//! Each variant is a mistake that authors of event handling have made, applied to every answer.

use crate::engine::Numbers;
use crate::engine::{Event, Outcome, Task};
use crate::system::{Mode, System, Values};

/// A way of making a right answer wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Variant {
    /// Each event is late by this many tolerances of the time scale, with the state of that time.
    Late(f64),
    /// The times of events alone are late by this many tolerances of the time scale.
    TimesLate(f64),
    /// One event, in the middle, is late by a thousand tolerances, with the state of that time.
    OneLate,
    /// Times are rounded to multiples of this.
    TimesRounded(f64),
    /// Each event of this number is dropped.
    Dropped(usize),
    /// Of two events within a thousandth of the time scale the second is dropped.
    CloseDropped,
    /// Each tenth event is told twice.
    Duplicates,
    /// Each tenth event changes places with the next, the times stay.
    Swapped,
    /// Each tenth event is followed by another mode, where the model has one.
    WrongMode,
    /// The reset leaves the states as they are.
    OldState,
    /// Samples are those of straight lines between the records.
    LinearSamples,
    /// The states just after events are off by this many tolerances, up and down in turn.
    Noise(f64),
    /// The states just after events are off by a thousandth of their size.
    StatesOff,
    /// The first two states change places everywhere.
    ColumnsSwapped,
    /// Samples are those of the instant before.
    SamplesBehind,
    /// Nothing is answered after half of the horizon.
    HalfHorizon,
    /// One state, of the record in the middle, is no number.
    OneNaN,
    /// After a third of the events the states are nonsense.
    GarbageAfterAThird,
}

impl Variant {
    /// All variants.
    pub const ALL: [Self; 27] = [
        Self::Late(3.0),
        Self::Late(10.0),
        Self::Late(30.0),
        Self::Late(100.0),
        Self::TimesLate(10.0),
        Self::TimesLate(30.0),
        Self::TimesLate(100.0),
        Self::OneLate,
        Self::TimesRounded(1e-7),
        Self::TimesRounded(1e-6),
        Self::TimesRounded(1e-5),
        Self::Dropped(50),
        Self::Dropped(500),
        Self::CloseDropped,
        Self::Duplicates,
        Self::Swapped,
        Self::WrongMode,
        Self::OldState,
        Self::LinearSamples,
        Self::Noise(10.0),
        Self::Noise(100.0),
        Self::StatesOff,
        Self::ColumnsSwapped,
        Self::SamplesBehind,
        Self::HalfHorizon,
        Self::OneNaN,
        Self::GarbageAfterAThird,
    ];

    /// The mistake in words.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Late(by) => format!("events late by {by} tolerances"),
            Self::TimesLate(by) => format!("times alone late by {by} tolerances"),
            Self::OneLate => "one event late by 1000 tolerances".to_owned(),
            Self::TimesRounded(to) => format!("times rounded to {to:e}"),
            Self::Dropped(every) => format!("every {every}th event dropped"),
            Self::CloseDropped => "the second of two close events dropped".to_owned(),
            Self::Duplicates => "events told twice".to_owned(),
            Self::Swapped => "neighbouring events swapped".to_owned(),
            Self::WrongMode => "wrong modes".to_owned(),
            Self::OldState => "no reset".to_owned(),
            Self::LinearSamples => "linear interpolation".to_owned(),
            Self::Noise(by) => format!("states off by {by} tolerances"),
            Self::StatesOff => "event states off by a thousandth".to_owned(),
            Self::ColumnsSwapped => "two columns swapped".to_owned(),
            Self::SamplesBehind => "samples one behind".to_owned(),
            Self::HalfHorizon => "half of the horizon".to_owned(),
            Self::OneNaN => "one NaN".to_owned(),
            Self::GarbageAfterAThird => "garbage after a third".to_owned(),
        }
    }

    /// The wrong answer; none where this mistake changes nothing by more than a tolerance in the
    /// samples or in the first `judged` events.
    #[must_use]
    pub fn wrong_answer(
        self,
        task: &Task,
        (right, judged): (&Outcome, usize),
        tolerance: f64,
    ) -> Option<Outcome> {
        let mut answer = right.clone();
        let spoiled = Spoiled { task, system: task.system.system(), tolerance };
        spoiled.apply(self, &mut answer);
        spoiled.differs((right, judged), &answer).then_some(answer)
    }
}

struct Spoiled<'a> {
    task: &'a Task,
    system: &'a System,
    tolerance: f64,
}

impl Spoiled<'_> {
    fn apply(&self, variant: Variant, answer: &mut Outcome) {
        let events = &mut answer.events;
        let middle = events.len() / 2;
        match variant {
            Variant::Late(by) => self.delay(events, |_| true, by),
            Variant::OneLate => self.delay(events, |n| n == middle, 1000.0),
            Variant::TimesLate(by) => {
                let by = by * self.unit_of_time();
                events.iter_mut().for_each(|it| it.elapsed += by);
            }
            Variant::TimesRounded(to) => {
                events.iter_mut().for_each(|it| it.elapsed = (it.elapsed / to).round() * to);
            }
            Variant::Dropped(every) => {
                let mut n = 0;
                events.retain(|_| {
                    n += 1;
                    n % every != 0
                });
            }
            Variant::CloseDropped => {
                let close = 1e-3 * self.system.time_scale;
                let mut last = f64::NEG_INFINITY;
                events.retain(|it| {
                    let keep = it.elapsed - last > close;
                    last = it.elapsed;
                    keep
                });
            }
            Variant::Duplicates => {
                let twice = |(n, it): (usize, &Event)| {
                    std::iter::repeat_n(*it, 1 + usize::from(n % 10 == 9))
                };
                *events = events.iter().enumerate().flat_map(twice).collect();
            }
            Variant::Swapped => {
                for n in (9..events.len().saturating_sub(1)).step_by(10) {
                    let [a, b] = [n, n + 1].map(|n| events[n].elapsed);
                    events.swap(n, n + 1);
                    (events[n].elapsed, events[n + 1].elapsed) = (a, b);
                }
            }
            Variant::WrongMode => self.wrong_modes(events),
            Variant::OldState => {
                events.iter_mut().for_each(|it| it.state = it.before.unwrap_or(it.state));
            }
            Variant::LinearSamples => self.straight(answer),
            Variant::Noise(by) => {
                for (n, it) in events.iter_mut().enumerate() {
                    let by = if n % 2 == 0 { by } else { -by } * self.tolerance;
                    self.shift(&mut it.state, by);
                }
            }
            Variant::StatesOff => {
                events.iter_mut().for_each(|it| self.shift(&mut it.state, 1e-3));
            }
            Variant::ColumnsSwapped => {
                let swap = |it: &mut Values| {
                    if it.len() > 1 {
                        it.swap(0, 1);
                    }
                };
                for it in events.iter_mut() {
                    swap(&mut it.state);
                    it.before.iter_mut().for_each(swap);
                }
                answer.samples.iter_mut().for_each(swap);
            }
            Variant::SamplesBehind => {
                for n in (1..answer.samples.len()).rev() {
                    answer.samples[n] = answer.samples[n - 1];
                }
            }
            Variant::HalfHorizon => {
                answer.ended_at = 0.5 * self.task.span;
                events.retain(|it| it.elapsed <= answer.ended_at);
            }
            Variant::OneNaN => {
                if let Some(it) = events.get_mut(middle) {
                    it.state[0] = f64::NAN;
                }
            }
            Variant::GarbageAfterAThird => {
                let from = events.len().div_ceil(3);
                for it in &mut events[from..] {
                    it.state.iter_mut().for_each(|value| *value = 1.0 - *value);
                }
            }
        }
    }

    fn unit_of_time(&self) -> f64 {
        self.tolerance * self.system.time_scale
    }

    /// Moves states by a part of their scale and size.
    fn shift(&self, state: &mut Values, by: f64) {
        for (value, scale) in state.iter_mut().zip(&self.system.scales) {
            *value += by * (scale + value.abs());
        }
    }

    /// Makes events late, with the states of that time: those before the reset go on along their
    /// tangents.
    fn delay(&self, events: &mut [Event], late: impl Fn(usize) -> bool, by: f64) {
        let by = by * self.unit_of_time();
        let mut mode = self.task.mode;
        for (n, it) in events.iter_mut().enumerate() {
            let own = std::mem::replace(&mut mode, it.mode);
            let Some(before) = it.before.as_mut().filter(|_| late(n)) else { continue };
            let rates = self.rates(own, it.elapsed, before);
            before.iter_mut().zip(rates).for_each(|(value, rate)| *value += rate * by);
            it.elapsed += by;
            it.state = self.after(own, it);
        }
    }

    /// z of a state: the states, cos theta, sin theta and 1.
    fn point(&self, elapsed: f64, state: &[f64]) -> Vec<f64> {
        let (sin, cos) = (self.system.omega * elapsed + self.system.phi).sin_cos();
        state.iter().copied().chain([cos, sin, 1.0]).collect()
    }

    fn rates(&self, mode: usize, elapsed: f64, state: &[f64]) -> Vec<f64> {
        let z = self.point(elapsed, state);
        let mode: &Mode = &self.system.modes[mode];
        (0..state.len()).map(|n| product(&mode.rate(n), &z)).collect()
    }

    /// The state after an event whose state before it has changed.
    fn after(&self, mode: usize, event: &Event) -> Values {
        let before = event.before.unwrap_or(event.state);
        let until = self.system.modes[mode].until.get(event.event);
        let Some(reset) = until.and_then(|it| it.reset.as_ref()) else { return before };
        let z = self.point(event.elapsed, &before);
        Values::from_slice(&reset.iter().map(|row| product(row, &z)).collect::<Vec<_>>())
    }

    /// Each tenth event that can is followed by another of its successors.
    fn wrong_modes(&self, events: &mut [Event]) {
        let mut mode = self.task.mode;
        for (n, it) in events.iter_mut().enumerate() {
            let own = std::mem::replace(&mut mode, it.mode);
            let Some(until) = self.system.modes[own].until.get(it.event) else { continue };
            let other = until.next.iter().map(|(_, next)| *next).find(|next| *next != it.mode);
            if let Some(other) = other.filter(|_| n % 10 == 9) {
                it.mode = other;
                mode = other;
            }
        }
    }

    /// Samples on straight lines between the records around them.
    fn straight(&self, answer: &mut Outcome) {
        let events = &answer.events;
        for (elapsed, sample) in self.task.samples.iter().zip(&mut answer.samples) {
            let next = events.partition_point(|it| it.elapsed <= *elapsed);
            let begin = next.checked_sub(1).map(|n| (events[n].elapsed, events[n].state));
            let begin = begin.unwrap_or((0.0, self.task.state));
            let Some((end, Some(before))) = events.get(next).map(|it| (it.elapsed, it.before))
            else {
                continue;
            };
            let share = (elapsed - begin.0) / (end - begin.0);
            for (n, value) in sample.iter_mut().enumerate() {
                *value = begin.1[n] + share * (before[n] - begin.1[n]);
            }
        }
    }

    /// Whether two answers differ by more than a tolerance where they are judged.
    fn differs(&self, (right, judged): (&Outcome, usize), wrong: &Outcome) -> bool {
        let states = |a: &Values, b: &Values| {
            let pairs = a.iter().zip(b.iter()).zip(&self.system.scales);
            pairs.into_iter().any(|((a, b), scale)| {
                let within = (a - b).abs() <= self.tolerance * (scale + a.abs());
                !within
            })
        };
        let events = |(a, b): (&Event, &Event)| {
            (a.event, a.mode) != (b.event, b.mode)
                || (a.elapsed - b.elapsed).abs() > self.unit_of_time()
                || states(&a.state, &b.state)
        };
        let is_whole = judged == right.events.len();
        is_whole && right.events.len() != wrong.events.len()
            || wrong.events.len() < judged
            || right.events.iter().zip(&wrong.events).take(judged).any(events)
            || right.samples.iter().zip(&wrong.samples).any(|(a, b)| states(a, b))
            || right.ended_at != wrong.ended_at
    }
}

fn product(row: &[f64], z: &[f64]) -> f64 {
    row.iter().zip(z).map(|(a, b)| a * b).sum()
}
