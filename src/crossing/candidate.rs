//! Finds almost every event: from a guess, one closed-form evaluation per step and a Taylor series
//! at the end lead to a candidate, and one certificate proves that it is the first crossing.

use crate::crossing::allowances::{GUESS_EVALUATIONS, MAX_ROOT_STEP, RESIDUAL_TOLERANCE, SLACK};
use crate::crossing::{Counters, Guarded, Proof, Root, SearchHint, Side, ThresholdEnds, slack};
use crate::flow::Point;
use crate::flow::steps::Steps;
use crate::numeric::roots::{CubicPolynomial, MIN_EXACT_SQUARE};
use crate::numeric::series::{SHORT_TERMS, Series, TERMS};
use crate::numeric::two_word::TwoWord;

/// A search in two parts, so that what follows an event can begin between them: it waits for the
/// candidate's root but not for its certificate, and the processor works on both.
pub struct CandidateSearch {
    /// The start of the phase.
    pub(super) left: Point<f64>,
    /// The guess, or what the phase says about its end without one.
    pub(super) hint: SearchHint,
}

/// What a guess leads to: a root, which is mostly the phase's end, or the point at which it is
/// given up.
pub type Candidate = Result<Root, Point<f64>>;

impl CandidateSearch {
    /// The search of a phase whose end is guessed; without a guess the phase gives a hint.
    #[inline(always)]
    pub fn new<G: Guarded>((phase, steps): (&G, &Steps), guess: Option<f64>, horizon: f64) -> Self {
        let left = phase.entry();
        let hint = match guess {
            Some(time) => SearchHint::Root(time),
            None => phase.hint(steps, &left, horizon),
        };
        Self { left, hint }
    }

    /// The guess, if there is one before the horizon.
    #[inline(always)]
    pub fn guess(&self, horizon: f64) -> Option<f64> {
        match self.hint {
            SearchHint::Root(time) if time > 0.0 && time < horizon => Some(time),
            _ => None,
        }
    }

    /// The first part: where the guess leads.
    #[inline(always)]
    pub fn candidate<G: Guarded>(
        phase: &G,
        guess: f64,
        horizon: f64,
        counters: &mut Counters,
    ) -> Candidate {
        follow(phase, 0.0, guess, horizon, counters)
    }

    /// The second part, as it mostly ends: one certificate says that the candidate's root is the
    /// first crossing.
    #[inline(always)]
    pub fn confirm<G: Guarded>(
        &self,
        (phase, steps): (&G, &Steps),
        root: &Root,
        horizon: f64,
    ) -> bool {
        let ends = ThresholdEnds { right: true, ..phase.imposed() };
        root.elapsed().high <= horizon
            && phase.certify(steps, &self.left, &root.point, ends) == Proof::Inside
    }
}

/// Evaluates a phase and counts it.
#[inline(always)]
pub fn evaluate<G: Guarded>(phase: &G, elapsed: f64, counters: &mut Counters) -> Point<f64> {
    counters.evaluations += 1;
    phase.at(elapsed)
}

/// Evaluates a phase, out of the way of the code that every event takes.
#[cold]
#[inline(never)]
pub fn evaluate_again<G: Guarded>(phase: &G, elapsed: f64, counters: &mut Counters) -> Point<f64> {
    evaluate(phase, elapsed, counters)
}

/// The step from a point to where its cubic meets the nearer threshold, and that threshold's side.
pub(super) fn cubic_step<G: Guarded>(phase: &G, point: &Point<f64>) -> CubicStep {
    let corridor = phase.corridor();
    let [value, slope, bend, third] = point.guard.orders;
    let (above, below) = (value - corridor.high, value - corridor.low);
    let rises = above.abs() <= below.abs();
    let over = if rises { above } else { below };
    let cubic = CubicPolynomial { value: over, slope, bend, third };
    let step = cubic.near_zero().unwrap_or_else(|| cubic.zero());
    let room = SLACK * point.guard.largest_term + RESIDUAL_TOLERANCE * over.abs();
    CubicStep { step, rises, settled: cubic.at(step).abs() <= room }
}

