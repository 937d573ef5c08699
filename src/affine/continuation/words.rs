//! What has happened to the events of an orbit at a corner of its branch.
//!
//! The words of the two sides, as they are cyclically, agree but for a part. Of the side that has
//! the part's events, two orbits are looked at, one sixteen times as far from the corner as the
//! other: the rate at which a guard is crossed that is touched at the corner grows with the root of
//! the distance, or faster, and so does the time between two events that are at once there.

use super::super::returns::crossings::Crossing;
use super::super::returns::section::Guard;
use super::curve::Curve;
use super::family::OrbitShots;
use super::point::CurvePoint;
use crate::dynamics::continuation::BifurcationKind;
use crate::dynamics::continuation::steps::Corner;

/// What a corner is, and the event that it is about.
pub(super) struct Meaning {
    pub kind: BifurcationKind,
    pub event: Guard,
}

impl Meaning {
    /// That of the touch by which an orbit loses an event.
    pub fn of_touch(event: Guard) -> Self {
        let is_watched = event.is_watched;
        let kind = if is_watched { BifurcationKind::EventLost } else { BifurcationKind::Grazing };
        Self { kind, event }
    }
}

/// The crossings of one side of a corner, near to it and far from it.
pub(super) type Sides = (Vec<Crossing>, Vec<Crossing>);

/// Distances from a corner at which its events are looked at; the first that serve do.
const PROBE_DISTANCES: [[f64; 2]; 3] = [[1e-6, 1.6e-5], [1e-8, 1.6e-7], [1e-4, 1.6e-3]];

/// A rate or a time that has grown by more vanishes at the corner: the root of sixteen is four.
const MIN_GROWTH_FACTOR: f64 = 2.0;

/// An event that comes earlier by more of the return's time has jumped: smooth changes and
/// roundings are smaller so near to a corner.
const MIN_JUMP: f64 = 1e-3;

/// The length along the curve from which the fall of a rate to a touch is looked at, at least.
pub(super) const LENGTH_FROM_TOUCH: f64 = 1e-4;

/// A rate that falls by more from the last step to the end of its piece, whose distance is smaller
/// by orders of magnitude, vanishes there; no rate falls so much in a step otherwise.
const MIN_FALL_TO_TOUCH: f64 = 16.0;

/// The most letters of two words that are compared from wherever they begin.
const MAX_LETTERS: usize = 200;

/// The word from wherever it is least: an event that passes a section does not change it.
pub(super) fn cyclic(word: &[Guard]) -> Vec<[usize; 3]> {
    let letters: Vec<_> =
        word.iter().map(|it| [it.mode, it.index, usize::from(it.is_watched)]).collect();
    let turned = (0..letters.len()).map(|k| [&letters[k..], &letters[..k]].concat());
    turned.min().unwrap_or_default()
}

