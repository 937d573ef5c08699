//! Lyapunov exponents with saltation, and the contraction that their sum must equal.
//!
//! # The third exponent
//!
//! An impact annihilates the direction A = dp - dq, and on the slider p and q move as one: with
//! either the last exponent is minus infinity. Only a motion in flight throughout has three finite
//! ones.
//!
//! # The exact mean contraction
//!
//! The other two exponents are those of a pair of errors with dp = dq on the slider. Their sum is
//! the mean growth of the area w = dp ^ dy that the pair spans, and that is known from the
//! durations alone.
//!
//! - Contact (Eq. 12): q' = y, y' = -2 xi y - q + F; the divergence is -2 xi, w shrinks by
//!   exp(-2 xi d).
//! - Progression (Eq. 13): q' = (1 - q)/(2 xi), y' = F - 1; the divergence is -1/(2 xi).
//! - At f = 0 and f = 1 the field is continuous: nothing changes.
//! - Separation raises the dimension from 2 to 3: the pair has dp = dq, so dp ^ dq = 0 and
//!   dy ^ dq = -w.
//! - Flight (Eq. 11): p'' = F, q' = -q/(2 xi). dp ^ dy is conserved. With e = exp(-d/(2 xi)) after
//!   a time d, dy ^ dq = -e w and, as dp has grown by d dy, dp ^ dq = -e d w.
//! - Impact lowers it to 2 again, A = dp - dq. Into contact dq+ = dp, dy+ = dy - 2 xi A, so
//!   w+ = dp ^ dy + 2 xi dp ^ dq = w (1 - 2 xi e d). Straight into progression
//!   dq+ = dp + (1 - f) A/f, dy+ = dy - 2 xi A/f, so
//!   w+ = dp ^ dy + (2 xi/f) dp ^ dq + ((1 - f)/f)(dp ^ dy + dy ^ dq), that is
//!   w (e + (1 - e)/f - 2 xi e d/f), which is the former at f = 1.
//!
//! The mean contraction per forcing period is the sum of the logarithms over the periods. With an
//! impact, f > 1 enters as the one thing that is not a duration: dp ^ dy shrinks to about 1/f.
//!
//! # How the exponents are found
//!
//! The area's factor is det of the pair's derivative, and the second diagonal entry of its QR
//! decomposition is det over the first. So the first exponent is the mean logarithm of one error's
//! growth, renormalised in every phase, and the second is that of the area less the first. As a
//! difference of vectors it would be lost in rounding wherever a phase on the slider contracts by
//! more than 1e16, which one progression does where xi is small.

use super::batches::{Batches, Stationarity, standard_error};
use super::section::Section;
use super::tangent::{TangentVector, contact_rates};
use crate::model::Model;
use crate::model::entry::{Entry, Motion};
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::phase::Phase;
use crate::run::exit::{Endless, Exit};
use crate::run::trajectory::Segment;

/// Lyapunov exponents of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    /// The exponents per forcing period, largest first; minus infinity where an impact annihilates
    /// a direction.
    pub exponents_per_period: [f64; 3],
    /// The standard errors of the exponents, from the scatter of the means over [`Batches`] of
    /// equal length: honest as soon as a batch is longer than the motion remembers. NaN of what is
    /// not finite, and where there is one period only.
    pub standard_error: [f64; 3],
    /// Whether the exponents and the drift of the batches scatter about one value each; a phase
    /// that never ends has its own exponents, which are known.
    pub stationarity: Stationarity,
    /// Mean growth of the area per forcing period, from durations and impacts alone: the sum of the
    /// first two exponents.
    pub contraction_per_period: f64,
    /// Mean drift per forcing period.
    pub drift_per_period: f64,
    /// The standard error of the mean drift, from the same batches.
    pub drift_standard_error: f64,
    /// Why the motion ends in a phase that never ends, where it does.
    pub endless: Option<Endless>,
    /// Whether rounding hides how a phase ends before the last period does; nothing else is known
    /// then.
    pub undecidable: bool,
}

impl Spectrum {
    /// The exponents over `periods` forcing periods (at least one) that follow `transient` ones.
    ///
    /// Where a phase that never ends is reached they are those of that phase, which are known.
    #[must_use]
    pub fn new(model: &Model, from: Entry, transient: u64, periods: u64) -> Self {
        Self::observe(model, from, transient, periods, &mut |_| ())
    }

