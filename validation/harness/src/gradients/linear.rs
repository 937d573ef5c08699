//! A system's matrices in f64, with their derivatives by a name.

use nalgebra::{DMatrix, DVector, RowDVector};
use percuss::affine::{Mode, Rational, Row, StartPoint, System, Tangent};

/// The matrices of a mode over z: the states, cosine and sine of the forcing, and 1.
#[derive(Clone, Debug)]
pub(super) struct LinearMode {
    pub matrix: DMatrix<f64>,
    /// The guards of `until`, then those that are watched.
    pub guards: Vec<RowDVector<f64>>,
    /// The resets of `until`.
    pub resets: Vec<DMatrix<f64>>,
}

/// The matrices of all modes, and z at the start.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    pub modes: Vec<LinearMode>,
    pub start: DVector<f64>,
}

impl Linear {
    /// The matrices of a system from its start.
    pub(super) fn new(system: &System, start: &StartPoint) -> Self {
        let angle = angle(system, start);
        Self {
            modes: modes(&system.modes),
            start: with_forcing(system, states(&start.state, angle), [angle.1, angle.0, 1.0]),
        }
    }

    /// The derivatives of the matrices and of z at the start, each in its place.
    pub(super) fn rates(system: &System, start: &StartPoint, tangent: &Tangent) -> Self {
        let (sin, cos) = angle(system, start);
        let turn = turn(system, start, tangent);
        let own = states(&start.state, (turn * cos, -turn * sin));
        // The factor of 1 does not turn.
        let own = own.iter().zip(&start.state).map(|(value, row)| value - row[2].to_f64());
        let rates = tangent.start.as_ref().map(|it| states(&it.state, (sin, cos)));
        let rates = rates.unwrap_or_else(|| vec![0.0; system.states.len()]);
        let rates = own.zip(rates).map(|(own, rate)| own + rate).collect();
        Self {
            modes: modes(&tangent.modes),
            start: with_forcing(system, rates, [-turn * sin, turn * cos, 0.0]),
        }
    }

    /// The system for a name's value that is larger by a step, to first order in its coefficients.
    pub(super) fn moved(&self, rates: &Self, step: f64) -> Self {
        let mut other = self.clone();
        other.start += &rates.start * step;
        for (mode, rate) in other.modes.iter_mut().zip(&rates.modes) {
            mode.matrix += &rate.matrix * step;
            mode.guards.iter_mut().zip(&rate.guards).for_each(|(it, rate)| *it += rate * step);
            mode.resets.iter_mut().zip(&rate.resets).for_each(|(it, rate)| *it += rate * step);
        }
        other
    }
}

/// Sine and cosine of the forcing angle at the start.
fn angle(system: &System, start: &StartPoint) -> (f64, f64) {
    let Some(forcing) = &system.forcing else { return (0.0, 1.0) };
    (&forcing.omega * &start.time + &forcing.phi).to_f64().sin_cos()
}

/// The derivative of that angle.
fn turn(system: &System, start: &StartPoint, tangent: &Tangent) -> f64 {
    let (Some(own), Some(rate)) = (&system.forcing, &tangent.forcing) else { return 0.0 };
    let begin = tangent.start.as_ref().map(|it| &own.omega * &it.time).unwrap_or_default();
    (&rate.omega * &start.time + begin + &rate.phi).to_f64()
}

/// The states of factors of cosine, sine and 1.
fn states(rows: &[[Rational; 3]], (sin, cos): (f64, f64)) -> Vec<f64> {
    let value = |[c, s, one]: &[Rational; 3]| c.to_f64() * cos + s.to_f64() * sin + one.to_f64();
    rows.iter().map(value).collect()
}

fn with_forcing(system: &System, mut states: Vec<f64>, [cos, sin, one]: [f64; 3]) -> DVector<f64> {
    if system.forcing.is_some() {
        states.extend([cos, sin]);
    }
    states.push(one);
    DVector::from_vec(states)
}

fn modes(all: &[Mode]) -> Vec<LinearMode> {
    let mode = |it: &Mode| LinearMode {
        matrix: matrix(&it.matrix),
        guards: it
            .until
            .iter()
            .map(|it| row(&it.guard))
            .chain(it.watch.iter().map(|it| row(&it.guard)))
            .collect(),
        resets: it.until.iter().map(|it| matrix(&it.reset)).collect(),
    };
    all.iter().map(mode).collect()
}

fn matrix(rows: &[Row]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64())
}

fn row(row: &Row) -> RowDVector<f64> {
    RowDVector::from_iterator(row.len(), row.iter().map(Rational::to_f64))
}

/// e^(M t), and its derivative by a name by which M has a derivative.
pub(super) fn flow_with_rate(
    matrix: &DMatrix<f64>,
    rate: &DMatrix<f64>,
    time: f64,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let size = matrix.nrows();
    let mut both = DMatrix::zeros(2 * size, 2 * size);
    both.view_mut((0, 0), (size, size)).copy_from(&(matrix * time));
    both.view_mut((size, size), (size, size)).copy_from(&(matrix * time));
    both.view_mut((size, 0), (size, size)).copy_from(&(rate * time));
    let all = both.exp();
    let part = |from: usize| all.view((from, 0), (size, size)).into_owned();
    (part(0), part(size))
}
