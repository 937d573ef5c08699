//! Neighbourhoods of a stable orbit that nothing leaves.
//!
//! With J the derivative of one turn of the orbit and all |multipliers| < 1, the sum S = 1 + J'J +
//! J'^2 J^2 + ... exists and x'Sx falls at every turn, by the factor 1 - 1/|S| at least, in linear
//! theory. How far linear theory reaches is measured: the largest ellipsoid is taken of which a net
//! of points comes back by half of that contraction or more. The net is finite, so this is evidence
//! and no proof; a start is believed after further turns each of which brought it closer.
//!
//! About a strobe on the slider only motions that are on it too are taken: there p and q are one.

use super::thresholds::{
    AT_REST, DIRECTIONS, DOUBLINGS, HALVINGS, LARGEST_RADIUS, RESTING, RESTING_TURNS, SHELLS, TRAPS,
};
use crate::dynamics::linear::{IDENTITY, apply, dot, product};
use crate::dynamics::orbit::Orbit;
use crate::dynamics::section::Section;
use crate::dynamics::strobe::{Jacobian, StrobeMap, StrobePoint};
use crate::phase::Phase;

/// An ellipsoid about one strobe of an orbit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Trap {
    centre: StrobePoint,
    metric: Jacobian,
    radius: f64,
    /// The distance, by the metric, within which a motion is at rest for all that rounding does.
    rest: f64,
    /// The gap, where the strobe is on the slider.
    slider: Option<f64>,
}

/// p = q + g to within this share of its terms: some roundings.
const ON_SLIDER: f64 = 1e-12;

impl Trap {
    /// Traps about some strobes of a stable orbit; none where no net comes back.
    pub fn all(map: &StrobeMap, orbit: &Orbit) -> Vec<Self> {
        let stride = orbit.points.len().div_ceil(TRAPS);
        orbit
            .points
            .iter()
            .step_by(stride)
            .filter_map(|centre| Self::around(map, *centre, u64::from(orbit.period())))
            .collect()
    }

    /// A ball, for tests of what is done with a trap.
    #[cfg(test)]
    pub const fn ball(centre: StrobePoint, radius: f64) -> Self {
        Self { centre, metric: IDENTITY, radius, rest: 0.0, slider: None }
    }

    fn around(map: &StrobeMap, centre: StrobePoint, period: u64) -> Option<Self> {
        let entry = map.entry(centre).ok()?;
        let turn = map.passage(&entry, period).free_jacobian();
        let on_slider = entry.phase() != Phase::NoContact;
        let slider = on_slider.then_some(map.model().parameters().g);
        let metric = metric(&turn)?;
        let largest = metric[0][0] + metric[1][1] + metric[2][2];
        let shrinks = 1.0 - 0.5 / largest;
        let upper = upper_factor(&metric)?;
        let unit = Self { centre: entry.point(), metric, radius: 1.0, rest: 0.0, slider };
        let rest = unit.rest_of(map, period);
        let attempt = |halving: i32| {
            let radius = LARGEST_RADIUS * 0.5_f64.powi(halving);
            let trap = Self { radius, rest, ..unit };
            let returns = |shell: &f64| trap.shell_returns(map, period, &upper, *shell, shrinks);
            SHELLS.iter().all(returns).then_some(trap)
        };
        (0..=HALVINGS).find_map(attempt)
    }

    /// How far rounding may move a motion that begins at the centre of this ellipsoid of radius 1.
    fn rest_of(&self, map: &StrobeMap, period: u64) -> f64 {
        let Ok(entry) = map.entry(self.centre) else { return 0.0 };
        let strobes = map.strobes(entry, RESTING_TURNS * period);
        let turns = strobes.step_by(usize::try_from(period).unwrap_or(usize::MAX));
        let moved = turns.map(|strobe| self.distance(&strobe.point())).fold(0.0, f64::max);
        if moved.is_finite() { RESTING * moved.sqrt() } else { 0.0 }
    }

