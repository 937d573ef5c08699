//! The growth of errors along a true run, for a truth whose table has none.
//!
//! In every mode z' = M z, so the derivative of a segment's flow is a matrix exponential; at an
//! event it is completed by the saltation matrix. The growth of a quantity at event n is the
//! largest, over m <= n and at least 1, of the norm of its derivative with respect to the state
//! just before event m (m = 0 is the start): theta where the system is forced, and the states.
//! States are divided by their scales and times by the time scale before any norm. The proved
//! tables hold the same numbers, from ball arithmetic.

use super::{Truth, TruthRow};
use crate::case::Case;
use nalgebra::{DMatrix, DVector, RowDVector, SMatrix};
use percuss::TwoWord;
use percuss::affine::{Row, System};
use std::sync::Arc;

/// A rate that is smaller than this part of what it is summed from is none: the event comes with
/// the one before it.
const RATE_TOLERANCE: f64 = 1e-12;

/// Perturbations that began just before one of the events, side by side: what they have become.
struct Perturbations {
    /// Derivatives of theta and the states at a fixed time.
    state: DMatrix<f64>,
    /// Derivatives of the time of the last event.
    time: RowDVector<f64>,
}

/// The matrices of a system in the direction of a run.
#[derive(Clone)]
pub struct GrowthMatrices {
    system: Arc<System>,
    /// The matrix of each mode.
    modes: Arc<[DMatrix<f64>]>,
    forced: usize,
    states: usize,
    /// The scales of theta and of each state.
    scales: Vec<f64>,
    /// The unit in which errors of times are counted.
    unit_of_time: f64,
    /// The clock's time at the start.
    begin: f64,
    backward: bool,
    /// Whether no event moves the state: a row then says what it was just before the event.
    continuous: bool,
}

