//! The slow part of a guard, without its harmonic, which decides about long phases and whole
//! futures.
//!
//! Without contact and in progression the guard, counted so that it rises to zero, is
//! G(d) = c + s d + k d^2/2 - K cos(omega d + angle) - e exp(-rate d). With e >= 0 it never exceeds
//! the parabola plus K; with e < 0 it never exceeds that plus what is left of the exponential.
//! While that bound is negative nothing can happen, however many forcing cycles pass; and where the
//! harmonic is at its crest the bound is attained, so that at most one period has to be
//! searched each time the bound becomes positive.

use crate::crossing::SearchHint;
use crate::crossing::allowances::NEGLIGIBLE_DECAY;
use crate::flow::steps::{FreeStep, Steps};
use crate::numeric::circle::rough_sin_cos;
use crate::numeric::exponential::rough_decay;
use crate::numeric::remainders::decay;
use crate::numeric::roots::{first_root, last_root, zero_between};
use std::f64::consts::TAU;

/// The envelope of a slow motion, with the symbols of the module's text.
#[derive(Clone, Copy, Debug)]
pub struct SlowEnvelope {
    /// c
    pub offset: f64,
    /// s
    pub slope: f64,
    /// k
    pub curvature: f64,
    /// K >= 0
    pub amplitude: f64,
    /// Sine of `angle`.
    pub sin: f64,
    /// Cosine of `angle`.
    pub cos: f64,
    /// e
    pub exponential: f64,
    /// rate
    pub rate: f64,
    /// omega
    pub omega: f64,
}

/// What the bound says about the time from some instant on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EnvelopeBound {
    /// The bound is negative until this elapsed time and may be positive afterwards.
    OpenFrom(f64),
    /// The bound is negative from now on.
    Never,
    /// The bound may be positive until this elapsed time, and is negative afterwards.
    NeverAfter(f64),
}

/// The smallest slope whose square does not underflow.
const MIN_SQUARABLE_SLOPE: f64 = 1e-150;

/// Room for rounding in statements about the parabola, relative to its terms.
const ROUNDING_TOLERANCE: f64 = 8.0 * f64::EPSILON;

impl SlowEnvelope {
    /// What the bound says from elapsed time `from` on.
    pub fn bound(&self, from: f64) -> EnvelopeBound {
        let Self { slope, curvature, exponential, .. } = *self;
        let value = self.parabola(from) + self.amplitude;
        let rising = slope + curvature * from;
        let lasting = exponential * decay(self.rate * from).exp;
        // e < 0: what is left of the exponential only decreases. e > 0: it may be dropped, or,
        // being concave in the guard, be replaced by its tangent here; whichever says more.
        let dropped = self.opening(from, value + (-lasting).max(0.0), rising, curvature);
        if lasting <= 0.0 {
            return dropped;
        }
        let sinking = self.rate * lasting * (1.0 + ROUNDING_TOLERANCE);
        let tangent = self.opening(from, value - lasting, rising + sinking, curvature);
        match (dropped, tangent) {
            (EnvelopeBound::OpenFrom(first), EnvelopeBound::OpenFrom(second)) => {
                EnvelopeBound::OpenFrom(first.max(second))
            }
            (EnvelopeBound::Never, _) | (_, EnvelopeBound::Never) => EnvelopeBound::Never,
            (EnvelopeBound::OpenFrom(first), EnvelopeBound::NeverAfter(second)) => {
                match first > from {
                    true => EnvelopeBound::OpenFrom(first),
                    false => EnvelopeBound::NeverAfter(second),
                }
            }
            (never_after, _) => never_after,
        }
    }

