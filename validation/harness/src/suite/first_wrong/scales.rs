//! The stretches of time that are shown: from some steps of the engine down to the event itself.

/// Instants of a view at which both curves are known.
const INSTANTS: usize = 121;

/// Half the widest view, in steps of the engine, as far as that is between [`MIN_WIDEST_PERIODS`]
/// and [`MAX_WIDEST_PERIODS`].
const WIDEST_VIEW_STEPS: f64 = 8.0;
/// The least half width of the widest view, in forcing periods.
const MIN_WIDEST_PERIODS: f64 = 0.02;
/// The largest half width of the widest view, in forcing periods.
const MAX_WIDEST_PERIODS: f64 = 0.25;

/// Half the closest view, in distances from the event to what it is confused with.
const CLOSEST_VIEW_DISTANCES: f64 = 2.5;
/// The share of half the widest view up to which a distance needs a closer one.
const MAX_CLOSEST_SHARE: f64 = 0.25;
/// A view is at most so much wider than the next one.
const MAX_ZOOM: f64 = 8.0;
/// Half a view at the least, as a share of the time it stands at: 2048 roundings.
const MIN_VIEW: f64 = 2048.0 * f64::EPSILON;

/// The ranges of the views, times since the start, from the widest to the closest.
pub(super) struct Scales {
    pub(super) spans: Vec<[f64; 2]>,
    centre: f64,
}

impl Scales {
    /// The scales around a wrong event, with how far it is to what it is confused with, for an
    /// engine with this mean step, in a run as long as `span`.
    pub(super) fn around(
        (centre, reach): (f64, f64),
        mean_step: f64,
        period: f64,
        span: f64,
    ) -> Self {
        let widest = (WIDEST_VIEW_STEPS * mean_step)
            .clamp(MIN_WIDEST_PERIODS * period, MAX_WIDEST_PERIODS * period);
        let closest = (CLOSEST_VIEW_DISTANCES * reach).max(MIN_VIEW * (1.0 + centre));
        let halves = halves(widest, closest);
        let view = |half: f64| [(centre - half).max(0.0), (centre + half).min(span)];
        Self { spans: halves.into_iter().map(view).collect(), centre }
    }

    /// The instants of all views.
    pub(super) fn all_instants(&self) -> Vec<f64> {
        let mut instants: Vec<f64> = self.spans.iter().copied().flat_map(view_instants).collect();
        instants.sort_by(f64::total_cmp);
        instants.dedup();
        instants
    }

    /// The range of all views together.
    pub(super) fn window(&self) -> [f64; 2] {
        self.spans.first().copied().unwrap_or([self.centre; 2])
    }
}

/// The instants of a view, times since the start, both ends among them.
pub fn view_instants([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    let share = |k: usize| k as f64 / (INSTANTS - 1) as f64;
    (0..INSTANTS).map(move |k| if k + 1 == INSTANTS { to } else { from + (to - from) * share(k) })
}

/// Halves of the views, each as much wider than the next.
fn halves(widest: f64, closest: f64) -> Vec<f64> {
    if closest > MAX_CLOSEST_SHARE * widest {
        return vec![widest];
    }
    let count = ((widest / closest).ln() / MAX_ZOOM.ln()).ceil();
    let ratio = (closest / widest).powf(1.0 / count);
    (0..=count as i32).map(|k| widest * ratio.powi(k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_close_in_by_at_most_the_zoom() {
        let halves = halves(1.0, 1e-6);
        assert_eq!(halves.len(), 8);
        assert!(halves.windows(2).all(|pair| pair[0] / pair[1] <= MAX_ZOOM * (1.0 + 1e-9)));
        assert!((halves[0] - 1.0).abs() < 1e-12 && (halves[7] / 1e-6 - 1.0).abs() < 1e-9);
        assert_eq!(super::halves(1.0, f64::INFINITY), [1.0]);
    }

    #[test]
    fn a_view_reaches_from_end_to_end() {
        let instants: Vec<f64> = view_instants([1.0, 1.3]).collect();
        assert_eq!((instants.len(), instants[0], instants[INSTANTS - 1]), (INSTANTS, 1.0, 1.3));
        assert!(instants.is_sorted());
    }
}
