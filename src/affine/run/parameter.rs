//! The part that a parameter has in small changes of a run's state.
//!
//! A parameter that changes by dp changes the matrix M of a mode, its guards w and its resets R by
//! dM dp, dw dp and dR dp. The change s of the state, per dp, obeys s' = M s + dM z; an event comes
//! later by -(w s + dw z)/(w M z), and its reset leaves R s + dR z.

use super::series::{MAX_SERIES_ARGUMENT, gain, series, sum};
use crate::affine::arithmetic::vector::{Vector, add_product, dot};
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{LARGEST_DIMENSION, Mode, Row, System};
use crate::affine::solver::Solver;
use crate::numeric::number::Number;

/// A time is doubled at most so often from one for which the series is short: no digit would be
/// left beyond.
const MAX_DOUBLINGS: u32 = 50;

/// The derivatives of a system's coefficients by a parameter.
#[derive(Debug)]
pub struct CoefficientRates<T> {
    modes: Vec<ModeRates<T>>,
    /// The derivative of the forcing frequency; zero where nothing is forced.
    pub omega: T,
    /// The derivative of the forcing phase at time zero.
    pub phi: T,
}

/// The derivatives of a mode's coefficients.
#[derive(Debug)]
struct ModeRates<T> {
    matrix: Vec<Vector<T>>,
    /// Whether the matrix is not zero.
    moves: bool,
    /// The rows of the guards: those of `until`, then those of `watch`.
    rows: Vec<Vector<T>>,
    /// The matrices of the resets of `until`, then those of their limits.
    resets: Vec<Vec<Vector<T>>>,
}

/// Columns of a square matrix.
type Columns<T> = Vec<Vector<T>>;

impl<T: Number> CoefficientRates<T> {
    /// The sum of the systems' coefficients, each with its weight, over a divisor; none where the
    /// systems differ in more than coefficients.
    pub fn new(systems: &[(System, i32)], divisor: f64) -> Option<Self> {
        let (first, _) = systems.first()?;
        let all: Vec<_> = systems.iter().map(|(it, weight)| (coefficients(it), *weight)).collect();
        let (own, _) = &all[0];
        if all.iter().any(|(it, _)| it.len() != own.len()) {
            return None;
        }
        let mut rates = (0..own.len()).map(|n| {
            // Most coefficients do not depend on the parameter.
            if all.iter().all(|(it, _)| it[n] == own[n]) {
                return T::zero();
            }
            let terms = all.iter().map(|(it, weight)| it[n] * &Rational::from(*weight));
            T::exact(terms.fold(Rational::ZERO, |sum, it| sum + it).to_f64() / divisor)
        });
        let mut row = |row: &Row| -> Vector<T> {
            let mut vector = [T::zero(); LARGEST_DIMENSION];
            vector.iter_mut().zip(row).for_each(|(it, _)| *it = rates.next().unwrap_or(*it));
            vector
        };
        let mut mode = |mode: &Mode| {
            let matrix: Vec<_> = mode.matrix.iter().map(&mut row).collect();
            ModeRates {
                moves: matrix.iter().flatten().any(|it| *it != T::zero()),
                matrix,
                rows: mode.guards().map(&mut row).collect(),
                resets: mode.exits().map(|(it, _)| it.iter().map(&mut row).collect()).collect(),
            }
        };
        let modes = first.modes.iter().map(&mut mode).collect();
        let mut forcing = || rates.next().unwrap_or_else(T::zero);
        Some(Self { modes, omega: forcing(), phi: forcing() })
    }

    /// The value at a state of the derivative of a guard.
    pub fn guard(&self, mode: usize, guard: usize, z: &Vector<T>) -> T {
        dot(&self.modes[mode].rows[guard], z, LARGEST_DIMENSION)
    }

    /// The derivative, at a state z, of the rate w M z that a guard of a mode has in a mode.
    pub fn guard_rate(
        &self,
        solver: &Solver<T>,
        (of, guard): (usize, usize),
        mode: usize,
        z: &Vector<T>,
    ) -> T {
        let own = dot(&solver.modes[of].rows[guard], &self.rates(mode, z), LARGEST_DIMENSION);
        own + self.guard(of, guard, &solver.rates_of(mode, z))
    }

