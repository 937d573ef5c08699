//! Neighbourhoods of a stable orbit that nothing leaves.
//!
//! With J the derivative of one turn of the orbit and all |multipliers| < 1, the sum S = 1 + J'J +
//! J'^2 J^2 + ... exists and x'Sx falls at every turn, by the factor 1 - 1/|S| at least, in linear
//! theory. How far linear theory reaches is measured: the largest ellipsoid is taken of which a net
//! of points comes back by half of that contraction or more. The net is finite, so this is evidence
//! and no proof; a start is believed after further turns each of which brought it closer.
//!
//! The net lies along the changes that the return to the orbit's point leaves: every later return
//! lies there, such as on the surface of the section's event.

use super::space::{Space, Spot};
use crate::affine::returns::multipliers::orthonormal;
use crate::affine::returns::shooting::{Change, Derivative, MOST, ReturnMap, identity};
use crate::affine::run::place::Place;
use crate::dynamics::attractor::thresholds::{
    AT_REST, DIRECTIONS, DOUBLINGS, HALVINGS, LARGEST_RADIUS, RESTING, RESTING_TURNS, SHELLS, TRAPS,
};
use crate::dynamics::linear::{apply, dot, product};

/// An ellipsoid about one point of an orbit.
#[derive(Clone, Debug)]
pub struct Trap {
    centre: Spot,
    metric: Derivative,
    radius: f64,
    /// The distance, by the metric, within which a motion is at rest for all that rounding does.
    rest: f64,
}

/// Points of the net on each of its shells for each dimension beyond three.
const MORE_DIRECTIONS: usize = 16;
/// Changes that are smaller, beside the largest, are roundings of it.
const SMALLEST: f64 = 1e-12;

impl Trap {
    /// Traps about some points of a stable orbit; none where no net comes back.
    pub fn all(space: &Space<'_>, places: &[Place<f64>]) -> Vec<Self> {
        let stride = places.len().div_ceil(TRAPS).max(1);
        let around = |place: &Place<f64>| Self::around(space, place, places.len() as u64);
        places.iter().step_by(stride).filter_map(around).collect()
    }

    fn around(space: &Space<'_>, place: &Place<f64>, period: u64) -> Option<Self> {
        let (turn, last) = turn(space, place, period)?;
        let metric = metric(&turn)?;
        let counted = (0..space.dimension).filter(|n| space.counts(*n));
        let largest: f64 = counted.map(|n| metric[n][n]).sum();
        let shrinks = 1.0 - 0.5 / largest;
        let net = net(space, &metric, &last)?;
        let unit = Self { centre: space.spot_of(place), metric, radius: 1.0, rest: 0.0 };
        let rest = unit.rest_of(space, place, period);
        let attempt = |halving: i32| {
            let radius = LARGEST_RADIUS * 0.5_f64.powi(halving);
            let trap = Self { radius, rest, ..unit.clone() };
            let returns =
                |shell: &f64| trap.comes_back(space, place, period, &net, *shell, shrinks);
            SHELLS.iter().all(returns).then_some(trap)
        };
        (0..=HALVINGS).find_map(attempt)
    }

    /// How far rounding may move a motion that begins at the centre of this ellipsoid of radius 1.
    fn rest_of(&self, space: &Space<'_>, place: &Place<f64>, period: u64) -> f64 {
        let mut moved = 0.0_f64;
        let followed = space.follow(place, RESTING_TURNS * period, &mut |n, _, spot| {
            if (n + 1).is_multiple_of(period) {
                moved = moved.max(self.distance(space, spot));
            }
            None
        });
        if followed.is_ok() && moved.is_finite() { RESTING * moved.sqrt() } else { 0.0 }
    }

    /// Whether all points of a shell of the net are closer after a turn.
    fn comes_back(
        &self,
        space: &Space<'_>,
        place: &Place<f64>,
        period: u64,
        net: &[Change],
        shell: f64,
        shrinks: f64,
    ) -> bool {
        net.iter().all(|direction| {
            let start = space.moved(place, &direction.map(|it| it * self.radius * shell));
            let before = self.distance(space, &space.spot_of(&start));
            let mut after = f64::INFINITY;
            let followed = space.follow(&start, period, &mut |n, _, spot| {
                if n + 1 == period {
                    after = self.distance(space, spot);
                }
                None
            });
            followed.is_ok() && after <= shrinks * before
        })
    }

    /// The square of the distance in units of the radius: at most 1 inside.
    pub fn size(&self, space: &Space<'_>, spot: &Spot) -> f64 {
        if spot.mode != self.centre.mode {
            return f64::INFINITY;
        }
        let step = space.step(&self.centre, spot);
        // The metric is not below the identity.
        let outside = step[..space.dimension].iter().any(|it| it.abs() > self.radius);
        if outside { f64::INFINITY } else { self.of_step(&step) }
    }

    /// Whether a motion at this [`Self::size`] is at rest on the orbit: it need not come closer
    /// still, or cannot for rounding.
    pub fn is_at_rest(&self, size: f64) -> bool {
        size < AT_REST || size.sqrt() * self.radius <= self.rest
    }