    /// Like [`Spectrum::new`], and `seen` is called with every phase that has been followed.
    #[must_use]
    pub fn observe(
        model: &Model,
        from: Entry,
        transient: u64,
        periods: u64,
        seen: &mut dyn FnMut(&Segment),
    ) -> Self {
        ExponentRun::new(model, from, transient, periods).follow_phases(model, from, seen)
    }

    /// [`Spectrum::new`] without a transient, but the last phase is not solved beyond `horizon` to
    /// see whether it ends.
    pub(super) fn within(model: &Model, from: Entry, periods: u64, horizon: Instant) -> Self {
        let run = ExponentRun::new(model, from, 0, periods);
        ExponentRun { last_horizon: Some(horizon), ..run }.follow_phases(model, from, &mut |_| ())
    }

    /// Whether the largest exponent is above zero by more than `errors` standard errors.
    #[must_use]
    pub fn is_chaotic(&self, errors: f64) -> bool {
        self.exponents_per_period[0] > errors * self.standard_error[0]
    }
}

/// What has been seen so far at the end of a batch.
#[derive(Clone, Copy, Debug)]
struct BatchMark {
    length: f64,
    size: f64,
    drift: TwoWord,
}

impl BatchMark {
    /// The growth of an error, and that of the area less it, up to a later mark.
    fn growth(&self, later: &Self) -> [f64; 2] {
        let length = later.length - self.length;
        [length, later.size - self.size - length]
    }

    /// The drift gained up to a later mark.
    fn drift(&self, later: &Self) -> f64 {
        later.drift.minus(self.drift).value()
    }
}

/// A run that is followed segment by segment.
struct ExponentRun {
    tangent: TangentVector,
    two_xi: f64,
    transient: u64,
    periods: u64,
    batches: Batches,
    start: Instant,
    next: Instant,
    marks: Vec<BatchMark>,
    contraction: f64,
    touched: bool,
    last: Option<Segment>,
    /// How far the last phase is solved to see whether it ends.
    last_horizon: Option<Instant>,
}

impl ExponentRun {
    fn new(model: &Model, from: Entry, transient: u64, periods: u64) -> Self {
        let periods = periods.max(1);
        Self {
            tangent: TangentVector::new(model),
            two_xi: model.constants().two_xi,
            transient,
            periods,
            batches: Batches::new(periods),
            start: from.instant,
            next: from.instant.after_periods(transient, 1),
            marks: Vec::new(),
            contraction: 0.0,
            touched: false,
            last: None,
            last_horizon: None,
        }
    }

    /// The exponents of the run from its first phase on, of which `seen` is told.
    fn follow_phases(
        mut self,
        model: &Model,
        from: Entry,
        seen: &mut dyn FnMut(&Segment),
    ) -> Spectrum {
        let end = self.next.after_periods(self.periods, 1);
        for segment in model.trajectory(from).until(end) {
            self.pass(&segment);
            seen(&segment);
        }
        self.spectrum(model)
    }

    fn observing(&self) -> bool {
        !self.marks.is_empty()
    }

    fn pass(&mut self, segment: &Segment) {
        let mut done = 0.0;
        while self.marks.len() as u64 <= self.batches.count() && !segment.ends_by(&self.next) {
            let here = segment.elapsed_at(&self.next).max(done);
            self.carry_errors(segment, done, here);
            self.mark(segment);
            done = here;
        }
        if let Exit::Switch(next) = segment.exit() {
            self.carry_errors(segment, done, segment.duration());
            self.tangent.switch(segment);
            if self.observing() && segment.phase() == Phase::NoContact {
                self.contraction +=
                    libm::log(impact_factor(segment, next.phase(), self.two_xi).abs());
                self.touched = true;
            }
        }
        if *segment.exit() == Exit::Undecidable {
            self.marks.clear();
        }
        self.last = Some(*segment);
    }

    /// Carries errors from one time in a phase to another.
    fn carry_errors(&mut self, segment: &Segment, from: f64, to: f64) {
        let elapsed = (to - from).max(0.0);
        self.tangent.flow(segment, elapsed);
        if self.observing() {
            self.touched |= segment.phase() != Phase::NoContact;
            self.contraction -= match segment.phase() {
                Phase::NoContact => 0.0,
                Phase::Contact => self.two_xi * elapsed,
                Phase::Progression => elapsed / self.two_xi,
            };
        }
    }

