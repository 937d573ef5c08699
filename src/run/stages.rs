//! A contact that dies out next to a threshold, taken up again as it does.
//!
//! The closed form adds what has changed since the contact began to what was there: its rounding
//! stays that of the state at entry, however little of it is left. Where the steady state reaches a
//! threshold to within much less than that, the end of the contact is decided by the little that is
//! left. So the search goes in stages: after a few decay times what is left is computed by itself,
//! with all its digits, and the contact goes on from there.

use crate::crossing::limit::Limit;
use crate::crossing::search::first_crossing;
use crate::crossing::{Counters, Crossing, Root};
use crate::flow::Point;
use crate::flow::constants::Constants;
use crate::flow::contact::Contact;
use crate::flow::forcing::EntryAngle;
use crate::model::Model;
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::state::State;

/// The contact as a phase of its own from which a root is taken, and how the search in stages ends.
pub(crate) struct Staged<'a> {
    /// The contact as taken up last.
    pub contact: Contact<f64, &'a Constants<f64>>,
    /// How the search ends, in time since the phase began.
    pub crossing: Crossing,
}

/// Searches on from `first`, a time after the contact's beginning at `instant`, up to `horizon`.
#[cold]
pub(crate) fn search_in_stages<'a>(
    model: &Model,
    contact: &Contact<f64, &'a Constants<f64>>,
    instant: &Instant,
    (first, horizon): (f64, f64),
    counters: &mut Counters,
) -> Staged<'a> {
    let taken_up = |contact: &Contact<_, _>, stage: f64, since: TwoWord| {
        let (_, angle) = model.instant_after(instant, since);
        contact.taken_up(stage, angle)
    };
    let limit = Limit::new(model.steps(), counters);
    let mut since = TwoWord::new(first);
    let mut contact = taken_up(contact, first, since);
    loop {
        let elapsed = since.value();
        let ended = |crossing| Staged { contact, crossing };
        if limit.is_passed(elapsed, counters) {
            return ended(Crossing::Undecided(elapsed));
        }
        match first_crossing(&contact, model.steps(), horizon - elapsed, counters) {
            Crossing::At(root) => {
                let total = since.plus(root.elapsed());
                let point = Point { elapsed: total.high, ..root.point };
                return ended(Crossing::At(Root { point, low: total.low, ..root }));
            }
            Crossing::Stage(stage) => {
                counters.evaluations += 1;
                since = since.plus(TwoWord::new(stage));
                contact = taken_up(&contact, stage, since);
            }
            Crossing::Undecided(stage) => return ended(Crossing::Undecided(elapsed + stage)),
            over @ (Crossing::Horizon | Crossing::Never) => return ended(over),
        }
    }
}

impl Contact<f64, &Constants<f64>> {
    /// The contact a time `d` after it began, as if it began then at the forcing angle `angle`,
    /// counted from the threshold next to its steady state; nothing is added that is larger than
    /// what is left.
    fn taken_up(&self, d: f64, angle: EntryAngle<f64>) -> Self {
        let Constants { a, b, g, xi, two_xi, damping, forced, .. } = *self.constants;
        let harmonic = self.angle.harmonic(&self.constants.drive(), d);
        let response = forced.at(d, &harmonic.turn, &damping.at(d));
        let EntryAngle { sin, cos, .. } = self.angle;
        let driven = |re: f64, im: f64| a * (cos * re - sin * im);
        let Left { s, c, s_rate } = Left::new(xi, d);
        let f_less_b = self.offset + (self.reference - b);
        let y0 = self.entry.y;
        let force = (f_less_b * s_rate + y0 * s) + driven(response.force.re, response.force.im);
        let y = (y0 * c - f_less_b * s) + driven(response.rate.re, response.rate.im);
        let reference = self.nearest_threshold();
        let offset = (b - reference) + force;
        let q = (reference + offset) - two_xi * y;
        let entry = State { p: q + g, y, q };
        Self { constants: self.constants, entry, angle, offset, reference }
    }
}

/// The rest of the fundamental solutions of the free oscillation: C, S and S' without the one
/// that [`crate::flow::damped`] takes from them.
struct Left {
    s: f64,
    c: f64,
    s_rate: f64,
}

impl Left {
    fn new(xi: f64, d: f64) -> Self {
        let root = ((1.0 - xi) * (1.0 + xi)).abs().sqrt();
        let (s, c, s_rate) = if xi < 1.0 {
            let shrink = libm::exp(-xi * d);
            let (sin, cos) = libm::sincos(root * d);
            let s = shrink * if root > 0.0 { sin / root } else { d };
            (s, shrink * cos + xi * s, shrink * cos - xi * s)
        } else {
            let fast = xi + root;
            let slow = 1.0 / fast;
            let lasting = libm::exp(-slow * d);
            let spread = 2.0 * root;
            let bare = if root > 0.0 { -libm::expm1(-spread * d) / spread } else { d };
            let s = lasting * bare;
            (s, lasting + slow * s, libm::exp(-fast * d) - slow * s)
        };
        Self { s, c, s_rate }
    }
}
