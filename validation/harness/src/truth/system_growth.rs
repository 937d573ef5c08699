//! The growth of errors along a system's true run, for a truth that is no proved table.
//!
//! In every mode z' = M z, so the derivative of a segment's flow is a matrix exponential; at an
//! event it is completed by the saltation matrix. The growth of a quantity at event n is the
//! largest, over m <= n and at least 1, of the norm of its derivative with respect to the state
//! just before event m (m = 0 is the start): theta where the system is forced, and the states.
//! States are divided by their scales and times by the time scale before any norm. The proved
//! tables hold the same numbers, from ball arithmetic.

use super::{SystemTruth, SystemTruthRow};
use crate::case::SystemCase;
use nalgebra::{DMatrix, DVector, RowDVector};
use percuss::TwoWord;
use percuss::affine::{Row, System};

/// A rate that is smaller than this part of what it is summed from is none: the event comes with
/// the one before it.
const NO_RATE: f64 = 1e-12;

/// Perturbations that began just before one of the events: what they have become.
#[derive(Clone)]
struct Perturbation {
    /// Derivatives of theta and the states at a fixed time.
    state: DMatrix<f64>,
    /// Derivatives of the time of the last event.
    time: RowDVector<f64>,
}

/// The matrices of a system in the direction of a run.
struct SystemMatrices {
    system: System,
    forced: usize,
    states: usize,
    /// The scales of theta and of each state.
    scales: Vec<f64>,
    begin: f64,
    backward: bool,
}

/// Fills in the growth of a truth's events, samples and end.
pub(super) fn fill(truth: &mut SystemTruth, case: &SystemCase) {
    let motion = SystemMatrices::of(case);
    let mut sources = vec![motion.source()];
    let mut begin = truth.start.clone();
    let mut sampled = 0;
    for n in 0..=truth.events.len() {
        let end = truth.events.get(n).map(|row| row.elapsed.value());
        let later = &mut truth.samples[sampled..];
        let inside = |row: &&mut SystemTruthRow| end.is_none_or(|end| row.elapsed.value() < end);
        for row in later.iter_mut().take_while(inside) {
            let flow = motion.flow(&begin, row.elapsed.minus(begin.elapsed).value());
            row.growth = motion.largest(sources.iter().map(|it| &flow * &it.state));
            sampled += 1;
        }
        let Some(row) = truth.events.get_mut(n) else {
            let flow = motion.flow(&begin, truth.end.elapsed.minus(begin.elapsed).value());
            truth.end.growth = motion.largest(sources.iter().map(|it| &flow * &it.state));
            break;
        };
        motion.pass(&mut sources, &begin, row);
        begin = row.clone();
    }
}

/// Takes a table's samples from its exact instants, k/n of the run, to the f64 next to each: these
/// are the times at which engines are asked for the state.
pub(super) fn round_instants(truth: &mut SystemTruth, case: &SystemCase) {
    let motion = SystemMatrices::of(case);
    for row in &mut truth.samples {
        let asked = TwoWord::new(row.elapsed.value());
        let ahead = asked.minus(row.elapsed).value();
        let matrix = motion.matrix(&motion.system.modes[row.mode].matrix);
        let rates = matrix * motion.point(&rounded(row), asked.value());
        // The time is a rounding, so that second derivatives change nothing.
        for (state, rate) in row.state.iter_mut().zip(rates.iter()) {
            *state = state.plus(TwoWord::new(rate * ahead));
        }
        row.elapsed = asked;
    }
}

impl SystemMatrices {
    fn of(case: &SystemCase) -> Self {
        let system = if case.backward { case.system.reversed() } else { case.system.clone() };
        let forced = usize::from(system.forcing.is_some());
        let scales = std::iter::repeat_n(1.0, forced).chain(system.scales.iter().copied());
        let start = system.start.as_ref().map(|it| it.time.to_f64());
        Self {
            forced,
            states: system.states.len(),
            scales: scales.collect(),
            begin: start.unwrap_or_default(),
            backward: case.backward,
            system,
        }
    }

    fn source(&self) -> Perturbation {
        let width = self.forced + self.states;
        Perturbation { state: DMatrix::identity(width, width), time: RowDVector::zeros(width) }
    }

    fn matrix(&self, rows: &[Row]) -> DMatrix<f64> {
        let size = self.system.dimension();
        DMatrix::from_fn(size, size, |i, j| rows[i][j].to_f64())
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
        let width = self.forced + self.states;
        DMatrix::from_fn(width, changed.ncols(), |i, j| {
            if i < self.forced { before[(i, j)] } else { changed[(i - self.forced, j)] }
        })
    }