    /// When value + rising t + curvature t^2/2, t after `from`, becomes positive or stays negative.
    ///
    /// The parabola's rounding grows with its terms; it is bounded by a parabola of its own.
    fn opening(&self, from: f64, value: f64, rising: f64, curvature: f64) -> EnvelopeBound {
        let bent = curvature.abs();
        let size = self.offset.abs() + (self.slope * from).abs() + 2.0 * bent * from * from;
        let value = value + ROUNDING_TOLERANCE * (size + self.amplitude + self.exponential.abs());
        let rising = rising + ROUNDING_TOLERANCE * self.slope.abs();
        let rising = if rising > 0.0 { rising.max(MIN_SQUARABLE_SLOPE) } else { rising };
        let curvature = curvature + 4.0 * ROUNDING_TOLERANCE * bent;
        if value < 0.0 {
            let opens = first_root(value, rising, curvature);
            return opens.map_or(EnvelopeBound::Never, |time| EnvelopeBound::OpenFrom(from + time));
        }
        let closes = curvature < 0.0 || (curvature == 0.0 && rising < 0.0);
        match closes.then(|| last_root(value, rising, curvature)).flatten() {
            Some(time) => EnvelopeBound::NeverAfter(from + time * (1.0 + 1e-6)),
            None => EnvelopeBound::OpenFrom(from),
        }
    }

    /// A hint about where the search should look after elapsed time `from`; `inside` as for the
    /// guess, which begins at a `place` before which there is nothing to be found.
    #[inline(always)]
    pub fn hint(
        &self,
        steps: &Steps,
        from: f64,
        (place, inside): (EnvelopePlace, bool),
        limit: f64,
    ) -> SearchHint {
        if let Some(time) = self.guess(&steps.guess_step, place, inside, limit) {
            return SearchHint::Root(time);
        }
        match self.bound(from) {
            EnvelopeBound::OpenFrom(time) if time > from + 4.0 * TAU / self.omega => {
                SearchHint::ClearUntil(time)
            }
            EnvelopeBound::Never => SearchHint::ClearFrom(from),
            EnvelopeBound::NeverAfter(time) | EnvelopeBound::OpenFrom(time) if time > limit => {
                SearchHint::Onward(limit)
            }
            EnvelopeBound::NeverAfter(time) => SearchHint::Onward(time),
            EnvelopeBound::OpenFrom(_) => SearchHint::Onward(from + TAU / self.omega),
        }
    }

    /// The time at which a long piece is divided: after the first `decay_times` of the exponential,
    /// and around the time in which the bound is negative. None if the piece is short in both
    /// respects.
    pub fn division(&self, from: f64, to: f64, decay_times: f64) -> Option<f64> {
        let length = to - from;
        let settled = 0.9 * decay_times / self.rate;
        if length * self.rate > decay_times && from < settled {
            return Some(from + settled);
        }
        let period = TAU / self.omega;
        if length <= 2.0 * period {
            return None;
        }
        let within = |time: &f64| *time > from + 0.5 * period && *time < to - 0.5 * period;
        let (now, later) = (self.bound(from), self.bound(from + period));
        // The bound is zero where it opens: a period before that it is negative by a margin.
        let before_opening = |bound| match bound {
            EnvelopeBound::OpenFrom(time) => Some(time - period).filter(within),
            _ => None,
        };
        let turn = before_opening(later).or_else(|| before_opening(now));
        turn.or_else(|| match (now, later) {
            // At the opening itself the proof would meet a zero and count it as a touch.
            (_, EnvelopeBound::OpenFrom(time)) if within(&time) => Some(time - 0.25 * period),
            (EnvelopeBound::NeverAfter(time), _) if within(&time) => Some(time),
            (EnvelopeBound::OpenFrom(_), _) => Some(from + period),
            _ => Some(from + 0.5 * length),
        })
    }

    /// c + s d + k d^2/2
    fn parabola(&self, d: f64) -> f64 {
        self.offset + d * (self.slope + 0.5 * self.curvature * d)
    }

