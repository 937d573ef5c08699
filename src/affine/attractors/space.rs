//! The co-ordinates in which distances between points of a section are taken, and the motions
//! between such points.

use crate::affine::returns::map::SectionMap;
use crate::affine::returns::shooting::{Change, Derivative, MOST};
use crate::affine::returns::walk::{NoReturn, Return};
use crate::affine::run::place::Place;
use crate::dynamics::attractor::Label;
use crate::dynamics::diagram::FARTHEST;

/// A point of a section: its mode, and each state over its scale. A drift is zero; the time of an
/// event in a forced system follows the states, within the forcing period.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    pub mode: usize,
    pub at: Change,
}

/// The co-ordinates of a section's points.
#[derive(Clone, Copy)]
pub struct Space<'m> {
    pub map: &'m SectionMap<'m, f64>,
    /// The number of co-ordinates.
    pub dimension: usize,
    /// The size of each, zero for a drift.
    sizes: Change,
    /// The time of a forcing period, where points have times.
    turn: Option<f64>,
}

/// The end of a motion that leads to no further return.
pub enum Stop {
    /// It is known where the motion leads.
    Label(Label),
    /// The motion rests, or does not return for so long, at this state.
    Rest(Return<f64>),
}

/// What is shown each return of a motion with its number from 0, and says where the motion leads if
/// that is known.
pub type Watcher<'w> = dyn FnMut(u64, &Return<f64>, &Spot) -> Option<Label> + 'w;

/// Returns for which the end of a motion is put off while they are amid events of one instant.
const AMID: u64 = 64;

impl<'m> Space<'m> {
    pub fn of(map: &'m SectionMap<'m, f64>) -> Self {
        let system = map.system();
        let states = system.states.len();
        let mut sizes = [0.0; MOST];
        for (n, (size, scale)) in sizes.iter_mut().zip(&system.scales).enumerate() {
            *size = if map.is_drift(n) { 0.0 } else { *scale };
        }
        let turn = map.forcing_period().filter(|_| map.has_times());
        if turn.is_some() {
            sizes[states] = system.time_scale;
        }
        Self { map, dimension: states + usize::from(turn.is_some()), sizes, turn }
    }

    pub fn spot(&self, point: &Return<f64>) -> Spot {
        self.spot_at(point.mode, point.time, &point.state)
    }

    pub fn spot_of(&self, place: &Place<f64>) -> Spot {
        self.spot_at(place.mode, place.time.value(), &place.state)
    }

    fn spot_at(&self, mode: usize, time: f64, state: &[f64]) -> Spot {
        let mut at = [0.0; MOST];
        at.iter_mut().zip(state).for_each(|(it, state)| *it = *state);
        if let Some(turn) = self.turn {
            at[state.len()] = time - turn * libm::floor(time / turn);
        }
        for (it, size) in at.iter_mut().zip(&self.sizes) {
            *it = if *size == 0.0 { 0.0 } else { *it / size };
        }
        Spot { mode, at }
    }

    /// The change from one spot to another, the shorter way round the forcing angle.
    pub fn step(&self, from: &Spot, to: &Spot) -> Change {
        let mut step: Change = std::array::from_fn(|n| to.at[n] - from.at[n]);
        if let Some(turn) = self.turn {
            let last = self.dimension - 1;
            let turn = turn / self.sizes[last];
            step[last] -= turn * libm::round(step[last] / turn);
        }
        step
    }

    /// A derivative of the map in these co-ordinates.
    pub fn scaled(&self, derivative: &Derivative) -> Derivative {
        let scaled = |i: usize, j: usize| match self.sizes[i] {
            0.0 => 0.0,
            size => derivative[i][j] * self.sizes[j] / size,
        };
        std::array::from_fn(|i| std::array::from_fn(|j| scaled(i, j)))
    }

    /// A place with a change in these co-ordinates.
    pub fn moved(&self, place: &Place<f64>, step: &Change) -> Place<f64> {
        let by = |n: usize| step[n] * self.sizes[n];
        let state: Vec<f64> = place.state.iter().enumerate().map(|(n, it)| it + by(n)).collect();
        let delay = if self.turn.is_some() { by(self.dimension - 1) } else { 0.0 };
        place.moved_to(place.time.after(delay), state)
    }

    /// Whether a co-ordinate is one: a drift is none.
    pub fn counts(&self, n: usize) -> bool {
        self.sizes[n] != 0.0
    }

    /// Follows a motion for so many returns, or until it is known where it leads; the place of the
    /// last.
    pub fn follow(
        &self,
        from: &Place<f64>,
        count: u64,
        see: &mut Watcher<'_>,
    ) -> Result<Place<f64>, Stop> {
        let mut returns = self.map.returns_after(from);
        for n in 0..count + AMID {
            if n >= count
                && let Ok(place) = returns.place()
            {
                return Ok(place);
            }
            let point = match returns.next() {
                Some(Ok(point)) => point,
                Some(Err(NoReturn::Equilibrium)) => return Err(Stop::Rest(returns.last_event())),
                Some(Err(NoReturn::Ended(_))) => return Err(Stop::Label(Label::Ended)),
                Some(Err(NoReturn::AmidEvents | NoReturn::PastAccumulation)) | None => break,
            };
            let spot = self.spot(&point);
            if spot.at.iter().any(|it| it.is_nan() || it.abs() > FARTHEST) {
                return Err(Stop::Label(Label::Escaping));
            }
            if let Some(label) = see(n, &point, &spot) {
                return Err(Stop::Label(label));
            }
        }
        Err(Stop::Label(Label::Unresolved))
    }
}