    /// The derivative of theta and the states this much later, by those at the segment's start.
    fn flow(&self, begin: &SystemTruthRow, time: f64) -> DMatrix<f64> {
        let matrix = self.matrix(&self.system.modes[begin.mode].matrix);
        let z = self.point(&rounded(begin), begin.elapsed.value());
        let width = self.forced + self.states;
        self.with_theta(&((matrix * time).exp() * self.lift(&z)), &DMatrix::identity(width, width))
    }

    /// Takes the sources through an event, and writes down how much errors have grown there.
    fn pass(
        &self,
        sources: &mut Vec<Perturbation>,
        begin: &SystemTruthRow,
        row: &mut SystemTruthRow,
    ) {
        let mode = &self.system.modes[begin.mode];
        let matrix = self.matrix(&mode.matrix);
        let size = self.system.dimension();
        let (guard, reset) = match mode.until.get(row.event) {
            Some(until) => (&until.guard, self.matrix(&until.reset)),
            None => {
                (&mode.watch[row.event - mode.until.len()].guard, DMatrix::identity(size, size))
            }
        };
        let time = row.elapsed.minus(begin.elapsed).value();
        let flow = self.flow(begin, time);
        let at_begin = self.point(&rounded(begin), begin.elapsed.value());
        let before = (&matrix * time).exp() * at_begin;
        let guard = Self::row(guard);
        let velocity = &matrix * &before;
        let rate = (&guard * &velocity)[0];
        let summed: f64 = guard.iter().zip(velocity.iter()).map(|(a, b)| (a * b).abs()).sum();
        let comes_alone = rate.abs() > NO_RATE * summed;
        for source in sources.iter_mut() {
            source.state = &flow * &source.state;
        }
        sources.push(self.source());
        let after = self.matrix(&self.system.modes[row.mode].matrix) * (&reset * &before);
        let lift = self.lift(&before);
        let mut at_event = Vec::new();
        for source in sources.iter_mut() {
            let lifted = &lift * &source.state;
            if comes_alone {
                source.time = -(&guard * &lifted) / rate;
            }
            let changed = &reset * (lifted + &velocity * &source.time);
            let later = &changed - &after * &source.time;
            at_event.push(self.with_theta(&changed, &source.state));
            source.state = self.with_theta(&later, &source.state);
        }
        let unit = self.system.time_scale;
        let times = sources.iter().map(|it| self.norm(it.time.iter(), unit));
        row.growth_time = times.fold(1.0, f64::max);
        row.growth = self.largest(at_event.into_iter());
    }

    fn norm<'a>(&self, derivative: impl Iterator<Item = &'a f64>, unit: f64) -> f64 {
        let scaled = derivative.zip(&self.scales).map(|(it, scale)| it * scale / unit);
        scaled.map(|it| it * it).sum::<f64>().sqrt()
    }

    /// The largest growth of each state.
    fn largest(&self, derivatives: impl Iterator<Item = DMatrix<f64>>) -> Vec<f64> {
        let mut largest = vec![1.0; self.states];
        for derivative in derivatives {
            for (i, growth) in largest.iter_mut().enumerate() {
                let row = derivative.row(i + self.forced);
                *growth = f64::max(*growth, self.norm(row.iter(), self.system.scales[i]));
            }
        }
        largest
    }
}

fn rounded(row: &SystemTruthRow) -> Vec<f64> {
    row.state.iter().map(|it| it.value()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Cases;
    use crate::truth::Library;

    /// The tables have four digits, and f64 loses some to stiff exponentials.
    const AGREES: f64 = 2e-3;

    /// Growth along a table is what the table says, which another program found in another
    /// arithmetic. Where several events share an instant the tables follow their other orders too.
    #[test]
    fn growth_along_a_table_is_the_tables() {
        let Ok(library) = Library::embedded() else { unreachable!("the manifest is read") };
        let mut compared = 0;
        for case in Cases::embedded().unwrap_or_default().systems {
            let proved = library.system_truth(&case);
            let Ok(proved) = proved else { unreachable!("{}: {:?}", case.name, proved.err()) };
            let together =
                |pair: &[SystemTruthRow]| pair[1].elapsed.minus(pair[0].elapsed).value() == 0.0;
            if proved.events.windows(2).any(together) {
                continue;
            }
            let mut own = proved.clone();
            fill(&mut own, &case);
            let rows = own.events.iter().zip(&proved.events);
            for (n, (own, proved)) in
                rows.chain(own.samples.iter().zip(&proved.samples)).enumerate()
            {
                let pairs = own.growth.iter().zip(&proved.growth);
                for (own, proved) in pairs.chain([(&own.growth_time, &proved.growth_time)]) {
                    let off = (own / proved - 1.0).abs();
                    assert!(off <= AGREES, "{} {n}: {own} {proved}", case.name);
                    compared += 1;
                }
            }
        }
        assert!(compared > 10_000, "{compared}");
    }
}