    /// A guess, not a proof, of the first rise of G to zero after this place; `inside` says that G
    /// is known to be negative just after it. None if there is none within three periods in which
    /// the bound allows one, or none before `limit`.
    #[inline(always)]
    fn guess(
        &self,
        guess_step: &FreeStep,
        mut here: EnvelopePlace,
        mut inside: bool,
        limit: f64,
    ) -> Option<f64> {
        /// The number of steps after which the guess is given up.
        const MAX_STEPS: usize = 40;
        // At larger angles one leap more, with an evaluation, is worth its cost.
        const MAX_LEAP_RADIANS: f64 = 1e6;
        for _ in 0..MAX_STEPS {
            if self.parabola(here.elapsed) + self.amplitude < 0.0 {
                inside = true;
                let opens = here.elapsed + self.opens_after(here.elapsed)?;
                if (opens - here.elapsed) * self.omega > MAX_LEAP_RADIANS {
                    return None;
                }
                if opens > here.elapsed + guess_step.length {
                    here = self.place_at(opens);
                }
            }
            let next = here.after(guess_step);
            if here.elapsed.is_nan() || here.elapsed > limit {
                return None;
            }
            let (value, rate) = self.value_and_rate(&next);
            if value >= 0.0 {
                if inside {
                    if guess_step.decay < NEGLIGIBLE_DECAY {
                        // The cubic would follow its slope, of which nothing is left at the root.
                        here.lasting = 0.0;
                    }
                    let (last, last_rate) = self.value_and_rate(&here);
                    let slopes = (last_rate * guess_step.length, rate * guess_step.length);
                    return Some(
                        here.elapsed + guess_step.length * zero_between(last, value, slopes),
                    );
                }
            } else {
                inside = true;
            }
            here = next;
        }
        None
    }

    /// When the parabola next rises to where the harmonic may reach zero.
    fn opens_after(&self, from: f64) -> Option<f64> {
        let value = self.parabola(from) + self.amplitude;
        first_root(value, self.slope + self.curvature * from, self.curvature)
    }

    /// The start of the phase.
    pub fn start(&self) -> EnvelopePlace {
        EnvelopePlace { elapsed: 0.0, sin: self.sin, cos: self.cos, lasting: self.exponential }
    }

    /// The place at this time, at which omega d + angle has this sine and cosine.
    pub fn place(&self, elapsed: f64, (sin, cos): (f64, f64)) -> EnvelopePlace {
        let lasting = self.exponential * rough_decay(self.rate * elapsed);
        EnvelopePlace { elapsed, sin, cos, lasting }
    }

    /// Harmonic and exponential to about 1e-7 and a per cent, without a call of a library function.
    pub fn place_at(&self, elapsed: f64) -> EnvelopePlace {
        let (sin, cos) = rough_sin_cos(self.omega * elapsed);
        let turned = (self.sin * cos + self.cos * sin, self.cos * cos - self.sin * sin);
        self.place(elapsed, turned)
    }

    /// G and its slope.
    fn value_and_rate(&self, at: &EnvelopePlace) -> (f64, f64) {
        let Self { slope, curvature, amplitude, omega, rate, .. } = *self;
        let EnvelopePlace { elapsed, sin, cos, lasting } = *at;
        (
            self.parabola(elapsed) - amplitude * cos - lasting,
            slope + curvature * elapsed + amplitude * omega * sin + rate * lasting,
        )
    }
}

/// A place on the way of a guess.
#[derive(Clone, Copy, Debug)]
pub struct EnvelopePlace {
    elapsed: f64,
    sin: f64,
    cos: f64,
    lasting: f64,
}

impl EnvelopePlace {
    fn after(&self, step: &FreeStep) -> Self {
        let FreeStep { length, sin, cos, decay, .. } = *step;
        Self {
            elapsed: self.elapsed + length,
            sin: self.sin * cos + self.cos * sin,
            cos: self.cos * cos - self.sin * sin,
            lasting: self.lasting * decay,
        }
    }
}