    fn shell_returns(
        &self,
        map: &StrobeMap,
        period: u64,
        upper: &Jacobian,
        shell: f64,
        shrinks: f64,
    ) -> bool {
        (0..DIRECTIONS).all(|k| {
            let step = on_ellipsoid(upper, direction(k)).map(|x| x * self.radius * shell);
            let mut start: StrobePoint = std::array::from_fn(|i| self.centre[i] + step[i]);
            if let Some(g) = self.slider {
                start[2] = start[0] - g;
            }
            let Ok(entry) = map.entry(start) else { return false };
            let after = entry.instant.after_periods(period, 1);
            let image = Section::along(map.model().trajectory(entry).until(after), after).next();
            let before = self.distance(&start);
            image.is_some_and(|image| self.distance(&image.point()) <= shrinks * before)
        })
    }

    /// The square of the distance in units of the radius: at most 1 inside.
    pub fn size(&self, point: &StrobePoint) -> f64 {
        // The metric is not below the identity.
        let outside = (0..2).any(|i| (point[i] - self.centre[i]).abs() > self.radius);
        if outside { f64::INFINITY } else { self.distance(point) }
    }

    /// Whether a motion at this [`Self::size`] is at rest on the orbit: it need not come closer
    /// still, or cannot for rounding.
    pub fn is_at_rest(&self, size: f64) -> bool {
        size < AT_REST || size.sqrt() * self.radius <= self.rest
    }

    /// Whether one of these strobes of an orbit is at rest on the orbit of the trap.
    pub fn is_at_rest_at(&self, points: &[StrobePoint]) -> bool {
        points.iter().any(|point| self.is_at_rest(self.size(point)))
    }

    fn distance(&self, point: &StrobePoint) -> f64 {
        if let Some(g) = self.slider {
            let [p, _, q] = *point;
            if (p - q - g).abs() > ON_SLIDER * p.abs().max(q.abs()).max(g) {
                return f64::INFINITY;
            }
        }
        let step: StrobePoint = std::array::from_fn(|i| (point[i] - self.centre[i]) / self.radius);
        dot(&step, &apply(&self.metric, &step))
    }
}

/// S; none where the multipliers are not inside the unit circle.
fn metric(turn: &Jacobian) -> Option<Jacobian> {
    let mut sum = IDENTITY;
    let mut power = *turn;
    for _ in 0..DOUBLINGS {
        let more = product(&transposed(&power), &product(&sum, &power));
        for (row, add) in sum.iter_mut().zip(more) {
            row.iter_mut().zip(add).for_each(|(x, more)| *x += more);
        }
        power = product(&power, &power);
    }
    let dead = power.iter().flatten().all(|x| x.abs() < 1e-3);
    (dead && sum.iter().flatten().all(|x| x.is_finite())).then_some(sum)
}

fn transposed(m: &Jacobian) -> Jacobian {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

/// U, upper triangular, with U'U = metric.
fn upper_factor(metric: &Jacobian) -> Option<Jacobian> {
    let mut u = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in i..3 {
            let rest = metric[i][j] - (0..i).map(|k| u[k][i] * u[k][j]).sum::<f64>();
            u[i][j] = if i == j { rest.sqrt() } else { rest / u[i][i] };
        }
    }
    u.iter().flatten().all(|x| x.is_finite()).then_some(u)
}

/// x with x' metric x = 1 and U x = direction.
fn on_ellipsoid(u: &Jacobian, direction: StrobePoint) -> StrobePoint {
    let mut x = [0.0; 3];
    for i in (0..3).rev() {
        let rest = direction[i] - ((i + 1)..3).map(|k| u[i][k] * x[k]).sum::<f64>();
        x[i] = rest / u[i][i];
    }
    x
}

/// Points spread evenly over the unit sphere: a spiral by the golden angle.
fn direction(k: u32) -> StrobePoint {
    let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(DIRECTIONS);
    let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt()));
    let across = (1.0 - z * z).sqrt();
    [across * cos, across * sin, z]
}
