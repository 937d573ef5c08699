//! A batch worked off, from the lanes' beginnings to their ends.

use super::batch::{Batch, Begin, LaneTask, PhaseEnds};
use super::contact::{LaneContact, Release};
use super::contact_constants::Forms;
use super::flight::{Flight, Impact};
use super::forcing::Angle;
use super::root::Fineness;
use super::shape::Shape;
use super::slip::{Slip, SlipStrobe, Stop};
use super::wide::{LaneValues, Mask, Wide};
use super::words::Words;
use crate::numeric::real::Real;
use pulp::{Simd, WithSimd};

/// A batch to be worked off.
pub struct BatchWork<'a> {
    /// The task of the batch.
    pub task: LaneTask,
    /// The batch.
    pub batch: &'a mut Batch,
}

impl WithSimd for BatchWork<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Batch { shape, begin, end } = self.batch;
        let lanes = LoadedLanes { shape: &shape.load(simd), begin, simd };
        match self.task {
            LaneTask::Flight => lanes.flight(Fineness::Usual, end),
            LaneTask::Contact => lanes.contact(Fineness::Usual, end),
            LaneTask::FlightAgain => lanes.flight(Fineness::Finer, end),
            LaneTask::ContactAgain => lanes.contact(Fineness::Finer, end),
            LaneTask::Slip => lanes.slip(end),
            LaneTask::FlightStrobe => lanes.flight_strobe(end),
            LaneTask::ContactStrobe => lanes.contact_strobe(end),
            LaneTask::SlipStrobe => lanes.slip_strobe(end),
        }
    }
}

struct LoadedLanes<'a, S: Simd> {
    shape: &'a Shape<Wide<S>>,
    begin: &'a Begin,
    simd: S,
}

/// The longest phase in lanes, radians of the faster of forcing and free oscillation: longer ones
/// are left to the scalar solver, whose reduction of the angle knows no bound.
const MAX_PHASE_RADIANS: f64 = 1e5;

impl<'a, S: Simd> LoadedLanes<'a, S> {
    #[inline(always)]
    fn load(&self, column: &LaneValues) -> Wide<S> {
        Wide::load(self.simd, column)
    }

    #[inline(always)]
    fn angle(&self) -> Words<S> {
        Words { high: self.load(&self.begin.angle), low: self.load(&self.begin.angle_low) }
    }

    #[inline(always)]
    fn flights(&self) -> Flight<'a, S> {
        Flight {
            shape: self.shape,
            angle: Angle::new(self.shape, self.angle()),
            y: self.load(&self.begin.y),
            q: self.load(&self.begin.q),
        }
    }

    #[inline(always)]
    fn contacts(&self, forms: Forms) -> LaneContact<'a, S> {
        LaneContact {
            shape: self.shape,
            forms,
            angle: Angle::new(self.shape, self.angle()),
            y: self.load(&self.begin.y),
            q: self.load(&self.begin.q),
            offset: self.load(&self.begin.first),
            reference: self.load(&self.begin.second),
        }
    }

    #[inline(always)]
    fn slips(&self) -> Slip<'a, S> {
        Slip {
            shape: self.shape,
            angle: Angle::new(self.shape, self.angle()),
            y: self.load(&self.begin.y),
            q: self.load(&self.begin.q),
            drift_rate: self.load(&self.begin.first),
            closing: self.load(&self.begin.second),
        }
    }

    #[inline(always)]
    fn flight(&self, fineness: Fineness, end: &mut PhaseEnds) {
        let Impact { elapsed, y, q, f, proved } = self.flights().impact(fineness);
        self.switch(elapsed, proved, end);
        y.store(&mut end.y);
        q.store(&mut end.q);
        f.store(&mut end.guard);
    }

    #[inline(always)]
    fn contact(&self, fineness: Fineness, end: &mut PhaseEnds) {
        let release = match Forms::new(self.shape) {
            Forms::Usual => self.contacts(Forms::Usual).release(fineness),
            Forms::Any => self.contacts(Forms::Any).release(fineness),
        };
        let Release { elapsed, y, rises, proved } = release;
        self.switch(elapsed, proved, end);
        y.store(&mut end.y);
        rises.number().store(&mut end.guard);
    }

    #[inline(always)]
    fn slip(&self, end: &mut PhaseEnds) {
        let Stop { elapsed, y, drift, proved } = self.slips().stop();
        self.switch(elapsed, proved, end);
        y.store(&mut end.y);
        drift.store(&mut end.drift);
    }

    /// When the phases end.
    #[inline(always)]
    fn switch(&self, (evaluated, step): (Wide<S>, Wide<S>), proved: Mask<S>, end: &mut PhaseEnds) {
        let omega = self.shape.omega;
        let elapsed = Words::sum(evaluated, step);
        let (cycles, angle) = self.angle().plus(elapsed.times(omega)).wrapped();
        let proved = proved & (elapsed.high * self.shape.pace).below(MAX_PHASE_RADIANS);
        proved.number().store(&mut end.proved);
        angle.high.store(&mut end.angle);
        angle.low.store(&mut end.angle_low);
        cycles.store(&mut end.cycles);
    }

    /// Time from the phase's beginning to the strobe.
    #[inline(always)]
    fn until_due(&self, end: &mut PhaseEnds) -> Words<S> {
        let due = Words { high: self.load(&self.begin.due), low: self.load(&self.begin.due_low) };
        let Words { high, low } = self.angle();
        let change = due.plus(Words { high: -high, low: -low });
        let cycles = self.load(&self.begin.due_cycles);
        let elapsed = Words::turns(cycles).plus(change).over(self.shape.omega);
        let near = (elapsed.high * self.shape.pace).below(MAX_PHASE_RADIANS);
        near.number().store(&mut end.proved);
        elapsed
    }

    #[inline(always)]
    fn flight_strobe(&self, end: &mut PhaseEnds) {
        let elapsed = self.until_due(end);
        let (values, rates) = self.flights().state(elapsed.high);
        let [p, y, q] = moved(values, rates, elapsed.low);
        p.store(&mut end.p);
        y.store(&mut end.y);
        q.store(&mut end.q);
    }

    #[inline(always)]
    fn contact_strobe(&self, end: &mut PhaseEnds) {
        let elapsed = self.until_due(end);
        let forms = Forms::new(self.shape);
        let (values, rates) = self.contacts(forms).state(elapsed.high);
        let [q, y, guard] = moved(values, rates, elapsed.low);
        (q + self.shape.g).store(&mut end.p);
        y.store(&mut end.y);
        q.store(&mut end.q);
        guard.store(&mut end.guard);
    }

    #[inline(always)]
    fn slip_strobe(&self, end: &mut PhaseEnds) {
        let elapsed = self.until_due(end);
        let SlipStrobe { values, rates, lag, terms } = self.slips().state(elapsed.high);
        let [q, y, drift, guard] = moved(values, rates, elapsed.low);
        (q + self.shape.g).store(&mut end.p);
        y.store(&mut end.y);
        q.store(&mut end.q);
        drift.store(&mut end.drift);
        guard.store(&mut end.guard);
        lag.store(&mut end.closing);
        terms.store(&mut end.terms);
    }
}

/// A second word of time later.
#[inline(always)]
fn moved<S: Simd, const N: usize>(
    values: [Wide<S>; N],
    rates: [Wide<S>; N],
    low: Wide<S>,
) -> [Wide<S>; N] {
    let mut moved = values;
    for (value, rate) in moved.iter_mut().zip(rates) {
        *value = low.times_plus(rate, *value);
    }
    moved
}
