//! The largest traps of a stable orbit.
//!
//! With J the derivative of one turn of the orbit and all |multipliers| < 1, the sum S = 1 + J'J +
//! J'^2 J^2 + ... exists and x'Sx falls at every turn, by the factor 1 - 1/|S| at least, in linear
//! theory. How far linear theory reaches is measured: the largest ellipsoid is taken of which a net
//! of points comes back by half of that contraction or more. The net is finite, so this is evidence
//! and no proof; a start is believed after further turns each of which brought it closer. Where
//! ways are told apart, points that come back on other ways than the orbit's are on other pieces of
//! the map, of which linear theory knows nothing: they are followed until they arrive.
//!
//! The net lies along the changes that the return to the orbit's point leaves: every later return
//! lies there, such as on the surface of the section's event.

use super::coordinates::Coordinates;
use super::motions::{Motions, Turn};
use super::thresholds::{
    ARRIVAL_TOLERANCE, ARRIVAL_TURNS, MAX_RADIUS, MAX_TRAPS, METRIC_DOUBLINGS, RADIUS_HALVINGS,
    REST_FACTOR, REST_TURNS, SHELLS,
};
use super::trap::Trap;
use crate::dynamics::linear::product;

/// Traps about some places of a stable orbit; none where no net comes back.
pub(crate) fn traps<M: Motions>(motions: &M, places: &[M::Place]) -> Vec<Trap<M::Coordinates>> {
    let stride = places.len().div_ceil(MAX_TRAPS).max(1);
    let around = |place: &M::Place| TrapSearch::at(motions, place, places.len() as u64)?.largest();
    places.iter().step_by(stride).filter_map(around).collect()
}

/// The search for the largest trap about a place of an orbit.
struct TrapSearch<'a, M: Motions> {
    motions: &'a M,
    place: &'a M::Place,
    period: u64,
    /// The trap of radius 1.
    unit: Trap<M::Coordinates>,
    /// Steps from the place to the surface of that trap.
    net: Vec<Vec<f64>>,
    /// The factor by which a turn has to bring the net closer.
    shrinks: f64,
}

impl<'a, M: Motions> TrapSearch<'a, M> {
    fn at(motions: &'a M, place: &'a M::Place, period: u64) -> Option<Self> {
        let Turn { metric, axes } = motions.turn(place, period)?;
        let counted = (0..metric.len()).filter(|n| motions.coordinates().counts(*n));
        let largest: f64 = counted.map(|n| metric[n][n]).sum();
        let net = net(&metric, &axes, &M::directions(axes.len()))?;
        let (centre, piece) = (motions.spot_of(place), motions.piece_of(place));
        let unit = Trap {
            centre,
            piece,
            metric: metric.concat(),
            radius: 1.0,
            rest: 0.0,
            ways: Vec::new(),
        };
        Some(Self { motions, place, period, unit, net, shrinks: 1.0 - 0.5 / largest })
    }

    fn largest(&self) -> Option<Trap<M::Coordinates>> {
        let mut own = Vec::new();
        let rest = self.rest(&mut own);
        let attempt = |halving: i32| {
            let radius = MAX_RADIUS * 0.5_f64.powi(halving);
            let mut trap = Trap { radius, rest, ways: own.clone(), ..self.unit.clone() };
            let mut others = Vec::new();
            let comes_back = SHELLS.iter().all(|shell| self.comes_back(&trap, *shell, &mut others));
            trap.ways.append(&mut others);
            comes_back.then_some(trap)
        };
        (0..=RADIUS_HALVINGS).find_map(attempt)
    }

    /// The distance by which rounding may move a motion that begins at the place. Its ways are
    /// noted.
    fn rest(&self, ways: &mut Vec<u64>) -> f64 {
        let mut moved = 0.0_f64;
        let followed = self.turns(self.place, REST_TURNS, &mut |spot| {
            moved = moved.max(self.unit.distance(self.motions.coordinates(), spot));
            note(ways, self.motions.coordinates().way(spot));
        });
        if followed && moved.is_finite() { REST_FACTOR * moved.sqrt() } else { 0.0 }
    }

