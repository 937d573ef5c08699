//! The events of a system by its closed form, for tests: exp(M t) in short steps, with guards
//! looked at between them and narrowed down by bisection. It shares nothing with what is tested but
//! the system's numbers.

use crate::system::{Row, System};

/// An event: which of its mode's, the mode after it, and its time.
pub(super) type TrueEvent = (usize, usize, f64);

type SquareRows = Vec<Vec<f64>>;

/// A system whose closed form is evaluated in steps.
pub(super) struct SteppedClosedForm<'a> {
    system: &'a System,
    step: f64,
}

impl<'a> SteppedClosedForm<'a> {
    pub(super) fn new(system: &'a System, step: f64) -> Self {
        Self { system, step }
    }

    /// The events up to `span` from a mode and a state, and the state there.
    pub(super) fn run(&self, mode: usize, x: &[f64], span: f64) -> (Vec<TrueEvent>, Vec<f64>) {
        let (mut t, mut mode) = (0.0, mode);
        let (sin, cos) = self.system.phi.sin_cos();
        let mut z = [x, &[cos, sin, 1.0]].concat();
        let mut found = Vec::new();
        while t < span {
            let step = self.step.min(span - t);
            let Some((length, event)) = self.first(mode, &z, step) else {
                z = self.later(mode, &z, step);
                t = if step < span - t { t + step } else { span };
                continue;
            };
            z = self.later(mode, &z, length);
            t += length;
            if let Some(until) = self.system.modes[mode].until.get(event) {
                if let Some(reset) = &until.reset {
                    let x: Vec<f64> = reset.iter().map(|row| dot(row, &z)).collect();
                    z[..x.len()].copy_from_slice(&x);
                }
                let holds = |when: &Option<Row>| when.as_ref().is_none_or(|it| dot(it, &z) > 0.0);
                mode = until.next.iter().find(|(when, _)| holds(when)).map_or(mode, |it| it.1);
            }
            found.push((event, mode, t));
            // Past the event, so that it is not found again.
            let past = (self.step * 1e-7).min(span - t);
            z = self.later(mode, &z, past);
            t += past;
        }
        z.truncate(x.len());
        (found, z)
    }

    /// The first event in a step: the first of those whose guards are not negative at its end and
    /// were at its begin, or that is watched and has changed its sign.
    fn first(&self, mode: usize, z: &[f64], step: f64) -> Option<(f64, usize)> {
        let here = &self.system.modes[mode];
        let guards =
            here.until.iter().map(|it| &it.guard).chain(here.watch.iter().map(|it| &it.guard));
        let sign = |guard: &Row, z: &[f64]| dot(guard, z) > 0.0;
        let after = self.later(mode, z, step);
        let mut first: Option<(f64, usize)> = None;
        for (event, guard) in guards.enumerate() {
            let was = sign(guard, z);
            let counts = match here.watch.get(event.wrapping_sub(here.until.len())) {
                None => !was,
                Some(watch) => match watch.direction {
                    crate::system::Direction::Rising => !was,
                    crate::system::Direction::Falling => was,
                    crate::system::Direction::Both => true,
                },
            };
            if sign(guard, &after) == was || !counts {
                continue;
            }
            let (mut left, mut right) = (0.0, step);
            for _ in 0..60 {
                let middle = 0.5 * (left + right);
                let same = sign(guard, &self.later(mode, z, middle)) == was;
                if same { left = middle } else { right = middle }
            }
            if first.is_none_or(|(length, _)| right < length) {
                first = Some((right, event));
            }
        }
        first
    }

    /// z a time later: exp(M t) z by Taylor's series.
    fn later(&self, mode: usize, z: &[f64], t: f64) -> Vec<f64> {
        let matrix = self.matrix(mode);
        let mut sum = z.to_vec();
        let mut term = z.to_vec();
        for k in 1..40 {
            term = matrix.iter().map(|row| dot(row, &term) * t / f64::from(k)).collect();
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += term);
        }
        sum
    }

    fn matrix(&self, mode: usize) -> SquareRows {
        let here = &self.system.modes[mode];
        let size = here.c.len();
        let mut rows: SquareRows =
            (0..size).map(|i| [here.a[i].as_slice(), &here.b[i], &[here.c[i]]].concat()).collect();
        let zero = vec![0.0; size + 3];
        let [mut cos, mut sin] = [zero.clone(), zero.clone()];
        cos[size + 1] = -self.system.omega;
        sin[size] = self.system.omega;
        rows.extend([cos, sin, zero]);
        rows
    }
}

fn dot(row: &[f64], z: &[f64]) -> f64 {
    row.iter().zip(z).map(|(a, b)| a * b).sum()
}
