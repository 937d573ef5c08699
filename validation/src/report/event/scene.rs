//! The true run and the engine's run in the views of one wrong event.

use super::{EventMark, View, ViewTrajectory};
use crate::suite::first_wrong::view_instants;

/// Marks of steps and looks nearer to each other than this share of a view are shown as one.
const MIN_MARK_DISTANCE: f64 = 1.0 / 120.0;
/// The largest share of the truth's range that the engine's error may be: a larger one hides the
/// truth's shape.
const MAX_ERROR_SHARE: f64 = 0.6;

/// The data of all views of one event, for any system.
pub(super) struct Scene {
    /// The time about which all views are drawn.
    pub(super) at: f64,
    pub(super) instants: Vec<f64>,
    /// The phase, or the mode, that holds at the start.
    pub(super) first: String,
    pub(super) truth: SceneCurve,
    pub(super) engine: SceneCurve,
    pub(super) steps: Vec<f64>,
    /// Times of looks at the guard, and what they saw, in the order of the times.
    pub(super) looks: Vec<[f64; 2]>,
}

/// Truth or engine: its values at the instants, and its events with what begins there and whether
/// both have them.
pub(super) struct SceneCurve {
    pub(super) values: Vec<f64>,
    pub(super) events: Vec<(f64, String, bool)>,
}

impl Scene {
    pub(super) fn view(&self, span: [f64; 2]) -> View {
        let [from, to] = span;
        let since = |t: f64| t - self.at;
        let inside = |t: &f64| from <= *t && *t <= to;
        let mut steps: Vec<f64> = self.steps.iter().copied().filter(inside).map(since).collect();
        steps.dedup_by(|next, kept| *next - *kept < MIN_MARK_DISTANCE * (to - from));
        View {
            from: since(from),
            to: since(to),
            truth: self.trajectory(span, &self.truth),
            engine: self.trajectory(span, &self.engine),
            steps,
            looks: self.looks(span),
        }
    }

    fn trajectory(&self, [from, to]: [f64; 2], side: &SceneCurve) -> ViewTrajectory {
        let SceneCurve { values, events } = side;
        let before = events.iter().take_while(|event| event.0 < from).last();
        let phase = before.map_or(&self.first, |event| &event.1).clone();
        let inside = events.iter().filter(|event| from <= event.0 && event.0 <= to);
        let mark = |(t, phase, matched): &(f64, String, bool)| EventMark {
            t: t - self.at,
            phase: phase.clone(),
            matched: *matched,
        };
        let place = |t: f64| self.instants.partition_point(|it| *it < t);
        let known = |t: f64| values.get(place(t)).copied();
        ViewTrajectory {
            phase,
            events: inside.map(mark).collect(),
            values: view_instants([from, to]).filter_map(known).collect(),
        }
    }

    fn looks(&self, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
        let inside = |look: &&[f64; 2]| from <= look[0] && look[0] <= to;
        let mut looks: Vec<_> = self.looks.iter().filter(inside).copied().collect();
        looks.dedup_by(|next, kept| next[0] - kept[0] < MIN_MARK_DISTANCE * (to - from));
        looks.iter().map(|[t, value]| [t - self.at, *value]).collect()
    }
}

/// Looks in the order of their times.
pub(super) fn in_order(looks: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut looks: Vec<_> = looks.collect();
    looks.sort_by(|a, b| a[0].total_cmp(&b[0]));
    looks
}

/// The closest view in which the truth's shape shows beside the engine's error.
pub(super) fn telling(views: &[View]) -> usize {
    let shows = |view: &View| {
        let range = |values: &[f64]| {
            let (low, high) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
            high - low
        };
        let pairs = view.truth.values.iter().zip(&view.engine.values);
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart <= MAX_ERROR_SHARE * range(&view.truth.values)
    };
    views.iter().rposition(shows).unwrap_or(0).max(usize::from(views.len() > 1))
}
