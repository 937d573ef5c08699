//! Two recorded versions against each other, in figures that repeat from run to run.
//!
//! Instructions do, where both were counted on the same kind of machine, and evaluations per event
//! do. Times of two runs do not; what does is the least time in units of the least time of the
//! floor beside it. It is recorded twice, so that here too slower means slower twice in a row.
//! Where instructions are counted they decide, and times only warn.

use super::verdict::{FAILURE_QUOTIENT, WARNING_QUOTIENT, WorkloadVerdict};
use crate::history::HistoryRecord;

/// A workload of both versions.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedChange {
    /// The workload.
    pub bench: String,
    /// The figure that is compared.
    pub figure: &'static str,
    /// The old and the new figure.
    pub figures: [f64; 2],
    /// The verdict.
    pub verdict: WorkloadVerdict,
}

impl RecordedChange {
    /// New over old.
    #[must_use]
    pub fn quotient(&self) -> f64 {
        self.figures[1] / self.figures[0]
    }
}

/// All changes of a workload; the deterministic figures come first.
#[must_use]
pub fn changes(old: &HistoryRecord, new: &HistoryRecord) -> Vec<RecordedChange> {
    let change = |figure, figures: [f64; 2], verdict| RecordedChange {
        bench: old.bench.clone(),
        figure,
        figures,
        verdict,
    };
    let settled =
        |figure, figures: [f64; 2]| change(figure, figures, repeatable(figures[1] / figures[0]));
    let alike = old.target_cpu == new.target_cpu;
    let counted = old.instructions.zip(new.instructions).filter(|_| alike);
    let mut all: Vec<RecordedChange> =
        counted.map(|(old, new)| settled("instructions", [old, new])).into_iter().collect();
    let evaluations = [old.evaluations_per_switch, new.evaluations_per_switch];
    all.push(settled("evaluations", evaluations));
    all.push(change("state_error", errors(old, new), accuracy(errors(old, new))));
    let quotients = [new.floors / old.floors, new.floors_again / old.floors_again];
    let verdict = match WorkloadVerdict::new(&quotients) {
        WorkloadVerdict::Fail if counted.is_some() => WorkloadVerdict::Warn,
        verdict => verdict,
    };
    all.push(change("floors", [old.floors, new.floors], verdict));
    all
}

/// Below this an error is rounding of the last digits: as `validate --baseline` has it.
const ROUNDING_ERROR: f64 = 1e-14;

fn errors(old: &HistoryRecord, new: &HistoryRecord) -> [f64; 2] {
    let seen = |error: f64| if error < ROUNDING_ERROR { ROUNDING_ERROR } else { error };
    [seen(old.state_error_max), seen(new.state_error_max)]
}

/// Speed is not bought with digits: an error more than twice as large fails.
fn accuracy([old, new]: [f64; 2]) -> WorkloadVerdict {
    if new <= 2.0 * old { WorkloadVerdict::Pass } else { WorkloadVerdict::Fail }
}

/// A figure that repeats needs no second measurement: it would say the same.
fn repeatable(quotient: f64) -> WorkloadVerdict {
    // Written so that a NaN is slower.
    if quotient < WARNING_QUOTIENT {
        WorkloadVerdict::Pass
    } else if quotient < FAILURE_QUOTIENT {
        WorkloadVerdict::Warn
    } else {
        WorkloadVerdict::Fail
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::Figures;
    use crate::provenance::Build;

    fn record(
        instructions: Option<f64>,
        floors: f64,
        evaluations_per_switch: f64,
    ) -> HistoryRecord {
        let figures = Figures {
            instructions,
            best_ns: 100.0,
            median_ns: 100.0,
            floor_ns: 30.0,
            floors,
            floors_again: floors,
            evaluations_per_switch,
            state_error_max: 0.0,
        };
        HistoryRecord::new(Build::new("", "rustc", "any"), "one", figures)
    }

    fn words(old: &HistoryRecord, new: &HistoryRecord) -> Vec<(&'static str, &'static str)> {
        changes(old, new).iter().map(|it| (it.figure, it.verdict.word())).collect()
    }

    #[test]
    fn counts_are_held_to_two_percent() {
        let old = record(Some(1000.0), 5.0, 1.0);
        let new = |instructions, evaluations| record(Some(instructions), 5.0, evaluations);
        assert_eq!(words(&old, &new(1030.0, 1.0))[0], ("instructions", "fail"));
        assert_eq!(words(&old, &new(1015.0, 1.0))[0], ("instructions", "warn"));
        assert_eq!(words(&old, &new(1005.0, 1.0))[0], ("instructions", "pass"));
        assert_eq!(words(&old, &new(900.0, 1.03))[1], ("evaluations", "fail"));
    }

    #[test]
    fn times_are_slower_where_both_halves_say_so() {
        let old = record(None, 5.0, 1.0);
        let said = |floors: f64, floors_again: f64| {
            let new = HistoryRecord { floors_again, ..record(None, floors, 1.0) };
            words(&old, &new).pop()
        };
        assert_eq!(said(5.0, 5.0), Some(("floors", "pass")));
        assert_eq!(said(5.08, 5.08), Some(("floors", "warn")));
        assert_eq!(said(5.2, 5.0), Some(("floors", "warn")));
        assert_eq!(said(5.15, 5.15), Some(("floors", "fail")));
        assert_eq!(words(&old, &old).len(), 3);
    }

    #[test]
    fn where_instructions_are_counted_times_only_warn() {
        let old = record(Some(1000.0), 5.0, 1.0);
        assert_eq!(words(&old, &record(Some(1000.0), 9.0, 1.0)).pop(), Some(("floors", "warn")));
    }

    #[test]
    fn digits_are_no_price_for_speed() {
        let with = |state_error_max| HistoryRecord { state_error_max, ..record(None, 5.0, 1.0) };
        let said = |old, new| words(&with(old), &with(new))[1];
        assert_eq!(said(1e-12, 3e-12), ("state_error", "fail"));
        assert_eq!(said(1e-12, 1.9e-12), ("state_error", "pass"));
        assert_eq!(said(0.0, 9e-15), ("state_error", "pass"));
        assert_eq!(said(1e-12, f64::NAN), ("state_error", "fail"));
    }

    #[test]
    fn instructions_of_different_targets_are_not_compared() {
        let old = record(Some(1000.0), 5.0, 1.0);
        let new =
            HistoryRecord { target_cpu: "other".to_owned(), ..record(Some(2000.0), 5.0, 1.0) };
        assert_eq!(words(&old, &new)[0].0, "evaluations");
    }
}
