//! Answered derivatives held against the truth, and against what wrong rules would give.

use super::answer::{GradientAnswer, NameAnswer};
use super::mechanism::{EXPLAINED_SHARE, Mechanism};
use super::reference::Reference;
use super::verdict::{Judged, Verdict};
use super::walk::Rows;

/// The number of units that a right derivative may be off. Rounding of f64 is a millionth of one at
/// 1e-9; an integrator whose steps have errors of the tolerance's size was off by 61 at most, in
/// every case at 1e-6, 1e-8 and 1e-9.
pub const ALLOWED_UNITS: f64 = 100.0;

/// A cell is judged where what is allowed is below this share of the largest derivative of its
/// kind: above it, no wrong term could be told from rounding.
const JUDGED_SHARE: f64 = 0.1;

/// Judges answers to a case at tolerances, one after the other.
#[must_use]
pub fn judge(reference: &Reference, answers: &[(f64, Option<&GradientAnswer>)]) -> Vec<Judged> {
    let names = reference.case.names();
    let judged = |name: usize, at: usize| OneName::new(reference, name, answers).judge(at);
    let rows = names.iter().enumerate();
    rows.flat_map(|(name, wrt)| {
        (0..answers.len()).map(move |at| {
            let (verdict, missing_term, why) = judged(name, at);
            Judged { wrt: wrt.clone(), tolerance: answers[at].0, verdict, missing_term, why }
        })
    })
    .collect()
}

type Said = (Verdict, Option<Mechanism>, String);

/// The answers by one name.
struct OneName<'a> {
    reference: &'a Reference,
    name: usize,
    answers: &'a [(f64, Option<&'a GradientAnswer>)],
    truth: Rows,
    /// The largest derivative of each column, or of all columns where one has only zeros.
    sizes: Vec<f64>,
}

/// The worst of the compared cells.
#[derive(Clone, Copy)]
struct Worst {
    units: f64,
    n: usize,
    k: usize,
}

