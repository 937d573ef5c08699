//! What is true of the reported end of a phase, and of what comes before it where no proof leads
//! there.

use crate::ball::Ball;
use crate::guard::Expansion;
use crate::hull::Piecewise;
use crate::proof::{CorridorProof, MAX_SLACKS, Verdict};
use percuss::insides::crossing::Corridor;

impl CorridorProof<'_> {
    /// The verdict on a reported end before which there is no crossing.
    pub fn crossing(&self, residual: Ball, at_end: &Expansion) -> Verdict {
        let slack = self.claim.slack;
        let outwards = if self.claim.rises { residual } else { -residual };
        let least = residual.lower().max(-residual.upper());
        if least > MAX_SLACKS * slack {
            return Verdict::Elsewhere { residual: least / slack };
        }
        let open = Verdict::Open { until: self.claim.duration.high };
        // Written so that a NaN confirms nothing.
        if !(residual.size() <= MAX_SLACKS * slack) {
            return open;
        }
        if outwards.lower() >= 0.0 {
            return Verdict::Confirmed { residual: residual.size() / slack };
        }
        self.rise(outwards, at_end).unwrap_or_else(|crest| match crest {
            Some(crest) => Verdict::Absent { crest: crest / slack },
            None => open,
        })
    }

    /// A guard that is still to rise by what rounding took does so straight on, or has its crest
    /// before. If it certainly stays inside, its crest comes back.
    fn rise(&self, outwards: Ball, at_end: &Expansion) -> Result<Verdict, Option<f64>> {
        let turned = |ball: Ball| if self.claim.rises { ball } else { -ball };
        let [slope, bend] = [turned(at_end.whole[1]).about(), turned(at_end.whole[2]).about()];
        let straight = 8.0 * self.claim.slack / slope;
        let crest = -slope / bend;
        let bends_back = bend < 0.0 && crest < straight;
        let further = Ball::exact(if bends_back { crest } else { straight });
        let risen = outwards + turned(at_end.change_after(further));
        if risen.lower() > 0.0 {
            return Ok(Verdict::Confirmed { residual: outwards.size() / self.claim.slack });
        }
        let around = Piecewise::full(at_end, further.scaled(2.0));
        let absent = bends_back && self.inside(&around, [0; 2]);
        Err(absent.then_some(risen.upper()))
    }

    /// A place after `from` and well before the reported end where the guard is certainly outside.
    pub fn excursion(&self, from: f64, at_end: &Expansion) -> Option<(f64, f64)> {
        const PLACES: usize = 400;
        let end = self.claim.duration.high;
        let slope = at_end.whole[1].about().abs();
        let near = (8.0 * self.claim.slack / slope).max(16.0 * f64::EPSILON * end);
        let latest = end - if near.is_finite() { near } else { end };
        let (span, Corridor { low, high }) = (latest - from, self.claim.corridor);
        let even = (1..PLACES).map(|k| from + span * k as f64 / PLACES as f64);
        let closer = (0..PLACES).map(|k| from + span * 0.93_f64.powi(k as i32));
        let mut worst: Option<(f64, f64)> = None;
        for at in even.chain(closer).filter(|at| *at > 0.0 && *at < latest) {
            let value = self.at(at).whole[0];
            let excess = (value.lower() - high).max(low - value.upper());
            if excess > 0.0 && worst.is_none_or(|(_, most)| excess > most) {
                worst = Some((at, excess));
            }
        }
        worst.map(|(at, excess)| (at, excess / self.claim.slack))
    }
}