impl Curve<'_> {
    /// The meaning of a corner to which the curve comes from `base`.
    pub fn meaning(&self, base: &CurvePoint, corner: &Corner<CurvePoint>) -> Option<Meaning> {
        let Corner { before, beyond, .. } = corner;
        if corner.is_of_section {
            return None;
        }
        let beyond = beyond.as_ref();
        let is_another = |it: &CurvePoint| cyclic(&it.orbit.events) != cyclic(&before.orbit.events);
        if is_another(base) {
            // The corner is that of the orbit beyond, which touches what it has not as an event.
            let [lost, _] = differing_parts(&base.orbit.events, &before.orbit.events);
            let event = *lost.first()?;
            return Some(Meaning { kind: BifurcationKind::Grazing, event });
        }
        match beyond {
            None => {
                let changed = || self.change_of_events(before, beyond);
                let touched = self.touch_before(base, before).or_else(changed);
                touched.or_else(|| self.touch_of_same_events(before))
            }
            Some(it) if is_another(it) => self.change_of_events(before, beyond),
            Some(_) if corner.turns() => self.touch_before(base, before),
            Some(_) => None,
        }
    }

    /// The touch at the end of a piece by which an event is lost, so that no orbit is beyond or the
    /// same orbits are, from the other side: such an event may be the section's own.
    fn touch_before(&self, base: &CurvePoint, before: &CurvePoint) -> Option<Meaning> {
        // Beside the speed of the motion, because an orbit may shrink to a state of rest.
        let relative = |it: Crossing| Crossing { rate: it.rate / it.speed, ..it };
        let far = self.point_before(base);
        let [near, far] = [before, &far].map(|it| {
            let all = self.crossings(it.value, &it.shots)?;
            Some(all.into_iter().map(relative).collect::<Vec<_>>())
        });
        let (near, far) = same_events(near?, far?)?;
        let event = touched_event(&near, &far, &before.orbit.events, MIN_FALL_TO_TOUCH)?;
        Some(Meaning::of_touch(event))
    }

    /// An orbit so far before a corner that the fall of a rate towards it is seen: a short last
    /// step begins next to the touch itself.
    pub(super) fn point_before(&self, base: &CurvePoint) -> CurvePoint {
        self.approach_within(&base.turned(), LENGTH_FROM_TOUCH, LENGTH_FROM_TOUCH).last
    }

    /// The touch beyond which the same events follow one another, the first of them earlier.
    fn touch_of_same_events(&self, before: &CurvePoint) -> Option<Meaning> {
        let here = self.crossings(before.value, &before.shots)?;
        let beyond = |distance: f64| {
            let shots = self.shifted(before, &before.tangent, distance)?;
            self.crossings(before.value + distance * before.tangent.rate, &shots)
        };
        PROBE_DISTANCES.iter().find_map(|[near, far]| {
            let (near, far) = same_events(beyond(*near)?, beyond(*far)?)?;
            let (here, near) = same_events(here.clone(), near)?;
            let sooner = |side: &[Crossing], k: usize| here[k].time - side[k].time;
            // A smooth change is sixteen times smaller next to the corner, and a root's four times.
            let least = MIN_JUMP * here.iter().fold(0.0, |most: f64, it| most.max(it.time));
            let jumps = |k: &usize| {
                let [near, far] = [&near, &far].map(|side| sooner(side, *k));
                near > least && MIN_GROWTH_FACTOR * near > far.abs()
            };
            let event = here[(0..here.len()).find(jumps)?].guard;
            Some(Meaning { kind: BifurcationKind::Grazing, event })
        })
    }

    /// The part in which the events of a corner's two sides differ.
    fn change_of_events(
        &self,
        before: &CurvePoint,
        beyond: Option<&CurvePoint>,
    ) -> Option<Meaning> {
        let probe = || Some(events_of(self.probes(before, PROBE_DISTANCES[0][0]).first()?));
        let after = beyond.map(|it| it.orbit.events.clone()).or_else(probe)?;
        let [lost, gained] = differing_parts(&before.orbit.events, &after);
        let is_beyond = lost.is_empty();
        let changed = if is_beyond { &gained } else { &lost };
        let first = *changed.first()?;
        let plain =
            if is_beyond { BifurcationKind::EventGained } else { BifurcationKind::EventLost };
        if changed.iter().chain(&gained).all(|it| it.is_watched) {
            return Some(Meaning { kind: plain, event: first });
        }
        let sides = |is_beyond: bool| -> Sides {
            // Where orbits beyond have other events again, points that do not close tell as much.
            let orbits = beyond.filter(|_| is_beyond).and_then(|it| self.orbits_beyond(before, it));
            let sides = orbits.or_else(|| {
                PROBE_DISTANCES.iter().find_map(|distances| {
                    let [near, far] = distances.map(|it| self.side(before, is_beyond, it));
                    same_events(near?, far?)
                })
            });
            sides.unwrap_or_default()
        };
        let (near, far) = sides(is_beyond);
        // The event that is touched may come in the place of another one, such as that of its rate.
        let beyond_too = || {
            let (near, far) = if is_beyond { Sides::default() } else { sides(true) };
            touched_event(&near, &far, &gained, MIN_GROWTH_FACTOR)
        };
        let touched = touched_event(&near, &far, changed, MIN_GROWTH_FACTOR).or_else(beyond_too);
        let is_corner = !gained.is_empty() && !lost.is_empty() || are_at_once(&near, &far, changed);
        Some(match touched {
            Some(event) => Meaning { kind: BifurcationKind::Grazing, event },
            None if is_corner => Meaning { kind: BifurcationKind::Corner, event: first },
            None => Meaning { kind: plain, event: first },
        })
    }

    /// The crossings of the first orbit beyond, and of one sixteen times as far from the corner.
    /// The distance is that at which a parabola would be whose top is the corner, or twice it.
    fn orbits_beyond(&self, before: &CurvePoint, beyond: &CurvePoint) -> Option<Sides> {
        let apart = ((beyond.value - before.value) / beyond.tangent.rate).abs();
        let far = self.corrected_point(beyond, 15.0 * apart)?;
        let near = self.crossings(beyond.value, &beyond.shots)?;
        same_events(near, self.crossings(far.value, &far.shots)?)
    }

    /// The crossings on one side at a distance from the corner: of the orbit before, or of points
    /// beyond that need not close.
    fn side(&self, before: &CurvePoint, is_beyond: bool, distance: f64) -> Option<Vec<Crossing>> {
        if is_beyond {
            let found = self.probes(before, distance).into_iter().next()?;
            return self.crossings(before.value + distance * before.tangent.rate, &found);
        }
        let point = self.corrected_point(before, -distance)?;
        self.crossings(point.value, &point.shots)
    }

    pub(super) fn crossings(&self, value: f64, shots: &OrbitShots) -> Option<Vec<Crossing>> {
        self.family.at(value, |map| {
            let all: Option<Vec<_>> =
                shots.points.iter().map(|it| map.crossings(it).ok()).collect();
            Some(all?.concat())
        })
    }
}