impl<'a> OneName<'a> {
    fn new(
        reference: &'a Reference,
        name: usize,
        answers: &'a [(f64, Option<&'a GradientAnswer>)],
    ) -> Self {
        let truth = reference.truth(name);
        let columns = truth.first().map_or(0, Vec::len);
        let largest = |k: usize| truth.iter().map(|it| it[k].abs()).fold(0.0, f64::max);
        let sizes: Vec<f64> = (0..columns).map(largest).collect();
        let all = sizes.iter().copied().fold(0.0, f64::max);
        let sizes = sizes.into_iter().map(|it| if it > 0.0 { it } else { all }).collect();
        Self { reference, name, answers, truth, sizes }
    }

    fn answer(&self, at: usize) -> Option<&'a NameAnswer> {
        self.answers[at].1?.by.get(self.name)?.as_ref()
    }

    /// The cells that are judged at a tolerance, and which were answered.
    fn cells(&self, tolerance: f64, answer: &NameAnswer) -> Vec<(usize, usize)> {
        self.judged_cells(tolerance)
            .into_iter()
            .filter(|(n, k)| answer.cell(*n, *k).is_some())
            .collect()
    }

    /// The cells in which a wrong term could be told at a tolerance.
    fn judged_cells(&self, tolerance: f64) -> Vec<(usize, usize)> {
        let units = self.reference.units(self.name);
        let is_told = |n: usize, k: usize| {
            ALLOWED_UNITS * tolerance * units[n][k] <= JUDGED_SHARE * self.sizes[k]
        };
        self.all_cells().filter(|(n, k)| is_told(*n, *k)).collect()
    }

    /// The cells behind the start.
    fn all_cells(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (rows, columns) = (self.truth.len(), self.sizes.len());
        (1..rows).flat_map(move |n| (0..columns).map(move |k| (n, k)))
    }

    fn judge(&self, at: usize) -> Said {
        let (tolerance, given) = self.answers[at];
        if given.is_none() {
            return (
                Verdict::NoneAsked,
                None,
                "the case has no answer with derivatives".to_owned(),
            );
        }
        let Some(answer) = self.answer(at) else {
            return (Verdict::Refused, None, "there is no answer by this name".to_owned());
        };
        let end = self.truth.len() - 1;
        if (1..self.sizes.len()).any(|k| answer.cell(end, k).is_none()) {
            return (Verdict::Refused, None, "there is no answer at the end".to_owned());
        }
        if self.judged_cells(tolerance).is_empty() {
            let why = "at this tolerance no derivative of the case can be told from its error";
            return (Verdict::NoneAsked, None, why.to_owned());
        }
        let cells = self.cells(tolerance, answer);
        let Some(worst) = self.worst(answer, &cells, tolerance) else {
            return (Verdict::Refused, None, "no cell that is judged was answered".to_owned());
        };
        if worst.units > ALLOWED_UNITS {
            return self.wrong_verdict(at, answer, &cells, worst);
        }
        if self.tells_zeros_alone(answer, &cells, tolerance) {
            let why =
                "of what was answered only derivatives that are 0 can be told from their error";
            return (Verdict::NoneAsked, None, why.to_owned());
        }
        (Verdict::Right, None, self.why_right(worst, tolerance, cells.len()))
    }

    /// Whether some derivative that was answered is not 0, and none of those is larger than its
    /// allowance: an answer of zeros would agree as well.
    fn tells_zeros_alone(
        &self,
        answer: &NameAnswer,
        cells: &[(usize, usize)],
        tolerance: f64,
    ) -> bool {
        let units = self.reference.units(self.name);
        let allowed = |n: usize, k: usize| ALLOWED_UNITS * tolerance * units[n][k];
        let is_told = |(n, k): &(usize, usize)| self.truth[*n][*k].abs() > allowed(*n, *k);
        let mut answered = self.all_cells().filter(|(n, k)| answer.cell(*n, *k).is_some());
        answered.any(|(n, k)| self.truth[n][k] != 0.0) && !cells.iter().any(is_told)
    }

    fn why_right(&self, worst: Worst, tolerance: f64, cells: usize) -> String {
        let told = self.judged_cells(tolerance).len();
        let part = if cells < told {
            format!("; {cells} of {told} cells answered")
        } else {
            String::new()
        };
        format!("off by {:.2} units at most{part}", worst.units)
    }

    /// The verdict on an answer that is off.
    fn wrong_verdict(
        &self,
        at: usize,
        answer: &NameAnswer,
        cells: &[(usize, usize)],
        worst: Worst,
    ) -> Said {
        let tolerance = self.answers[at].0;
        let off = self.place(worst, answer);
        if cells.iter().all(|(n, k)| answer.cell(*n, *k) == Some(0.0)) {
            return (Verdict::Zero, None, format!("all are 0; {off}"));
        }
        let found = match self.is_right_when_tighter(at) {
            true => Vec::new(),
            false => self.mechanisms(answer, cells, tolerance),
        };
        if let Some((mechanism, units)) = found.first() {
            let others: Vec<&str> = found[1..].iter().map(|(it, _)| it.as_str()).collect();
            let also = if others.is_empty() {
                String::new()
            } else {
                format!(", as {}", others.join(", "))
            };
            let why =
                format!("within {units:.2} units of derivatives with {mechanism}{also}; {off}");
            return (Verdict::MissingTerm, Some(*mechanism), why);
        }
        if let Some(said) = self.coarse_step_verdict(at, answer, cells, &off) {
            return said;
        }
        self.by_tolerances(cells, off)
    }

    /// Whether the answer at a tighter tolerance is right: no term is missing there, and so none
    /// is at this tolerance.
    fn is_right_when_tighter(&self, at: usize) -> bool {
        let is_tighter = |it: &usize| self.answers[*it].0 < self.answers[at].0;
        (0..self.answers.len()).filter(is_tighter).any(|it| {
            let (tolerance, Some(answer)) = (self.answers[it].0, self.answer(it)) else {
                return false;
            };
            let worst = self.worst(answer, &self.cells(tolerance, answer), tolerance);
            worst.is_some_and(|it| it.units <= ALLOWED_UNITS)
        })
    }

    /// Where an answer is off most.
    fn place(&self, Worst { units, n, k }: Worst, answer: &NameAnswer) -> String {
        let states = &self.reference.case.system.states;
        let of = if k == 0 { "time" } else { &states[k - 1] };
        let got = answer.cell(n, k).unwrap_or(f64::NAN);
        let wanted = self.truth[n][k];
        format!("row {n}, d{of} is {got:e}, not {wanted:e}, {units:.3e} units off")
    }

    /// The worst of some cells beside the truth.
    fn worst(
        &self,
        answer: &NameAnswer,
        cells: &[(usize, usize)],
        tolerance: f64,
    ) -> Option<Worst> {
        let units = self.reference.units(self.name);
        let unit = |n: usize, k: usize| tolerance * units[n][k];
        worst(cells, |n, k| answer.cell(n, k).map(|it| (it - self.truth[n][k]).abs() / unit(n, k)))
    }

    /// The mechanisms whose derivatives an answer agrees with, and by how many units.
    fn mechanisms(
        &self,
        answer: &NameAnswer,
        cells: &[(usize, usize)],
        tolerance: f64,
    ) -> Vec<(Mechanism, f64)> {
        let units = self.reference.units(self.name);
        let agrees = |wrong: &Rows, sign: f64| {
            // What is wrong from the first event on grows by another rule than the truth.
            let unit = |n: usize, k: usize| {
                tolerance * (units[n][k] + (n as f64 + 1.0) * wrong[n][k].abs())
            };
            let off = |rows: &Rows, sign: f64| {
                let cell = |n: usize, k: usize| {
                    answer.cell(n, k).map(|it| (it - sign * rows[n][k]).abs() / unit(n, k))
                };
                worst(cells, cell).map_or(f64::INFINITY, |it| it.units)
            };
            let left = off(wrong, sign);
            let explains = left <= EXPLAINED_SHARE * off(&self.truth, 1.0);
            (left <= ALLOWED_UNITS && explains).then_some(left)
        };
        let of = |mechanism: Mechanism| {
            let mut all = self.reference.wrong_derivatives(self.name, mechanism);
            let mut closest = None;
            if mechanism == Mechanism::Sign {
                closest = agrees(&self.truth, -1.0);
            }
            all.drain(..).filter_map(|it| agrees(&it, 1.0)).chain(closest).reduce(f64::min)
        };
        Mechanism::ALL.into_iter().filter_map(|it| Some((it, of(it)?))).collect()
    }

    /// The verdict on differences over a step that is too large; none on an answer that is not said
    /// to be differences.
    fn coarse_step_verdict(
        &self,
        at: usize,
        answer: &NameAnswer,
        cells: &[(usize, usize)],
        off: &str,
    ) -> Option<Said> {
        if !self.answers[at].1?.are_differences {
            return None;
        }
        let units = self.reference.units(self.name);
        let weigh = |rows: &Rows| cells.iter().map(|(n, k)| rows[*n][*k] / units[*n][*k]).collect();
        let error: Vec<f64> = cells
            .iter()
            .filter_map(|(n, k)| Some((answer.cell(*n, *k)? - self.truth[*n][*k]) / units[*n][*k]))
            .collect();
        let quotients = self.reference.quotients(self.name);
        let steps = quotients.steps(&self.truth, &error, weigh);
        if steps.is_empty() {
            return None;
        }
        let told = steps.into_iter().map(|(step, central)| {
            let kind = if central { "central" } else { "one-sided" };
            format!("{kind} differences over a step of {step:.2e}")
        });
        let why = format!("as {}; {off}", told.collect::<Vec<_>>().join(" or "));
        Some((Verdict::WrongLimit, Some(Mechanism::CoarseDifferences), why))
    }

    /// The verdict by whether the error falls from the largest to the smallest of the tolerances at
    /// which the engine answered.
    fn by_tolerances(&self, cells: &[(usize, usize)], off: String) -> Said {
        let at = |it: usize| {
            let answer = self.answer(it)?;
            let worst = self.worst(answer, cells, 1.0)?;
            Some((self.answers[it].0, worst.units, self.answers[it].1?.event_error))
        };
        let mut all: Vec<_> = (0..self.answers.len()).filter_map(at).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (Some(coarse), Some(fine)) = (all.first(), all.last()) else {
            return (Verdict::Noisy, None, off);
        };
        if coarse.0 <= fine.0 {
            let why = format!("{off}; answers at one tolerance do not tell whether it falls");
            return (Verdict::Noisy, None, why);
        }
        // Half of an order and less still falls: a third of the tolerance's own fall.
        let fall = (coarse.0 / fine.0).cbrt();
        let (from, to) = (coarse.1, fine.1);
        let told =
            format!("{off}; from {:e} to {:e} it falls by {:.1e}", coarse.0, fine.0, from / to);
        if from >= fall * to {
            return (Verdict::Noisy, None, told);
        }
        match (coarse.2, fine.2) {
            (Some(from), Some(to)) if to > fine.0 && from < fall * to => {
                (Verdict::Noisy, None, format!("{told}, and that of the events does not either"))
            }
            (Some(_), Some(_)) => (Verdict::WrongLimit, None, told),
            _ => (Verdict::WrongLimit, None, format!("{told}; the events' errors are not known")),
        }
    }
}

/// The largest of the measures of cells; a number that is none is infinite.
fn worst(cells: &[(usize, usize)], measure: impl Fn(usize, usize) -> Option<f64>) -> Option<Worst> {
    let measured = cells.iter().filter_map(|(n, k)| {
        let units = measure(*n, *k)?;
        Some(Worst { units: if units.is_nan() { f64::INFINITY } else { units }, n: *n, k: *k })
    });
    measured.reduce(|a, b| if b.units > a.units { b } else { a })
}