    /// The rates dM z.
    pub fn rates(&self, mode: usize, z: &Vector<T>) -> Vector<T> {
        applied(&self.modes[mode].matrix, z)
    }

    /// The product of a reset's derivative and a state.
    pub fn reset(&self, mode: usize, number: usize, z: &Vector<T>) -> Vector<T> {
        applied(&self.modes[mode].resets[number], z)
    }

    /// The part of a change that the parameter adds along a mode, from a state on and for a time.
    ///
    /// For a time h with F = exp(M h), and with what is added D, both as matrices, those of 2 h are
    /// F F and F D + D F.
    pub fn added(&self, solver: &Solver<T>, mode: usize, z: &Vector<T>, elapsed: T) -> Vector<T> {
        let zero = [T::zero(); LARGEST_DIMENSION];
        if !self.modes[mode].moves {
            return zero;
        }
        let argument = solver.modes[mode].flow.speed * elapsed.to_f64();
        let doublings = (0..MAX_DOUBLINGS)
            .find(|n| argument <= MAX_SERIES_ARGUMENT * libm::scalbn(1.0, *n as i32));
        let doublings = doublings.unwrap_or(MAX_DOUBLINGS);
        let short = elapsed.scaled(-i64::from(doublings));
        let dimension = solver.system().dimension();
        let units = (0..dimension).map(|n| {
            let mut unit = zero;
            unit[n] = T::one();
            unit
        });
        let (mut flow, mut added): (Columns<T>, Columns<T>) = units
            .map(|unit| {
                let moved = sum(&unit, &gain(solver, mode, &unit, short), T::one());
                (moved, gain_by_parameter(solver, self, mode, (&zero, &unit), short))
            })
            .unzip();
        for _ in 0..doublings {
            let [later, sooner] = [product(&flow, &added), product(&added, &flow)];
            added = later.iter().zip(&sooner).map(|(a, b)| sum(a, b, T::one())).collect();
            flow = product(&flow, &flow);
        }
        combined(&added, z)
    }
}

/// The gain of a change by a parameter along a mode, from a state on: the series of
/// s' = M s + dM z, less its beginning.
pub fn gain_by_parameter<T: Number>(
    solver: &Solver<T>,
    rates: &CoefficientRates<T>,
    mode: usize,
    (change, state): (&Vector<T>, &Vector<T>),
    elapsed: T,
) -> Vector<T> {
    let (mut term, mut own) = (*change, *state);
    // What is added may vanish at first: not for as many terms as change and state have entries.
    series(elapsed, 2 * solver.system.dimension(), |factor| {
        let added = rates.rates(mode, &own);
        own = solver.rates_of(mode, &own).map(|it| it * factor);
        term = sum(&solver.rates_of(mode, &term), &added, T::one()).map(|it| it * factor);
        term
    })
}

/// All coefficients of a system in one list: those of its modes, then frequency and phase.
fn coefficients(system: &System) -> Vec<&Rational> {
    let rows = system.modes.iter().flat_map(|mode| {
        let resets = mode.exits().flat_map(|(reset, _)| reset);
        mode.matrix.iter().chain(mode.guards()).chain(resets)
    });
    let forcing = system.forcing.iter().flat_map(|it| [&it.omega, &it.phi]);
    rows.flatten().chain(forcing).collect()
}

fn applied<T: Number>(matrix: &[Vector<T>], z: &Vector<T>) -> Vector<T> {
    let mut moved = [T::zero(); LARGEST_DIMENSION];
    moved.iter_mut().zip(matrix).for_each(|(it, row)| *it = dot(row, z, LARGEST_DIMENSION));
    moved
}

/// The product of a matrix, given by its columns, and a vector.
fn combined<T: Number>(columns: &[Vector<T>], vector: &Vector<T>) -> Vector<T> {
    let mut sums = [T::zero(); LARGEST_DIMENSION];
    for (column, factor) in columns.iter().zip(vector) {
        add_product(&mut sums, column, *factor);
    }
    sums
}

fn product<T: Number>(a: &Columns<T>, b: &Columns<T>) -> Columns<T> {
    b.iter().map(|column| combined(a, column)).collect()
}