/// The step from a point to where its cubic meets a threshold.
pub(super) struct CubicStep {
    /// The step.
    pub step: f64,
    /// Whether that threshold is the upper one.
    pub rises: bool,
    /// Whether the cubic meets the threshold there. Next to a crest that misses the threshold
    /// Newton's method wanders.
    settled: bool,
}

impl CubicStep {
    /// Whether the series reaches the root with all its digits, and the root is not so much closer
    /// to `left` than the point is that the point's rounding would show.
    pub fn is_short(&self, point: &Point<f64>, left: f64, reach: f64) -> bool {
        let root = point.elapsed + self.step;
        self.settled && self.step.abs() <= reach && self.step.abs() <= MAX_ROOT_STEP * (root - left)
    }
}

/// The root that the guard's series has next to a point's cubic step; none where that is no
/// crossing outwards.
#[inline(always)]
pub(super) fn polish<G: Guarded>(phase: &G, point: &Point<f64>, cubic: &CubicStep) -> Option<Root> {
    let [few_terms, _] = phase.reaches();
    if cubic.step.abs() <= few_terms {
        polished_by(phase, point, cubic, &phase.series::<SHORT_TERMS>(point))
    } else {
        polished_by(phase, point, cubic, &phase.series::<TERMS>(point))
    }
}

#[inline(always)]
fn polished_by<G: Guarded, const N: usize>(
    phase: &G,
    point: &Point<f64>,
    cubic: &CubicStep,
    series: &Series<f64, N>,
) -> Option<Root> {
    /// The largest relative change of the slope by Newton's last step: it is put right to fifth
    /// order, which leaves REACH^4/24 = 3e-8 of that, so that the force of an impact keeps its
    /// digits; the time is settled by twice as many.
    const SLOPE_CHANGE_TOLERANCE: f64 = 1e-9;
    let CubicStep { mut step, rises, .. } = *cubic;
    let corridor = phase.corridor();
    let threshold = if rises { corridor.high } else { corridor.low };
    for attempt in 1..=GUESS_EVALUATIONS {
        let (value, slope) = series.value_and_slope(step);
        let change = (threshold - value) / slope;
        step += change;
        let bend = series.bend(step);
        let gain = change * (bend + 0.5 * change * series.0[3]);
        let settled = gain.abs() <= SLOPE_CHANGE_TOLERANCE * slope.abs();
        // Next to a graze rounding keeps the time from settling any further.
        let hidden = (value - threshold).abs() <= SLACK * point.guard.largest_term;
        if settled || (attempt == GUESS_EVALUATIONS && hidden) {
            if !passes((value - threshold, slope, bend), rises, slack(phase, point, point)) {
                return None;
            }
            let TwoWord { high: elapsed, low } = TwoWord::sum(point.elapsed, step);
            let end = phase.continued(point, step, series, (threshold, slope + gain));
            let end = Point { elapsed, ..end };
            return leaves(&end, rises).then_some(Root {
                point: end,
                low,
                side: Side::high(rises),
            });
        }
    }
    None
}

pub(super) fn leaves(point: &Point<f64>, rises: bool) -> bool {
    let slope = point.guard.orders[1];
    if rises { slope > 0.0 } else { slope < 0.0 }
}

/// Whether a guard that turns back next to its threshold goes beyond it by more than rounding. A
/// crest within that may as well be no crossing: it is a touch, at which Newton's method may settle
/// anywhere.
#[inline(always)]
fn passes((over, slope, bend): (f64, f64, f64), rises: bool, slack: f64) -> bool {
    let outward = if rises { 1.0 } else { -1.0 };
    let (bend, over) = (bend * outward, over * outward - slack);
    let square = slope * slope;
    if square >= MIN_EXACT_SQUARE {
        square > 2.0 * bend * over
    } else {
        passes_without_squares(slope, bend, over)
    }
}