    /// Whether all points of a shell of the net are closer after a turn, and those that come on
    /// other ways than the orbit's arrive at it. Such ways are noted.
    fn comes_back(&self, trap: &Trap<M::Coordinates>, shell: f64, others: &mut Vec<u64>) -> bool {
        let coordinates = self.motions.coordinates();
        self.net.iter().all(|direction| {
            let step: Vec<f64> = direction.iter().map(|it| it * trap.radius * shell).collect();
            let Some((start, spot)) = self.motions.moved(self.place, &step) else { return false };
            let before = trap.distance(coordinates, &spot);
            let mut after = f64::INFINITY;
            let mut is_on_way = true;
            let followed = self.turns(&start, 1, &mut |spot| {
                after = trap.distance(coordinates, spot);
                is_on_way = trap.is_on_way(coordinates, spot);
                note(others, coordinates.way(spot).filter(|_| !is_on_way));
            });
            followed && after <= self.shrinks * before && (is_on_way || self.arrives(&start, trap))
        })
    }

    /// Whether a motion arrives at the orbit.
    fn arrives(&self, start: &M::Place, trap: &Trap<M::Coordinates>) -> bool {
        let mut left = f64::INFINITY;
        let followed = self.turns(start, ARRIVAL_TURNS, &mut |spot| {
            left = trap.distance(self.motions.coordinates(), spot);
        });
        followed && left <= ARRIVAL_TOLERANCE
    }

    /// Shows the spots of a motion after each of so many turns; whether it makes them.
    fn turns(
        &self,
        from: &M::Place,
        turns: u64,
        see: &mut dyn FnMut(&<M::Coordinates as Coordinates>::Spot),
    ) -> bool {
        let count = turns * self.period + u64::from(M::FIRST_RETURN_IS_START);
        let followed = self.motions.follow(from, count, &mut |n, _, spot| {
            if n.is_multiple_of(self.period) && n > 0 {
                see(spot);
            }
            None
        });
        followed.is_ok()
    }
}

fn note(ways: &mut Vec<u64>, way: Option<u64>) {
    ways.extend(way.filter(|it| !ways.contains(it)));
}

/// S, by the derivative of one turn; none where the multipliers are not inside the unit circle.
pub(crate) fn metric<const N: usize>(turn: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut sum = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let mut power = *turn;
    for _ in 0..METRIC_DOUBLINGS {
        let more = product(&transposed(&power), &product(&sum, &power));
        for (row, add) in sum.iter_mut().zip(more) {
            row.iter_mut().zip(add).for_each(|(x, more): (&mut f64, f64)| *x += more);
        }
        power = product(&power, &power);
    }
    let dead = power.iter().flatten().all(|x| x.abs() < 1e-3);
    (dead && sum.iter().flatten().all(|x| x.is_finite())).then_some(sum)
}

fn transposed<const N: usize>(m: &[[f64; N]; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

/// Steps x along the axes with x' metric x = 1, one in each of the directions that the metric makes
/// of these.
fn net(metric: &[Vec<f64>], axes: &[Vec<f64>], directions: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let upper = upper_factor(metric, axes)?;
    let along = |direction: &Vec<f64>| {
        let factors = solve(&upper, direction);
        let entry = |n| axes.iter().zip(&factors).map(|(axis, by)| axis[n] * by).sum();
        (0..metric.len()).map(entry).collect()
    };
    Some(directions.iter().map(along).collect())
}

/// U, upper triangular, with U'U = the metric along the axes.
fn upper_factor(metric: &[Vec<f64>], axes: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let count = axes.len();
    let mut u = vec![vec![0.0_f64; count]; count];
    for i in 0..count {
        for (j, axis) in axes.iter().enumerate().skip(i) {
            let image: Vec<f64> = metric.iter().map(|row| dot(row, axis)).collect();
            let whole = dot(&axes[i], &image);
            let rest = whole - (0..i).map(|k| u[k][i] * u[k][j]).sum::<f64>();
            u[i][j] = if i == j { rest.sqrt() } else { rest / u[i][i] };
        }
    }
    u.iter().flatten().all(|x| x.is_finite()).then_some(u)
}

/// x with U x = right.
fn solve(upper: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; right.len()];
    for i in (0..right.len()).rev() {
        let rest = right[i] - ((i + 1)..right.len()).map(|k| upper[i][k] * x[k]).sum::<f64>();
        x[i] = rest / upper[i][i];
    }
    x
}