/// The events of shots, one after the other.
pub(super) fn events_of(shots: &OrbitShots) -> Vec<Guard> {
    shots.images.iter().flat_map(|it| it.way.events.iter().copied()).collect()
}

/// The crossings near to a corner and far from it, if they are of the same events.
pub(super) fn same_events(near: Vec<Crossing>, far: Vec<Crossing>) -> Option<Sides> {
    let guards = |side: &[Crossing]| side.iter().map(|it| it.guard).collect::<Vec<_>>();
    (guards(&near) == guards(&far)).then_some((near, far))
}

/// The event among those that have changed whose rate is so many times smaller near to the corner,
/// the first of those that follow one another: a touch is followed by the end of what it has begun.
fn touched_event(
    near: &[Crossing],
    far: &[Crossing],
    changed: &[Guard],
    factor: f64,
) -> Option<Guard> {
    let count = near.len();
    let is_touched = |k: usize| {
        let (one, other) = (&near[k], &far[k]);
        changed.contains(&one.guard) && other.rate.abs() > factor * one.rate.abs()
    };
    let first = (0..count).find(|k| is_touched(*k) && !is_touched((k + count - 1) % count));
    first.or_else(|| (0..count).find(|k| is_touched(*k))).map(|k| near[k].guard)
}

/// Whether an event that has changed is at once with the one before or after it.
fn are_at_once(near: &[Crossing], far: &[Crossing], changed: &[Guard]) -> bool {
    let pairs = near.windows(2).zip(far.windows(2));
    pairs.into_iter().any(|(near, far)| {
        let is_own = near.iter().any(|it| changed.contains(&it.guard));
        let [near, far] = [near, far].map(|it| it[1].time - it[0].time);
        is_own && far > MIN_GROWTH_FACTOR * near
    })
}

/// The parts in which two words differ, as they are cyclically: what the first has alone, and the
/// second.
fn differing_parts(one: &[Guard], other: &[Guard]) -> [Vec<Guard>; 2] {
    let turns = |word: &[Guard]| if word.len() > MAX_LETTERS { 1 } else { word.len().max(1) };
    let mut best: Option<[Vec<Guard>; 2]> = None;
    for k in 0..turns(one) {
        let one = turned(one, k);
        for n in 0..turns(other) {
            let other = turned(other, n);
            let same = |(a, b): &(&Guard, &Guard)| a == b;
            let head = one.iter().zip(&other).take_while(same).count();
            let left = one.len().min(other.len()) - head;
            let tail = one.iter().rev().zip(other.iter().rev()).take(left).take_while(same).count();
            let parts = [&one[head..one.len() - tail], &other[head..other.len() - tail]];
            let length = parts[0].len() + parts[1].len();
            if best.as_ref().is_none_or(|it| length < it[0].len() + it[1].len()) {
                best = Some(parts.map(<[Guard]>::to_vec));
            }
        }
    }
    best.unwrap_or_default()
}

fn turned(word: &[Guard], by: usize) -> Vec<Guard> {
    let mut word = word.to_vec();
    if !word.is_empty() {
        word.rotate_left(by);
    }
    word
}