    fn mark(&mut self, segment: &Segment) {
        let TangentVector { length, size, .. } = self.tangent;
        let drift = segment.entry_at(&self.next).drift;
        self.marks.push(BatchMark { length, size, drift });
        let passed = self.batches.end(self.marks.len() as u64);
        self.next = self.start.after_periods(self.transient + passed, 1);
    }

    fn spectrum(&self, model: &Model) -> Spectrum {
        let periods = self.periods as f64;
        // A motion that is decided to its end has a mark at either end of every batch.
        let [first, .., end] = self.marks.as_slice() else { return Spectrum::UNKNOWN };
        if self.marks.len() as u64 <= self.batches.count() {
            return Spectrum::UNKNOWN;
        }
        let drift = self.batches.means(&self.marks, BatchMark::drift);
        let third =
            if self.touched { f64::NEG_INFINITY } else { -model.period() * model.constants().rate };
        let unknown = Spectrum {
            drift_per_period: first.drift(end) / periods,
            drift_standard_error: standard_error(&drift),
            undecidable: false,
            ..Spectrum::UNKNOWN
        };
        if let Some(endless) = self.endless(model) {
            return unknown.of_endless(model, endless, third);
        }
        let growths =
            [0, 1].map(|i| self.batches.means(&self.marks, |a, b| BatchMark::growth(a, b)[i]));
        let error = if third.is_finite() { 0.0 } else { f64::NAN };
        let mut exponents = [(f64::NAN, f64::NAN), (f64::NAN, f64::NAN), (third, error)];
        for ((sum, means), exponent) in first.growth(end).iter().zip(&growths).zip(&mut exponents) {
            *exponent = (sum / periods, standard_error(means));
        }
        exponents.sort_by(|a, b| b.0.total_cmp(&a.0));
        let [length, rest] = growths;
        Spectrum {
            exponents_per_period: exponents.map(|it| it.0),
            standard_error: exponents.map(|it| it.1),
            stationarity: self.batches.stationarity(&[length, rest, drift]),
            contraction_per_period: self.contraction / periods,
            ..unknown
        }
    }

    /// Why the last phase has no end, if it has none.
    fn endless(&self, model: &Model) -> Option<Endless> {
        let entry = *self.last.as_ref()?.entry();
        let begun = model.trajectory(entry);
        let solved = match self.last_horizon {
            Some(horizon) => begun.until(horizon),
            None => begun,
        };
        Section::along(solved, entry.instant).endless()
    }
}

/// The factor by which the impact that ends a flight changes an area that was dp ^ dy at
/// separation.
fn impact_factor(segment: &Segment, next: Phase, two_xi: f64) -> f64 {
    let d = segment.duration();
    let e = libm::exp(-d / two_xi);
    let lost = two_xi * e * d;
    match (next, &segment.motion()) {
        (Phase::Progression, Motion::NoContact(_)) => {
            let f = two_xi * segment.point(d).guard.orders[1];
            e + (1.0 - e - lost) / f
        }
        _ => 1.0 - lost,
    }
}

impl Spectrum {
    /// The spectrum of a motion that is not decided to its end.
    const UNKNOWN: Self = Self {
        exponents_per_period: [f64::NAN; 3],
        standard_error: [f64::NAN; 3],
        stationarity: Stationarity::Unknown,
        contraction_per_period: f64::NAN,
        drift_per_period: f64::NAN,
        drift_standard_error: f64::NAN,
        endless: None,
        undecidable: true,
    };

    /// This spectrum with the exponents of a phase that never ends.
    fn of_endless(self, model: &Model, endless: Endless, third: f64) -> Self {
        let period = model.period();
        let slider_returns = -period * model.constants().rate;
        let [fast, slow] = contact_rates(model.parameters().xi).map(|rate| -period * rate);
        let (exponents, contraction) = match endless {
            Endless::NeverReturns => ([0.0, 0.0, third], 0.0),
            Endless::NeverStops => ([0.0, slider_returns, f64::NEG_INFINITY], slider_returns),
            Endless::RestsForEver => ([slow, fast, f64::NEG_INFINITY], slow + fast),
        };
        Self {
            exponents_per_period: exponents,
            standard_error: exponents.map(|it| if it.is_finite() { 0.0 } else { f64::NAN }),
            stationarity: Stationarity::Stationary,
            contraction_per_period: contraction,
            endless: Some(endless),
            ..self
        }
    }
}