    fn distance(&self, space: &Space<'_>, spot: &Spot) -> f64 {
        match spot.mode == self.centre.mode {
            true => self.of_step(&space.step(&self.centre, spot)),
            false => f64::INFINITY,
        }
    }

    fn of_step(&self, step: &Change) -> f64 {
        let step = step.map(|it| it / self.radius);
        dot(&step, &apply(&self.metric, &step))
    }
}

/// The derivative of one turn from a place, and that of its last return.
fn turn(space: &Space<'_>, place: &Place<f64>, period: u64) -> Option<(Derivative, Derivative)> {
    let mut turn = identity();
    let mut last = turn;
    let mut at = place.clone();
    for _ in 0..period {
        let image = space.map.image(&at).ok()?;
        last = space.scaled(&image.derivative);
        turn = product(&last, &turn);
        at = image.point;
    }
    Some((turn, last))
}

/// S; none where the multipliers are not inside the unit circle.
fn metric(turn: &Derivative) -> Option<Derivative> {
    let mut sum = identity();
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

/// Changes x with x' metric x = 1, along what a return with this derivative leaves; along all
/// states where it leaves nothing.
fn net(space: &Space<'_>, metric: &Derivative, last: &Derivative) -> Option<Vec<Change>> {
    let column = |n: usize| (0..MOST).map(|k| last[k][n]).collect::<Vec<f64>>();
    let columns: Vec<_> = (0..space.dimension).map(column).collect();
    let length = |it: &Vec<f64>| it.iter().map(|it| it * it).sum::<f64>().sqrt();
    let largest = columns.iter().map(length).fold(0.0, f64::max);
    let mut axes = orthonormal(columns, SMALLEST * largest);
    if axes.is_empty() {
        let unit = |n: usize| (0..MOST).map(|k| if k == n { 1.0 } else { 0.0 }).collect();
        axes = (0..space.dimension).filter(|n| space.counts(*n)).map(unit).collect();
    }
    let axes: Vec<Change> = axes.iter().map(|it| std::array::from_fn(|n| it[n])).collect();
    let upper = upper_factor(metric, &axes)?;
    let directions = directions(axes.len());
    let along = |direction: &Vec<f64>| {
        let factors = solved(&upper, direction);
        std::array::from_fn(|n| axes.iter().zip(&factors).map(|(axis, by)| axis[n] * by).sum())
    };
    Some(directions.iter().map(along).collect())
}

/// U, upper triangular, with U'U = the metric along the axes.
fn upper_factor(metric: &Derivative, axes: &[Change]) -> Option<Vec<Vec<f64>>> {
    let count = axes.len();
    let mut u = vec![vec![0.0_f64; count]; count];
    for i in 0..count {
        for (j, axis) in axes.iter().enumerate().skip(i) {
            let whole = dot(&axes[i], &apply(metric, axis));
            let rest = whole - (0..i).map(|k| u[k][i] * u[k][j]).sum::<f64>();
            u[i][j] = if i == j { rest.sqrt() } else { rest / u[i][i] };
        }
    }
    u.iter().flatten().all(|x| x.is_finite()).then_some(u)
}

/// x with U x = right.
fn solved(upper: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; right.len()];
    for i in (0..right.len()).rev() {
        let rest = right[i] - ((i + 1)..right.len()).map(|k| upper[i][k] * x[k]).sum::<f64>();
        x[i] = rest / upper[i][i];
    }
    x
}

/// Directions that are spread evenly over the unit sphere of so many dimensions: normal numbers of
/// an evenly spread sequence (Roberts' generalised golden ratio, 2018), made of length 1.
fn directions(dimension: usize) -> Vec<Vec<f64>> {
    if dimension == 1 {
        return vec![vec![1.0], vec![-1.0]];
    }
    let pairs = dimension.div_ceil(2);
    let golden = golden_ratio(2 * pairs);
    let part = |k: usize, n: usize| (0.5 + (k + 1) as f64 * golden.powi(-(n as i32 + 1))).fract();
    let direction = |k: usize| {
        let pair = |n: usize| {
            let length = (-2.0 * libm::log(part(k, 2 * n).max(f64::MIN_POSITIVE))).sqrt();
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * part(k, 2 * n + 1));
            [length * cos, length * sin]
        };
        let mut numbers: Vec<f64> = (0..pairs).flat_map(pair).collect();
        numbers.truncate(dimension);
        let size = numbers.iter().map(|it| it * it).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        numbers.into_iter().map(|it| it / size).collect()
    };
    (0..DIRECTIONS as usize + MORE_DIRECTIONS * dimension.saturating_sub(3))
        .map(direction)
        .collect()
}

/// The root above 1 of x^(d+1) = x + 1.
fn golden_ratio(dimension: usize) -> f64 {
    let power = 1.0 / (dimension + 1) as f64;
    (0..64).fold(1.5, |x, _| libm::pow(1.0 + x, power))
}

fn transposed(m: &Derivative) -> Derivative {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}