/// Whether such a guard passes, where its slope has no square.
#[cold]
fn passes_without_squares(slope: f64, bend: f64, over: f64) -> bool {
    let turns_back = bend < 0.0 && over < 0.0 || bend > 0.0 && over > 0.0;
    !turns_back || slope.abs() > (2.0 * bend.abs()).sqrt() * over.abs().sqrt()
}

/// Follows a guess to a root beyond `left`, where the guard leaves its corridor; or gives the last
/// evaluation back.
#[inline(always)] // else a root is copied twice on its way
pub fn follow<G: Guarded>(
    phase: &G,
    left: f64,
    guess: f64,
    limit: f64,
    counters: &mut Counters,
) -> Result<Root, Point<f64>> {
    let [_, reach] = phase.reaches();
    let mut point = evaluate(phase, guess, counters);
    let mut last_step = f64::INFINITY;
    for _ in 0..GUESS_EVALUATIONS {
        let cubic = cubic_step(phase, &point);
        let step = cubic.step;
        let next = point.elapsed + step;
        // Written so that a NaN gives up.
        if !(next > left && next <= limit && step.abs() < 0.5 * last_step) {
            return Err(point);
        }
        if cubic.is_short(&point, left, reach) {
            return polish(phase, &point, &cubic).ok_or(point);
        }
        last_step = step.abs();
        point = evaluate_again(phase, next, counters);
    }
    Err(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::constants::Constants;
    use crate::flow::forcing::EntryAngle;
    use crate::flow::no_contact::NoContact;
    use crate::parameters::Parameters;
    use crate::state::State;

    /// Excess, slope, bend and slack next to a threshold, and whether the guard passes it: a crest
    /// of slope^2/(2 bend) above the excess, less the slack.
    const CREST_CASES: [([f64; 4], bool); 7] = [
        ([0.0, 1.0, -1.0, 0.4], true),
        ([0.0, 1.0, -1.0, 0.6], false),
        ([-0.3, 1.0, -1.0, 0.1], true),
        ([-0.3, 1.0, -1.0, 0.3], false),
        ([0.3, 1.0, 1.0, 0.1], true),
        ([0.9, 1.0, 1.0, 0.1], false),
        ([-0.9, 0.1, 1.0, 0.1], true),
    ];

    #[test]
    fn a_crest_passes_its_threshold_or_not_at_every_scale() {
        for ([over, slope, bend, slack], passing) in CREST_CASES {
            for scale in [1.0, 1e-100, 1e-144, 1e-146, 1e-150, 1e-200, 1e-290] {
                let [over, slope, bend, slack] = [over, slope, bend, slack].map(|it| it * scale);
                let rises = passes((over, slope, bend), true, slack);
                let falls = passes((-over, -slope, -bend), false, slack);
                assert_eq!([rises, falls], [passing; 2], "{over} {slope} {bend} {slack} {scale:e}");
            }
        }
    }

    /// Without a bend there is no crest.
    #[test]
    fn a_straight_guard_passes() {
        for slope in [1.0, 1e-200] {
            assert!(passes((0.0, slope, 0.0), true, slope));
        }
    }

    /// A crossing not after the horizon is one at the horizon itself, too. Without any force h is
    /// the straight line d - 1, and all numbers here are exact.
    #[test]
    fn a_guess_leads_to_a_root_at_the_limit_itself() {
        let parameters = Parameters { a: 0.0, b: 0.0, g: 0.0, ..Parameters::default() };
        let constants: Constants<f64> = Constants::new(&parameters);
        let angle = EntryAngle { radians: 0.0, sin: 0.0, cos: 1.0 };
        let entry = State { p: -1.0, y: 1.0, q: 0.0 };
        let flight = NoContact { constants, entry, angle, surface: None };
        let guess = 1.0 - 1.0 / 1024.0;
        let until = |limit: f64| follow(&flight, 0.0, guess, limit, &mut Counters::default());
        assert!(until(1.0).is_ok_and(|root| root.point.elapsed == 1.0 && root.low == 0.0));
        assert!(until(1.0 - f64::EPSILON).is_err());
    }
}