impl GrowthMatrices {
    /// The matrices of a case's system, from the case's start.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let system = if case.backward { case.system.reversed() } else { case.system.clone() };
        let forced = usize::from(system.forcing.is_some());
        let scales = std::iter::repeat_n(1.0, forced).chain(system.scales.iter().copied());
        let start = system.start.as_ref().map(|it| it.time.to_f64());
        Self {
            modes: system.modes.iter().map(|mode| matrix(&mode.matrix)).collect(),
            forced,
            states: system.states.len(),
            scales: scales.collect(),
            unit_of_time: case.unit_of_time(),
            begin: start.unwrap_or_default(),
            backward: case.backward,
            continuous: case.oscillator.is_some(),
            system: Arc::new(system),
        }
    }

    /// The same from a start at another time of the clock.
    #[must_use]
    pub fn from(&self, begin: f64) -> Self {
        Self { begin, ..self.clone() }
    }

    /// Fills in the growth of a truth's events, samples and end.
    pub fn fill(&self, truth: &mut Truth) {
        let mut grown =
            Perturbations { state: self.source(), time: RowDVector::zeros(self.width()) };
        let mut begin = truth.start.clone();
        let mut sampled = 0;
        for n in 0..=truth.events.len() {
            let end = truth.events.get(n).map(|row| row.elapsed);
            let later = &mut truth.samples[sampled..];
            let inside =
                |row: &&mut TruthRow| end.is_none_or(|end| row.elapsed.minus(end).value() < 0.0);
            for row in later.iter_mut().take_while(inside) {
                let (flow, _) = self.flow(&begin, row.elapsed.minus(begin.elapsed).value());
                row.growth = self.largest_growth(&(flow * &grown.state));
                sampled += 1;
            }
            let Some(row) = truth.events.get_mut(n) else {
                let (flow, _) = self.flow(&begin, truth.end.elapsed.minus(begin.elapsed).value());
                truth.end.growth = self.largest_growth(&(flow * &grown.state));
                break;
            };
            self.pass(&mut grown, &begin, row);
            begin = row.clone();
        }
    }

    /// Takes a table's samples from its exact instants, k/n of the run, to the f64 next to each:
    /// these are the times at which engines are asked for the state.
    pub(super) fn round_instants(&self, truth: &mut Truth) {
        for row in &mut truth.samples {
            let asked = TwoWord::new(row.elapsed.value());
            let ahead = asked.minus(row.elapsed).value();
            let rates = &self.modes[row.mode] * self.point(&row.rounded(), asked.value());
            // The time is a rounding, so that second derivatives change nothing.
            for (state, rate) in row.state.iter_mut().zip(rates.iter()) {
                *state = state.plus(TwoWord::new(rate * ahead));
            }
            row.elapsed = asked;
        }
    }

    fn width(&self) -> usize {
        self.forced + self.states
    }

    fn source(&self) -> DMatrix<f64> {
        DMatrix::identity(self.width(), self.width())
    }

    fn row(row: &Row) -> RowDVector<f64> {
        RowDVector::from_iterator(row.len(), row.iter().map(|it| it.to_f64()))
    }

    /// The states with cos theta, sin theta and 1 appended.
    fn point(&self, state: &[f64], elapsed: f64) -> DVector<f64> {
        let mut z: Vec<f64> = state.to_vec();
        if let Some(forcing) = &self.system.forcing {
            let (omega, phi) = (forcing.omega.to_f64(), forcing.phi.to_f64());
            // In a run back in time omega has changed its sign, and so has the start's time.
            let begin = if self.backward { -self.begin } else { self.begin };
            let (sin, cos) = (omega * (begin + elapsed) + phi).sin_cos();
            z.extend([cos, sin]);
        }
        z.push(1.0);
        DVector::from_vec(z)
    }

    /// Changes of z by changes of theta and the states.
    fn lift(&self, z: &DVector<f64>) -> DMatrix<f64> {
        let mut lifted = DMatrix::zeros(z.len(), self.forced + self.states);
        for i in 0..self.states {
            lifted[(i, i + self.forced)] = 1.0;
        }
        if self.forced == 1 {
            lifted[(self.states, 0)] = -z[self.states + 1];
            lifted[(self.states + 1, 0)] = z[self.states];
        }
        lifted
    }

    /// Changes of theta and the states, from changes of z; theta is changed by no event and no
    /// flow.
    fn with_theta(&self, changed: &DMatrix<f64>, before: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(self.width(), changed.ncols(), |i, j| {
            if i < self.forced { before[(i, j)] } else { changed[(i - self.forced, j)] }
        })
    }

    /// The derivative of theta and the states this much later, by those at the segment's start, and
    /// the states there with cos theta, sin theta and 1.
    fn flow(&self, begin: &TruthRow, time: f64) -> (DMatrix<f64>, DVector<f64>) {
        let z = self.point(&begin.rounded(), begin.elapsed.value());
        let later = exponential(&(&self.modes[begin.mode] * time));
        let there = &later * &z;
        (self.with_theta(&(later * self.lift(&z)), &self.source()), there)
    }

    /// Takes perturbations through an event, and writes down how much errors have grown there.
    fn pass(&self, grown: &mut Perturbations, begin: &TruthRow, row: &mut TruthRow) {
        let mode = &self.system.modes[begin.mode];
        let size = self.system.dimension();
        let (guard, reset) = match mode.until.get(row.event) {
            Some(until) => (&until.guard, matrix(&until.reset)),
            None => {
                (&mode.watch[row.event - mode.until.len()].guard, DMatrix::identity(size, size))
            }
        };
        let (flow, mut before) = self.flow(begin, row.elapsed.minus(begin.elapsed).value());
        if self.continuous {
            // More of its digits are right than after a long segment's exponential.
            before = self.point(&row.rounded(), row.elapsed.value());
        }
        let guard = Self::row(guard);
        let velocity = &self.modes[begin.mode] * &before;
        let rate = (&guard * &velocity)[0];
        let summed: f64 = guard.iter().zip(velocity.iter()).map(|(a, b)| (a * b).abs()).sum();
        let after = &self.modes[row.mode] * (&reset * &before);
        // Those that begin just before this event join the others.
        let (width, count) = (self.width(), grown.state.ncols());
        let state = joined_columns(&(flow * &grown.state), &self.source());
        let lifted = self.lift(&before) * &state;
        grown.time = if rate.abs() > RATE_TOLERANCE * summed {
            -(guard * &lifted) / rate
        } else {
            joined_columns(&grown.time, &RowDVector::zeros(width))
        };
        debug_assert_eq!(grown.time.ncols(), count + width);
        let changed = reset * (lifted + velocity * &grown.time);
        let later = &changed - after * &grown.time;
        let sources = (0..grown.time.ncols()).step_by(width);
        let times = sources
            .map(|from| self.norm(grown.time.columns(from, width).iter(), self.unit_of_time));
        row.growth_time = times.fold(1.0, f64::max);
        row.growth = self.largest_growth(&self.with_theta(&changed, &state));
        grown.state = self.with_theta(&later, &state);
    }

    fn norm<'a>(&self, derivative: impl Iterator<Item = &'a f64>, unit: f64) -> f64 {
        let scaled = derivative.zip(&self.scales).map(|(it, scale)| it * scale / unit);
        scaled.map(|it| it * it).sum::<f64>().sqrt()
    }

    /// The largest growth of each state.
    fn largest_growth(&self, derivatives: &DMatrix<f64>) -> Vec<f64> {
        let width = self.width();
        let of_state = |i: usize| {
            let sources = (0..derivatives.ncols()).step_by(width);
            let norms = sources.map(|from| {
                let row = derivatives.view((i + self.forced, from), (1, width));
                self.norm(row.iter(), self.system.scales[i])
            });
            norms.fold(1.0, f64::max)
        };
        (0..self.states).map(of_state).collect()
    }
}

fn matrix(rows: &[Row]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64())
}

/// The columns of the one, then those of the other.
fn joined_columns<R: nalgebra::Dim>(
    one: &nalgebra::OMatrix<f64, R, nalgebra::Dyn>,
    other: &nalgebra::OMatrix<f64, R, nalgebra::Dyn>,
) -> nalgebra::OMatrix<f64, R, nalgebra::Dyn>
where
    nalgebra::DefaultAllocator: nalgebra::allocator::Allocator<R, nalgebra::Dyn>,
{
    let (rows, _) = one.shape_generic();
    let columns = one.iter().chain(other.iter()).copied();
    nalgebra::OMatrix::from_iterator_generic(
        rows,
        nalgebra::Dyn(one.ncols() + other.ncols()),
        columns,
    )
}

/// The exponential of a matrix; that of the oscillator's size is several times as fast where its
/// size is known beforehand, and long runs take many.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    const OSCILLATOR_DIMENSION: usize = 7;
    if matrix.nrows() != OSCILLATOR_DIMENSION {
        return matrix.exp();
    }
    let known = SMatrix::<f64, OSCILLATOR_DIMENSION, OSCILLATOR_DIMENSION>::from_iterator(
        matrix.iter().copied(),
    );
    DMatrix::from_iterator(OSCILLATOR_DIMENSION, OSCILLATOR_DIMENSION, known.exp().iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::embedded;
    use crate::truth::Library;

    /// The tables have four digits, and f64 loses some to stiff exponentials.
    const AGREEMENT_TOLERANCE: f64 = 2e-3;

    /// Growth along a table is what the table says, which another program found in another
    /// arithmetic. Where several events share an instant the tables follow their other orders too.
    #[test]
    fn growth_along_a_table_is_the_tables() {
        let Ok(library) = Library::embedded() else { unreachable!("the manifest is read") };
        let mut compared = 0;
        let cases = embedded().unwrap_or_default().into_iter();
        for case in cases.filter(|it| it.oscillator.is_none()) {
            let proved = library.truth(&case);
            let Ok(proved) = proved else { unreachable!("{}: {:?}", case.name, proved.err()) };
            let together =
                |pair: &[TruthRow]| pair[1].elapsed.minus(pair[0].elapsed).value() == 0.0;
            if proved.events.windows(2).any(together) {
                continue;
            }
            let mut own = proved.clone();
            GrowthMatrices::new(&case).fill(&mut own);
            let rows = own.events.iter().zip(&proved.events);
            for (n, (own, proved)) in
                rows.chain(own.samples.iter().zip(&proved.samples)).enumerate()
            {
                let pairs = own.growth.iter().zip(&proved.growth);
                for (own, proved) in pairs.chain([(&own.growth_time, &proved.growth_time)]) {
                    let off = (own / proved - 1.0).abs();
                    assert!(off <= AGREEMENT_TOLERANCE, "{} {n}: {own} {proved}", case.name);
                    compared += 1;
                }
            }
        }
        assert!(compared > 10_000, "{compared}");
    }
}
